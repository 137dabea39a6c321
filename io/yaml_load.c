/* The tree to a struct, row by row. */
#include "io/yaml_load.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool load_table(Load *load, const YamlTable *table, const Node *node, void *scene);
static bool load_value(Load *load, const YamlField *row, const Node *node, void *scene);

/* ---- Lists ---- */

static bool check_count(Load *load, const YamlField *row, const Node *node, int least, int most)
{
    char what[128];
    if (node->kind != NODE_LIST) {
        snprintf(what, sizeof what, "must be a list%s, not %s", least == most && least ? "" : " of entries",
                 node_kind_name(node));
        if (least == most && least)
            snprintf(what, sizeof what, "must be a list of %d %s, not %s", least,
                     row->kind == FIELD_ROWS ? "rows" : "entries", node_kind_name(node));
        return load_wrong(load, node, what);
    }
    if (node->count >= least && (!most || node->count <= most)) return true;
    if (least == most)
        snprintf(what, sizeof what, "must be a list of %d entries, not %d", least, node->count);
    else if (node->count < least)
        snprintf(what, sizeof what, "must have %d entr%s at least, not %d", least, least == 1 ? "y" : "ies",
                 node->count);
    else
        snprintf(what, sizeof what, "must have %d entries at most, not %d", most, node->count);
    return load_wrong(load, node, what);
}

/* Entries of a list into an array of this many bytes each; a lone value is a list of one. */
static bool load_entries(Load *load, const YamlField *row, const Node *node, char *array, size_t size,
                         bool (*entry)(Load *, const YamlField *, const Node *, void *))
{
    bool ok = true;
    for (int i = 0; i < node->count; i++) {
        size_t length = load_enter(load, NULL, i);
        ok = entry(load, row, node->items[i], array + (size_t)i * size) && ok;
        load_leave(load, length);
    }
    return ok;
}

static bool number_entry(Load *load, const YamlField *row, const Node *node, void *value)
{
    return load_number(load, row, node, value);
}
static bool integer_entry(Load *load, const YamlField *row, const Node *node, void *value)
{
    return load_integer(load, row, node, value);
}
static bool choice_entry(Load *load, const YamlField *row, const Node *node, void *value)
{
    return load_choice(load, row, node, value);
}
static bool text_entry(Load *load, const YamlField *row, const Node *node, void *value)
{
    return (void)row, load_text(load, node, value);
}
static bool table_entry(Load *load, const YamlField *row, const Node *node, void *value)
{
    return load_table(load, row->table, node, value);
}

static bool row_entry(Load *load, const YamlField *row, const Node *node, void *value)
{
    YamlField numbers = *row;
    numbers.kind = FIELD_NUMBERS;
    return check_count(load, &numbers, node, row->width, row->width) &&
           load_entries(load, &numbers, node, value, sizeof(double), number_entry);
}

static size_t entry_size(const YamlField *row)
{
    switch (row->kind) {
    case FIELD_NUMBERS:
        return sizeof(double);
    case FIELD_INTEGERS:
    case FIELD_CHOICES:
        return sizeof(int);
    case FIELD_TEXTS:
        return sizeof(char *);
    case FIELD_ROWS:
        return (size_t)row->width * sizeof(double);
    default:
        return row->size;
    }
}

/* Is it one entry of a list that may stand without it: no list of mappings? */
bool load_is_alone(const YamlField *row, const Node *node)
{
    return row->alone && (node->kind != NODE_LIST || (node->count && node->items[0]->kind == NODE_SCALAR));
}

/* Lists whose entries the struct owns, or arrays of fixed width in it. */
static bool load_list(Load *load, const YamlField *row, const Node *node, void *scene)
{
    static bool (*const entries[])(Load *, const YamlField *, const Node *, void *) = {
        [FIELD_NUMBERS] = number_entry, [FIELD_INTEGERS] = integer_entry, [FIELD_CHOICES] = choice_entry,
        [FIELD_TEXTS] = text_entry,     [FIELD_ROWS] = row_entry,         [FIELD_LIST] = table_entry};
    Node alone = {
        .kind = NODE_LIST, .line = node->line, .column = node->column, .origin = node->origin, .count = 1};
    Node *item = (Node *)node;
    bool scalar_list = row->count_offset && (row->kind == FIELD_NUMBERS || row->kind == FIELD_INTEGERS ||
                                             row->kind == FIELD_CHOICES);
    if (node->kind == NODE_SCALAR && scalar_list) alone.items = &item, node = &alone;
    if (!row->count_offset) {
        return check_count(load, row, node, row->width, row->width) &&
               load_entries(load, row, node, row_member(row, scene), entry_size(row), entries[row->kind]);
    }
    bool single = load_is_alone(row, node);
    if (!single && !check_count(load, row, node, row->min_count, row->max_count)) return false;
    int count = single ? 1 : node->count;
    void *array = mem_alloc((size_t)count, entry_size(row));
    *(void **)row_member(row, scene) = array;
    *row_count(row, scene) = count;
    if (single) return table_entry(load, row, node, array);
    return load_entries(load, row, node, array, entry_size(row), entries[row->kind]);
}

