/* Gmsh .msh 2.2 and 4.1, ASCII: triangles, and named groups of them, of lines and of points. */
#include "base/memory.h"
#include "io/mesh_reader.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Gmsh's numbers of element types. */
enum { TYPE_LINE = 1, TYPE_TRIANGLE = 2, TYPE_POINT = 15 };

typedef struct Node {
    long tag;
    int vertex;
} Node;

typedef struct Physical {
    int dim;
    long tag;
    Word name;
} Physical;

/* Of 4.1: an entity and one of the physical groups it is in. */
typedef struct Entity {
    int dim;
    long tag, physical;
} Entity;

typedef struct Msh {
    Scan *scan;
    MeshReader *reader;
    bool new_format;
    Node *nodes; /* [vertex_count] sorted by tag */
    Physical *names;
    Entity *entities;
    int name_count, entity_count;
    size_t entity_room;
} Msh;

static const long LARGEST = 9007199254740991; /* of a tag */

static bool integer(Msh *msh, const char *what, long low, long high, long *value)
{
    return scan_integer(msh->scan, what, low, high, value);
}

static bool line(Msh *msh, const char *section)
{
    return scan_line(msh->scan) || scan_refuse(msh->scan, "the file ends within %s", section);
}

/* ---- Groups ---- */

static bool read_names(Msh *msh)
{
    long count, dim;
    if (!line(msh, "$PhysicalNames") || !integer(msh, "the number of names", 0, 100000, &count)) return false;
    msh->names = mem_resize(msh->names, 0, (size_t)count, sizeof *msh->names);
    for (long k = 0; k < count; k++) {
        Physical *name = &msh->names[k];
        if (!line(msh, "$PhysicalNames") || !integer(msh, "a dimension", 0, 3, &dim) ||
            !integer(msh, "a tag", -LARGEST, LARGEST, &name->tag))
            return false;
        const char *open = memchr(msh->scan->at, '"', (size_t)(msh->scan->word_end - msh->scan->at));
        const char *close = open ? memchr(open + 1, '"', (size_t)(msh->scan->word_end - open - 1)) : NULL;
        if (!close) return scan_refuse(msh->scan, "a name in quotes is missing");
        name->dim = (int)dim;
        name->name = (Word){open + 1, (int)(close - open - 1)};
        msh->name_count++;
    }
    return true;
}

static void add_to_group(Msh *msh, int dim, long physical, const int *members)
{
    char unnamed[40];
    Word name = {unnamed, snprintf(unnamed, sizeof unnamed, "physical_%ld", physical)};
    for (int k = 0; k < msh->name_count; k++)
        if (msh->names[k].dim == dim && msh->names[k].tag == physical) name = msh->names[k].name;
    reader_group_add(msh->reader, reader_group(msh->reader, name.text, name.length, dim), members);
}

static bool read_entity(Msh *msh, int dim)
{
    long tag, count, physical;
    double number;
    if (!line(msh, "$Entities") || !integer(msh, "an entity's tag", -LARGEST, LARGEST, &tag)) return false;
    for (int i = 0; i < (dim == 0 ? 3 : 6); i++)
        if (!scan_number(msh->scan, "a bound", &number)) return false;
    if (!integer(msh, "the number of physical tags", 0, 100000, &count)) return false;
    for (long k = 0; k < count; k++) {
        if (!integer(msh, "a physical tag", -LARGEST, LARGEST, &physical)) return false;
        if ((size_t)msh->entity_count == msh->entity_room) {
            size_t room = 2 * msh->entity_room + 16;
            msh->entities = mem_resize(msh->entities, msh->entity_room, room, sizeof *msh->entities);
            msh->entity_room = room;
        }
        msh->entities[msh->entity_count++] = (Entity){dim, tag, labs(physical)};
    }
    return true;
}

static bool read_entities(Msh *msh)
{
    long counts[4];
    if (!line(msh, "$Entities")) return false;
    for (int d = 0; d < 4; d++)
        if (!integer(msh, "a number of entities", 0, READER_MAX_INDEX, &counts[d])) return false;
    for (int d = 0; d < 4; d++)
        for (long k = 0; k < counts[d]; k++)
            if (!read_entity(msh, d)) return false;
    return true;
}

/* ---- Nodes ---- */

static int compare_nodes(const void *a, const void *b)
{
    long s = ((const Node *)a)->tag, t = ((const Node *)b)->tag;
    return (s > t) - (s < t);
}

