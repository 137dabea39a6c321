/* Errors of a scene file: kept by place, reported with the source line. */
#include "base/memory.h"
#include "io/yaml_private.h"
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Takes the sentence. */
static void store(YamlFile *file, int line, int column, bool is_set, char *sentence)
{
    file->error_count++;
    if (file->stored_count == YAML_MAX_ERRORS) {
        mem_free(sentence);
        return;
    }
    int k = file->stored_count++;
    for (; k > 0; k--) {
        const YamlError *before = &file->errors[k - 1];
        if (before->line < line || (before->line == line && before->column <= column)) break;
        file->errors[k] = file->errors[k - 1];
        file->error_is_set[k] = file->error_is_set[k - 1];
    }
    file->errors[k] = (YamlError){line, column, sentence};
    file->error_is_set[k] = is_set;
}

static char *format_text(const char *format, va_list args)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, args);
    return mem_text(text);
}

static void store_at(YamlFile *file, const Node *at, char *sentence)
{
    if (at && at->origin) {
        char *whole = mem_format("--set %s: %s", at->origin, sentence);
        mem_free(sentence);
        store(file, 0, 0, true, whole);
    } else {
        store(file, at ? at->line : 0, at ? at->column : 0, false, sentence);
    }
}

void yaml_error(YamlFile *file, const Node *at, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    store_at(file, at, format_text(format, args));
    va_end(args);
}

void yaml_error_at(YamlFile *file, int line, int column, const char *format, ...)
{
    const Node at = {.line = line, .column = column, .origin = file->setting};
    va_list args;
    va_start(args, format);
    store_at(file, &at, format_text(format, args));
    va_end(args);
}

/* ---- Keys ---- */

bool path_step(const char **path, const char **name, int *length, int *index)
{
    const char *c = *path;
    if (*c == '.') c++;
    *index = -1;
    if (*c == '[') {
        char *end;
        long number = strtol(c + 1, &end, 10);
        if (!isdigit((unsigned char)c[1]) || *end != ']' || number > YAML_MAX_VALUES) return false;
        *index = (int)number;
        *path = end + 1;
        return true;
    }
    *name = c;
    while (*c && *c != '.' && *c != '[') c++;
    *length = (int)(c - *name);
    *path = c;
    return *length > 0;
}

Node *tree_follow(const YamlFile *file, const char *key, const char **rest)
{
    Node *node = file->root;
    const char *name = NULL;
    int length = 0, index;
    *rest = key;
    for (const char *next = key; node && path_step(&next, &name, &length, &index); *rest = next) {
        Node *item = NULL;
        if (index >= 0 && node->kind == NODE_LIST && index < node->count) item = node->items[index];
        int known = index < 0 && node->kind == NODE_MAP ? node_index(node, name, (size_t)length) : -1;
        if (known >= 0) item = node->items[known];
        if (index < 0 && node->kind == NODE_LIST) item = node; /* the short form of a table with such a key */
        if (!item) return node;
        node = item;
    }
    return node;
}

bool yaml_refuse(YamlFile *file, const char *key, const char *format, ...)
{
    const char *rest;
    va_list args;
    va_start(args, format);
    char *sentence = format_text(format, args);
    va_end(args);
    if (*key) {
        char *whole = mem_format("%s: %s", key, sentence);
        mem_free(sentence);
        sentence = whole;
    }
    store_at(file, tree_follow(file, key, &rest), sentence);
    return false;
}

bool yaml_says(const YamlFile *file, const char *key)
{
    const char *rest;
    return tree_follow(file, key, &rest) != NULL && !*rest;
}

char *yaml_where(const YamlFile *file, const char *key)
{
    const char *rest;
    const Node *node = tree_follow(file, key, &rest);
    if (node && node->origin) return mem_format("--set %s", node->origin);
    if (!node || !node->line) return mem_text(file->path);
    return mem_format("%s:%d:%d", file->path, node->line, node->column);
}

/* ---- Reports ---- */

int yaml_error_count(const YamlFile *file)
{
    return file->error_count;
}

const YamlError *yaml_errors(const YamlFile *file, int *count)
{
    *count = file->stored_count;
    return file->errors;
}

/* The source line, cut where it is long, and a caret below the column. Tabs stay tabs, so that the caret
 * stands right. */