static bool load_map(Load *load, const YamlField *row, const Node *node, void *scene)
{
    if (node->kind != NODE_MAP) return load_wrong(load, node, "must be a mapping of names");
    char *array = mem_alloc((size_t)node->count, row->size);
    *(void **)row_member(row, scene) = array;
    *row_count(row, scene) = node->count;
    bool ok = true;
    for (int i = 0; i < node->count; i++) {
        size_t length = load_enter(load, node->keys[i], 0);
        ok = load_table(load, row->table, node->items[i], array + (size_t)i * row->size) && ok;
        *(char **)(array + (size_t)i * row->size) = mem_text(node->keys[i]);
        load_leave(load, length);
    }
    return ok;
}

static bool load_optional(Load *load, const YamlField *row, const Node *node, void *scene)
{
    void *table = mem_alloc(1, row->table->size);
    *(void **)row_member(row, scene) = table;
    return load_table(load, row->table, node, table);
}

static bool load_value(Load *load, const YamlField *row, const Node *node, void *scene)
{
    void *member = row_member(row, scene);
    switch (row->kind) {
    case FIELD_NUMBER:
        return load_number(load, row, node, member);
    case FIELD_INTEGER:
        return load_integer(load, row, node, member);
    case FIELD_BOOL:
        return load_bool(load, node, member);
    case FIELD_TEXT:
        return load_text(load, node, member);
    case FIELD_FILE:
        return load_file(load, node, member);
    case FIELD_CHOICE:
        return load_choice(load, row, node, member);
    case FIELD_TABLE:
        return load_table(load, row->table, node, member);
    case FIELD_OPTIONAL:
        return load_optional(load, row, node, scene);
    case FIELD_MAP:
        return load_map(load, row, node, scene);
    default:
        return load_list(load, row, node, scene);
    }
}

/* ---- Tables ---- */

/* What a member holds when its key is absent: zero, or this. */
static void set_absent(const YamlField *row, void *scene)
{
    void *member = row_member(row, scene);
    if (row->kind == FIELD_NUMBER) *(double *)member = NAN;
    if (row->kind == FIELD_INTEGER) *(int *)member = YAML_ABSENT;
    if (row->kind == FIELD_CHOICE) *(int *)member = -1;
    if (row->kind == FIELD_NUMBERS && !row->count_offset) *(double *)member = NAN;
    if (row->kind == FIELD_INTEGERS && !row->count_offset) *(int *)member = YAML_ABSENT;
}

static bool load_default(Load *load, const YamlField *row, void *scene)
{
    if (!row->fallback) {
        if (row->kind != FIELD_TABLE) return true;
        Node nothing = {.kind = NODE_MAP};
        return load_table(load, row->table, &nothing, row_member(row, scene));
    }
    Node *node = tree_parse(load->file, row->fallback, strlen(row->fallback));
    bool ok = node && load_value(load, row, node, scene);
    node_destroy(node);
    return ok;
}

/* May the row take this value in place of a mapping? Kinds are told apart, so that the first that may, must.
 */
static bool accepts(const YamlField *row, const Node *node)
{
    bool number = node->kind == NODE_SCALAR && unit_is_number(node->text);
    switch (row->kind) {
    case FIELD_NUMBER:
    case FIELD_INTEGER:
        return number;
    case FIELD_TEXT:
    case FIELD_FILE:
        return node->kind == NODE_SCALAR;
    case FIELD_CHOICE:
        for (int k = 0; node->kind == NODE_SCALAR && row->choices[k]; k++)
            if (!strcmp(node->text, row->choices[k])) return true;
        return false;
    case FIELD_NUMBERS:
        for (int i = 0; node->kind == NODE_LIST && i < node->count; i++)
            if (node->items[i]->kind != NODE_SCALAR || !unit_is_number(node->items[i]->text)) return false;
        return node->kind == NODE_LIST;
    default:
        return node->kind == NODE_LIST;
    }
}

