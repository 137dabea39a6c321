/* Keys of a mapping that its table does not have. */
#include "io/yaml_load.h"
#include <stdio.h>
#include <string.h>

const YamlField *table_rest(const YamlTable *table)
{
    for (const YamlField *row = table->fields; row->key; row++)
        if (row->rest) return row;
    return NULL;
}

const char *table_version(const YamlTable *root)
{
    return root->version ? root->version : "slender";
}

static const char *field_word(const void *self, int i)
{
    return ((const YamlField *)self)[i].key;
}

void load_list_keys(const YamlTable *table, char *text, size_t size)
{
    size_t length = 0;
    for (const YamlField *row = table->fields; row->key && length < size; row++)
        length += (size_t)snprintf(text + length, size - length, "%s%s", row == table->fields ? "" : ", ",
                                   row->key);
}

static bool unknown_key(Load *load, const YamlTable *table, const Node *node, int i)
{
    char known[700], root[80];
    const char *near = nearest_word(load->file, node->keys[i], field_word, table->fields);
    Node at = {
        .line = node->key_place[i][0], .column = node->key_place[i][1], .origin = node->items[i]->origin};
    load_list_keys(table, known, sizeof known);
    const char *where = load_place(load, root);
    if (near)
        yaml_error(load->file, &at, "%s has no key '%.60s'; did you mean '%s'?", where, node->keys[i], near);
    else
        yaml_error(load->file, &at, "%s has no key '%.60s'; its keys are %s", where, node->keys[i], known);
    return false;
}

bool load_is_misspelt(const Load *load, const YamlTable *table, const Node *node, const YamlField *row)
{
    bool found = false;
    for (int i = 0; !found && i < node->count; i++)
        found = !table_row(table, node->keys[i]) &&
                nearest_word(load->file, node->keys[i], field_word, table->fields) == row->key;
    return found;
}

static const char *version_word(const void *self, int i)
{
    return i ? NULL : table_version(self);
}

/* The version's key, at the root, is no row of a table; that it is missing, misspelt perhaps, is told by then. */
static bool is_version(const Load *load, const Node *node, const char *key)
{
    if (load->path[0]) return false;
    const char *version = table_version(load->root);
    return !strcmp(key, version) ||
           (!node_find(node, version) && nearest_word(load->file, key, version_word, load->root));
}

bool load_keys(Load *load, const YamlTable *table, const Node *node)
{
    bool ok = true;
    for (int i = 0; i < node->count && !table_rest(table); i++)
        if (!table_row(table, node->keys[i]) && !is_version(load, node, node->keys[i]))
            ok = unknown_key(load, table, node, i);
    return ok;
}

/* ---- Units ---- */

/* The row of a name; of one that its table leaves free, the row that takes it. */
static const YamlField *row_of(const YamlTable *table, const char *name, int length)
{
    char key[80];
    snprintf(key, sizeof key, "%.*s", length, name);
    const YamlField *row = table_row(table, key);
    return row ? row : table_rest(table);
}

static const char *short_unit(const YamlTable *table)
{
    for (const YamlField *row = table->fields; row->key; row++)
        if (row->short_form && row->unit) return row->unit;
    return "";
}

const char *yaml_unit(const YamlTable *table, const char *key)
{
    const YamlField *row = NULL;
    const char *name;
    int length, index;
    bool named = false; /* the name of an entry comes next */
    while (*key) {
        if (!path_step(&key, &name, &length, &index)) return "";
        if (index >= 0 || named) {
            named = false;
            continue;
        }
        if (row) table = row->table;
        row = table ? row_of(table, name, length) : NULL;
        if (!row) return "";
        named = row->kind == FIELD_MAP && !row->rest;
    }
    return !row ? "" : row->table ? short_unit(row->table) : row->unit ? row->unit : "";
}
