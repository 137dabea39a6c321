/* The field tables of load cases, sequences and targets. */
#include "model/scene_tables.h"

const YamlTable target_table = {
    .name = "target",
    .size = sizeof(TargetScene),
    .doc = "Where vertices should be: each at a place of its own, or points on the body, which do not say "
           "which vertex they "
           "are of. Of several targets, a list, the squared distances are added, each times its weight.",
    .fields = (const YamlField[]){
        {YAML_FILE(TargetScene, file), .one_of = 1, .required = true,
         .doc = "a mesh file with the vertices of the mesh"},
        {YAML_FILE(TargetScene, height_map), .one_of = 1, .required = true,
         .doc = "a PNG, JPEG, PGM or PPM image over the body's rectangle in x and y: black is 0, white is "
                "height, row 0 "
                "at +y"},
        {YAML_ROWS(TargetScene, strokes), .unit = "m", .one_of = 1, .required = true,
         .doc = "segments x0, y0, x1, y1: ridges of height, round across"},
        {YAML_TEXTS(TargetScene, formula), .one_of = 1, .required = true, .short_form = true, .min_count = 3,
         .max_count = 3, .doc = "three expressions, in m, of the rest position x, y, z, r"},
        {YAML_NUMBER(TargetScene, height), .when = "height_map | strokes", .unit = "m",
         .doc = "of a height map or strokes"},
        {YAML_NUMBER(TargetScene, width), .when = "strokes", .unit = "m", .range = "(0, inf)",
         .doc = "of strokes, at half their height"},
        {YAML_FILE(TargetScene, cloud), .one_of = 1, .required = true,
         .doc =
             "a CSV file with a point x, y, z in each row (of `axes: xz` x, z will do), in any order, as of "
             "an "
             "outline in a photograph: each is to lie on the body's line, the edges of the mesh whose ends "
             "are both chosen by `on`, of a rod its elements. What counts is the sum over the points of the "
             "squared distance "
             "to that line, m^2; parts of the body that the points do not show are free"},
        {YAML_NUMBER(TargetScene, scale), .when = "file | cloud", .range = "(0, inf)",
         .doc = "of a file: factor on its coordinates; that of the mesh if absent, of a cloud 1"},
        {YAML_NUMBER(TargetScene, blend), .when = "cloud", .unit = "m", .range = "(0, inf)",
         .fallback = "0.1 mm",
         .doc = "of a cloud: edges whose squared distances differ by less than its square are blended, so "
                "that the "
                "gradient has no jump where the nearest one changes"},
        WHERE_ROW(TargetScene),
        {YAML_TEXT(TargetScene, axes), .fallback = "xyz",
         .doc = "the coordinates that count: some of xyz, each once at most; of a cloud those of the plane "
                "that it "
                "is seen in"},
        {YAML_NUMBER(TargetScene, weight), .range = "[0, inf)", .fallback = "1",
         .doc = "a factor beside that of the objective, between several targets"},
        {YAML_OPTIONAL(TargetScene, on, &selection_table), .also = ON_NAMES,
         .doc = "for these vertices only"},
        {0}}};

const YamlTable case_table = {
    .name = "cases",
    .size = sizeof(CaseScene),
    .doc = "A load case: a field or loads, and what the body should then do.",
    .fields = (const YamlField[]){
        {YAML_TEXT(CaseScene, name), .doc = "its name in the result; case1, case2, .. if absent"},
        {YAML_NUMBER(CaseScene, weight), .when = "/job: design", .range = "[0, inf)", .fallback = "1",
         .doc = "of its objectives"},
        {YAML_LIST(CaseScene, flux_density, &flux_density_table), .alone = true,
         .doc = "in place of the scene's"},
        {YAML_LIST(CaseScene, loads, &load_table), .doc = "in place of the scene's"},
        {YAML_VECTOR(CaseScene, gravity), .unit = "m/s^2", .doc = "in place of the shell's"},
        {YAML_LIST(CaseScene, target, &target_table), .alone = true, .doc = "in place of the scene's"},
        {0}}};