/* The row that a value which is no mapping goes to: the first that accepts it, else the first of all, whose
 * refusal tells what is wanted. */
const YamlField *load_short_row(const YamlTable *table, const Node *node)
{
    const YamlField *first = NULL;
    for (const YamlField *row = table->fields; row->key; row++) {
        if (!row->short_form) continue;
        if (accepts(row, node)) return row;
        if (!first) first = row;
    }
    return first;
}

/* Is it a name of the row's key? */
static bool row_is(const YamlField *row, const char *key)
{
    if (!strcmp(row->key, key)) return true;
    for (int k = 0; row->also && row->also[k]; k++)
        if (!strcmp(row->also[k], key)) return true;
    return false;
}

/* The index of the row's value in a mapping, under any of its names; -1: none. *count: under how many. */
static int row_index(const YamlField *row, const Node *node, int *count)
{
    int index = node_index(node, row->key, strlen(row->key));
    *count = index >= 0;
    for (int k = 0; row->also && row->also[k]; k++) {
        int other = node_index(node, row->also[k], strlen(row->also[k]));
        if (other >= 0) index = other, ++*count;
    }
    return index;
}

const Node *load_row_item(const YamlField *row, const Node *node)
{
    int count, index = row_index(row, node, &count);
    return index < 0 ? NULL : node->items[index];
}

const YamlField *table_row(const YamlTable *table, const char *key)
{
    for (const YamlField *row = table->fields; row->key; row++)
        if (row_is(row, key)) return row;
    return NULL;
}

static bool is_given(const YamlField *row, const Node *node)
{
    const Node *item = load_row_item(row, node);
    return item && !(row->kind == FIELD_BOOL && item->kind == NODE_SCALAR && strcmp(item->text, "true"));
}

/* Rows that exclude each other. */
static bool check_one_of(Load *load, const YamlTable *table, const Node *node, int group)
{
    char given[200] = "", all[300] = "";
    int count = 0;
    bool required = false, misspelt = false;
    for (const YamlField *row = table->fields; row->key; row++) {
        if (row->one_of != group) continue;
        required |= row->required;
        misspelt |= row->required && load_is_misspelt(load, table, node, row);
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", all[0] ? ", " : "", row->key);
        if (!is_given(row, node)) continue;
        snprintf(given + strlen(given), sizeof given - strlen(given), "%s%s", count++ ? " and " : "",
                 row->key);
    }
    char what[600];
    if (count > 1)
        snprintf(what, sizeof what, "has %s; give only one of %s", given, all);
    else if (count == 0 && required && !misspelt)
        snprintf(what, sizeof what, "needs one of %s", all);
    else
        return true;
    return load_wrong(load, node, what);
}

static bool group_is_given(const YamlTable *table, const Node *node, int group)
{
    for (const YamlField *row = table->fields; row->key; row++)
        if (row->one_of == group && is_given(row, node)) return true;
    return false;
}

bool load_row_alone(Load *load, const YamlField *row, const Node *item, void *scene)
{
    set_absent(row, scene);
    return item ? load_value(load, row, item, scene) : load_default(load, row, scene);
}

static bool load_row(Load *load, const YamlTable *table, const YamlField *row, const Node *node, void *scene)
{
    int count, index = row_index(row, node, &count);
    size_t length = load_enter(load, row->key, 0);
    bool ok = true;
    set_absent(row, scene);
    if (count > 1) {
        ok = load_wrong(load, node, "is there twice, under two of its names");
    } else if (index >= 0) {
        ok = load_value(load, row, node->items[index], scene);
    } else if (row->required && !row->one_of) {
        if (!load_is_misspelt(load, table, node, row))
            yaml_error(load->file, node, "%s is missing%s%s", load->path, row->doc ? ": " : "",
                       row->doc ? row->doc : "");
        ok = false;
    } else if (!row->one_of || !group_is_given(table, node, row->one_of)) {
        ok = load_default(load, row, scene);
    }
    load_leave(load, length);
    return ok;
}

static bool load_map_node(Load *load, const YamlTable *table, const Node *node, void *scene)
{
    bool ok = load_keys(load, table, node);
    for (const YamlField *row = table->fields; row->key; row++)
        ok = load_row(load, table, row, node, scene) && ok;
    for (int group = 1, more = 1; more; group++) {
        more = 0;
        for (const YamlField *row = table->fields; row->key; row++) more |= row->one_of >= group;
        if (more) ok = check_one_of(load, table, node, group) && ok;
    }
    return ok;
}

