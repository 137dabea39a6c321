/* The field tables of what a body meets. */
#include "model/scene_tables.h"
#include <math.h>

/* ---- Obstacles ---- */

static const YamlTable plane_table = {
    .name = "plane",
    .size = sizeof(PlaneScene),
    .doc = "A half space. It turns about its point.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(PlaneScene, point), .unit = "m", .fallback = "[0, 0, 0]", .doc = "a point of it"},
        {YAML_VECTOR(PlaneScene, normal), .fallback = "[0, 0, 1]",
         .doc = "to where it is free; of any length but 0"},
        {0}}};

static const YamlTable sphere_table = {
    .name = "sphere",
    .size = sizeof(SphereScene),
    .doc = "A ball, or a cavity. It turns about its centre.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(SphereScene, center), .unit = "m", .required = true, .doc = "its centre"},
        {YAML_NUMBER(SphereScene, radius), .unit = "m", .range = "(0, inf)", .required = true,
         .doc = "its radius"},
        {YAML_BOOL(SphereScene, inside), .doc = "inside is free: a cavity"},
        {0}}};

static const YamlTable cylinder_table = {
    .name = "cylinder",
    .size = sizeof(CylinderScene),
    .doc = "An infinite round bar, or a pipe. It turns about its point.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(CylinderScene, point), .unit = "m", .required = true, .doc = "a point of its axis"},
        {YAML_VECTOR(CylinderScene, axis), .required = true, .doc = "along it; of any length but 0"},
        {YAML_NUMBER(CylinderScene, radius), .unit = "m", .range = "(0, inf)", .required = true,
         .doc = "its radius"},
        {YAML_BOOL(CylinderScene, inside), .doc = "inside is free: a pipe"},
        {0}}};

static const YamlTable box_table = {
    .name = "box",
    .size = sizeof(BoxScene),
    .doc = "A box along the axes whose edges and corners are rounded: at sharp ones a force would jump. It "
           "turns about its centre.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(BoxScene, center), .unit = "m", .required = true, .doc = "its centre"},
        {YAML_VECTOR(BoxScene, half), .unit = "m", .range = "(0, inf)", .required = true,
         .doc = "half its lengths along x, y, z"},
        {YAML_NUMBER(BoxScene, rounding), .unit = "m", .range = "(0, inf)",
         .doc = "radius of edges and corners, at most the smallest half; a tenth of that if absent"},
        {0}}};

static const YamlTable height_field_table = {
    .name = "height_field",
    .size = sizeof(HeightFieldScene),
    .doc =
        "Ground z = h(x, y), free above: the bicubic spline (C2) through its heights at the nodes of a "
        "grid. Beyond the range it goes on level. Contact knows the height above it, z - h: no distance "
        "where it is steep, and forces are along its normal. It turns about the middle of its range, z = 0.",
    .fields = (const YamlField[]){
        {YAML_TEXT(HeightFieldScene, formula), .one_of = 1, .required = true,
         .doc = "an expression of x and y, in m"},
        {YAML_FILE(HeightFieldScene, image), .one_of = 1, .required = true,
         .doc = "a PNG, JPEG, PGM or PPM image over the range: black is 0, white is height, row 0 at +y"},
        {YAML_NUMBER(HeightFieldScene, height), .when = "image", .unit = "m",
         .doc = "of an image: where it is white"},
        {YAML_ROWS(HeightFieldScene, range), .unit = "m", .min_count = 2, .max_count = 2, .required = true,
         .doc = "its lower and its upper corner, [[x0, y0], [x1, y1]]"},
        {YAML_INTEGER_VECTOR(HeightFieldScene, cells), .range = "[2, 4096]",
         .doc = "of the grid along x and y; if absent [64, 64], of an image its pixels"},
        WHERE_ROW(HeightFieldScene),
        {0}}};

static const YamlTable tube_table = {
    .name = "tube",
    .size = sizeof(TubeScene),
    .doc = "A tube along an axis, inside is free: round across the axis, with a radius and a middle that "
           "change along it, cubic splines (C2) through samples. Beyond its range it goes straight on, as "
           "wide as it is there. It turns about the middle of its line.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(TubeScene, axis), .choices = YAML_NAMES("x", "y", "z"), .required = true,
         .doc = "along which it lies"},
        {YAML_TEXT(TubeScene, radius), .required = true,
         .doc = "an expression of s, the coordinate along the axis, in m; positive"},
        {YAML_TEXTS(TubeScene, center), .min_count = 2, .max_count = 2, .fallback = "[\"0\", \"0\"]",
         .doc = "its middle: two expressions of s, in m, for the other two coordinates in their order"},
        {YAML_VECTOR(TubeScene, range), .unit = "m", .required = true, .doc = "from and to which s"},
        {YAML_INTEGER(TubeScene, cells), .range = "[2, 100000]", .fallback = "256",
         .doc = "pieces of the splines"},
        {0}}};

