/* The field tables of scene files. Every key of the program is a row here. */
#include "model/scene_tables.h"

/* ---- Values ---- */

const YamlTable where_table = {
    .name = "where",
    .size = sizeof(WhereScene),
    .doc = "A formula is one expression: numbers with a decimal point, + - * / ^ (-x^2 is -(x^2)), < <= > >= "
           "== !=, "
           "&&, ||, c ? a : b, pi, e, and sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, asinh, "
           "acosh, atanh, "
           "exp, ln or log (natural), log2, log10, sqrt, abs, sign, rint, min, max, sum, avg, mod(a, b), "
           "clamp(x, low, high) "
           "and step(x), 0 below 0 and else 1. Assignments, lists and texts are refused.\n\n"
           "Helper names of a formula, each an expression of the formula's variables and of the other names; "
           "their "
           "order means nothing.",
    .fields = (const YamlField[]){
        {YAML_TEXT(WhereScene, formula), .required = true, .short_form = true, .doc = "the expression"},
        {0}}};

/* A number per face or edge, with the unit and range of its parameter. */
#define NUMBER_TABLE(id, of, u, r)                                                                           \
    static const YamlTable id##_group_table = {                                                              \
        .name = #id " of a group",                                                                           \
        .size = sizeof(NumberGroup),                                                                         \
        .doc = "The value on one named group.",                                                              \
        .fields = (const YamlField[]){{YAML_NUMBER(NumberGroup, value), .unit = u, .range = r,               \
                                       .required = true, .short_form = true, .doc = "the value"},            \
                                      {0}}};                                                                 \
    const YamlTable id##_table = {                                                                           \
        .name = #id,                                                                                         \
        .size = sizeof(NumberScene),                                                                         \
        .doc = of,                                                                                           \
        .fields = (const YamlField[]){                                                                       \
            {YAML_NUMBER(NumberScene, value), .unit = u, .range = r, .one_of = 1, .required = true,          \
             .short_form = true, .doc = "the same everywhere"},                                              \
            {YAML_FILE(NumberScene, file), .one_of = 1, .required = true, .doc = "a CSV file"},              \
            {YAML_TEXT(NumberScene, formula), .one_of = 1, .required = true, .short_form = true,             \
             .doc = "an expression of the rest position x, y, z, r"},                                        \
            {YAML_MAP(NumberScene, groups, &id##_group_table), .one_of = 1, .required = true,                \
             .doc = "a value for each named group; what lies in several has that of the smallest"},          \
            {YAML_NUMBER(NumberScene, other), .when = "groups", .unit = u, .range = r,                       \
             .doc = "with groups: the value elsewhere"},                                                     \
            WHERE_ROW(NumberScene),                                                                          \
            {0}}}

NUMBER_TABLE(young, "Young's modulus, per face. A file has one number per face.", "Pa", "(0, inf)");
NUMBER_TABLE(thickness, "Thickness, per face. A file has one number per face.", "m", "(0, inf)");
NUMBER_TABLE(density, "Mass density, per face. A file has one number per face.", "kg/m^3", "(0, inf)");
NUMBER_TABLE(
    fold,
    "Factor on the curvature of each edge's fold; the energy goes with its square. A file has rows v0, v1, "
    "value (vertices of an edge, from 0) and 1 elsewhere.",
    NULL, "[0, inf)");

static const YamlTable magnetization_group_table = {
    .name = "magnetization of a group",
    .size = sizeof(VectorGroup),
    .doc = "The value on one named group.",
    .fields = (const YamlField[]){{YAML_VECTOR(VectorGroup, value), .unit = "A/m", .one_of = 1,
                                   .required = true, .short_form = true, .doc = "the value"},
                                  {YAML_VECTOR(VectorGroup, remanence), .unit = "T", .one_of = 1,
                                   .required = true, .doc = "mu_0 times the value"},
                                  {0}}};