static bool load_table(Load *load, const YamlTable *table, const Node *node, void *scene)
{
    if (node->kind == NODE_MAP) return load_map_node(load, table, node, scene);
    const YamlField *row = load_short_row(table, node);
    if (!row) {
        char what[800] = "must be a mapping with the keys ";
        load_list_keys(table, what + strlen(what), sizeof what - strlen(what));
        return load_wrong(load, node, what);
    }
    /* As if the key had been written. */
    Node *item = (Node *)node;
    char *key = (char *)row->key;
    int place[1][2] = {{node->line, node->column}};
    Node map = {.kind = NODE_MAP,
                .line = node->line,
                .column = node->column,
                .origin = node->origin,
                .count = 1,
                .items = &item,
                .keys = &key,
                .key_place = place};
    lookup_add(&map.lookup, lookup_hash(0, key, strlen(key)), 0);
    bool ok = load_map_node(load, table, &map, scene);
    lookup_clear(&map.lookup);
    return ok;
}

bool yaml_load(YamlFile *file, const YamlTable *table, void *scene)
{
    memset(scene, 0, table->size);
    if (!file->root && !file->error_count)
        yaml_error_at(file, 1, 1, "the file is empty; a %s has the key `slender: 1`", table->name);
    if (!file->root) return false;
    if (file->root->kind != NODE_MAP) {
        yaml_error(file, file->root, "a %s is a mapping with the key `slender: 1`", table->name);
        return false;
    }
    const Node *version = node_find(file->root, VERSION_KEY);
    if (!version || version->kind != NODE_SCALAR || strcmp(version->text, "1"))
        yaml_error(file, version ? version : file->root,
                   "a %s must have the key `slender: 1`, the format's version", table->name);
    Load load = {.file = file, .name = table->name};
    load_table(&load, table, file->root, scene);
    if (!file->error_count) return true;
    yaml_clear(table, scene);
    return false;
}

/* ---- Files ---- */

static const char *find_in_row(const YamlField *row, void *scene,
                               bool (*is)(const char *file, const char *other), const char *other)
{
    void *member = row_member(row, scene);
    if (row->kind == FIELD_TABLE) return yaml_find_file(row->table, member, is, other);
    bool file = row->kind == FIELD_FILE,
         tables = row->kind == FIELD_OPTIONAL || row->kind == FIELD_LIST || row->kind == FIELD_MAP;
    char *block = file || tables ? *(char **)member : NULL;
    if (file) return block && is(block, other) ? block : NULL;
    int count = row->count_offset ? *row_count(row, scene) : 1;
    const char *found = NULL;
    for (int i = 0; block && !found && i < count; i++)
        found = yaml_find_file(row->table, block + (size_t)i * row->size, is, other);
    return found;
}

const char *yaml_find_file(const YamlTable *table, const void *scene,
                           bool (*is)(const char *file, const char *other), const char *other)
{
    const char *found = NULL;
    for (const YamlField *row = table->fields; row->key && !found; row++)
        found = find_in_row(row, (void *)scene, is, other);
    return found;
}

/* ---- Freeing ---- */

static void clear_row(const YamlField *row, void *scene)
{
    void *member = row_member(row, scene);
    if (row->kind == FIELD_TABLE) {
        yaml_clear(row->table, member);
        return;
    }
    bool pointer = row->count_offset || row->kind == FIELD_TEXT || row->kind == FIELD_FILE ||
                   row->kind == FIELD_OPTIONAL;
    if (!pointer) return;
    void *block = *(void **)member;
    int count = row->count_offset ? *row_count(row, scene) : 1;
    for (int i = 0; block && i < count; i++) {
        if (row->kind == FIELD_TEXTS) mem_free(((char **)block)[i]);
        if (row->kind == FIELD_MAP) mem_free(*(char **)((char *)block + (size_t)i * row->size));
        if (row->kind == FIELD_LIST || row->kind == FIELD_MAP)
            yaml_clear(row->table, (char *)block + (size_t)i * row->size);
        if (row->kind == FIELD_OPTIONAL) yaml_clear(row->table, block);
    }
    mem_free(block);
}

void yaml_clear(const YamlTable *table, void *scene)
{
    for (const YamlField *row = table->fields; row->key; row++) clear_row(row, scene);
    memset(scene, 0, table->size);
}
