/* The field tables of rods. */
#include "rod/front/scene.h"
#include "model/scene_tables.h"

#define MOTIONS "/job: simulate, trajectory"
#define STATES  "/job: equilibrium, evaluate, design, simulate, trajectory" /* what has a discrete rod */

static const YamlTable noise_table = {
    .name = "noise",
    .size = sizeof(NoiseScene),
    .doc = "How far sampled points are off the curve.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(NoiseScene, mode), .choices = YAML_NAMES("auto"), .one_of = 1, .short_form = true,
         .required = true, .doc = "found by generalised cross-validation"},
        {YAML_NUMBER(NoiseScene, value), .unit = "m", .range = "[0, inf)", .one_of = 1, .short_form = true,
         .required = true, .doc = "standard deviation of each coordinate; 0: the points are exact"},
        {0}}};

static const YamlTable rod_curve_table = {
    .name = "curve of a rod",
    .size = sizeof(RodCurveScene),
    .doc = "The shape that a hanging rod has, from its clamp on; taken by its arclength.",
    .fields = (const YamlField[]){
        {YAML_TEXTS(RodCurveScene, formula), .one_of = 1, .required = true, .min_count = 3, .max_count = 3,
         .doc = "three expressions, in m, of the parameter (and of n, the number of the strand, from 0)"},
        {YAML_FILE(RodCurveScene, file), .one_of = 1, .required = true,
         .doc =
             "points: a CSV file with rows x, y, z or s, x, y, z (s the arclength), or the polylines of an "
             "OBJ or SVG file (mm); a smooth curve is put through them"},
        {YAML_TEXT(RodCurveScene, parameter), .when = "formula", .fallback = "u",
         .doc = "of a formula: its name"},
        {YAML_NUMBERS(RodCurveScene, range), .when = "formula", .min_count = 2, .max_count = 2,
         .doc = "of a formula: the parameter at the clamp and at the free end"},
        {YAML_INTEGER(RodCurveScene, strands), .when = "formula", .range = "[1, 1000000]", .fallback = "1",
         .doc = "of a formula: how many rods, n = 0, 1, .."},
        WHERE_ROW(RodCurveScene),
        {YAML_NUMBER(RodCurveScene, scale), .when = "file", .range = "(0, inf)", .fallback = "1",
         .doc = "of a file: factor on its coordinates"},
        {YAML_TABLE(RodCurveScene, noise, &noise_table), .when = "file", .fallback = "auto",
         .doc = "of a file"},
        {0}}};

static const YamlTable strain_table = {
    .name = "natural_strain",
    .size = sizeof(StrainScene),
    .doc = "Twist, k1 and k2 of the unloaded rod, 1/m, in its frames.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(StrainScene, value), .unit = "1/m", .one_of = 1, .required = true, .short_form = true,
         .doc = "the same everywhere"},
        {YAML_TEXTS(StrainScene, formula), .one_of = 1, .required = true, .short_form = true, .min_count = 3,
         .max_count = 3, .doc = "three expressions, in 1/m, of the arclength s and the length L"},
        {YAML_FILE(StrainScene, file), .one_of = 1, .required = true,
         .doc = "a CSV file with rows s, twist, k1, k2: at the elements' middles as they are (a round trip), "
                "else along half of the rod at least: linear between the rows, constant beyond them"},
        WHERE_ROW(StrainScene),
        {0}}};

/* Of a number along a rod, in that unit. */
#define ALONG_TABLE(id, table_name, table_doc, unit_name)                                                    \
    static const YamlTable id = {                                                                            \
        .name = table_name,                                                                                  \
        .size = sizeof(AlongScene),                                                                          \
        .doc = table_doc,                                                                                    \
        .fields = (const YamlField[]){                                                                       \
            {YAML_NUMBER(AlongScene, value), .unit = unit_name, .range = "(0, inf)", .one_of = 1,            \
             .required = true, .short_form = true, .doc = "the same everywhere"},                            \
            {YAML_TEXT(AlongScene, formula), .one_of = 1, .required = true, .short_form = true,              \
             .doc = "an expression of the arclength s and the length L"},                                    \
            {YAML_FILE(AlongScene, file), .one_of = 1, .required = true,                                     \
             .doc = "a CSV file with rows of s and the number, along half of the rod at least: linear "      \
                    "between the rows, constant beyond them"},                                               \
            WHERE_ROW(AlongScene),                                                                           \
            {0}}}