const YamlTable magnetization_table = {
    .name = "magnetization",
    .size = sizeof(VectorScene),
    .doc = "Remanent magnetisation in material space, per face. A file has one row x, y, z per face.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(VectorScene, value), .unit = "A/m", .one_of = 1, .required = true, .short_form = true,
         .doc = "the same everywhere"},
        {YAML_VECTOR(VectorScene, remanence), .unit = "T", .one_of = 1, .required = true,
         .doc =
             "the same everywhere, as the flux density that it leaves: mu_0 times the magnetisation, 75 mT "
             "for 59.7 kA/m"},
        {YAML_FILE(VectorScene, file), .one_of = 1, .required = true, .doc = "a CSV file"},
        {YAML_TEXTS(VectorScene, formula), .one_of = 1, .required = true, .short_form = true, .min_count = 3,
         .max_count = 3,
         .doc = "three expressions of the rest position x, y, z, r of a face's barycentre, in A/m"},
        {YAML_MAP(VectorScene, groups, &magnetization_group_table), .one_of = 1, .required = true,
         .doc = "a value for each named group; what lies in several has that of the smallest"},
        {YAML_VECTOR(VectorScene, other), .when = "groups", .unit = "A/m",
         .doc = "with groups: the value elsewhere"},
        WHERE_ROW(VectorScene),
        {0}}};

/* ---- A mesh and its parts ---- */

const YamlTable mesh_table = {
    .name = "mesh",
    .size = sizeof(MeshScene),
    .doc = "The triangle mesh of the shell at rest, from a file or generated. A generated one lies in the "
           "plane z = 0, its "
           "upper side towards +z: a sheet or strip from the origin along +x and +y, a hexagram, disc or "
           "kirigami around "
           "the origin. They have groups of vertices: of a sheet or strip `root` (the edge x = 0) and `tip` "
           "(the vertex in "
           "the middle of the opposite edge, of an odd number of cells across the one just below it), of a "
           "disc or kirigami `centre` and `rim`; a hexagram has "
           "groups of faces, `hub` "
           "and `flap1` (on +x, a tip on the axis) to `flap6`, counter-clockwise. A rod has none; its ends "
           "are the clamp, s = 0, and the tip.",
    .fields = (const YamlField[]){
        {YAML_FILE(MeshScene, file), .one_of = 1, .required = true, .short_form = true,
         .doc = "an OBJ, PLY, STL or Gmsh .msh (2.2 or 4.1, ASCII) file; docs/meshes.md says what is read of "
                "it"},
        {YAML_CHOICE(MeshScene, shape), .one_of = 1, .required = true,
         .choices = YAML_NAMES("sheet", "strip", "hexagram", "disc", "kirigami"),
         .doc = "a generated mesh in the plane z = 0"},
        {YAML_NUMBERS(MeshScene, size), .unit = "m", .range = "(0, inf)", .min_count = 1, .max_count = 2,
         .doc = "of a sheet or strip: length along x and width along y; of a hexagram or disc: the diameter; "
                "of a kirigami: its side"},
        {YAML_INTEGERS(MeshScene, cells), .range = "[1, inf)", .min_count = 2, .max_count = 2,
         .doc = "of a sheet: cells along x and y"},
        {YAML_INTEGER(MeshScene, n), .also = YAML_NAMES("divisions", "false"), .range = "[1, inf)",
         .doc = "of a strip: cells along x; of a hexagram: 12 n^2 faces; of a disc: 6 n^2 faces; "
                "of a kirigami: cells of its checkerboard along a side, odd"},
        {YAML_CHOICE(MeshScene, pattern), .choices = YAML_NAMES("right", "alternate", "crossed"),
         .fallback = "right", .doc = "of a sheet or strip: how cells are split"},
        {YAML_NUMBER(MeshScene, scale), .range = "(0, inf)", .fallback = "1",
         .doc = "of a file: factor on its coordinates, 1.0e-3 for a file in millimetres"},
        {YAML_NUMBER(MeshScene, weld), .unit = "m", .range = "[0, inf)", .fallback = "0",
         .doc = "of a file: joins vertices that are closer than this; 0: none"},
        {0}}};

const YamlTable pose_table = {
    .name = "pose",
    .size = sizeof(PoseScene),
    .doc = "A state to start from.",
    .fields = (const YamlField[]){{YAML_FILE(PoseScene, file), .one_of = 1, .required = true,
                                   .short_form = true, .doc = "a mesh file with the faces of the mesh"},
                                  {YAML_TEXTS(PoseScene, formula), .one_of = 1, .required = true,
                                   .short_form = true, .min_count = 3, .max_count = 3,
                                   .doc = "three expressions, in m, of the rest position x, y, z, r"},
                                  {YAML_NUMBER(PoseScene, scale), .when = "file", .range = "(0, inf)",
                                   .doc = "of a file: factor on its coordinates; that of the mesh if absent"},
                                  WHERE_ROW(PoseScene),
                                  {0}}};