static char *source_line(const YamlFile *file, int line, int column)
{
    enum { SHOWN = 160 };
    const char *start = file->text, *end = file->text + file->length;
    for (int k = 1; k < line && start < end; k++) {
        const char *newline = memchr(start, '\n', (size_t)(end - start));
        start = newline ? newline + 1 : end;
    }
    int length = 0, caret = 0;
    while (start + length < end && start[length] && start[length] != '\n' && start[length] != '\r' &&
           length < SHOWN)
        length++;
    char blanks[SHOWN + 1];
    for (int characters = 1; caret < length && characters < column; caret++) {
        blanks[caret] = start[caret] == '\t' ? '\t' : ' ';
        characters += ((unsigned char)start[caret + 1] & 0xc0) != 0x80;
    }
    int width = 0; /* a character of several bytes is one blank */
    for (int k = 0; k < caret; k++)
        if (((unsigned char)start[k] & 0xc0) != 0x80) blanks[width++] = start[k] == '\t' ? '\t' : ' ';
    blanks[width] = 0;
    return mem_format("    %.*s\n    %s^\n", length, start, blanks);
}

static char *error_text(const YamlFile *file, int k)
{
    const YamlError *error = &file->errors[k];
    if (file->error_is_set[k]) return mem_format("%s\n", error->sentence);
    if (!error->line) return mem_format("%s: %s\n", file->path, error->sentence);
    char *line = source_line(file, error->line, error->column);
    char *text =
        mem_format("%s:%d:%d: %s\n%s", file->path, error->line, error->column, error->sentence, line);
    mem_free(line);
    return text;
}

char *yaml_report(const YamlFile *file)
{
    char *report = mem_text("");
    for (int k = 0; k < file->stored_count; k++) {
        char *text = error_text(file, k), *longer = mem_format("%s%s", report, text);
        mem_free(text);
        mem_free(report);
        report = longer;
    }
    if (file->error_count <= file->stored_count) return report;
    char *longer = mem_format("%sand %d errors more\n", report, file->error_count - file->stored_count);
    mem_free(report);
    return longer;
}

/* ---- Misspelt words ---- */

/* Edits (one letter more, less, other, or two swapped) from a to b; words longer than the table count as far.
 */
static int distance(const char *a, const char *b)
{
    enum { LONGEST = 40 };
    int n = (int)strlen(a), m = (int)strlen(b), d[LONGEST + 1][LONGEST + 1];
    if (n > LONGEST || m > LONGEST) return LONGEST;
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= m; j++) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            int other =
                d[i - 1][j - 1] + (tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[j - 1]));
            int least = d[i - 1][j] < d[i][j - 1] ? d[i - 1][j] + 1 : d[i][j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && d[i - 2][j - 2] + 1 < least)
                least = d[i - 2][j - 2] + 1;
            d[i][j] = other < least ? other : least;
        }
    return d[n][m];
}

const char *nearest_word(const YamlFile *file, const char *word,
                         const char *(*words)(const void *self, int i), const void *self)
{
    if (file->stored_count == YAML_MAX_ERRORS) return NULL;
    const char *best = NULL;
    int least = 1 + (int)strlen(word) / 3, near = least + 1;
    for (int i = 0; words(self, i); i++) {
        int edits = distance(word, words(self, i));
        if (edits < near) near = edits, best = words(self, i);
    }
    return near <= least ? best : NULL;
}

/* The path below `path` of what stands there; NULL: nothing does. */
static char *find_key(const Node *node, int line, int column, const char *path)
{
    char *found = NULL;
    if (node->line == line && node->column == column && node->kind == NODE_SCALAR) return mem_text(path);
    for (int i = 0; !found && i < node->count; i++) {
        bool map = node->kind == NODE_MAP;
        char *below =
            map ? mem_format("%s%s%s", path, *path ? "." : "", node->keys[i]) : mem_format("%s[%d]", path, i);
        bool here = map && node->key_place[i][0] == line && node->key_place[i][1] == column;
        found = here ? mem_text(below) : find_key(node->items[i], line, column, below);
        mem_free(below);
    }
    if (!found && node->line == line && node->column == column) return mem_text(path);
    return found;
}

char *yaml_key_at(const YamlFile *file, int line, int column)
{
    char *found = file->root ? find_key(file->root, line, column, "") : NULL;
    return found ? found : mem_text("");
}

void yaml_forget_errors(YamlFile *file)
{
    for (int k = 0; k < file->stored_count; k++) mem_free(file->errors[k].sentence);
    file->error_count = file->stored_count = 0;
}
