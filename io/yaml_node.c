/* Nodes of a scene's tree: made, found, copied. */
#include "base/memory.h"
#include "io/yaml_private.h"
#include <ctype.h>
#include <string.h>

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
    lookup_clear(&node->lookup);
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
    if (key) lookup_add(&node->lookup, lookup_hash(0, key, strlen(key)), node->count);
    node->items[node->count] = item;
    node->keys[node->count] = key;
    node->key_place[node->count][0] = line;
    node->key_place[node->count++][1] = column;
}

typedef struct Wanted {
    const Node *map;
    const char *key;
    size_t length;
} Wanted;

static bool same_key(const void *self, int index)
{
    const Wanted *wanted = self;
    const char *key = wanted->map->keys[index];
    return !strncmp(key, wanted->key, wanted->length) && !key[wanted->length];
}

int node_index(const Node *map, const char *key, size_t length)
{
    Wanted wanted = {map, key, length};
    return lookup_find(&map->lookup, lookup_hash(0, key, length), same_key, &wanted);
}

Node *node_find(const Node *map, const char *key)
{
    int index = map && map->kind == NODE_MAP ? node_index(map, key, strlen(key)) : -1;
    return index < 0 ? NULL : map->items[index];
}

/* Would it be read as the same text without quotes, within brackets too? */
static bool is_plain(const char *text)
{
    static const char marks[] = " ._+-*/^()";
    size_t length = strlen(text);
    const char *first =
        text + (*text && strchr("-+./", *text) != NULL); /* no mark of YAML's, as "- x" and "---" */
    bool plain = isalnum((unsigned char)*first) && text[length - 1] != ' ';
    for (const char *c = text; plain && *c; c++) plain = isalnum((unsigned char)*c) || strchr(marks, *c);
    return plain;
}

static void write_scalar(const char *scalar, Text *text)
{
    if (is_plain(scalar))
        text_add(text, "%s", scalar);
    else
        text_add_quoted(text, scalar);
}

void node_write(const Node *node, Text *text)
{
    if (node->kind == NODE_SCALAR) {
        write_scalar(node->text, text);
        return;
    }
    text_add(text, node->kind == NODE_LIST ? "[" : "{");
    for (int i = 0; i < node->count; i++) {
        text_add(text, "%s", i ? ", " : "");
        if (node->kind == NODE_MAP) write_scalar(node->keys[i], text), text_add(text, ": ");
        node_write(node->items[i], text);
    }
    text_add(text, node->kind == NODE_LIST ? "]" : "}");
}

Node *node_copy(const Node *node, int depth, int *left)
{
    if (depth == 0 || *left == 0) return NULL;
    Node *copy = node_create(node->kind, node->line, node->column);
    copy->text = mem_text(node->text);
    --*left;
    for (int i = 0; i < node->count; i++) {
        Node *item = node_copy(node->items[i], depth - 1, left);
        if (!item) {
            node_destroy(copy);
            return NULL;
        }
        node_append(copy, mem_text(node->keys[i]), node->key_place[i][0], node->key_place[i][1], item);
    }
    return copy;
}
