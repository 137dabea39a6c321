/* scene_tables.h - the field tables that scene.c and scene_design.c share. */
#pragma once
#include "cli/scene.h"

extern const YamlTable young_table, fold_table, magnetization_table; /* scene.c        */
extern const YamlTable design_table;                                 /* scene_design.c */
