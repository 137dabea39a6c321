/* The field tables of probes. */
#include "model/scene_tables.h"

static const YamlTable force_table = {
    .name = "force of a probe",
    .size = sizeof(ForceScene),
    .doc =
        "What a support or an obstacle does to the body, N along x, y, z. At the end of a step of "
        "time a support also bears what accelerates and damps what it holds; at the start of a motion it is "
        "taken as at rest.",
    .fields = (const YamlField[]){
        {YAML_TEXT(ForceScene, group), .one_of = 1, .required = true, .short_form = true,
         .doc = "on all that is held of a group, of a rod's end or node, or of `all`"},
        {YAML_INTEGER(ForceScene, fix), .range = "[0, inf)", .one_of = 1, .required = true,
         .doc = "of this entry of `fix`, from 0 on; of a rod 0 is its clamp and 1 its held end. What two "
                "entries hold counts for the first"},
        {YAML_TEXT(ForceScene, obstacle), .one_of = 1, .required = true,
         .doc = "of the obstacle of that name; of a motion with its friction"},
        {0}}};

const YamlTable probe_table = {
    .name = "probes",
    .size = sizeof(ProbeScene),
    .doc = "A number, or three along x, y, z, that is followed: a row for each stage of an equilibrium, each "
           "frame of a motion (the start first), or each evaluation of a design. `probes: {tip: {group: "
           "tip}, opening: {distance: [left, right]}}`. A point is a vertex by its number, `mass_center`, or "
           "a group by its name (of a rod `tip`, which `end` is too, `all`, or a node's number): the mean of "
           "its vertices.",
    .fields = (const YamlField[]){
        {YAML_TEXT(ProbeScene, vertex), .one_of = 1, .required = true,
         .doc = "the place of a vertex of the mesh's file, from 0 on, of a group of one, or of a rod's node"},
        {YAML_TEXT(ProbeScene, group), .one_of = 1, .required = true,
         .doc = "the mean place of a group's vertices; `all`"},
        {YAML_BOOL(ProbeScene, mass_center), .one_of = 1, .required = true, .doc = "the centre of mass"},
        {YAML_TEXT(ProbeScene, height), .one_of = 1, .required = true, .doc = "z of a point"},
        {YAML_TEXTS(ProbeScene, distance), .one_of = 1, .required = true, .min_count = 2, .max_count = 2,
         .doc = "that of two points"},
        {YAML_TEXTS(ProbeScene, angle), .one_of = 1, .required = true, .min_count = 2, .max_count = 3,
         .doc = "rad, 0 to pi: at the second of three points; of two points, with an axis: that of their "
                "line, from the first to the second"},
        {YAML_VECTOR(ProbeScene, axis), .when = "angle", .doc = "with an angle of two points: a direction"},
        {YAML_OPTIONAL(ProbeScene, force, &force_table), .one_of = 1, .required = true,
         .doc = "what a support or an obstacle does to the body"},
        {YAML_INTEGER(ProbeScene, couple), .when = "/rod", .range = "[0, inf)", .one_of = 1, .required = true,
         .doc = "of a rod: the couple of its clamp (0), or of its held end (1), N m along x, y, z"},
        {0}}};