static const YamlTable block_table = {
    .name = "mesh of an obstacle",
    .size = sizeof(BlockScene),
    .doc = "What a closed triangle mesh encloses: a tricubic spline (C2) through its signed distance at the "
           "nodes of a grid, which rounds edges and corners on the scale of a cell. Normals that all point "
           "inwards are turned. It turns about the middle of its box.",
    .fields = (const YamlField[]){
        {YAML_FILE(BlockScene, file), .required = true, .short_form = true,
         .doc = "an OBJ, PLY, STL or Gmsh .msh file; vertices at equal places are one"},
        {YAML_NUMBER(BlockScene, scale), .range = "(0, inf)", .fallback = "1",
         .doc = "factor on its coordinates, 1.0e-3 for a file in millimetres"},
        {YAML_NUMBER(BlockScene, cell), .unit = "m", .range = "(0, inf)",
         .doc = "of the grid; 1/48 of the mesh's diagonal if absent. Half as large takes 8 times the memory"},
        {0}}};

/* Of what needs steps of time. */
#define MOTIONS      "/job: simulate, trajectory"
#define FRICTIONLESS "in statics contact is frictionless"

const YamlTable obstacle_table = {
    .name = "obstacles",
    .size = sizeof(ObstacleScene),
    .doc = "A rigid thing that the body meets, given where it is without its motion.",
    .fields = (const YamlField[]){
        {YAML_TEXT(ObstacleScene, name), .doc = "its name in the result; obstacle1, obstacle2, .. if absent"},
        {YAML_OPTIONAL(ObstacleScene, plane, &plane_table), .one_of = 1, .required = true,
         .doc = "a floor, or a wall"},
        {YAML_OPTIONAL(ObstacleScene, sphere, &sphere_table), .one_of = 1, .required = true,
         .doc = "a ball, or a cavity"},
        {YAML_OPTIONAL(ObstacleScene, cylinder, &cylinder_table), .one_of = 1, .required = true,
         .doc = "a bar, or a pipe"},
        {YAML_OPTIONAL(ObstacleScene, box, &box_table), .one_of = 1, .required = true,
         .doc = "a box with round edges"},
        {YAML_OPTIONAL(ObstacleScene, height_field, &height_field_table), .one_of = 1, .required = true,
         .doc = "ground"},
        {YAML_OPTIONAL(ObstacleScene, tube, &tube_table), .one_of = 1, .required = true,
         .doc = "a pipe of changing width"},
        {YAML_OPTIONAL(ObstacleScene, mesh, &block_table), .one_of = 1, .required = true,
         .doc = "any solid thing"},
        {YAML_NUMBER(ObstacleScene, friction), .when = MOTIONS, .otherwise = FRICTIONLESS,
         .range = "[0, inf)", .doc = "coefficient of friction; contact.friction if absent"},
        {YAML_OPTIONAL(ObstacleScene, move, &path_table),
         .doc = "how far it has moved, m; friction feels its velocity"},
        {YAML_OPTIONAL(ObstacleScene, turn, &path_table),
         .doc = "how far it has turned: a rotation vector, rad"},
        {0}}};

/* ---- Contact ---- */

static const YamlTable self_contact_table = {
    .name = "self contact",
    .size = sizeof(SelfContactScene),
    .doc = "Whether parts of the body meet each other. A table with distance or stiffness asks for it, too.",
    .fields = (const YamlField[]){
        {YAML_BOOL(SelfContactScene, enabled), .short_form = true, .doc = "they do"},
        {YAML_NUMBER(SelfContactScene, distance), .unit = "m", .range = "(0, inf)",
         .doc = "between middles at which they begin to; the thickness of a shell, twice the "
                "radius of a rod, a "
                "fifth of the mean edge of a solid's surface if absent"},
        {YAML_NUMBER(SelfContactScene, stiffness), .unit = "J", .range = "(0, inf)",
         .doc = "scale of its energy, per pair; Young's modulus times the cube of the (largest) distance if "
                "absent"},
        {0}}};

bool self_contact_is_asked(const SelfContactScene *self)
{
    return self->enabled || !isnan(self->distance) || !isnan(self->stiffness);
}

