/* The field tables of designs: unknowns and objectives. */
#include "model/scene_tables.h"
#include "optim/optimiser.h"

/* ---- Unknowns ---- */

#define BOUNDS_ROW(S, u, r)                                                                                  \
    {                                                                                                        \
        YAML_VECTOR(S, bounds), .unit = u, .range = r,                                                       \
                                .doc = "lower and upper bound; a start beyond them is put on them"           \
    }
#define ROWS_ROWS(S, element)                                                                                \
    {YAML_CHOICE(S, per), .choices = YAML_NAMES(element, "group", "body"), .fallback = element,              \
     .doc = "an unknown for each " element " (of what has a value per tetrahedron or element: for each of "  \
            "these), for each named group of them, or one for the whole body"},                              \
    {                                                                                                        \
        YAML_TEXTS(S, groups), .min_count = 1,                                                               \
                               .doc = "these named groups only, what is in none of them stays as it is; "    \
                                      "all if absent"                                                        \
    }

static const YamlTable magnetization_unknown_table = {
    .name = "unknown magnetization",
    .size = sizeof(VectorUnknown),
    .doc = "The magnetisation as an unknown.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(VectorUnknown, noise), .unit = "A/m", .range = "[0, inf)", .fallback = "0",
         .doc = "size of seeded noise that is added to the start"},
        {YAML_NUMBER(VectorUnknown, scale), .unit = "A/m", .range = "(0, inf)", .fallback = "1.0e+4 A/m",
         .doc = "a natural size: optimisers see the value over it"},
        BOUNDS_ROW(VectorUnknown, "A/m", NULL),
        {YAML_NUMBER(VectorUnknown, magnitude), .unit = "A/m", .range = "(0, inf)", .one_of = 1,
         .doc = "fixes |M|: only its direction is free"},
        {YAML_NUMBER(VectorUnknown, max_magnitude), .unit = "A/m", .range = "(0, inf)", .one_of = 1,
         .doc = "a cap on |M|"},
        ROWS_ROWS(VectorUnknown, "face"),
        {YAML_OPTIONAL(VectorUnknown, start, &magnetization_table), .doc = "in place of the body's"},
        {0}}};

