/* scene_tables.h - the field tables that scene.c and scene_design.c share. */
#pragma once
#include "model/scene.h"

extern const YamlTable where_table, velocity_table;                  /* scene.c        */
extern const YamlTable young_table, fold_table, magnetization_table; /* scene.c        */
extern const YamlTable design_table;                                 /* scene_design.c */
extern const YamlTable rod_table;                                    /* scene_rod.c    */
extern const YamlTable spline_table;                                 /* scene_spline.c */

#define WHERE_ROW(S)                                                                                         \
    {                                                                                                        \
        YAML_MAP(S, where, &where_table), .when = "formula", .doc = "names for parts of the formula"         \
    }