static bool read_point(Msh *msh)
{
    double x[3];
    for (int i = 0; i < 3; i++)
        if (!scan_number(msh->scan, "a coordinate", &x[i])) return false;
    reader_add_vertex(msh->reader, x, msh->scan->line);
    return true;
}

static void push_node(Msh *msh, size_t *room, int index, long tag)
{
    if ((size_t)index >= *room) {
        size_t larger = 2 * *room + 64;
        msh->nodes = mem_resize(msh->nodes, *room, larger, sizeof *msh->nodes);
        *room = larger;
    }
    msh->nodes[index] = (Node){tag, index};
}

/* 4.1: tags first, then as many points. */
static bool read_node_block(Msh *msh, size_t *room)
{
    long dim, entity, parametric, count, tag;
    if (!line(msh, "$Nodes") || !integer(msh, "a dimension", 0, 3, &dim) ||
        !integer(msh, "an entity", -LARGEST, LARGEST, &entity) ||
        !integer(msh, "the parametric flag", 0, 1, &parametric) ||
        !integer(msh, "the number of nodes", 0, READER_MAX_INDEX, &count))
        return false;
    int first = msh->reader->mesh->vertex_count;
    for (long k = 0; k < count; k++) {
        if (!line(msh, "$Nodes") || !integer(msh, "a node's tag", 0, LARGEST, &tag)) return false;
        push_node(msh, room, first + (int)k, tag);
    }
    for (long k = 0; k < count; k++)
        if (!line(msh, "$Nodes") || !read_point(msh)) return false;
    return true;
}

static bool read_nodes(Msh *msh)
{
    long count, tag;
    size_t room = 0;
    if (msh->nodes) return scan_refuse(msh->scan, "a second $Nodes section");
    if (!line(msh, "$Nodes") || !integer(msh, "the number of nodes", 0, READER_MAX_INDEX, &count))
        return false;
    for (long k = 0; k < count; k++) {
        if (msh->new_format) {
            if (!read_node_block(msh, &room)) return false;
            continue;
        }
        if (!line(msh, "$Nodes") || !integer(msh, "a node's number", 0, LARGEST, &tag)) return false;
        push_node(msh, &room, (int)k, tag);
        if (!read_point(msh)) return false;
    }
    int vertices = msh->reader->mesh->vertex_count;
    if (vertices) qsort(msh->nodes, (size_t)vertices, sizeof *msh->nodes, compare_nodes);
    for (int v = 1; v < vertices; v++)
        if (msh->nodes[v].tag == msh->nodes[v - 1].tag)
            return scan_refuse(msh->scan, "node %ld is there twice", msh->nodes[v].tag);
    return true;
}

static bool corners(Msh *msh, int count, int *vertices)
{
    for (int i = 0; i < count; i++) {
        Node wanted = {0};
        if (!integer(msh, "a node", 0, LARGEST, &wanted.tag)) return false;
        const Node *node = NULL;
        if (msh->reader->mesh->vertex_count)
            node = bsearch(&wanted, msh->nodes, (size_t)msh->reader->mesh->vertex_count, sizeof *msh->nodes,
                           compare_nodes);
        if (!node) return scan_refuse(msh->scan, "node %ld does not exist", wanted.tag);
        vertices[i] = node->vertex;
    }
    return true;
}

/* ---- Elements ---- */

static int type_dim(long type)
{
    return type == TYPE_POINT ? 0 : type == TYPE_LINE ? 1 : type == TYPE_TRIANGLE ? 2 : -1;
}

static bool check_type(Msh *msh, long type)
{
    return type_dim(type) >= 0 || scan_refuse(msh->scan,
                                              "elements of Gmsh's type %ld: a shell is made of 3-node "
                                              "triangles (type 2), and lines and points in groups",
                                              type);
}

/* Reads the element's nodes; members are what a group of it holds. */
static bool read_element(Msh *msh, int dim, int *members)
{
    int vertices[3] = {0};
    if (!corners(msh, dim + 1, vertices)) return false;
    memcpy(members, vertices, 2 * sizeof *members);
    if (dim < 2) return true;
    members[0] = msh->reader->mesh->face_count;
    reader_add_face(msh->reader, vertices, msh->scan->line);
    return true;
}