/* A positive number per face, with the unit of its parameter. */
#define NUMBER_UNKNOWN_TABLE(id, of, u)                                                                      \
    static const YamlTable id##_unknown_table = {                                                            \
        .name = "unknown " #id,                                                                              \
        .size = sizeof(NumberUnknown),                                                                       \
        .doc = of " as an unknown.",                                                                         \
        .fields = (const YamlField[]){                                                                       \
            BOUNDS_ROW(NumberUnknown, u, "(0, inf)"),                                                        \
            {YAML_CHOICE(NumberUnknown, scale), .choices = YAML_NAMES("log", "linear"), .fallback = "log",   \
             .doc = "optimisers see its logarithm, or its ratio to the start's mean"},                       \
            {YAML_NUMBER(NumberUnknown, noise), .unit = u, .range = "[0, inf)", .fallback = "0",             \
             .doc = "size of seeded noise that is added to the start"},                                      \
            ROWS_ROWS(NumberUnknown, "face"),                                                                \
            {YAML_OPTIONAL(NumberUnknown, start, &id##_table), .doc = "in place of the body's"},             \
            {0}}}

NUMBER_UNKNOWN_TABLE(young, "Young's modulus", "Pa");
NUMBER_UNKNOWN_TABLE(thickness, "A shell's thickness", "m");

static const YamlTable fold_unknown_table = {
    .name = "unknown fold",
    .size = sizeof(NumberUnknown),
    .doc = "The factor on each edge's curvature as an unknown.",
    .fields = (const YamlField[]){
        BOUNDS_ROW(NumberUnknown, NULL, "[0, inf)"),
        {YAML_CHOICE(NumberUnknown, scale), .choices = YAML_NAMES("log", "linear"), .fallback = "log",
         .doc = "optimisers see its logarithm over 0.2, or its ratio to the start's mean"},
        {YAML_NUMBER(NumberUnknown, noise), .range = "[0, inf)", .fallback = "0",
         .doc = "size of seeded noise that is added to the start"},
        ROWS_ROWS(NumberUnknown, "edge"),
        {YAML_OPTIONAL(NumberUnknown, start, &fold_table), .doc = "in place of the body's"},
        {0}}};

static const YamlTable strain_unknown_table = {
    .name = "unknown natural_strain",
    .size = sizeof(StrainUnknown),
    .doc = "A rod's natural strains (twist, k1, k2) as unknowns. A motion starts in the natural shape of "
           "their starts.",
    .fields =
        (const YamlField[]){{YAML_NUMBER(StrainUnknown, noise), .unit = "1/m", .range = "[0, inf)",
                             .fallback = "0", .doc = "size of seeded noise that is added to the start"},
                            {YAML_NUMBER(StrainUnknown, scale), .unit = "1/m", .range = "(0, inf)",
                             .fallback = "10 1/m", .doc = "a natural size: optimisers see the value over it"},
                            BOUNDS_ROW(StrainUnknown, "1/m", NULL),
                            {0}}};

static const YamlTable flux_start_table = {
    .name = "start of flux_density",
    .size = sizeof(FluxStart),
    .doc = "Where an unknown flux density starts. A file has one row Bx, By, Bz per control row: per frame, "
           "knot, or "
           "coefficient (mean, cos 1, sin 1, cos 2, ..) of a harmonic one.",
    .fields =
        (const YamlField[]){{YAML_VECTOR(FluxStart, value), .unit = "T", .one_of = 1, .required = true,
                             .short_form = true, .doc = "the same at all times"},
                            {YAML_FILE(FluxStart, file), .one_of = 1, .required = true, .doc = "a CSV file"},
                            {0}}};

#define CONTROL_ROWS(S)                                                                                      \
    {YAML_INTEGER(S, knots), .when = "per: knot", .range = "[2, 1000000]", .fallback = "20",                 \
     .doc = "per knot: how many"},                                                                           \
    {                                                                                                        \
        YAML_INTEGER(S, harmonics), .when = "per: harmonic", .range = "[1, 32]", .fallback = "5",            \
                                    .doc = "per harmonic: how many"                                          \
    }

static const YamlTable flux_unknown_table = {
    .name = "unknown flux_density",
    .size = sizeof(FluxUnknown),
    .doc = "The uniform part of the flux density as an unknown: of a design one for each load case, of a "
           "trajectory one that "
           "changes in time.",
    .fields = (const YamlField[]){
        {YAML_CHOICE(FluxUnknown, per), .when = "/job: trajectory",
         .choices = YAML_NAMES("frame", "knot", "harmonic"), .fallback = "frame",
         .doc = "of a trajectory: a value for each step of time, for each knot of a C1 cubic spline "
                "(Catmull-Rom, equal "
                "distances), or a mean and (cos, sin) of 1, 2, .. periods in the whole time"},
        CONTROL_ROWS(FluxUnknown),
        {YAML_NUMBER(FluxUnknown, noise), .unit = "T", .range = "[0, inf)", .fallback = "0",
         .doc = "size of seeded noise that is added to the start"},
        {YAML_NUMBER(FluxUnknown, scale), .unit = "T", .range = "(0, inf)", .fallback = "0.01 T",
         .doc = "a natural size: optimisers see the value over it"},
        {YAML_VECTOR(FluxUnknown, bounds), .unit = "T",
         .doc = "lower and upper bound (a start beyond them is put on them), of knots and harmonic "
                "coefficients as of frames"},
        {YAML_OPTIONAL(FluxUnknown, start, &flux_start_table), .when = "/job: trajectory",
         .doc = "of a trajectory, in place of the scene's flux_density over time"},
        {0}}};

#define SOURCE_ROWS(u, natural)                                                                              \
    {YAML_TEXTS(SourceUnknown, sources), .min_count = 1,                                                     \
     .doc = "of which sources, by their names; of all if absent"},                                           \
        {YAML_NUMBER(SourceUnknown, noise), .unit = u, .range = "[0, inf)", .fallback = "0",                 \
         .doc = "size of seeded noise that is added to the start"},                                          \
        {YAML_NUMBER(SourceUnknown, scale), .unit = u, .range = "(0, inf)", .fallback = natural,             \
         .doc = "a natural size: optimisers see the value over it"},                                         \
        BOUNDS_ROW(SourceUnknown, u, NULL)
static const YamlTable strength_unknown_table = {
    .name = "unknown source_strength",
    .size = sizeof(SourceUnknown),
    .doc = "Factors on sources of the flux density as unknowns, "
           "the same in all load cases and at all times: of a coil "
           "its current over the scene's. They start at 1. A "
           "uniform source has none: its unknown is flux_density.",
    .fields = (const YamlField[]){SOURCE_ROWS(NULL, "1"),
                                  {YAML_CHOICE(SourceUnknown, per), .when = "/job: trajectory",
                                   .choices = YAML_NAMES("frame", "knot", "harmonic"),
                                   .doc = "of a trajectory: they change in time, with a value for each step, "
                                          "for each knot of a C1 cubic spline, or a "
                                          "mean and (cos, sin) of 1, 2, .. periods in the whole time; of up "
                                          "to eight sources that stand one after the "
                                          "other; the same at all times if absent"},
                                  CONTROL_ROWS(SourceUnknown),
                                  {0}}};

static const YamlTable move_unknown_table = {.name = "unknown source_move",
                                             .size = sizeof(SourceUnknown),
                                             .doc =
                                                 "How far sources of the flux density are moved as unknowns, "
                                                 "beyond where the scene has them, the same in all "
                                                 "load cases and at all times. They start at 0.",
                                             .fields = (const YamlField[]){SOURCE_ROWS("m", "10 mm"), {0}}};

static const YamlTable turn_unknown_table = {.name = "unknown source_turn",
                                             .size = sizeof(SourceUnknown),
                                             .doc =
                                                 "How far sources of the flux density are turned about their "
                                                 "centres as unknowns, beyond how the scene has them, "
                                                 "rotation vectors. They start at 0.",
                                             .fields = (const YamlField[]){SOURCE_ROWS("rad", "1 rad"), {0}}};

static const YamlTable unknowns_table = {
    .name = "unknowns",
    .size = sizeof(UnknownsScene),
    .doc = "What the optimiser may change; starts at the body's values.",
    .fields = (const YamlField[]){
        {YAML_OPTIONAL(UnknownsScene, magnetization, &magnetization_unknown_table),
         .doc = "three numbers per face; of a solid without a skin per tetrahedron, of a rod per element"},
        {YAML_OPTIONAL(UnknownsScene, young, &young_unknown_table),
         .doc = "a number per face, of a solid per tetrahedron, of a rod per element"},
        {YAML_OPTIONAL(UnknownsScene, skin_young, &young_unknown_table),
         .doc = "of a solid's film, a number per face of the surface"},
        {YAML_OPTIONAL(UnknownsScene, thickness, &thickness_unknown_table),
         .doc = "of a shell, a number per face. Obstacles feel it; what the body keeps from itself stays "
                "that of the scene's thickness, and a centre of mass follows it"},
        {YAML_OPTIONAL(UnknownsScene, fold, &fold_unknown_table), .doc = "a number per edge"},
        {YAML_OPTIONAL(UnknownsScene, natural_strain, &strain_unknown_table),
         .doc = "of a rod, three numbers per element"},
        {YAML_OPTIONAL(UnknownsScene, flux_density, &flux_unknown_table),
         .doc = "three numbers per load case"},
        {YAML_OPTIONAL(UnknownsScene, source_strength, &strength_unknown_table),
         .doc = "a factor per source of the flux density: of coils, their currents"},
        {YAML_OPTIONAL(UnknownsScene, source_move, &move_unknown_table),
         .doc = "three numbers per source: where magnets and coils are"},
        {YAML_OPTIONAL(UnknownsScene, source_turn, &turn_unknown_table),
         .doc = "three numbers per source: how they are turned"},
        {0}}};

/* ---- Objectives ---- */

#define POINT_ROWS(S)                                                                                        \
    {YAML_TEXT(S, vertex), .one_of = 1, .required = true,                                                    \
     .doc = "a vertex of the mesh file, from 0, or a named group of one vertex; of a rod a node, from 0, "   \
            "or `tip`"},                                                                                     \
    {                                                                                                        \
        YAML_BOOL(S, mass_center), .one_of = 1, .required = true, .doc = "the body's centre of mass"         \
    }
#define FRAME_ROWS(S, use, otherwise)                                                                        \
    {YAML_INTEGER(S, frame), .when = use, .one_of = 2, .range = "[0, inf)",                                  \
     .doc = "the frame (the state after so many steps) at which it counts" otherwise},                       \
    {                                                                                                        \
        YAML_INTEGERS(S, frames), .when = use, .one_of = 2, .range = "[0, inf)", .min_count = 2,             \
                                  .max_count = 2,                                                            \
                                  .doc = "the first and the last of such frames; their values are added"     \
    }

static const YamlTable waypoint_table = {
    .name = "waypoint",
    .size = sizeof(WaypointScene),
    .doc = "The squared distance of a point of the body to a place, m^2.",
    .fields = (const YamlField[]){
        POINT_ROWS(WaypointScene),
        FRAME_ROWS(WaypointScene, NULL, "; the last one if absent"),
        {YAML_VECTOR(WaypointScene, at), .unit = "m", .required = true, .doc = "the place"},
        {0}}};

static const YamlTable curve_table = {
    .name = "curve",
    .size = sizeof(CurveScene),
    .doc = "The squared distance of a point of the body to a curve, m^2.",
    .fields = (const YamlField[]){
        POINT_ROWS(CurveScene),
        FRAME_ROWS(CurveScene, NULL, "; the last one if absent"),
        {YAML_ROWS(CurveScene, points), .unit = "m", .one_of = 3, .required = true, .min_count = 2,
         .doc = "a polyline"},
        {YAML_ROWS(CurveScene, arc), .unit = "m", .one_of = 3, .required = true, .min_count = 3,
         .max_count = 3, .doc = "an arc from the first point through the second to the third"},
        {YAML_NUMBER(CurveScene, blend), .when = "points", .unit = "m", .range = "(0, inf)",
         .fallback = "0.1 mm",
         .doc = "of a polyline: segments whose squared distances differ by less than its square are blended, "
                "so that the "
                "gradient has no jump at a corner"},
        {0}}};

static const YamlTable reach_table = {
    .name = "reach",
    .size = sizeof(ReachScene),
    .doc = "Places that a point of the body should be at, one after the other: the sum over the frames from "
           "`delay` after "
           "each switch until the next of the squared distance to the place, m^2.",
    .fields = (const YamlField[]){
        POINT_ROWS(ReachScene),
        {YAML_ROWS(ReachScene, targets), .unit = "m", .required = true, .min_count = 1, .doc = "the places"},
        {YAML_NUMBER(ReachScene, every), .unit = "s", .range = "(0, inf)", .required = true,
         .doc = "from one switch to the next; the first is at the start"},
        {YAML_NUMBER(ReachScene, delay), .unit = "s", .range = "[0, inf)", .fallback = "0 s",
         .doc = "time to get there"},
        {0}}};

static const YamlTable objective_table = {
    .name = "objectives",
    .size = sizeof(ObjectiveScene),
    .doc = "What should be small: a sum of rows, each times its weight and without hidden normalisation. "
           "Those of a point "
           "and of a field over time are for trajectories.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(ObjectiveScene, target), .one_of = 1, .required = true,
         .doc = "weight of the squared distances to each case's target, m^2"},
        {YAML_NUMBER(ObjectiveScene, height), .one_of = 1, .required = true,
         .doc = "weight of the mean height (z), m, a negative one asks for height; with `at` of its squared "
                "difference to that, m^2"},
        {YAML_NUMBER(ObjectiveScene, magnetization_smoothness), .one_of = 1, .required = true,
         .doc = "weight of the squared jumps of the magnetisation over inner edges, (A/m)^2"},
        {YAML_NUMBER(ObjectiveScene, young_smoothness), .one_of = 1, .required = true,
         .doc = "weight of the squared jumps of the logarithm of Young's modulus over inner edges"},
        {YAML_NUMBER(ObjectiveScene, thickness_smoothness), .one_of = 1, .required = true,
         .doc = "weight of the squared jumps of the logarithm of a shell's thickness over inner edges"},
        {YAML_NUMBER(ObjectiveScene, fold_smoothness), .one_of = 1, .required = true,
         .doc = "weight of the squared jumps of the folds' factors between the edges of each face"},
        {YAML_OPTIONAL(ObjectiveScene, waypoint, &waypoint_table), .one_of = 1, .required = true,
         .doc = "a place to be at"},
        {YAML_OPTIONAL(ObjectiveScene, curve, &curve_table), .one_of = 1, .required = true,
         .doc = "a curve to be on"},
        {YAML_OPTIONAL(ObjectiveScene, reach, &reach_table), .one_of = 1, .required = true,
         .doc = "places to be at in turn"},
        {YAML_NUMBER(ObjectiveScene, field_magnitude), .one_of = 1, .required = true,
         .doc = "weight of the sum over the steps of the unknown flux density's square, T^2"},
        {YAML_NUMBER(ObjectiveScene, field_smoothness), .one_of = 1, .required = true,
         .doc = "weight of the sum of the squares of its changes from step to step, T^2"},
        {YAML_NUMBER(ObjectiveScene, dmp), .one_of = 1, .required = true,
         .doc = "weight of the squared difference to a sum of few sines, whose frequencies and amplitudes "
                "are unknowns, "
                "too, T^2"},
        {YAML_NUMBER(ObjectiveScene, weight), .fallback = "1",
         .doc = "another factor, of a point's rows the only one"},
        {YAML_TEXT(ObjectiveScene, of), .when = "height", .fallback = "all",
         .doc = "of height: a named group of the mesh, or all; of a rod its end, `tip`, a node, or all"},
        {YAML_NUMBER(ObjectiveScene, at), .when = "height", .unit = "m",
         .doc = "the mean height that is wanted"},
        FRAME_ROWS(ObjectiveScene, "/job: trajectory & target | height",
                   ", of a target or height in a trajectory; the last one if absent"),
        {YAML_INTEGER(ObjectiveScene, pairs), .when = "dmp", .range = "[1, 100]", .fallback = "5",
         .doc = "of dmp: how many frequencies"},
        {0}}};

const YamlTable design_table = {
    .name = "design",
    .size = sizeof(DesignScene),
    .doc = "A design or trajectory job: parameters that make the body do what its objectives say.",
    .fields = (const YamlField[]){
        {YAML_TABLE(DesignScene, unknowns, &unknowns_table), .required = true, .doc = "what may change"},
        {YAML_LIST(DesignScene, objectives, &objective_table), .required = true, .min_count = 1,
         .doc = "what should be small"},
        {YAML_CHOICE(DesignScene, optimizer), .choices = optimiser_names, .fallback = "mma",
         .doc = "NLopt's method of moving asymptotes, NLopt's L-BFGS, or a matrix-free Gauss-Newton"},
        {YAML_INTEGER(DesignScene, iterations), .range = "[0, inf)", .fallback = "50",
         .doc = "evaluations of the objective after the first; 0 evaluates the start and its gradient"},
        {YAML_NUMBER(DesignScene, tolerance), .range = "[0, 1)", .fallback = "1.0e-6",
         .doc = "done when the gradient, projected on the bounds, fell to this part of the first one"},
        {YAML_INTEGER(DesignScene, seed), .range = "[0, inf)", .fallback = "1", .doc = "of the noise"},
        {0}}};
