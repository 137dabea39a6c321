/* yaml_private.h - the tree that scene files are read into, and what the parts of yaml.h share. */
#pragma once
#include "io/lookup.h"
#include "io/text.h"
#include "io/yaml.h"

typedef enum NodeKind { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

typedef struct Node Node;

/* A value; of a mapping, keys[i] stands at key_line[i] and has items[i]. Owned all the way down. */
struct Node {
    NodeKind kind;
    int line, column;   /* from 1; 0: from --set or a default           */
    const char *origin; /* the --set assignment that it comes from, the file's; NULL: the file itself */
    char *text;         /* of a mapping or list: what stood in its place before a --set, if anything */
    int count, room;
    Node **items;
    char **keys;
    int (*key_place)[2];
    Lookup lookup; /* of keys */
};

struct YamlFile {
    char *path, *folder, *text;
    size_t length;
    Node *root; /* NULL: not readable */
    int set_count;
    char **set;          /* assignments, borrowed by nodes */
    const char *setting; /* whose value is being read; NULL: the file is */
    int error_count, stored_count;
    YamlError *errors;
    bool *error_is_set; /* [stored] the sentence begins with --set, not with a place */
};

enum {
    YAML_MAX_ERRORS = 100,
    YAML_MAX_DEPTH = 32,
    YAML_MAX_VALUES = 4000000,
    YAML_MAX_BYTES = 64 << 20,
    YAML_MAX_COPIES = 100000 /* values that aliases make */
};

Node *node_create(NodeKind kind, int line, int column);
void node_destroy(Node *node);

/* Takes key (NULL in lists) and item. */
void node_append(Node *node, char *key, int line, int column, Node *item);

/* The item under a key, or NULL; the index of a key of that length in a map, or -1. */
Node *node_find(const Node *map, const char *key);
int node_index(const Node *map, const char *key, size_t length);

/* The value on one line: what tree_parse makes the same value of. */
void node_write(const Node *node, Text *text);

/* A copy of so many levels and, taken from *left, so many values at most; else NULL. */
Node *node_copy(const Node *node, int depth, int *left);

/* The tree of a text; errors go to the file (NULL: a default, which must be right). NULL where there is none.
 */
Node *tree_parse(YamlFile *file, const char *text, size_t length);

/* Adds an error at a node's place. */
void yaml_error(YamlFile *file, const Node *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void yaml_error_at(YamlFile *file, int line, int column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Follows "a.b[2].c" from the root as far as it is written; *rest is what is left. */
Node *tree_follow(const YamlFile *file, const char *key, const char **rest);

/* The next step of a key path: a name (length of it) or an index (>= 0). False at the end or where it is
 * malformed. */
bool path_step(const char **path, const char **name, int *length, int *index);

/* ---- Numbers ---- */

/* Does the text look like a number, with a unit or not, and not like an expression? */
bool unit_is_number(const char *text);

/* The number in SI. False with a phrase that says what is wrong: "must be a number in m, not 'x'". unit as in
 * YamlField. */
bool unit_parse(const char *text, const char *unit, double *value, char *wrong, size_t size);

/* Does the text begin with a number and the symbol of a unit, `3 mm * x`? What that is in SI, and how long. */
bool unit_begins(const char *text, double *value, int *length);

/* The units that take prefixes, or those that take none; the prefixes; each between two marks. */
void unit_list(bool prefixed, const char *mark, Text *text);
void unit_list_prefixes(const char *mark, Text *text);

/* Is it a unit that the table of units can read? */
bool unit_is_known(const char *unit);

/* ---- Tables ---- */

const YamlField *table_row(const YamlTable *table, const char *key);

/* The row that takes the keys which have none (YamlField.rest); NULL: they are refused. */
const YamlField *table_rest(const YamlTable *table);

/* The key of the format's version. */
const char *table_version(const YamlTable *root);

/* The member of a struct, and the count beside it. */
static inline void *row_member(const YamlField *row, const void *scene)
{
    return (char *)scene + row->offset;
}
static inline int *row_count(const YamlField *row, const void *scene)
{
    return (int *)((char *)scene + row->count_offset);
}

/* Is it one entry of a list that may stand without it (YamlField.alone): no list of mappings? */
bool load_is_alone(const YamlField *row, const Node *node);

/* "key: value" as in the effective scene; "" where it is not given. To be freed. */
char *row_text(const YamlField *row, const void *scene);

/* Are the keys and values in the row's condition there? */
bool row_use_is_sound(const YamlTable *root, const YamlTable *table, const YamlField *row);

/* The known word nearest to a misspelt one; NULL if none is near, or if the file has more errors than are
 * shown. words(self, i) gives them, NULL at the end. */
const char *nearest_word(const YamlFile *file, const char *word,
                         const char *(*words)(const void *self, int i), const void *self);
