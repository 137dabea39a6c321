/* Keys that a scene writes and nothing would read. */
#include "base/memory.h"
#include "io/yaml_load.h"
#include <stdio.h>
#include <string.h>

/* One condition of a row: `a | b`, `!a` or `a: value, value`, keys of the root after a slash, and what there is
 * elsewhere. */
typedef struct Condition {
    char keys[64], values[128], otherwise[128];
    bool root, absent;
} Condition;

/* A part of a condition without the blanks around it. */
static void copy_part(char *to, size_t size, const char *from, size_t length)
{
    while (length && strchr(" :", *from)) from++, length--;
    while (length && from[length - 1] == ' ') length--;
    snprintf(to, size, "%.*s", (int)length, from);
}

/* Takes the next condition off *text; false at the end. */
static bool next_condition(const char **text, Condition *c)
{
    *text += strspn(*text, " &");
    if (!**text) return false;
    c->absent = **text == '!';
    *text += c->absent;
    c->root = **text == '/';
    *text += c->root;
    size_t end = strcspn(*text, "{&"), keys = strcspn(*text, ":{&");
    copy_part(c->keys, sizeof c->keys, *text, keys);
    copy_part(c->values, sizeof c->values, *text + keys, end - keys);
    *text += end;
    bool said = **text == '{';
    size_t words = said ? strcspn(*text, "}") : 0;
    copy_part(c->otherwise, sizeof c->otherwise, *text + said, words ? words - 1 : 0);
    *text += words + said;
    return true;
}

static bool has_value(const char *values, const char *value)
{
    size_t size = value ? strlen(value) : 0;
    for (size_t length; size && *values; values += length + strspn(values + length, ", ")) {
        length = strcspn(values, ",");
        if (length == size && !strncmp(values, value, size)) return true;
    }
    return false;
}

/* Where a table of the scene stands. */
typedef struct Place {
    YamlFile *file;
    const YamlTable *root, *table;
    const Node *node;
} Place;

/* A key's value as it is written, or its default: of a scalar. *given: it is written. */
static const char *value_at(const YamlTable *table, const Node *node, const char *path, bool *given)
{
    const char *fallback = NULL;
    while (table && *path) {
        char name[64];
        copy_part(name, sizeof name, path, strcspn(path, "."));
        path += strcspn(path, "."), path += *path == '.';
        const YamlField *row = table_row(table, name);
        if (node && node->kind == NODE_MAP)
            node = row ? load_row_item(row, node) : NULL;
        else if (node && load_short_row(table, node) != row)
            node = NULL;
        fallback = row ? row->fallback : NULL;
        table = row ? row->table : NULL;
    }
    *given = node != NULL && !(node->kind == NODE_LIST && node->count == 0);
    return node && node->kind == NODE_SCALAR ? node->text : fallback;
}

/* *value: of the last key of the condition. */
static bool holds(const Place *at, const Condition *c, const char **value)
{
    bool given = false;
    for (const char *key = c->keys; *key;) {
        char path[64];
        bool here;
        copy_part(path, sizeof path, key, strcspn(key, "|"));
        *value = c->root ? value_at(at->root, at->file->root, path, &here)
                         : value_at(at->table, at->node, path, &here);
        given |= here;
        key += strcspn(key, "|"), key += strspn(key, "| ");
    }
    return *c->values ? has_value(c->values, *value) : given != c->absent;
}

/* The row at the end of a path; NULL: there is none. */
static const YamlField *row_at(const YamlTable *table, const char *path)
{
    const YamlField *row = NULL;
    for (char name[64]; table && *path; path += *path == '.') {
        copy_part(name, sizeof name, path, strcspn(path, "."));
        row = table_row(table, name);
        table = row ? row->table : NULL;
        path += strcspn(path, ".");
    }
    return *path ? NULL : row;
}

static bool is_choice(const YamlField *row, const char *value, size_t length)
{
    for (int k = 0; row->choices && row->choices[k]; k++)
        if (strlen(row->choices[k]) == length && !strncmp(row->choices[k], value, length)) return true;
    return false;
}

