/* The field table of shells. */
#include "shell/front/scene.h"
#include "model/scene_tables.h"

const YamlTable shell_table = {
    .name = "shell",
    .size = sizeof(ShellScene),
    .doc = "A magnetised thin shell.",
    .fields = (const YamlField[]){
        {YAML_TABLE(ShellScene, mesh, &mesh_table), .required = true, .doc = "its mesh at rest"},
        {YAML_OPTIONAL(ShellScene, pose, &pose_table), .when = "!/start",
         .doc = "where a job starts; at rest if absent"},
        {YAML_OPTIONAL(ShellScene, velocity, &velocity_table), .when = "/job: simulate, trajectory & !/start",
         .doc = "of the free coordinates at the start of a motion; at rest if absent"},
        {YAML_TABLE(ShellScene, thickness, &thickness_table), .required = true,
         .doc = "thickness h, half of it on either side of the mesh"},
        {YAML_TABLE(ShellScene, young, &young_table), .required = true, .doc = "Young's modulus"},
        {YAML_NUMBER(ShellScene, poisson), .range = "[0, 0.5]", .required = true,
         .doc = "Poisson's ratio (plane stress)"},
        {YAML_TABLE(ShellScene, density, &density_table), .fallback = "1000", .doc = "mass density"},
        {YAML_CHOICE(ShellScene, material), .choices = YAML_NAMES("st_venant_kirchhoff", "neo_hookean"),
         .fallback = "st_venant_kirchhoff",
         .doc = "of the stretching; neo_hookean resists being crushed, and is incompressible for a Poisson's "
                "ratio of 0.5"},
        {YAML_CHOICE(ShellScene, bending), .choices = YAML_NAMES("midedge", "hinge"), .fallback = "midedge",
         .doc =
             "midedge converges on any mesh; hinge is faster, and on all but right-diagonal and equilateral "
             "meshes plates sag by up to 48 % too little"},
        {YAML_TABLE(ShellScene, fold, &fold_table), .fallback = "1",
         .doc = "factor on the curvature of each edge"},
        {YAML_TABLE(ShellScene, magnetization, &magnetization_table), .fallback = "[0, 0, 0]",
         .doc = "remanent magnetisation"},
        {YAML_NUMBER(ShellScene, coercivity), .unit = "A/m", .range = "(0, inf)",
         .doc = "of what it is magnetised with: a larger field than half of it, anywhere on what is "
                "magnetised, is a "
                "warning; not looked at if absent"},
        {YAML_NUMBER(ShellScene, damping), .when = "/job: simulate, trajectory", .unit = "N s/m",
         .range = "[0, inf)", .fallback = "0",
         .doc =
             "of a simulation: viscous damping c at every vertex. A vertex of mass m whose motion has the "
             "angular frequency w loses amplitude as exp(-z w t) with z = c/(2 m w): c = 2 z m w, where m is "
             "the body's mass over its vertices and w = 2 pi times the lowest frequency of `modes`; 0.05 is "
             "a usual z of silicone"},
        {YAML_VECTOR(ShellScene, gravity), .unit = "m/s^2", .fallback = "[0, 0, 0]",
         .doc = "acceleration of gravity"},
        {0}}};

const ShellScene *shell_scene(const Scene *scene)
{
    return scene_of(scene, &shell_body);
}