ALONG_TABLE(along_length, "length along a rod", "A radius or width of a rod's section.", "m");
ALONG_TABLE(along_young, "young along a rod", "Young's modulus of a rod.", "Pa");
ALONG_TABLE(along_area, "area along a rod", "The area of a rod's section.", "m^2");
ALONG_TABLE(along_moment, "moment of area along a rod", "A second moment of area of a rod's section.", "m^4");

static const YamlTable section_table = {
    .name = "section of a rod",
    .size = sizeof(SectionScene),
    .doc = "A section that is not round: a rectangle, or one of which is given what it amounts to. Its axes "
           "are n1 and n2 of the rod's frames.",
    .fields = (const YamlField[]){
        {YAML_OPTIONAL(SectionScene, width, &along_length), .one_of = 1, .required = true,
         .doc = "of a rectangle, along n1"},
        {YAML_OPTIONAL(SectionScene, height, &along_length), .when = "width",
         .doc = "of a rectangle, along n2; needed"},
        {YAML_OPTIONAL(SectionScene, area, &along_area), .one_of = 1, .required = true,
         .doc = "of any section"},
        {YAML_OPTIONAL(SectionScene, I1, &along_moment), .when = "area",
         .doc = "beside `area`: of bending about n1, the integral of the square of the distance along n2; "
                "needed"},
        {YAML_OPTIONAL(SectionScene, I2, &along_moment), .when = "area",
         .doc = "beside `area`: of bending about n2; needed"},
        {YAML_OPTIONAL(SectionScene, J, &along_moment), .when = "area",
         .doc = "beside `area`: of torsion, which the shear modulus times it resists; needed"},
        {YAML_VECTOR(SectionScene, kappa), .when = "area & /rod.model: cosserat", .range = "(0, inf)",
         .doc = "beside `area`: shear coefficients along n1 and n2; needed by model: cosserat"},
        {YAML_NUMBER(SectionScene, contact_radius), .unit = "m", .range = "(0, inf)",
         .doc = "of the round rod that others, obstacles and water meet; if absent half of the larger side "
                "of a rectangle, else that of a circle of `area`"},
        {0}}};

static const YamlTable rod_frame_table = {
    .name = "frame",
    .size = sizeof(RodFrameScene),
    .doc = "Where the section's axes n1 and n2 are along a curve.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(RodFrameScene, kind), .choices = YAML_NAMES("frenet", "bishop"), .one_of = 1,
         .short_form = true, .required = true, .doc = "n1 along the curvature, or turning least"},
        {YAML_TEXT(RodFrameScene, formula), .one_of = 1, .required = true,
         .doc = "turned about the tangent by this angle, of the arclength s and the length L"},
        {YAML_CHOICE(RodFrameScene, from), .when = "formula", .choices = YAML_NAMES("frenet", "bishop"),
         .fallback = "frenet", .doc = "of a formula: what is turned"},
        {YAML_FILE(RodFrameScene, file), .one_of = 1, .required = true,
         .doc =
             "a CSV file with rows s, x, y, z: the direction of n1, along half of the rod at least: linear "
             "between the rows, constant beyond them"},
        {0}}};

static const YamlTable clamp_table = {
    .name = "clamp",
    .size = sizeof(ClampScene),
    .doc = "Where a rod's first end is held, and how what holds it moves. A curve says where it is before it "
           "moves. Clamps of several strands are one rigid thing, which turns about the first one.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(ClampScene, position), .when = "!/rod.curve", .unit = "m", .fallback = "[0, 0, 0]",
         .doc = "of its first end"},
        {YAML_ROWS(ClampScene, frame), .when = "!/rod.curve", .min_count = 3, .max_count = 3,
         .doc = "tangent, n1 and n2 there; the axes x, y, z if absent"},
        {YAML_OPTIONAL(ClampScene, move, &path_table), .when = STATES, .doc = "how far it has moved, m"},
        {YAML_OPTIONAL(ClampScene, turn, &path_table), .when = STATES " & /rod.hold: clamped",
         .doc = "how far it has turned about where it is: a rotation vector, rad, of any size"},
        {0}}};

