/* The effective scene as text, and the comparison of two of them. */
#include "base/memory.h"
#include "io/text.h"
#include "io/yaml_private.h"
#include <math.h>
#include <string.h>

static void write_table(Text *text, const YamlTable *table, const void *scene, int depth);

/* Is the value there, or as it is when absent? */
static bool is_given(const YamlField *row, const void *scene)
{
    const void *member = row_member(row, scene);
    switch (row->kind) {
    case FIELD_NUMBER:
        return !isnan(*(const double *)member);
    case FIELD_INTEGER:
        return *(const int *)member != YAML_ABSENT;
    case FIELD_CHOICE:
        return *(const int *)member >= 0;
    case FIELD_BOOL:
        return *(const bool *)member;
    case FIELD_TABLE:
        return true;
    case FIELD_NUMBERS:
        if (!row->count_offset) return !isnan(*(const double *)member);
        break;
    case FIELD_INTEGERS:
        if (!row->count_offset) return *(const int *)member != YAML_ABSENT;
        break;
    default:
        break;
    }
    return *(void *const *)member != NULL;
}

static void write_number(Text *text, double value)
{
    char number[40];
    number_format(value, number);
    text_add(text, "%s", number);
}

static void write_entry(Text *text, const YamlField *row, const void *array, int i)
{
    switch (row->kind) {
    case FIELD_NUMBERS:
        write_number(text, ((const double *)array)[i]);
        break;
    case FIELD_INTEGERS:
        text_add(text, "%d", ((const int *)array)[i]);
        break;
    case FIELD_TEXTS:
        text_add_quoted(text, ((char *const *)array)[i]);
        break;
    case FIELD_CHOICES:
        text_add(text, "%s", row->choices[((const int *)array)[i]]);
        break;
    case FIELD_VALUES:
        text_add(text, "%s", ((const YamlValue *)array)[i].text);
        break;
    default: /* FIELD_ROWS */
        text_add(text, "[");
        for (int k = 0; k < row->width; k++) {
            if (k) text_add(text, ", ");
            write_number(text, ((const double *)array)[i * row->width + k]);
        }
        text_add(text, "]");
    }
}

static void write_list(Text *text, const YamlField *row, const void *scene)
{
    const void *member = row_member(row, scene);
    int count = row->count_offset ? *row_count(row, scene) : row->width;
    const void *array = row->count_offset ? *(void *const *)member : member;
    text_add(text, "[");
    for (int i = 0; i < count; i++) {
        if (i) text_add(text, ", ");
        write_entry(text, row, array, i);
    }
    text_add(text, "]\n");
}

/* Lists and maps of tables, one entry below the other. */
static void write_tables(Text *text, const YamlField *row, const void *scene, int depth)
{
    const char *array = *(char *const *)row_member(row, scene);
    int count = *row_count(row, scene);
    if (!row->rest) text_add(text, count ? "\n" : row->kind == FIELD_MAP ? "{}\n" : "[]\n");
    if (row->alone && count == 1) {
        write_table(text, row->table, array, depth);
        return;
    }
    for (int i = 0; i < count; i++) {
        const char *entry = array + (size_t)i * row->size;
        text_indent(text, depth);
        if (row->kind == FIELD_MAP) {
            text_add_quoted(text, *(char *const *)entry);
            text_add(text, ":\n");
        } else {
            text_add(text, "-\n");
        }
        write_table(text, row->table, entry, depth + 1);
    }
}

/* Do readers of YAML 1.1 take the key for true or false? Such keys are in quotes. */
static bool is_boolean_elsewhere(const YamlField *row)
{
    for (int k = 0; row->also && row->also[k]; k++)
        if (!strcmp(row->also[k], "true") || !strcmp(row->also[k], "false")) return true;
    return false;
}

static void write_row(Text *text, const YamlField *row, const void *scene, int depth)
{
    const void *member = row_member(row, scene);
    if (row->rest) {
        write_tables(text, row, scene, depth);
        return;
    }
    text_indent(text, depth);
    text_add(text, is_boolean_elsewhere(row) ? "\"%s\": " : "%s: ", row->key);
    switch (row->kind) {
    case FIELD_NUMBER:
        write_number(text, *(const double *)member);
        break;
    case FIELD_INTEGER:
        text_add(text, "%d", *(const int *)member);
        break;
    case FIELD_BOOL:
        text_add(text, "true");
        break;
    case FIELD_CHOICE:
        text_add(text, "%s", row->choices[*(const int *)member]);
        break;
    case FIELD_TEXT:
    case FIELD_FILE:
        text_add_quoted(text, *(char *const *)member);
        break;
    case FIELD_TABLE:
    case FIELD_OPTIONAL:
        text_add(text, "\n");
        write_table(text, row->table, row->kind == FIELD_TABLE ? member : *(void *const *)member, depth + 1);
        return;
    case FIELD_LIST:
    case FIELD_MAP:
        write_tables(text, row, scene, depth + 1);
        return;
    default:
        write_list(text, row, scene);
        return;
    }
    text_add(text, "\n");
}