const YamlTable velocity_table = {
    .name = "velocity",
    .size = sizeof(VelocityScene),
    .doc = "Velocities at the start of a motion.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(VelocityScene, value), .unit = "m/s", .one_of = 1, .required = true, .short_form = true,
         .doc = "the same everywhere"},
        {YAML_TEXTS(VelocityScene, formula), .one_of = 1, .required = true, .short_form = true,
         .min_count = 3, .max_count = 3,
         .doc = "three expressions of the rest position x, y, z, r of a vertex, in m/s"},
        {YAML_FILE(VelocityScene, file), .one_of = 1, .required = true,
         .doc = "a CSV file with rows vx, vy, vz (m/s): one for each vertex of the mesh's file, or "
                "node of the rod"},
        WHERE_ROW(VelocityScene),
        {0}}};

static const YamlTable ball_table = {
    .name = "ball",
    .size = sizeof(BallScene),
    .doc = "All vertices in a ball.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(BallScene, center), .unit = "m", .required = true, .doc = "its centre"},
        {YAML_NUMBER(BallScene, radius), .unit = "m", .range = "(0, inf)", .required = true,
         .doc = "its radius"},
        {0}}};

#define SELECTION_ROWS(S)                                                                                    \
    {YAML_INTEGERS(S, vertices), .range = "[0, inf)", .doc = "these vertices of the mesh file, from 0"},     \
        {YAML_ROWS(S, box), .unit = "m", .min_count = 2, .max_count = 2,                                     \
         .doc = "lower and upper corner of a box"},                                                          \
        {YAML_OPTIONAL(S, ball, &ball_table), .doc = "a ball"},                                              \
        {YAML_TEXT(S, group), .short_form = true, .doc = "a named group of the mesh"},                       \
    {                                                                                                        \
        YAML_BOOL(S, boundary), .doc = "vertices on the boundary"                                            \
    }

const YamlTable selection_table = {
    .name = "selection",
    .size = sizeof(SelectionScene),
    .doc = "Some vertices, by their rest positions. A vertex must satisfy all conditions that are given.",
    .fields = (const YamlField[]){SELECTION_ROWS(SelectionScene), {0}}};

static const YamlTable fix_table = {
    .name = "fix",
    .size = sizeof(FixScene),
    .doc = "Vertices that are held. A vertex must satisfy all conditions that are given.",
    .fields = (const YamlField[]){
        SELECTION_ROWS(FixScene),
        {YAML_TEXT(FixScene, axes), .fallback = "xyz",
         .doc = "the coordinates that are held: some of xyz, each once at most"},
        {YAML_BOOL(FixScene, clamp), .doc = "holds the slope of the edges between these vertices too"},
        {YAML_TEXTS(FixScene, move), .when = "/job: equilibrium, simulate, trajectory", .min_count = 3,
         .max_count = 3,
         .doc =
             "where they are held: a place, as three expressions, in m, of the rest position x, y, z, r and "
             "the time t ([x + 0.01*t, y, z] moves along x); 0 along what is not among the axes; a vertex "
             "that two entries move must go to one place"},
        {0}}};

const YamlTable load_point_table = {
    .name = "point of a load",
    .size = sizeof(LoadPointScene),
    .doc = "Where on the rod a load acts.",
    .fields =
        (const YamlField[]){{YAML_CHOICE(LoadPointScene, end), .choices = YAML_NAMES("end"), .one_of = 1,
                             .short_form = true, .required = true, .doc = "the end that is not the clamp's"},
                            {YAML_NUMBER(LoadPointScene, value), .unit = "m", .range = "[0, inf)",
                             .one_of = 1, .short_form = true, .required = true, .doc = "an arclength"},
                            {0}}};