static const YamlTable end_table = {
    .name = "end",
    .size = sizeof(EndScene),
    .doc = "Where the rod's other end is held; of an inversion, where the curve says it, what holds it.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(EndScene, position), .when = STATES, .unit = "m", .doc = "of the end; needed"},
        {YAML_CHOICE(EndScene, hold), .choices = YAML_NAMES("clamped", "pinned"), .fallback = "pinned",
         .doc = "with its frame, or free to turn"},
        {YAML_ROWS(EndScene, frame), .when = "hold: clamped & " STATES, .min_count = 3, .max_count = 3,
         .doc = "of a clamped end: tangent, n1 and n2 there"},
        {YAML_OPTIONAL(EndScene, move, &path_table), .when = STATES,
         .doc = "how far it has moved from there, m"},
        {YAML_OPTIONAL(EndScene, turn, &path_table), .when = "hold: clamped & " STATES,
         .doc = "of a clamped end: how far it has turned about where it is: a rotation vector, rad, of any "
                "size"},
        {YAML_VECTOR(EndScene, force), .when = "/job: invert", .unit = "N", .one_of = 1,
         .doc = "of an inversion: what its support does to the end; this or `choose` is needed"},
        {YAML_CHOICE(EndScene, choose), .when = "/job: invert",
         .choices = YAML_NAMES("straightest", "least_stressed"), .one_of = 1,
         .doc = "of an inversion: force and couple, unknown, are those with which the natural shape bends "
                "least, or the "
                "rod stores the least energy"},
        {YAML_VECTOR(EndScene, couple), .when = "force & hold: clamped", .unit = "N m",
         .fallback = "[0, 0, 0]", .doc = "beside `force`: the couple of a clamp"},
        {0}}};

/* Of a load: a vector in that unit, by numbers or by formulas. */
#define LOAD_VECTOR_TABLE(table_name, table_doc, unit_name, variables)                                       \
    {                                                                                                        \
        .name = table_name, .size = sizeof(LoadVectorScene), .doc = table_doc, .fields = (const YamlField[]) \
        {                                                                                                    \
            {YAML_VECTOR(LoadVectorScene, value),                                                            \
             .unit = unit_name,                                                                              \
             .one_of = 1,                                                                                    \
             .required = true,                                                                               \
             .short_form = true,                                                                             \
             .doc = "as it stays"},                                                                          \
                {YAML_TEXTS(LoadVectorScene, formula),                                                       \
                 .one_of = 1,                                                                                \
                 .required = true,                                                                           \
                 .short_form = true,                                                                         \
                 .min_count = 3,                                                                             \
                 .max_count = 3,                                                                             \
                 .doc = "three expressions, in " unit_name ", of " variables},                               \
                WHERE_ROW(LoadVectorScene),                                                                  \
            {                                                                                                \
                0                                                                                            \
            }                                                                                                \
        }                                                                                                    \
    }

static const YamlTable load_line_table =
    LOAD_VECTOR_TABLE("line load of a rod", "A force on each metre.", "N/m",
                      "the arclength s, the length L and the time t; where the rod's place is known, in an "
                      "inversion or identification, of x, y, z and r = sqrt(x^2 + y^2), too");
static const YamlTable load_force_table =
    LOAD_VECTOR_TABLE("force on a rod", "A force at a point.", "N", "the time t");
static const YamlTable load_couple_table =
    LOAD_VECTOR_TABLE("couple on a rod", "A couple at a point.", "N m", "the time t");

static const YamlTable rod_load_table = {
    .name = "loads of a rod",
    .size = sizeof(RodLoadScene),
    .doc = "What acts on a rod beside its weight. Forces and couples keep their direction in the world while "
           "the rod turns. "
           "Formulas of t are followed in motions, and have the time of their stage elsewhere.",
    .fields = (const YamlField[]){
        {YAML_OPTIONAL(RodLoadScene, point, &load_point_table), .one_of = 1, .required = true,
         .doc = "where `force` and `couple` act"},
        {YAML_OPTIONAL(RodLoadScene, line, &load_line_table), .one_of = 1, .required = true,
         .doc = "on each metre"},
        {YAML_TEXT(RodLoadScene, potential), .one_of = 1, .required = true, .when = "/rod.solver: newton",
         .doc = "an energy in J/m whose gradient in space pulls at each metre: an expression of the place x, "
                "y, z, "
                "r = sqrt(x^2 + y^2), the arclength s, the length L and the time t"},
        {YAML_OPTIONAL(RodLoadScene, force, &load_force_table), .when = "point", .doc = "at the point"},
        {YAML_OPTIONAL(RodLoadScene, couple, &load_couple_table), .when = "point & /rod.solver: newton",
         .doc = "at the point"},
        {YAML_MAP(RodLoadScene, where, &where_table), .when = "potential",
         .doc = "names for parts of the potential"},
        {0}}};