#define AUTO_TABLE(id, title, u, r, of, what, number)                                                        \
    static const YamlTable id##_table = {                                                                    \
        .name = title,                                                                                       \
        .size = sizeof(AutoScene),                                                                           \
        .doc = of,                                                                                           \
        .fields = (const YamlField[]){{YAML_CHOICE(AutoScene, mode), .choices = YAML_NAMES("auto"),          \
                                       .one_of = 1, .short_form = true, .required = true, .doc = what},      \
                                      {YAML_NUMBER(AutoScene, value), .unit = u, .range = r, .one_of = 1,    \
                                       .short_form = true, .required = true, .doc = number},                 \
                                      {0}}}

AUTO_TABLE(
    contact_stiffness, "stiffness of contact", "N/m", "(0, inf)",
    "How much an obstacle resists to be entered.",
    "from the body as it is at the start, so that what rests or is pressed sinks in by less than 1 % of the "
    "thickness, or of a rod's radius; derivatives by an unknown thickness leave it as it is",
    "per contact point");
AUTO_TABLE(contact_offset, "offset of contact", "m", "[0, inf)",
           "How far from an obstacle the body's middle surface or line stays.",
           "half the thickness of a shell, the radius of a rod, each where it touches; 0 of a solid",
           "a distance");

const YamlTable contact_table = {
    .name = "contact",
    .size = sizeof(ContactScene),
    .doc = "How the body meets obstacles and itself.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(ContactScene, friction), .when = MOTIONS, .otherwise = FRICTIONLESS, .range = "[0, inf)",
         .fallback = "0",
         .doc = "coefficient of friction with obstacles without one of their own, and itself"},
        {YAML_TABLE(ContactScene, self, &self_contact_table), .fallback = "false",
         .doc = "do parts of the body meet each other?"},
        {YAML_TABLE(ContactScene, stiffness, &contact_stiffness_table), .when = "/obstacles",
         .fallback = "auto", .doc = "of obstacles"},
        {YAML_TABLE(ContactScene, offset, &contact_offset_table), .when = "/obstacles", .fallback = "auto",
         .doc = "from obstacles"},
        {YAML_NUMBER(ContactScene, slip_speed), .when = MOTIONS, .otherwise = FRICTIONLESS, .unit = "m/s",
         .range = "(0, inf)", .fallback = "1 mm/s",
         .doc = "up to which friction grows: what sticks creeps below it"},
        {YAML_CHOICE(ContactScene, coupling), .when = MOTIONS, .otherwise = FRICTIONLESS,
         .choices = YAML_NAMES("lagged", "implicit"), .fallback = "lagged",
         .doc = "friction has the normal forces and planes of the step's start, or of its end, which takes "
                "several solves a step"},
        {0}}};

/* ---- Water ---- */

static const YamlTable stream_table = {
    .name = "velocity of water",
    .size = sizeof(StreamScene),
    .doc = "How a fluid moves.",
    .fields = (const YamlField[]){{YAML_VECTOR(StreamScene, value), .unit = "m/s", .one_of = 1,
                                   .required = true, .short_form = true, .doc = "the same everywhere"},
                                  {YAML_TEXTS(StreamScene, formula), .one_of = 1, .required = true,
                                   .short_form = true, .min_count = 3, .max_count = 3,
                                   .doc = "three expressions of x, y, z, r and the time t, in m/s"},
                                  WHERE_ROW(StreamScene),
                                  {0}}};

const YamlTable water_table = {
    .name = "water",
    .size = sizeof(WaterScene),
    .doc = "A fluid all around, which drags and thrusts what moves through it. Buoyancy and added mass are "
           "left out.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(WaterScene, density), .unit = "kg/m^3", .range = "(0, inf)", .fallback = "1000",
         .doc = "its mass density"},
        {YAML_TABLE(WaterScene, velocity, &stream_table), .fallback = "[0, 0, 0]", .doc = "how it moves"},
        {YAML_CHOICE(WaterScene, sides), .when = "/shell", .choices = YAML_NAMES("two", "outer"),
         .fallback = "two",
         .doc = "of a shell: both sides of a face feel the stream, or, of closed surfaces, the outer ones "
                "(as of a solid)"},
        {YAML_NUMBER(WaterScene, viscosity), .when = "/rod", .unit = "Pa s", .range = "[0, inf)",
         .fallback = "1.0e-3", .doc = "of rods: its dynamic viscosity"},
        {0}}};