const YamlTable load_table = {
    .name = "loads",
    .size = sizeof(LoadScene),
    .doc = "A dead load: a force, or a couple on a rod, that keeps its direction. Of stages and cases they "
           "come in "
           "place of the scene's; those of a rod in place of `rod.loads`, but for potentials.",
    .fields = (const YamlField[]){{YAML_VECTOR(LoadScene, force), .unit = "N", .one_of = 1, .required = true,
                                   .doc = "in all, shared equally by the vertices (of a solid by its nodes: "
                                          "use area for an even pull); of "
                                          "a rod at its `point`"},
                                  {YAML_VECTOR(LoadScene, line), .unit = "N/m", .one_of = 1, .required = true,
                                   .doc = "per rest length of boundary edges; on each metre of a rod"},
                                  {YAML_VECTOR(LoadScene, area), .when = "!/rod", .unit = "N/m^2",
                                   .one_of = 1, .required = true, .doc = "per rest area"},
                                  {YAML_VECTOR(LoadScene, couple), .when = "/rod", .unit = "N m", .one_of = 1,
                                   .required = true, .doc = "of a rod, at its `point`"},
                                  {YAML_OPTIONAL(LoadScene, on, &selection_table), .when = "!/rod",
                                   .also = ON_NAMES, .doc = "where; everywhere if absent"},
                                  {YAML_OPTIONAL(LoadScene, point, &load_point_table),
                                   .when = "/rod & force | couple",
                                   .doc = "of a rod: where `force` or `couple` acts"},
                                  {0}}};

/* ---- The whole ---- */

static const YamlTable solver_table = {
    .name = "solver",
    .size = sizeof(SolverScene),
    .doc = "When the equilibrium solver is content, and what it solves with.",
    .fields = (const YamlField[]){
        {YAML_INTEGER(SolverScene, max_iterations), .range = "[1, inf)", .fallback = "300",
         .doc = "Newton iterations of a solve"},
        {YAML_NUMBER(SolverScene, step_tolerance), .range = "(0, 1)", .fallback = "1.0e-8",
         .doc = "largest last step, in parts of the body's size (radians of edge angles), unless rounding "
                "lets none be so small; a step of time "
                "also ends where the "
                "next one would gain less than 1e-10 of the energies"},
        {YAML_NUMBER(SolverScene, force_tolerance), .range = "(0, 1)", .fallback = "1.0e-6",
         .doc = "largest force left, in parts of the element forces"},
        {YAML_CHOICE(SolverScene, direct),
         .when = "/job: equilibrium, evaluate, design, simulate, trajectory",
         .choices = YAML_NAMES("cholmod", "mumps"), .fallback = "cholmod",
         .doc =
             "what factors matrices: mumps spreads a factor over the processes of `mpirun -n 2 slender run "
             "SCENE`, for what one machine's memory does not hold, in a program that is built with it "
             "(docs/solver.md)"},
        {0}}};

static const YamlTable load_steps_table = {
    .name = "load_steps",
    .size = sizeof(LoadStepsScene),
    .doc = "Over how many steps loads, fields and prescribed motion come on.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(LoadStepsScene, mode), .choices = YAML_NAMES("auto"), .one_of = 1, .short_form = true,
         .required = true, .doc = "one step, halved where it fails"},
        {YAML_INTEGER(LoadStepsScene, count), .range = "[1, 10000]", .one_of = 1, .short_form = true,
         .required = true, .doc = "this many, halved where one fails"},
        {YAML_BOOL(LoadStepsScene, frames), .when = "/job: equilibrium & count",
         .doc =
             "each of them is a stage of the result, as those of a `sequence`: a frame, with how it ended, "
             "energies, forces of supports, a row of the probes, and the part of the loads that it bears. "
             "Of a "
             "`sequence` each of its stages comes on so"},
        {0}}};

/* Of the time of a motion, which may stay where its scene is put to rest: `--set job=equilibrium`. */
#define MOTIONS_AND_STATICS "/job: equilibrium, evaluate, simulate, trajectory"

static const YamlTable time_table = {
    .name = "time",
    .size = sizeof(TimeScene),
    .doc = "The time t of formulas in statics, or the steps of a simulation or trajectory.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(TimeScene, at),
         .when = "/job: equilibrium, evaluate, design, simulate, trajectory, invert, identify", .unit = "s",
         .fallback = "0 s", .short_form = true, .doc = "t in statics; where a simulation begins"},
        {YAML_NUMBER(TimeScene, step), .when = MOTIONS_AND_STATICS, .unit = "s", .range = "(0, inf)",
         .doc =
             "of a simulation or trajectory: the step of implicit Euler; the statics of its scene leave it"},
        {YAML_INTEGER(TimeScene, steps), .when = MOTIONS_AND_STATICS, .range = "[1, inf)",
         .doc = "of a simulation or trajectory: how many"},
        {0}}};