static const YamlTable stage_table = {
    .name = "stages",
    .size = sizeof(StageScene),
    .doc = "A stage of an equilibrium job: each starts from the one before, and is a frame of the result. "
           "What a stage does "
           "not say stays as it was.",
    .fields = (const YamlField[]){
        {YAML_LIST(StageScene, flux_density, &flux_density_table), .alone = true, .doc = "the field"},
        {YAML_LIST(StageScene, loads, &load_table), .doc = "the dead loads"},
        {YAML_VECTOR(StageScene, gravity), .unit = "m/s^2", .doc = "acceleration of gravity"},
        {YAML_NUMBER(StageScene, time), .unit = "s", .doc = "the time t of formulas"},
        {0}}};

#define RANGE_COUNT(S)                                                                                       \
    {                                                                                                        \
        YAML_INTEGER(S, count), .range = "[2, 10000]",                                                       \
                                .doc = "how many stages, both ends with them; of ranges beside each other "  \
                                       "one says it, or all say the same"                                    \
    }

static const YamlTable flux_range_table = {
    .name = "range of flux densities",
    .size = sizeof(FluxRange),
    .doc = "In equal parts from one field to the other; sources fade.",
    .fields = (const YamlField[]){{YAML_LIST(FluxRange, from, &flux_density_table), .alone = true,
                                   .required = true, .doc = "the first stage's"},
                                  {YAML_LIST(FluxRange, to, &flux_density_table), .alone = true,
                                   .required = true, .doc = "the last stage's"},
                                  RANGE_COUNT(FluxRange),
                                  {0}}};

static const YamlTable loads_range_table = {
    .name = "range of loads",
    .size = sizeof(LoadsRange),
    .doc = "In equal parts from some dead loads to others.",
    .fields = (const YamlField[]){
        {YAML_LIST(LoadsRange, from, &load_table), .alone = true, .required = true,
         .doc = "the first stage's"},
        {YAML_LIST(LoadsRange, to, &load_table), .alone = true, .required = true, .doc = "the last stage's"},
        RANGE_COUNT(LoadsRange),
        {0}}};

static const YamlTable gravity_range_table = {
    .name = "range of gravity",
    .size = sizeof(GravityRange),
    .doc = "In equal parts from one acceleration to the other.",
    .fields = (const YamlField[]){
        {YAML_VECTOR(GravityRange, from), .unit = "m/s^2", .required = true, .doc = "the first stage's"},
        {YAML_VECTOR(GravityRange, to), .unit = "m/s^2", .required = true, .doc = "the last stage's"},
        RANGE_COUNT(GravityRange),
        {0}}};

static const YamlTable time_range_table = {
    .name = "range of times",
    .size = sizeof(TimeRange),
    .doc = "In equal parts from one time to the other: what moves by formula of t goes with it.",
    .fields = (const YamlField[]){
        {YAML_NUMBER(TimeRange, from), .unit = "s", .required = true, .doc = "the first stage's"},
        {YAML_NUMBER(TimeRange, to), .unit = "s", .required = true, .doc = "the last stage's"},
        RANGE_COUNT(TimeRange),
        {0}}};

const YamlTable sequence_table = {
    .name = "sequence",
    .size = sizeof(SequenceScene),
    .doc = "Stages of an equilibrium job: a list of them, or ranges, which go side by side: `sequence: "
           "{flux_density: {from: [0, 0, 0], to: [0, 0, 20 mT], count: 9}}`.",
    .fields = (const YamlField[]){
        {YAML_LIST(SequenceScene, stages, &stage_table), .short_form = true, .doc = "one by one"},
        {YAML_OPTIONAL(SequenceScene, flux_density, &flux_range_table), .when = "!stages",
         .doc = "the field"},
        {YAML_OPTIONAL(SequenceScene, loads, &loads_range_table), .when = "!stages", .doc = "the dead loads"},
        {YAML_OPTIONAL(SequenceScene, gravity, &gravity_range_table), .when = "!stages",
         .doc = "acceleration of gravity"},
        {YAML_OPTIONAL(SequenceScene, time, &time_range_table), .when = "!stages",
         .doc = "the time t of formulas"},
        {0}}};
