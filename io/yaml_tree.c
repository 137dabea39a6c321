/* libyaml's events to our own tree. The only file that includes yaml.h of libyaml. */
#include "base/memory.h"
#include "io/scan.h"
#include "io/yaml_private.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* ---- Nodes ---- */

Node *node_create(NodeKind kind, int line, int column)
{
    Node *node = mem_alloc(1, sizeof *node);
    node->kind = kind;
    node->line = line;
    node->column = column;
    return node;
}

void node_destroy(Node *node)
{
    if (!node) return;
    for (int i = 0; i < node->count; i++) {
        node_destroy(node->items[i]);
        mem_free(node->keys[i]);
    }
    mem_free(node->text);
    mem_free(node->items);
    mem_free(node->keys);
    mem_free(node->key_place);
    mem_free(node);
}

void node_append(Node *node, char *key, int line, int column, Node *item)
{
    if (node->count == node->room) {
        size_t old = (size_t)node->room, room = old ? 2 * old : 4;
        node->items = mem_resize(node->items, old, room, sizeof *node->items);
        node->keys = mem_resize(node->keys, old, room, sizeof *node->keys);
        node->key_place = mem_resize(node->key_place, old, room, sizeof *node->key_place);
        node->room = (int)room;
    }
    node->items[node->count] = item;
    node->keys[node->count] = key;
    node->key_place[node->count][0] = line;
    node->key_place[node->count++][1] = column;
}

Node *node_find(const Node *map, const char *key)
{
    for (int i = 0; map && map->kind == NODE_MAP && i < map->count; i++)
        if (!strcmp(map->keys[i], key)) return map->items[i];
    return NULL;
}

/* ---- Events ---- */

/* The containers that are open, and the key that waits for its value in each. */
typedef struct Builder {
    YamlFile *file;
    Node *root, *open[YAML_MAX_DEPTH];
    char *key[YAML_MAX_DEPTH];
    int key_place[YAML_MAX_DEPTH][2];
    int depth;
    long values;
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
    for (int i = 0; i < map->count; i++)
        if (!strcmp(map->keys[i], text)) {
            yaml_error_at(b->file, line, column, "the key '%.60s' is there twice; it is in line %d already",
                          text, map->key_place[i][0]);
            return false;
        }
    b->key[b->depth - 1] = mem_text(text);
    b->key_place[b->depth - 1][0] = line;
    b->key_place[b->depth - 1][1] = column;
    return true;
}

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
    if (node->kind == NODE_SCALAR) return true;
    if (b->depth == YAML_MAX_DEPTH) return refuse(b, event, "more than 32 levels");
    b->open[b->depth++] = node;
    return true;
}

static Node *scalar(const yaml_event_t *event)
{
    Node *node = node_create(NODE_SCALAR, (int)event->start_mark.line + 1, (int)event->start_mark.column + 1);
    node->text = mem_text((const char *)event->data.scalar.value);
    node->quoted = event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
    return node;
}

/* Anchors, tags, and texts with a NUL (which would be cut off). */
static const char *forbidden(const yaml_event_t *event)
{
    if (event->type == YAML_ALIAS_EVENT) return "aliases (*name) are not allowed; write the value out";
    const yaml_char_t *anchor = NULL, *tag = NULL;
    if (event->type == YAML_SCALAR_EVENT) {
        anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
        if (strlen((const char *)event->data.scalar.value) != event->data.scalar.length)
            return "a text must not contain NUL";
    }
    if (event->type == YAML_SEQUENCE_START_EVENT)
        anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
    if (event->type == YAML_MAPPING_START_EVENT)
        anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
    if (anchor) return "anchors (&name) are not allowed; write the value out";
    if (tag) return "tags (!name) are not allowed";
    return NULL;
}

static bool take(Builder *b, const yaml_event_t *event)
{
    const char *what = forbidden(event);
    if (what) return refuse(b, event, what);
    int line = (int)event->start_mark.line + 1, column = (int)event->start_mark.column + 1;
    bool value = event->type == YAML_SCALAR_EVENT || event->type == YAML_SEQUENCE_START_EVENT ||
                 event->type == YAML_MAPPING_START_EVENT;
    if (value && b->depth && b->open[b->depth - 1]->kind == NODE_MAP && !b->key[b->depth - 1])
        return take_key(b, event);
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return !b->root || refuse(b, event, "a scene file holds one document");
    case YAML_SCALAR_EVENT:
        return add(b, event, scalar(event));
    case YAML_SEQUENCE_START_EVENT:
        return add(b, event, node_create(NODE_LIST, line, column));
    case YAML_MAPPING_START_EVENT:
        return add(b, event, node_create(NODE_MAP, line, column));
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        b->depth--;
        return true;
    default:
        return true;
    }
}

static void syntax_error(YamlFile *file, const yaml_parser_t *parser)
{
    yaml_mark_t mark = parser->problem_mark;
    if (parser->error == YAML_READER_ERROR)
        yaml_error_at(file, 0, 0, "byte %zu: %s; a scene file is UTF-8 text", parser->problem_offset,
                      parser->problem);
    else
        yaml_error_at(file, (int)mark.line + 1, (int)mark.column + 1, "no YAML: %s%s%s",
                      parser->problem ? parser->problem : "?", parser->context ? ", " : "",
                      parser->context ? parser->context : "");
}

Node *tree_parse(YamlFile *file, const char *text, size_t length)
{
    yaml_parser_t parser;
    yaml_event_t event;
    Builder b = {.file = file};
    if (!yaml_parser_initialize(&parser)) abort(); /* out of memory */
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    bool ok = true;
    for (bool end = false; ok && !end; yaml_event_delete(&event)) {
        if (!yaml_parser_parse(&parser, &event)) {
            syntax_error(file, &parser);
            ok = false;
            break;
        }
        ok = take(&b, &event);
        end = event.type == YAML_STREAM_END_EVENT;
    }
    yaml_parser_delete(&parser);
    for (int d = 0; d < YAML_MAX_DEPTH; d++) mem_free(b.key[d]);
    if (ok) return b.root;
    node_destroy(b.root);
    return NULL;
}

/* ---- Files ---- */

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
    file->length = length;
    if (encoding)
        yaml_error_at(file, 0, 0, "the file is %s text; save it as UTF-8", encoding);
    else if (length > YAML_MAX_BYTES)
        yaml_error_at(file, 0, 0, "more than 64 MiB; large tables belong into CSV files");
    else
        file->root = tree_parse(file, file->text, length);
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
