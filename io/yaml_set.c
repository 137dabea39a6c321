/* --set key=value: changes of the tree before it is loaded; values as they are written there. */
#include "base/memory.h"
#include "io/yaml_private.h"
#include <string.h>

/* Every node of the value says where it came from. */
static void mark(Node *node, const char *origin)
{
    node->origin = origin;
    node->line = node->column = 0;
    for (int i = 0; i < node->count; i++) mark(node->items[i], origin);
}

static bool refuse(YamlFile *file, const char *assignment, const char *what)
{
    Node at = {.origin = assignment};
    yaml_error(file, &at, "%s", what);
    return false;
}

static bool refuse_other(YamlFile *file, const char *assignment, const char *other)
{
    char *what =
        mem_format("it and %.*s say the same: one of them can be set", (int)strcspn(other, "="), other);
    refuse(file, assignment, what);
    mem_free(what);
    return false;
}

/* The setting of another key that a node, or what is in it, comes from, and that would be lost; NULL: none. */
static const char *other_setting(const Node *node, const char *key)
{
    const char *setting = node ? node->origin : NULL;
    size_t length = strlen(key);
    if (setting && !strncmp(setting, key, length) && setting[length] == '=') setting = NULL;
    for (int i = 0; node && !setting && i < node->count; i++) setting = other_setting(node->items[i], key);
    return setting;
}

/* The slot of a name or an index in a container; made where it is missing. NULL with a sentence where it
 * cannot be. */
static Node **slot(Node *node, const char *name, int length, int index, const char **what)
{
    if (index >= 0) {
        if (node->kind != NODE_LIST) return *what = "there is no list at this index", NULL;
        if (index > node->count) return *what = "the index is beyond the end of the list", NULL;
        if (index == node->count) node_append(node, NULL, 0, 0, NULL);
        return &node->items[index];
    }
    if (node->kind != NODE_MAP) return *what = "there is no mapping with that key", NULL;
    int known = node_index(node, name, (size_t)length);
    if (known >= 0) return &node->items[known];
    node_append(node, mem_format("%.*s", length, name), 0, 0, NULL);
    return &node->items[node->count - 1];
}

/* The container that the next step needs. */
static Node *make_container(const char *path, const char *origin)
{
    Node *node = node_create(*path == '[' ? NODE_LIST : NODE_MAP, 0, 0);
    node->origin = origin;
    return node;
}

/* Is it made of names and indices, no deeper than a tree may be? */
static bool is_key(const char *path)
{
    const char *name;
    int length, index, depth = 0;
    while (*path)
        if (++depth >= YAML_MAX_DEPTH || !path_step(&path, &name, &length, &index)) return false;
    return true;
}

/* Walks the key and puts the value there; takes the value in any case. */
static bool put(YamlFile *file, const char *assignment, const char *key, Node *value)
{
    Node **place = &file->root;
    const char *path = key, *name, *what = NULL, *other = NULL;
    int length, index;
    if (!is_key(key)) what = "the key is malformed; it is like shell.mesh.n or fix[0].ball.radius";
    while (!what && *path) {
        path_step(&path, &name, &length, &index);
        const char *step = index >= 0 ? "[" : name;
        bool leaf = *place && (*place)->kind == NODE_SCALAR;
        if (leaf && (other = other_setting(*place, key))) break;
        if (leaf || !*place) { /* a short form makes way for the long one, which remembers it */
            Node *container = make_container(step, assignment);
            if (leaf) container->text = mem_text((*place)->text);
            node_destroy(*place);
            *place = container;
        }
        place = slot(*place, name, length, index, &what);
        if (!place) break;
    }
    if (!what && !other) other = other_setting(*place, key);
    if (what || other || !*key) {
        node_destroy(value);
        return other
                   ? refuse_other(file, assignment, other)
                   : refuse(file, assignment, what ? what : "the key is missing; it is like shell.mesh.n=7");
    }
    node_destroy(*place);
    *place = value;
    return true;
}

bool yaml_override(YamlFile *file, const char *assignment)
{
    file->set =
        mem_resize(file->set, (size_t)file->set_count, (size_t)file->set_count + 1, sizeof *file->set);
    char *kept = file->set[file->set_count++] = mem_text(assignment);
    const char *equal = strchr(kept, '=');
    if (!file->root) return false; /* its error is there already */
    if (!equal) return refuse(file, kept, "it must be key=value, e.g. shell.thickness=1mm");
    int before = file->error_count;
    file->setting = kept;
    Node *value = tree_parse(file, equal + 1, strlen(equal + 1));
    file->setting = NULL;
    if (!value) return file->error_count == before ? refuse(file, kept, "the value is missing") : false;
    mark(value, kept);
    char *key = mem_format("%.*s", (int)(equal - kept), kept);
    bool ok = put(file, kept, key, value);
    mem_free(key);
    return ok;
}

static char *value_as(const char *text, bool said)
{
    YamlFile *file = yaml_parse("value", text, strlen(text));
    const Node *root = file->error_count ? NULL : file->root;
    Text line = {0};
    if (root && said && root->kind == NODE_SCALAR)
        text_add(&line, "%s", root->text);
    else if (root)
        node_write(root, &line);
    yaml_destroy(file);
    return line.text;
}

char *yaml_value_line(const char *text)
{
    return value_as(text, false);
}

char *yaml_value_text(const char *text)
{
    char *said = value_as(text, true);
    return said ? said : mem_text(text);
}

bool yaml_number_at(const char *scene, const char *key, double *value)
{
    YamlFile *file = yaml_parse("scene", scene, strlen(scene));
    const char *rest = key;
    const Node *node = file->root ? tree_follow(file, key, &rest) : NULL;
    bool is = node && !*rest && node->kind == NODE_SCALAR && yaml_quantity(node->text, value);
    yaml_destroy(file);
    return is;
}