/* Of what has states. */
#define WITH_STATES "/job: equilibrium, evaluate, design, simulate, trajectory"

static const YamlTable start_frame_table = {
    .name = "frame of a start",
    .size = sizeof(StartFrameScene),
    .doc = "Which of a result's states.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(StartFrameScene, mode), .choices = YAML_NAMES("last"), .one_of = 1, .short_form = true,
         .required = true, .doc = "where the run ended, or was interrupted"},
        {YAML_INTEGER(StartFrameScene, number), .range = "[0, inf)", .one_of = 1, .short_form = true,
         .required = true, .doc = "this frame, from 0 on, of a result with `output: {states: all}`"},
        {0}}};

static const YamlTable start_table = {
    .name = "start",
    .size = sizeof(StartScene),
    .doc =
        "A job starts from what another run left: the places, velocities and angles of its state, and what "
        "its energies remember. The body must be the same: the mesh, or a rod's length, elements and ends; "
        "its "
        "material, loads, fields, what is held and what it meets may be others. A motion goes on from the "
        "time of the "
        "state, "
        "so that formulas of t go on, too, and `time.at` is left out; its steps and frames count from its "
        "own "
        "start. Cut in two it ends with the same bits. An equilibrium's loads come on from those that act "
        "in the state, and t is its own `time.at`.",
    .fields = (const YamlField[]){
        {YAML_FILE(StartScene, result), .required = true, .short_form = true,
         .doc = "a result, NAME.vtkhdf, of any job with states; of an interrupted run, too"},
        {YAML_TABLE(StartScene, frame, &start_frame_table), .fallback = "last", .doc = "which state"},
        {.key = "case",
         .kind = FIELD_TEXT,
         .offset = offsetof(StartScene, load_case),
         .doc = "the state of this load case of the result; if absent each of the scene's `cases` starts "
                "from that of "
                "its name where there is one, all else from the last one"},
        {0}}};

#define DRAWING_FILE(m, d)                                                                                   \
    {                                                                                                        \
        YAML_TEXT(OutputScene, m), .when = "/job: draw", .otherwise = "slender picture shows results",       \
                                   .doc = "of a drawing: " d                                                 \
    }
static const YamlTable output_table = {
    .name = "output",
    .size = sizeof(OutputScene),
    .doc =
        "What goes into the result file, and further files. Their names are relative to the result's folder.",
    .fields = (const YamlField[]){
        {YAML_INTEGER(OutputScene, every), .when = "/job: design, simulate, trajectory, draw",
         .range = "[0, inf)", .fallback = "0",
         .doc = "a frame for every so many steps of a motion (0: every step) or improvements of a design (0: "
                "the final one only); of a drawing: NAME-000020.svg and so on, after every so many "
                "iterations (0: none)"},
        {YAML_INTEGER(OutputScene, film), .when = "/job: draw",
         .otherwise = "other jobs have frames, by `every`", .range = "[0, inf)", .fallback = "0",
         .doc = "of a drawing: its strokes after every so many iterations stay in the result, for `slender "
                "picture --animation` (0: none)"},
        {YAML_CHOICE(OutputScene, precision),
         .when = "/job: equilibrium, evaluate, design, simulate, trajectory, invert",
         .choices = YAML_NAMES("single", "double"), .fallback = "single",
         .doc = "of frames; single only as long as its numbers, where the body is, are closer than 1e-5 of "
                "its size"},
        {YAML_CHOICE(OutputScene, states), .when = WITH_STATES, .choices = YAML_NAMES("last", "all"),
         .fallback = "last",
         .doc =
             "which states are kept whole, in double precision and with all that is remembered, for a job to "
             "`start` from: the last one (of each load case), or those of all frames, too"},
        {YAML_BOOL(OutputScene, stress), .when = "/job: simulate, trajectory",
         .otherwise = "frames of other jobs always have strains and stresses",
         .doc = "of motions: strains and stresses (of rods forces and moments) in each frame, which frames "
                "of other jobs "
                "always have"},
        DRAWING_FILE(svg, "curves in mm, a layer for each pen; NAME.svg if absent"),
        DRAWING_FILE(png, "target and drawing side by side; NAME.png if absent"),
        DRAWING_FILE(gcode, "for a pen on a z axis; none if absent"),
        DRAWING_FILE(gcode_servo, "for a pen on a servo; none if absent"),
        DRAWING_FILE(hpgl, "none if absent"),
        DRAWING_FILE(plotter, "in the words of `spline.plotter.profile`; none if absent"),
        {0}}};

