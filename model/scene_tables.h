/* scene_tables.h - the field tables that scenes of several bodies share, and the form of the whole. */
#pragma once
#include "model/scene.h"

/* Of `on`, which is `true` to readers of YAML 1.1. */
#define ON_NAMES YAML_NAMES("region", "true")

extern const YamlTable where_table, mesh_table, pose_table, velocity_table;
extern const YamlTable selection_table, load_table, load_point_table;
extern const YamlTable target_table, case_table;       /* scene_cases.c */
extern const YamlTable flux_density_table, path_table; /* scene_flux.c */
extern const YamlTable young_table, thickness_table, density_table, fold_table, magnetization_table;
extern const YamlTable design_table;                               /* scene_design.c */
extern const YamlTable sequence_table;                             /* scene_sequence.c */
extern const YamlTable probe_table;                                /* scene_probes.c */
extern const YamlTable obstacle_table, contact_table, water_table; /* scene_world.c  */

/* The common keys; its first row is `job`. scene_table (rows.c) has the bodies' too. */
extern const YamlTable scene_form;
extern const char *scene_job_names[]; /* rows.c: of all bodies; ends with NULL */

#define WHERE_ROW(S)                                                                                         \
    {                                                                                                        \
        YAML_MAP(S, where, &where_table), .when = "formula", .doc = "names for parts of the formula"         \
    }