/* A table in which nothing is given is written as {}, because YAML reads nothing as a null. */
static void write_table(Text *text, const YamlTable *table, const void *scene, int depth)
{
    int written = 0;
    for (const YamlField *row = table->fields; row->key; row++) {
        if (!is_given(row, scene)) continue;
        write_row(text, row, scene, depth);
        written++;
    }
    if (written) return;
    text_indent(text, depth);
    text_add(text, "{}\n");
}

char *row_text(const YamlField *row, const void *scene)
{
    Text text = {0};
    text_add(&text, "%s", "");
    if (is_given(row, scene)) write_row(&text, row, scene, 0);
    return text.text;
}

char *yaml_write(const YamlTable *table, const void *scene)
{
    Text text = {0};
    text_add(&text, "%s: 1\n", table_version(table));
    write_table(&text, table, scene, 0);
    return text.text;
}

char *yaml_write_key(const YamlTable *table, const void *scene, const char *key)
{
    char *row = row_text(table_row(table, key), scene), *colon = strchr(row, ':');
    char *assignment = mem_format("%s=%s", key, colon ? colon + 1 : "");
    mem_free(row);
    return assignment;
}

/* ---- Files ---- */

typedef struct Visit {
    void (*visit)(void *self, const char *key, const char *path);
    void *self;
} Visit;

static void visit_table(const Visit *visit, const YamlTable *table, const void *scene, const char *path);

/* Entries of a list or map, or the one table. */
static void visit_row(const Visit *visit, const YamlField *row, const void *scene, const char *key)
{
    const void *member = row_member(row, scene);
    if (row->kind == FIELD_FILE) visit->visit(visit->self, key, *(char *const *)member);
    if (row->kind == FIELD_TABLE) visit_table(visit, row->table, member, key);
    if (row->kind == FIELD_OPTIONAL) visit_table(visit, row->table, *(void *const *)member, key);
    if (row->kind != FIELD_LIST && row->kind != FIELD_MAP) return;
    const char *entry = *(char *const *)member;
    for (int i = 0; i < *row_count(row, scene); i++, entry += row->size) {
        bool single = row->alone && *row_count(row, scene) == 1;
        char *below = single                    ? mem_text(key)
                      : row->kind == FIELD_LIST ? mem_format("%s[%d]", key, i)
                                                : mem_format("%s.%s", key, *(char *const *)entry);
        visit_table(visit, row->table, entry, below);
        mem_free(below);
    }
}

static void visit_table(const Visit *visit, const YamlTable *table, const void *scene, const char *path)
{
    for (const YamlField *row = table->fields; row->key; row++) {
        if (!is_given(row, scene)) continue;
        char *key = mem_format("%s%s%s", path, *path ? "." : "", row->key);
        visit_row(visit, row, scene, key);
        mem_free(key);
    }
}

void yaml_files(const YamlTable *table, const void *scene,
                void (*visit)(void *self, const char *key, const char *path), void *self)
{
    visit_table(&(Visit){visit, self}, table, scene, "");
}

/* ---- Comparison ---- */

static bool is_below(const char *path, const char *const *ignored)
{
    for (; ignored && *ignored; ignored++) {
        size_t length = strlen(*ignored);
        if (!strncmp(path, *ignored, length) && (!path[length] || strchr(".[", path[length]))) return true;
    }
    return false;
}

static char *difference(const Node *a, const Node *b, const char *path, const char *const *ignored);

static char *map_difference(const Node *a, const Node *b, const char *path, const char *const *ignored,
                            bool both_ways)
{
    char *found = NULL;
    for (int i = 0; !found && i < a->count; i++) {
        char *below = mem_format("%s%s%s", path, *path ? "." : "", a->keys[i]);
        const Node *other = node_find(b, a->keys[i]);
        if (!other && !is_below(below, ignored)) found = mem_text(below);
        if (other && both_ways) found = difference(a->items[i], other, below, ignored);
        mem_free(below);
    }
    return found;
}

static char *list_difference(const Node *a, const Node *b, const char *path, const char *const *ignored)
{
    char *found = NULL;
    for (int i = 0; !found && i < a->count; i++) {
        char *below = mem_format("%s[%d]", path, i);
        found = difference(a->items[i], b->items[i], below, ignored);
        mem_free(below);
    }
    return found;
}

static char *difference(const Node *a, const Node *b, const char *path, const char *const *ignored)
{
    if (is_below(path, ignored)) return NULL;
    if (a->kind == NODE_MAP && b->kind == NODE_MAP) {
        char *found = map_difference(a, b, path, ignored, true);
        return found ? found : map_difference(b, a, path, ignored, false);
    }
    if (a->kind == NODE_LIST && b->kind == NODE_LIST && a->count == b->count)
        return list_difference(a, b, path, ignored);
    if (a->kind == NODE_SCALAR && b->kind == NODE_SCALAR && !strcmp(a->text, b->text)) return NULL;
    return mem_text(*path ? path : "the scene");
}

char *yaml_difference(const char *scene, const char *other, const char *const *ignored)
{
    YamlFile *a = yaml_parse("scene", scene, strlen(scene)), *b = yaml_parse("scene", other, strlen(other));
    char *found = a->root && b->root ? difference(a->root, b->root, "", ignored) : mem_text("the scene");
    yaml_destroy(a);
    yaml_destroy(b);
    return found;
}
