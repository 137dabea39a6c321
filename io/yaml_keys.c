/* Keys of a mapping that its table does not have. */
#include "base/memory.h"
#include "io/yaml_load.h"
#include <stdio.h>
#include <string.h>

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
    char known[700];
    const char *near = nearest_word(load->file, node->keys[i], field_word, table->fields);
    Node at = {
        .line = node->key_place[i][0], .column = node->key_place[i][1], .origin = node->items[i]->origin};
    load_list_keys(table, known, sizeof known);
    char *where = load_where(load);
    if (near)
        yaml_error(load->file, &at, "%s has no key '%.60s'; did you mean '%s'?", where, node->keys[i], near);
    else
        yaml_error(load->file, &at, "%s has no key '%.60s'; its keys are %s", where, node->keys[i], known);
    mem_free(where);
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
    (void)self;
    return i ? NULL : VERSION_KEY;
}

/* The version's key, at the root, is no row of a table; that it is missing, misspelt perhaps, is told by then. */
static bool is_version(const Load *load, const Node *node, const char *key)
{
    if (load->path[0]) return false;
    return !strcmp(key, VERSION_KEY) ||
           (!node_find(node, VERSION_KEY) && nearest_word(load->file, key, version_word, NULL));
}

bool load_keys(Load *load, const YamlTable *table, const Node *node)
{
    bool ok = true;
    for (int i = 0; i < node->count; i++)
        if (!table_row(table, node->keys[i]) && !is_version(load, node, node->keys[i]))
            ok = unknown_key(load, table, node, i);
    return ok;
}
