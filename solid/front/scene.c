/* The field table of solids. */
#include "solid/front/scene.h"
#include "model/scene_tables.h"

const YamlTable solid_mesh_table = {
    .name = "mesh of a solid",
    .size = sizeof(SolidMeshScene),
    .doc = "The tetrahedra of a solid at rest: from a file, generated, of a sheet that is made thick, or of "
           "a closed surface "
           "that is filled. A box or plate lies from the origin along +x, +y and +z, with groups of its "
           "sides: left and right "
           "(x), front and back (y), bottom and top (z). A hand lies on the plane z = 0, its palm from the "
           "origin, four "
           "fingers along +y and the thumb along +x: groups wrist, palm, thumb, index, middle, ring, little, "
           "and anchors, "
           "five times three nodes below and above. A heart is a cup, open above, its rim in the plane z = "
           "0: groups rim, "
           "centre, lower, ribbon, bottom (outside) and top (inside). A starfish lies on the plane z = 0 "
           "around the origin: "
           "groups arm1 (along +x) to arm5, centre, bottom and top. What is extruded keeps the groups of its "
           "sheet, and has "
           "bottom and top. docs/meshes.md says which groups are of nodes, faces or tetrahedra.",
    .fields = (const YamlField[]){
        {YAML_FILE(SolidMeshScene, file), .one_of = 1, .required = true, .short_form = true,
         .doc = "a Gmsh .msh (2.2 or 4.1, ASCII) file with tetrahedra of 4 or 10 nodes, and its physical "
                "groups"},
        {YAML_CHOICE(SolidMeshScene, shape), .one_of = 1, .required = true,
         .choices = YAML_NAMES("box", "plate", "hand", "heart", "starfish"), .doc = "a generated mesh"},
        {YAML_OPTIONAL(SolidMeshScene, extrude, &mesh_table), .one_of = 1, .required = true,
         .doc = "a mesh of triangles that is made thick along its normals: three tetrahedra over each, in "
                "layers"},
        {YAML_FILE(SolidMeshScene, surface), .one_of = 1, .required = true,
         .doc = "a file with a closed surface of triangles, which the program tetgen fills; it stays as it "
                "is, with its "
                "groups"},
        {YAML_NUMBERS(SolidMeshScene, size), .unit = "m", .range = "(0, inf)", .min_count = 1, .max_count = 3,
         .doc = "of a box or plate: its lengths along x, y and z; of a hand: the length of its palm; of a "
                "heart or starfish: "
                "its diameter; of a surface: the edges of the tetrahedra within, as large as they become"},
        {YAML_INTEGERS(SolidMeshScene, cells), .range = "[1, inf)", .min_count = 3, .max_count = 3,
         .doc = "of a box or plate: cells along x, y and z"},
        {YAML_INTEGER(SolidMeshScene, n), .also = YAML_NAMES("divisions", "false"), .range = "[1, 200]",
         .doc = "of a hand: cells in a tenth of its palm (1: 1248 tetrahedra); of a heart: rings (10); of a "
                "starfish: cells "
                "across an arm (3)"},
        {YAML_CHOICE(SolidMeshScene, pattern), .choices = YAML_NAMES("right", "alternate", "crossed"),
         .fallback = "right", .doc = "of a plate: how its cells are split, seen from above"},
        {YAML_NUMBER(SolidMeshScene, thickness), .unit = "m", .range = "(0, inf)",
         .doc = "of what is extruded; of a hand (size/20), a heart (its wall, 3/40 size) or a starfish (3/50 "
                "size)"},
        {YAML_INTEGER(SolidMeshScene, layers), .range = "[1, inf)", .fallback = "1",
         .doc = "of what is extruded, a hand, heart or starfish: tetrahedra through its thickness"},
        {YAML_NUMBER(SolidMeshScene, scale), .range = "(0, inf)", .fallback = "1",
         .doc = "factor on the coordinates of a file or surface, e.g. 1.0e-3 for one in millimetres"},
        {0}}};

static const YamlTable skin_place_table = {
    .name = "place of a skin",
    .size = sizeof(SkinPlace),
    .doc = "Where a skin is: a name, or {group: NAME}.",
    .fields = (const YamlField[]){{YAML_TEXT(SkinPlace, group), .required = true, .short_form = true,
                                   .doc = "a named group of faces of the surface"},
                                  {0}}};

static const YamlTable skin_table = {
    .name = "skin",
    .size = sizeof(SkinScene),
    .doc = "A thin layer on the surface of a solid: magnetised, and with a Young's modulus of its own a film "
           "that "
           "resists "
           "stretching (not bending).",
    .fields = (const YamlField[]){
        {YAML_NUMBER(SkinScene, thickness), .unit = "m", .range = "(0, inf)", .required = true,
         .doc = "of the layer"},
        {YAML_TABLE(SkinScene, magnetization, &magnetization_table), .fallback = "[0, 0, 0]",
         .doc = "its remanent magnetisation, per face of the surface"},
        {YAML_OPTIONAL(SkinScene, young, &young_table),
         .doc = "of a film: its Young's modulus, per face of the surface; without, the layer bears nothing"},
        {YAML_NUMBER(SkinScene, poisson), .when = "young", .range = "[0, 0.5]",
         .doc = "of a film, which needs it: its Poisson's ratio"},
        {YAML_CHOICE(SkinScene, material), .when = "young",
         .choices = YAML_NAMES("st_venant_kirchhoff", "neo_hookean"), .fallback = "st_venant_kirchhoff",
         .doc = "of a film: neo_hookean resists being crushed"},
        {YAML_OPTIONAL(SkinScene, on, &skin_place_table), .also = ON_NAMES,
         .doc = "where it is; all of the surface if absent"},
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
        {YAML_OPTIONAL(SolidScene, skin, &skin_table), .doc = "a layer on its surface: magnetised, a film"},
        {YAML_TABLE(SolidScene, magnetization, &magnetization_table), .fallback = "[0, 0, 0]",
         .doc = "remanent magnetisation of the volume, per tetrahedron"},
        {YAML_NUMBER(SolidScene, coercivity), .unit = "A/m", .range = "(0, inf)",
         .doc = "of what it is magnetised with: a larger field than half of it, anywhere on what is "
                "magnetised, is a "
                "warning; not looked at if absent"},
        {YAML_OPTIONAL(SolidScene, pose, &pose_table), .when = "!/start",
         .doc = "where a job starts; at rest if absent"},
        {YAML_OPTIONAL(SolidScene, velocity, &velocity_table), .when = "/job: simulate, trajectory & !/start",
         .doc = "of the free coordinates at the start of a motion; at rest if absent"},
        {YAML_NUMBER(SolidScene, damping), .when = "/job: simulate, trajectory", .unit = "N s/m",
         .range = "[0, inf)", .fallback = "0",
         .doc =
             "of a simulation: viscous damping c at every node: 2 z m w, with a node's mass m, the angular "
             "frequency w and the part z of critical damping that is wanted (as of a shell)"},
        {YAML_VECTOR(SolidScene, gravity), .unit = "m/s^2", .fallback = "[0, 0, 0]",
         .doc = "acceleration of gravity"},
        {0}}};
