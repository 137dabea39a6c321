/* libyaml's events to our own tree. The only file that includes yaml.h of libyaml. */
#include "base/memory.h"
#include "io/scan.h"
#include "io/yaml_private.h"
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* ---- Events ---- */

/* The containers that are open, the key that waits for its value in each, and all anchors so far. */
typedef struct Builder {
    YamlFile *file;
    Node *root, *open[YAML_MAX_DEPTH];
    char *key[YAML_MAX_DEPTH];
    int key_place[YAML_MAX_DEPTH][2];
    int depth, copies_left;
    long values;
    Node *anchors; /* a map whose items are borrowed */
} Builder;

static bool refuse(const Builder *b, const yaml_event_t *event, const char *what)
{
    yaml_error_at(b->file, (int)event->start_mark.line + 1, (int)event->start_mark.column + 1, "%s", what);
    return false;
}

static bool take_key(Builder *b, const yaml_event_t *event)
{
    Node *map = b->open[b->depth - 1];
    int line = (int)event->start_mark.line + 1, column = (int)event->start_mark.column + 1;
    if (event->type != YAML_SCALAR_EVENT) return refuse(b, event, "a key must be a word");
    const char *text = (const char *)event->data.scalar.value;
    if (event->data.scalar.anchor)
        return refuse(b, event, "an anchor (&name) stands before a value, not before a key");
    if (!strcmp(text, "<<"))
        return refuse(b, event, "merge keys (<<) are no part of YAML 1.2; write the keys out");
    int twin = node_index(map, text, strlen(text));
    if (twin >= 0) {
        char *where = b->file->setting ? mem_text("")
                                       : mem_format("; it is in line %d already", map->key_place[twin][0]);
        yaml_error_at(b->file, line, column, "the key '%.60s' is there twice%s", text, where);
        mem_free(where);
        return false;
    }
    b->key[b->depth - 1] = mem_text(text);
    b->key_place[b->depth - 1][0] = line;
    b->key_place[b->depth - 1][1] = column;
    return true;
}

/* Puts a value where it belongs; takes it. */
static bool add(Builder *b, const yaml_event_t *event, Node *node)
{
    if (++b->values > YAML_MAX_VALUES) {
        node_destroy(node);
        return refuse(b, event, "more than 4 million values; large tables belong into CSV files");
    }
    if (b->depth == 0) {
        b->root = node;
    } else {
        int top = b->depth - 1;
        node_append(b->open[top], b->key[top], b->key_place[top][0], b->key_place[top][1], node);
        b->key[top] = NULL;
    }
    return true;
}

/* An anchor that is set again stands for the later value. */
static void set_anchor(Builder *b, const yaml_char_t *anchor, Node *node)
{
    const char *name = (const char *)anchor;
    if (!b->anchors) b->anchors = node_create(NODE_MAP, 0, 0);
    int known = node_index(b->anchors, name, strlen(name));
    if (known >= 0)
        b->anchors->items[known] = node;
    else
        node_append(b->anchors, mem_text(name), 0, 0, node);
}

static void forget_anchors(Builder *b)
{
    for (int i = 0; b->anchors && i < b->anchors->count; i++) b->anchors->items[i] = NULL;
    node_destroy(b->anchors);
}

static bool add_scalar(Builder *b, const yaml_event_t *event)
{
    Node *node = node_create(NODE_SCALAR, (int)event->start_mark.line + 1, (int)event->start_mark.column + 1);
    node->text = mem_text((const char *)event->data.scalar.value);
    if (!add(b, event, node)) return false;
    if (event->data.scalar.anchor) set_anchor(b, event->data.scalar.anchor, node);
    return true;
}

static bool open_container(Builder *b, const yaml_event_t *event, NodeKind kind, const yaml_char_t *anchor)
{
    int line = (int)event->start_mark.line + 1, column = (int)event->start_mark.column + 1;
    bool block = event->type == YAML_MAPPING_START_EVENT &&
                 event->data.mapping_start.style == YAML_BLOCK_MAPPING_STYLE;
    if (block && b->depth && b->key[b->depth - 1]) { /* it is where its key is, not at its first one */
        line = b->key_place[b->depth - 1][0];
        column = b->key_place[b->depth - 1][1];
    }
    Node *node = node_create(kind, line, column);
    if (!add(b, event, node)) return false;
    if (anchor) set_anchor(b, anchor, node);
    if (b->depth == YAML_MAX_DEPTH) return refuse(b, event, "more than 32 levels");
    b->open[b->depth++] = node;
    return true;
}