static const YamlTable pose_curve_table = {
    .name = "poses",
    .size = sizeof(RodPoseScene),
    .doc = "A shape that a rod was seen in.",
    .fields = (const YamlField[]){
        {YAML_FILE(RodPoseScene, file), .required = true,
         .doc = "points from the clamp on: a CSV file with rows x, y, z or s, x, y, z"},
        {YAML_ROWS(RodPoseScene, frame), .min_count = 3, .max_count = 3, .required = true,
         .doc = "of the clamp: the tangent, n1 and n2 of one and the same rod"},
        {YAML_TABLE(RodPoseScene, noise, &noise_table), .fallback = "auto", .doc = "of its points"},
        {0}}};

static const YamlTable motion_frame_table = {
    .name = "frames of a motion",
    .size = sizeof(RodMotionFrameScene),
    .doc = "A shape that a moving rod had.",
    .fields = (const YamlField[]){
        {YAML_FILE(RodMotionFrameScene, file), .required = true,
         .doc = "points from the clamp on: a CSV file with rows x, y, z or s, x, y, z"},
        {YAML_NUMBER(RodMotionFrameScene, time), .required = true, .unit = "s", .doc = "when; they increase"},
        {YAML_TABLE(RodMotionFrameScene, noise, &noise_table), .fallback = "auto", .doc = "of its points"},
        {0}}};

static const YamlTable motion_table = {
    .name = "motion of a rod",
    .size = sizeof(RodMotionScene),
    .doc = "Shapes of one moving rod, three or more, from which its accelerations follow. Its clamp stays as "
           "it is.",
    .fields = (const YamlField[]){
        {YAML_LIST(RodMotionScene, frames, &motion_frame_table), .one_of = 1, .required = true,
         .doc = "from files"},
        {YAML_FILE(RodMotionScene, result), .one_of = 1, .required = true,
         .doc = "all frames of a simulation's result (best with `output: {precision: double}`)"},
        {YAML_CHOICE(RodMotionScene, difference), .choices = YAML_NAMES("central", "backward"),
         .fallback = "central",
         .doc = "whose acceleration the second difference of three frames is: of the middle one, or of the "
                "last one, "
                "as implicit Euler has it (exact for what slender has simulated with a frame for each step)"},
        {0}}};

static const YamlTable pbd_table = {
    .name = "pbd",
    .size = sizeof(PbdScene),
    .doc = "Of the position-based solver.",
    .fields = (const YamlField[]){
        {YAML_INTEGER(PbdScene, substeps), .range = "[1, 100000]", .fallback = "50",
         .doc = "per step of time"},
        {YAML_INTEGER(PbdScene, sweeps), .range = "[1, 100000]", .fallback = "2", .doc = "per substep"},
        {0}}};

