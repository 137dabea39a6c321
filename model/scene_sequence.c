/* The field tables of sequences: stages one by one, and ranges. */
#include "model/scene_tables.h"

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