/* A copy of what the anchor stands for; its errors are those of the place where it is written. */
static bool add_alias(Builder *b, const yaml_event_t *event)
{
    const Node *meant = node_find(b->anchors, (const char *)event->data.alias.anchor);
    if (!meant) return refuse(b, event, "there is no anchor (&name) of that name before this alias");
    for (int d = 0; d < b->depth; d++)
        if (b->open[d] == meant) return refuse(b, event, "the alias stands within what it stands for");
    Node *copy = node_copy(meant, YAML_MAX_DEPTH - b->depth, &b->copies_left);
    if (!copy) return refuse(b, event, "aliases that make more than 100 000 values or 32 levels");
    return add(b, event, copy);
}

/* Tags, and texts with a NUL (which would be cut off). */
static const char *forbidden(const yaml_event_t *event)
{
    const yaml_char_t *tag = NULL;
    if (event->type == YAML_SCALAR_EVENT) {
        tag = event->data.scalar.tag;
        if (strlen((const char *)event->data.scalar.value) != event->data.scalar.length)
            return "a text must not contain NUL";
    }
    if (event->type == YAML_SEQUENCE_START_EVENT) tag = event->data.sequence_start.tag;
    if (event->type == YAML_MAPPING_START_EVENT) tag = event->data.mapping_start.tag;
    return tag ? "tags (!name) are not allowed" : NULL;
}

static bool take(Builder *b, const yaml_event_t *event)
{
    const char *what = forbidden(event);
    if (what) return refuse(b, event, what);
    bool value = event->type == YAML_SCALAR_EVENT || event->type == YAML_SEQUENCE_START_EVENT ||
                 event->type == YAML_MAPPING_START_EVENT || event->type == YAML_ALIAS_EVENT;
    if (value && b->depth && b->open[b->depth - 1]->kind == NODE_MAP && !b->key[b->depth - 1])
        return take_key(b, event);
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return !b->root || refuse(b, event, "the file must hold one document");
    case YAML_SCALAR_EVENT:
        return add_scalar(b, event);
    case YAML_ALIAS_EVENT:
        return add_alias(b, event);
    case YAML_SEQUENCE_START_EVENT:
        return open_container(b, event, NODE_LIST, event->data.sequence_start.anchor);
    case YAML_MAPPING_START_EVENT:
        return open_container(b, event, NODE_MAP, event->data.mapping_start.anchor);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        b->depth--;
        return true;
    default:
        return true;
    }
}

/* Does a tab stand where that line is indented? Of no text (NULL) the length is 0. */
static bool has_tab(const char *text, size_t length, size_t line)
{
    size_t at = 0;
    while (at < length && line > 0) line -= text[at++] == '\n';
    while (at < length && text[at] == ' ') at++;
    return at < length && text[at] == '\t';
}

static void syntax_error(YamlFile *file, const yaml_parser_t *parser, const char *text, size_t length)
{
    yaml_mark_t mark = parser->problem_mark;
    bool tab = has_tab(text, length, mark.line);
    if (parser->error == YAML_READER_ERROR)
        yaml_error_at(file, 0, 0, "byte %zu: %s; the file must be UTF-8 text", parser->problem_offset,
                      parser->problem);
    else if (tab)
        yaml_error_at(file, (int)mark.line + 1, (int)mark.column + 1,
                      "a tab indents this line: YAML takes blanks only");
    else
        yaml_error_at(file, (int)mark.line + 1, (int)mark.column + 1, "no YAML: %s%s%s",
                      parser->problem ? parser->problem : "?", parser->context ? ", " : "",
                      parser->context ? parser->context : "");
}

Node *tree_parse(YamlFile *file, const char *text, size_t length)
{
    yaml_parser_t parser;
    yaml_event_t event;
    Builder b = {.file = file, .copies_left = YAML_MAX_COPIES};
    if (!yaml_parser_initialize(&parser)) mem_exhausted("libyaml");
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    bool ok = true;
    for (bool end = false; ok && !end; yaml_event_delete(&event)) {
        if (!yaml_parser_parse(&parser, &event)) {
            syntax_error(file, &parser, text, length);
            ok = false;
            break;
        }
        ok = take(&b, &event);
        end = event.type == YAML_STREAM_END_EVENT;
    }
    yaml_parser_delete(&parser);
    forget_anchors(&b);
    for (int d = 0; d < YAML_MAX_DEPTH; d++) mem_free(b.key[d]);
    if (ok) return b.root;
    node_destroy(b.root);
    return NULL;
}