static bool read_old_element(Msh *msh)
{
    long number, type, tags, physical = 0, tag;
    int members[2] = {0};
    if (!integer(msh, "an element's number", 0, LARGEST, &number) ||
        !integer(msh, "a type", 1, 1000, &type) || !check_type(msh, type) ||
        !integer(msh, "the number of tags", 0, 100, &tags))
        return false;
    for (long k = 0; k < tags; k++) {
        if (!integer(msh, "a tag", -LARGEST, LARGEST, &tag)) return false;
        if (k == 0) physical = labs(tag);
    }
    if (!read_element(msh, type_dim(type), members)) return false;
    if (physical) add_to_group(msh, type_dim(type), physical, members);
    return true;
}

static bool read_element_block(Msh *msh)
{
    long dim, entity, type, count, number;
    if (!integer(msh, "a dimension", 0, 3, &dim) || !integer(msh, "an entity", -LARGEST, LARGEST, &entity) ||
        !integer(msh, "a type", 1, 1000, &type) || !check_type(msh, type) ||
        !integer(msh, "the number of elements", 0, READER_MAX_INDEX, &count))
        return false;
    for (long k = 0; k < count; k++) {
        int members[2] = {0};
        if (!line(msh, "$Elements") || !integer(msh, "an element's tag", 0, LARGEST, &number) ||
            !read_element(msh, type_dim(type), members))
            return false;
        for (int e = 0; e < msh->entity_count; e++)
            if (msh->entities[e].dim == dim && msh->entities[e].tag == entity)
                add_to_group(msh, (int)dim, msh->entities[e].physical, members);
    }
    return true;
}

static bool read_elements(Msh *msh)
{
    long count;
    if (!line(msh, "$Elements") || !integer(msh, "the number of elements", 0, READER_MAX_INDEX, &count))
        return false;
    for (long k = 0; k < count; k++)
        if (!line(msh, "$Elements") || !(msh->new_format ? read_element_block(msh) : read_old_element(msh)))
            return false;
    return true;
}

/* ---- The file ---- */

static bool read_format(Msh *msh)
{
    Word version;
    long binary;
    if (!line(msh, "$MeshFormat") || !scan_word(msh->scan, &version)) return false;
    msh->new_format = word_is(version, "4.1");
    if (!msh->new_format && !word_is(version, "2.2"))
        return scan_refuse(msh->scan, "version %.*s: save it as 2.2 or 4.1 (gmsh -format msh41)",
                           version.length > 10 ? 10 : version.length, version.text);
    if (!integer(msh, "the file type", 0, 1, &binary)) return false;
    return !binary || scan_refuse(msh->scan, "a binary file: save it as ASCII (gmsh -bin 0)");
}

static bool skip_section(Msh *msh, Word name)
{
    char section[64];
    snprintf(section, sizeof section, "%.*s", name.length > 60 ? 60 : name.length, name.text);
    for (Word word; line(msh, section);)
        if (scan_word(msh->scan, &word) && word_begins(word, "$End")) return true;
    return false;
}

static bool read_section(Msh *msh, Word name)
{
    bool (*read)(Msh *) = word_is(name, "$PhysicalNames")                 ? read_names
                          : word_is(name, "$Nodes")                       ? read_nodes
                          : word_is(name, "$Elements")                    ? read_elements
                          : word_is(name, "$Entities") && msh->new_format ? read_entities
                                                                          : NULL;
    if (read == read_names && msh->names) return scan_refuse(msh->scan, "a second $PhysicalNames section");
    return (!read || read(msh)) && skip_section(msh, name);
}

static bool read_msh(Msh *msh)
{
    Word word;
    if (!scan_line(msh->scan) || !scan_word(msh->scan, &word) || !word_is(word, "$MeshFormat")) {
        if (msh->scan->line == 0) msh->scan->line = 1;
        return scan_refuse(msh->scan, "a .msh file begins with $MeshFormat");
    }
    if (!read_format(msh) || !skip_section(msh, word)) return false;
    while (scan_line(msh->scan)) {
        scan_word(msh->scan, &word);
        if (word.text[0] != '$')
            return scan_refuse(msh->scan, "'%.*s' where a section should begin",
                               word.length > 40 ? 40 : word.length, word.text);
        if (!read_section(msh, word)) return false;
    }
    return true;
}

bool mesh_read_msh(Scan *scan, MeshReader *reader)
{
    Msh msh = {.scan = scan, .reader = reader};
    bool ok = read_msh(&msh);
    mem_free(msh.nodes);
    mem_free(msh.names);
    mem_free(msh.entities);
    return ok;
}