const YamlTable scene_form = {
    .name = "scene",
    .size = sizeof(Scene),
    .doc =
        "A scene file is YAML (or JSON) with the key `slender: 1`, the format's version. Numbers are SI, or "
        "carry a "
        "unit: `1 mm`, `20 mT`, `0.3 MPa` (the last section lists them); in quotes they are numbers too. The "
        "order of keys means nothing. "
        "Aliases (`*name`) are copies of what was anchored (`&name`) before; there are no merge keys (`<<`) "
        "and no "
        "tags. A key may have other names, which stand beside it: `on` and `n` are `true` and `false` to "
        "programs "
        "that read YAML 1.1 (PyYAML, R), and are read as such again; `region` and `divisions` pass through "
        "all of "
        "them.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(Scene, job), .choices = scene_job_names, .required = true, .doc = "what to do"},
        {YAML_LIST(Scene, flux_density, &flux_density_table), .alone = true, .fallback = "[0, 0, 0]",
         .doc = "applied field"},
        {YAML_LIST(Scene, fix, &fix_table), .doc = "what is held"},
        {YAML_LIST(Scene, loads, &load_table), .doc = "dead loads"},
        {YAML_LIST(Scene, target, &target_table), .alone = true,
         .when = "/job: equilibrium, evaluate, design, simulate, trajectory & !sequence",
         .doc = "where vertices should be, in all cases without one of their own"},
        {YAML_LIST(Scene, obstacles, &obstacle_table), .when = WITH_STATES,
         .doc = "rigid things that the body meets"},
        {YAML_TABLE(Scene, contact, &contact_table), .when = WITH_STATES " & obstacles | contact.self",
         .fallback = "{}", .doc = "how the body meets obstacles and itself"},
        {YAML_OPTIONAL(Scene, water, &water_table), .when = "/job: simulate, trajectory",
         .otherwise = "it resists what moves", .doc = "a fluid all around"},
        {YAML_LIST(Scene, cases, &case_table), .when = "/job: equilibrium, evaluate, design",
         .otherwise = "what changes in a motion is a formula of t",
         .doc = "load cases of a design; one with the scene's loads if absent"},
        {YAML_OPTIONAL(Scene, sequence, &sequence_table), .when = "/job: equilibrium",
         .otherwise = "what changes in a motion is a formula of t", .doc = "stages of an equilibrium"},
        {YAML_MAP(Scene, probes, &probe_table), .when = WITH_STATES,
         .doc = "numbers to follow: a table in the result, and NAME_probes.csv"},
        {YAML_OPTIONAL(Scene, design, &design_table), .when = "/job: design, trajectory",
         .doc = "what a design or trajectory job looks for"},
        {YAML_TABLE(Scene, solver, &solver_table),
         .when = "/job: equilibrium, evaluate, design, simulate, trajectory, invert", .fallback = "{}",
         .doc = "tolerances, and what solves"},
        {YAML_TABLE(Scene, load_steps, &load_steps_table), .when = "/job: equilibrium, invert",
         .fallback = "auto", .doc = "how loads come on"},
        {YAML_TABLE(Scene, time, &time_table), .fallback = "0 s",
         .doc = "the time t of formulas, or the steps of a simulation"},
        {YAML_OPTIONAL(Scene, start, &start_table), .when = WITH_STATES,
         .otherwise = "only these jobs have states; any run goes on by --resume",
         .doc = "what another run left, to go on from"},
        {YAML_INTEGER(Scene, modes), .range = "[0, 100]", .fallback = "0",
         .doc = "the lowest vibrations to put into the result, in Hz, and of shells and solids the lowest "
                "eigenmodes, in N/m"},
        {YAML_CHOICES(Scene, checks), .when = "/job: invert",
         .choices = YAML_NAMES("stability", "self_contact", "round_trip"),
         .doc = "of a rod: what else to find out"},
        {YAML_TABLE(Scene, output, &output_table), .fallback = "{}", .doc = "what to keep"},
        {0}}};