/* ---- Files ---- */

/* The code unit of "\\uXXXX", where the text is that; else 0. */
static unsigned code_unit(const char *text, const char *end)
{
    unsigned unit = 0;
    if (end - text < 6 || text[0] != '\\' || text[1] != 'u') return 0;
    for (int k = 2; k < 6; k++) {
        const char *digits = "0123456789abcdef", *digit = strchr(digits, tolower((unsigned char)text[k]));
        if (!text[k] || !digit) return 0;
        unit = 16 * unit + (unsigned)(digit - digits);
    }
    return unit;
}

/* JSON writes a letter beyond U+FFFF as a pair of surrogates (RFC 8259, section 7), YAML as one
 * "\\UXXXXXXXX": makes that of the pairs, in place. Returns the new length. */
static size_t join_surrogates(char *text, size_t length)
{
    const char *from = text, *end = text + length;
    char *to = text;
    while (from < end) {
        unsigned high = code_unit(from, end), low = high ? code_unit(from + 6, end) : 0;
        if (high >= 0xd800 && high < 0xdc00 && low >= 0xdc00 && low < 0xe000) {
            char one[11];
            snprintf(one, sizeof one, "\\U%08X", 0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00));
            memcpy(to, one, 10);
            to += 10, from += 12;
            continue;
        }
        size_t step = *from == '\\' && from + 1 < end ? 2 : 1; /* "\\\\" is no beginning of an escape */
        memmove(to, from, step);
        to += step, from += step;
    }
    return (size_t)(to - text);
}

static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *relative = slash ? mem_format("%.*s", (int)(slash - path + 1), path) : mem_text(".");
    char *absolute = realpath(relative, NULL);
    char *folder = mem_text(absolute ? absolute : relative);
    free(absolute);
    mem_free(relative);
    return folder;
}

YamlFile *yaml_parse(const char *path, const char *text, size_t length)
{
    YamlFile *file = mem_alloc(1, sizeof *file);
    file->path = mem_text(path);
    file->folder = folder_of(path);
    file->errors = mem_alloc(YAML_MAX_ERRORS, sizeof *file->errors);
    file->error_is_set = mem_alloc(YAML_MAX_ERRORS, sizeof *file->error_is_set);
    const char *encoding = length ? text_skip_mark(&text, &length) : NULL;
    file->text = mem_alloc(length + 1, 1);
    if (length) memcpy(file->text, text, length);
    file->length = join_surrogates(file->text, length);
    if (encoding)
        yaml_error_at(file, 0, 0, "the file is %s text; save it as UTF-8", encoding);
    else if (length > YAML_MAX_BYTES)
        yaml_error_at(file, 0, 0, "more than 64 MiB; large tables belong into CSV files");
    else
        file->root = tree_parse(file, file->text, file->length);
    return file;
}

YamlFile *yaml_read(const char *path)
{
    char *text = NULL;
    size_t length = 0, got = 0;
    FILE *stream = fopen(path, "rb");
    int code = errno;
    if (stream) {
        do {
            text = mem_resize(text, length, length + 65536, 1);
            got = fread(text + length, 1, 65536, stream);
            length += got;
        } while (got > 0 && length <= YAML_MAX_BYTES);
        code = ferror(stream) ? errno : 0;
        fclose(stream);
    }
    YamlFile *file = yaml_parse(path, text, code ? 0 : length);
    mem_free(text);
    if (!code) return file;
    node_destroy(file->root);
    file->root = NULL;
    yaml_error_at(file, 0, 0, "cannot be read: %s", strerror(code));
    return file;
}

void yaml_destroy(YamlFile *file)
{
    if (!file) return;
    node_destroy(file->root);
    for (int k = 0; k < file->set_count; k++) mem_free(file->set[k]);
    for (int k = 0; k < file->stored_count; k++) mem_free(file->errors[k].sentence);
    mem_free(file->set);
    mem_free(file->errors);
    mem_free(file->error_is_set);
    mem_free(file->path);
    mem_free(file->folder);
    mem_free(file->text);
    mem_free(file);
}
