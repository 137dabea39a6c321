/* The field table of solids. */
#include "solid/front/scene.h"
#include "model/scene_tables.h"

static const YamlTable solid_mesh_table = {
    .name = "mesh of a solid",
    .size = sizeof(SolidMeshScene),
    .doc = "The tetrahedra of a solid at rest, from a file or generated. A box has groups of nodes: left and "
           "right (x), front "
           "and back (y), bottom and top (z).",
    .fields = (const YamlField[]){
        {YAML_FILE(SolidMeshScene, file), .one_of = 1, .required = true, .short_form = true,
         .doc = "a Gmsh .msh (2.2 or 4.1, ASCII) file with tetrahedra of 4 or 10 nodes, and its physical "
                "groups"},
        {YAML_CHOICE(SolidMeshScene, shape), .one_of = 1, .required = true, .choices = YAML_NAMES("box"),
         .doc = "a generated mesh"},
        {YAML_NUMBERS(SolidMeshScene, size), .unit = "m", .range = "(0, inf)", .min_count = 3, .max_count = 3,
         .doc = "of a box: its lengths along x, y and z, from the origin"},
        {YAML_INTEGERS(SolidMeshScene, cells), .range = "[1, inf)", .min_count = 3, .max_count = 3,
         .doc = "of a box: cells along x, y and z, of six tetrahedra each"},
        {YAML_NUMBER(SolidMeshScene, scale), .range = "(0, inf)", .fallback = "1",
         .doc = "factor on the coordinates of a file, e.g. 1.0e-3 for one in millimetres"},
        {0}}};

static const YamlTable skin_table = {
    .name = "skin",
    .size = sizeof(SkinScene),
    .doc = "A magnetised layer on the surface of a solid, thin enough to bear nothing.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(SkinScene, thickness), .unit = "m", .range = "(0, inf)", .required = true,
         .doc = "of the layer"},
        {YAML_TABLE(SkinScene, magnetization, &magnetization_table), .fallback = "[0, 0, 0]",
         .doc = "its remanent magnetisation, per face of the surface"},
        {YAML_TEXT(SkinScene, on), .doc = "the group of faces that it is on; all of the surface if absent"},
        {0}}};

const YamlTable solid_table = {
    .name = "solid",
    .size = sizeof(SolidScene),
    .doc = "An elastic solid of tetrahedra, which may be magnetised on its surface or within.",
    .fields = (const YamlField[]){
        {YAML_TABLE(SolidScene, mesh, &solid_mesh_table), .required = true, .doc = "its mesh at rest"},
        {YAML_INTEGER(SolidScene, order), .range = "[1, 2]", .fallback = "2",
         .doc = "2: quadratic tetrahedra, of 10 nodes (a linear mesh gets the middles of its edges); 1: "
                "linear ones, which "
                "are far too stiff in bending"},
        {YAML_CHOICE(SolidScene, material),
         .choices = YAML_NAMES("neo_hookean", "neo_hookean_log", "st_venant_kirchhoff"),
         .fallback = "neo_hookean",
         .doc = "its energy; neo_hookean is finite where it is turned inside out, and finds back"},
        {YAML_TABLE(SolidScene, young, &young_table), .required = true,
         .doc = "Young's modulus, per tetrahedron"},
        {YAML_NUMBER(SolidScene, poisson), .range = "[0, 0.5]", .required = true,
         .doc = "Poisson's ratio, below 0.5"},
        {YAML_NUMBER(SolidScene, density), .unit = "kg/m^3", .range = "(0, inf)", .fallback = "1000",
         .doc = "mass density"},
        {YAML_NUMBER(SolidScene, averaging), .range = "[0, 1]", .fallback = "0",
         .doc = "part of the resistance to changes of volume that is taken of means, against locking: over a "
                "quadratic "
                "tetrahedron (at most 0.6), or over a patch of linear ones"},
        {YAML_OPTIONAL(SolidScene, skin, &skin_table), .doc = "a magnetised layer on its surface"},
        {YAML_TABLE(SolidScene, magnetization, &magnetization_table), .fallback = "[0, 0, 0]",
         .doc = "remanent magnetisation of the volume, per tetrahedron"},
        {YAML_OPTIONAL(SolidScene, pose, &pose_table), .when = "!/start",
         .doc = "where a job starts; at rest if absent"},
        {YAML_OPTIONAL(SolidScene, velocity, &velocity_table), .when = "/job: simulate, trajectory & !/start",
         .doc = "of the free coordinates at the start of a motion; at rest if absent"},
        {YAML_NUMBER(SolidScene, damping), .when = "/job: simulate, trajectory", .unit = "N s/m",
         .range = "[0, inf)", .fallback = "0", .doc = "of a simulation: viscous damping at every node"},
        {YAML_VECTOR(SolidScene, gravity), .unit = "m/s^2", .fallback = "[0, 0, 0]",
         .doc = "acceleration of gravity"},
        {0}}};
