/* yaml_load.h - where loading stands, its keys and scalars. Private to yaml_load.c, yaml_keys.c
 * and yaml_value.c. */
#pragma once
#include "io/yaml_private.h"

/* At the root, of the format's version; no row of a table. */
#define VERSION_KEY "slender"

/* Where loading stands: the key path, for sentences, and what the root is called. */
typedef struct Load {
    YamlFile *file;
    const char *name;
    char path[512];
} Load;

/* Goes down to a key or (key NULL) an index; returns what load_leave needs. */
size_t load_enter(Load *load, const char *key, int index);
void load_leave(Load *load, size_t length);

/* The key path, or "the scene" at the root; the caller frees. */
char *load_where(const Load *load);

/* Adds "key what" at the node; returns false. */
bool load_wrong(Load *load, const Node *at, const char *what);

/* "a list", "a mapping", "a text" */
const char *node_kind_name(const Node *node);

/* A row of a table by itself: the node's value, or the default (NULL). scene is the whole struct, zeroed. */
bool load_row_alone(Load *load, const YamlField *row, const Node *item, void *scene);

/* The row's value in a mapping, under any of its names; NULL: there is none. */
const Node *load_row_item(const YamlField *row, const Node *map);

/* The row that a value which is no mapping goes to; NULL: there is none. */
const YamlField *load_short_row(const YamlTable *table, const Node *node);

/* Refuses the mapping's keys that the table does not have. */
bool load_keys(Load *load, const YamlTable *table, const Node *node);

/* Is one of these keys, which is told as such, the row's, misspelt? That it is missing is then no second fault. */
bool load_is_misspelt(const Load *load, const YamlTable *table, const Node *node, const YamlField *row);

/* "mesh, thickness, young" */
void load_list_keys(const YamlTable *table, char *text, size_t size);

/* One value; false after adding an error. */
bool load_number(Load *load, const YamlField *row, const Node *node, double *value);
bool load_integer(Load *load, const YamlField *row, const Node *node, int *value);
bool load_text(Load *load, const Node *node, char **value);
bool load_bool(Load *load, const Node *node, bool *value);
bool load_choice(Load *load, const YamlField *row, const Node *node, int *value);
bool load_file(Load *load, const Node *node, char **value);