bool row_use_is_sound(const YamlTable *root, const YamlTable *table, const YamlField *row)
{
    Condition c;
    for (const char *when = row->when; when && next_condition(&when, &c);) {
        const YamlField *found = NULL;
        for (const char *key = c.keys; *key; key += strspn(key, "| ")) {
            char path[64];
            copy_part(path, sizeof path, key, strcspn(key, "|"));
            found = row_at(c.root ? root : table, path);
            if (!found) return false;
            key += strcspn(key, "|");
        }
        for (const char *value = c.values; *value; value += strspn(value, ", ")) {
            if (!is_choice(found, value, strcspn(value, ","))) return false;
            value += strcspn(value, ",");
        }
    }
    return true;
}

/* Does the value say nothing but the default? */
static bool is_default(const Place *at, const YamlField *row, const Node *item)
{
    Load load = {.file = at->file, .name = at->root->name};
    void *written = mem_alloc(1, at->table->size), *fallback = mem_alloc(1, at->table->size);
    load_row_alone(&load, row, item, written);
    load_row_alone(&load, row, NULL, fallback);
    char *one = row_text(row, written), *other = row_text(row, fallback);
    bool same = !strcmp(one, other);
    YamlTable alone = {.size = at->table->size, .fields = (const YamlField[]){*row, {0}}};
    yaml_clear(&alone, written);
    yaml_clear(&alone, fallback);
    mem_free(written);
    mem_free(fallback);
    mem_free(one);
    mem_free(other);
    return same;
}

static void refuse(const Place *at, const YamlField *row, const char *key, int i, const Condition *c,
                   const char *value)
{
    const char *more = *c->otherwise ? c->otherwise : row->otherwise;
    Node place = *at->node;
    if (place.kind == NODE_MAP)
        place = (Node){.line = at->node->key_place[i][0],
                       .column = at->node->key_place[i][1],
                       .origin = at->node->items[i]->origin};
    char why[400];
    if (*c->values && value)
        snprintf(why, sizeof why, "with `%s: %s`, only with %s", c->keys, value, c->values);
    else if (*c->values)
        snprintf(why, sizeof why, "without `%s: %s`", c->keys, c->values);
    else
        snprintf(why, sizeof why, "%s `%s`", c->absent ? "beside" : "without", c->keys);
    yaml_error(at->file, &place, "%s is not used %s%s%s", key, why, more ? ": " : "", more ? more : "");
}

static void check_table(const Place *at, const char *path);

static void check_entries(const Place *at, const YamlField *row, const Node *item, const char *path)
{
    Place below = {at->file, at->root, row->table, item};
    bool many = (row->kind == FIELD_LIST && !load_is_alone(row, item)) || row->kind == FIELD_MAP;
    if (!many) check_table(&below, path);
    for (int i = 0; many && i < item->count; i++) {
        char *entry =
            row->kind == FIELD_MAP ? mem_format("%s.%s", path, item->keys[i]) : mem_format("%s[%d]", path, i);
        below.node = item->items[i];
        check_table(&below, entry);
        mem_free(entry);
    }
}

/* A row's value in its table: at the index of a mapping, or the whole of a short form. */
static void check_row(const Place *at, const YamlField *row, int i, const char *path)
{
    const Node *item = at->node->kind == NODE_MAP ? at->node->items[i] : at->node;
    Condition c;
    const char *when = row->when, *value = NULL;
    bool used = true;
    while (used && when && next_condition(&when, &c)) used = holds(at, &c, &value);
    char *key = mem_format("%s%s%s", path, *path ? "." : "", row->key);
    if (!used && !is_default(at, row, item))
        refuse(at, row, key, i, &c, value);
    else if (used && row->table)
        check_entries(at, row, item, key);
    mem_free(key);
}

static void check_table(const Place *at, const char *path)
{
    bool map = at->node->kind == NODE_MAP;
    for (int i = 0; i < (map ? at->node->count : 1); i++) {
        const YamlField *row =
            map ? table_row(at->table, at->node->keys[i]) : load_short_row(at->table, at->node);
        if (row) check_row(at, row, i, path); /* the version has none */
    }
}

bool yaml_check_use(YamlFile *file, const YamlTable *table)
{
    Place at = {file, table, table, file->root};
    int before = file->error_count;
    check_table(&at, "");
    return file->error_count == before;
}
