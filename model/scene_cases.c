/* The field tables of load cases and targets. */
#include "model/scene_tables.h"

const YamlTable target_table = {
    .name = "target",
    .size = sizeof(TargetScene),
    .doc = "Where vertices should be: each at a place of its own, or points on the body, which do not say "
           "which vertex they "
           "are of. Of several targets, a list, the squared distances are added, each times its weight.",
    .fields = (const YamlField[]){
        {YAML_FILE(TargetScene, file), .one_of = 1, .required = true,
         .doc = "a mesh file with the vertices of the mesh; of rods a polyline, divided at equal arclengths"},
        {YAML_FILE(TargetScene, height_map), .one_of = 1, .required = true,
         .doc = "a PNG, JPEG, PGM or PPM image over the body's rectangle in x and y: black is 0, white is "
                "height, row 0 "
                "at +y"},
        {YAML_ROWS(TargetScene, strokes), .unit = "m", .one_of = 1, .required = true,
         .doc = "segments x0, y0, x1, y1: ridges of height, round across"},
        {YAML_TEXTS(TargetScene, formula), .one_of = 1, .required = true, .short_form = true, .min_count = 3,
         .max_count = 3,
         .doc = "three expressions, in m, of the rest position x, y, z, r; of rods of the arclength s and "
                "the length L"},
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
         .doc = "for these vertices only; of a rod by `group` (`tip`, or a node's number) or `vertices`, its "
                "nodes"},
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