const YamlTable rod_table = {
    .name = "rod",
    .size = sizeof(RodScene),
    .doc = "An elastic rod. It is held at its first end and hangs, unless `end` holds the other "
           "one, too.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(RodScene, model), .when = STATES, .choices = YAML_NAMES("kirchhoff", "cosserat"),
         .fallback = "kirchhoff",
         .doc = "inextensible and without shear, or with the stiffness against stretch and shear that its "
                "section "
                "has"},
        {YAML_OPTIONAL(RodScene, curve, &rod_curve_table), .one_of = 1,
         .doc = "the shape that it has under its loads: its natural shape follows; with natural strains the "
                "shape that it is held in until it is let go (`start: curve`)"},
        {YAML_OPTIONAL(RodScene, natural_strain, &strain_table), .when = STATES,
         .doc = "its natural shape, by strains; needed where there is no curve"},
        {YAML_LIST(RodScene, poses, &pose_curve_table), .one_of = 1, .when = "/job: identify",
         .doc = "of an identification: shapes that it was seen in"},
        {YAML_OPTIONAL(RodScene, motion, &motion_table), .one_of = 1, .when = "/job: invert",
         .doc = "of an inversion: shapes that it had while it moved"},
        {YAML_NUMBER(RodScene, length), .when = "!curve & !poses & !motion", .unit = "m", .range = "(0, inf)",
         .doc = "without a curve: its length"},
        {YAML_TABLE(RodScene, clamp, &clamp_table), .when = "!poses & !motion", .fallback = "{}",
         .doc = "its first end"},
        {YAML_CHOICE(RodScene, hold), .when = STATES, .choices = YAML_NAMES("clamped", "pinned"),
         .fallback = "clamped", .doc = "how the first end is held"},
        {YAML_OPTIONAL(RodScene, end, &end_table), .when = STATES ", invert & !motion",
         .doc = "how the other end is held; free if absent"},
        {YAML_INTEGER(RodScene, elements), .range = "[2, 1000000]", .fallback = "200",
         .doc = "pieces of constant strain"},
        {YAML_OPTIONAL(RodScene, radius, &along_length), .one_of = 2, .doc = "of a round section"},
        {YAML_NUMBERS(RodScene, ellipse), .when = "!poses & !motion", .unit = "m", .range = "(0, inf)",
         .one_of = 2, .min_count = 2, .max_count = 2,
         .doc = "half-axes along n1 and n2 of an elliptic section"},
        {YAML_OPTIONAL(RodScene, section, &section_table), .when = "!poses & !motion", .one_of = 2,
         .doc = "another section"},
        {YAML_OPTIONAL(RodScene, young, &along_young),
         .doc = "Young's modulus. Needed, as `radius` (or `ellipse`, `section`) and `density` are; of an "
                "identification "
                "two of "
                "the three, and the third one is what is looked for"},
        {YAML_NUMBER(RodScene, poisson), .range = "[-0.99, 0.5]",
         .doc = "Poisson's ratio. Needed; of an identification looked for unless it is given"},
        {YAML_NUMBER(RodScene, density), .unit = "kg/m^3", .range = "(0, inf)", .doc = "mass density"},
        {YAML_VECTOR(RodScene, gravity), .unit = "m/s^2", .fallback = "[0, 0, -9.81]",
         .doc = "acceleration of gravity"},
        {YAML_TABLE(RodScene, frame, &rod_frame_table), .when = "curve & !frames", .fallback = "bishop",
         .doc = "with a curve: the frames of section and strains"},
        {YAML_LIST(RodScene, frames, &rod_frame_table), .when = "curve & /job: invert", .min_count = 1,
         .doc = "of an inversion of one curve: several framings of it, each a strand of the result; their "
                "natural strains "
                "are compared in the picture"},
        {YAML_VECTOR(RodScene, bishop_normal), .when = "curve | motion",
         .doc = "the direction of n1 at the clamp; Frenet's if absent"},
        {YAML_LIST(RodScene, loads, &rod_load_table), .doc = "beside its weight"},
        {YAML_TABLE(RodScene, magnetization, &magnetization_table), .fallback = "[0, 0, 0]",
         .doc = "remanent magnetisation in the frame (tangent, n1, n2); formulas are of s and L, a file has "
                "a row for "
                "each element"},
        {YAML_NUMBER(RodScene, coercivity), .when = STATES " & solver: newton", .unit = "A/m",
         .range = "(0, inf)",
         .doc = "of what it is magnetised with: a larger field than half of it, anywhere on what is "
                "magnetised, is "
                "a warning; not looked at if absent"},
        {YAML_NUMBER(RodScene, damping), .when = MOTIONS ", invert", .unit = "N s/m^2", .range = "[0, inf)",
         .fallback = "0", .doc = "of a motion: viscous drag per length"},
        {YAML_CHOICE(RodScene, start), .when = "curve & " STATES " & !/start",
         .choices = YAML_NAMES("natural", "curve"), .fallback = "natural",
         .doc = "where the job begins: in the natural shape, or in the curve that was given"},
        {YAML_OPTIONAL(RodScene, velocity, &velocity_table), .when = MOTIONS " & solver: newton & !/start",
         .doc = "at the start of a motion; formulas are of the place x, y, z, r at the start"},
        {YAML_CHOICE(RodScene, solver), .when = "/job: simulate", .choices = YAML_NAMES("newton", "pbd"),
         .fallback = "newton",
         .doc = "of a simulation: implicit Euler, or position-based previews (docs/rods.md says what these "
                "are not)"},
        {YAML_TABLE(RodScene, pbd, &pbd_table), .when = "solver: pbd", .fallback = "{}",
         .doc = "of solver: pbd"},
        {0}}};

const RodScene *rod_scene(const Scene *scene)
{
    return scene_of(scene, &rod_body);
}
