/* Gmsh .msh 2.2 and 4.1, ASCII: triangles and quadrilaterals, and named groups of them, of lines and of
 * points. */
#include "base/memory.h"
#include "io/mesh_reader.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Gmsh's numbers of the element types that are read. */
typedef struct ElementType {
    int type, dim, corners;
} ElementType;

static const ElementType element_types[] = {{1, 1, 2}, {2, 2, 3}, {3, 2, 4}, {15, 0, 1}};

enum { CORNERS_MAX = 4 };

typedef struct Node {
    long tag;
    int vertex;
} Node;

/* What names a physical group or an entity; first in each, for compare_tags. */
typedef struct Tag {
    int dim;
    long tag;
} Tag;

typedef struct Physical {
    Tag at;
    Word name;
} Physical;

/* Of 4.1: an entity and one of the physical groups it is in. */
typedef struct Entity {
    Tag at;
    long physical;
} Entity;

/* An element of 2.2: one that is in several physical groups is written once for each. */
typedef struct Element {
    int dim, corners[CORNERS_MAX], count;
    long entity, physical; /* the last one of those it was written for */
    int first_face, end_face;
} Element;

typedef struct Msh {
    Scan *scan;
    MeshReader *reader;
    bool new_format;
    Node *nodes; /* [vertex_count] sorted by tag */
    Physical *names;
    Entity *entities;
    int name_count, entity_count;
    size_t entity_room;
    Element *elements; /* the faces of 2.2 */
    Lookup element_lookup;
    int element_count;
    size_t element_room;
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

static int compare_tags(const void *a, const void *b)
{
    const Tag *s = a, *t = b;
    return s->dim != t->dim ? (s->dim > t->dim) - (s->dim < t->dim) : (s->tag > t->tag) - (s->tag < t->tag);
}

/* Between the first and the last quote of the line: Gmsh writes a quote within a name as it is. */
static bool read_name(Msh *msh, Physical *name)
{
    long dim;
    if (!line(msh, "$PhysicalNames") || !integer(msh, "a dimension", 0, 3, &dim) ||
        !integer(msh, "a tag", -LARGEST, LARGEST, &name->at.tag))
        return false;
    size_t left = (size_t)(msh->scan->word_end - msh->scan->at);
    const char *open = memchr(msh->scan->at, '"', left), *close = memrchr(msh->scan->at, '"', left);
    if (!open || open == close) return scan_refuse(msh->scan, "a name in quotes is missing");
    name->at.dim = (int)dim;
    name->name = (Word){open + 1, (int)(close - open - 1)};
    return true;
}

static bool read_names(Msh *msh)
{
    long count;
    if (!line(msh, "$PhysicalNames") || !integer(msh, "the number of names", 0, 100000, &count)) return false;
    msh->names = mem_resize(msh->names, 0, (size_t)count, sizeof *msh->names);
    for (; msh->name_count < count; msh->name_count++)
        if (!read_name(msh, &msh->names[msh->name_count])) return false;
    qsort(msh->names, (size_t)count, sizeof *msh->names, compare_tags);
    return true;
}

static int group_of(Msh *msh, int dim, long physical)
{
    char unnamed[40];
    Physical wanted = {.at = {dim, physical}};
    const Physical *named = NULL;
    if (msh->name_count)
        named = bsearch(&wanted, msh->names, (size_t)msh->name_count, sizeof wanted, compare_tags);
    Word name = {unnamed, snprintf(unnamed, sizeof unnamed, "physical_%ld", physical)};
    if (named) name = named->name;
    return reader_group(msh->reader, name.text, name.length, dim);
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
        msh->entities = reader_grow(msh->entities, &msh->entity_room, (size_t)msh->entity_count + 1,
                                    sizeof *msh->entities);
        msh->entities[msh->entity_count++] = (Entity){{dim, tag}, labs(physical)};
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
    if (msh->entity_count)
        qsort(msh->entities, (size_t)msh->entity_count, sizeof *msh->entities, compare_tags);
    return true;
}

/* The physical groups of an entity: the number of them, from *first on. */
static int groups_of_entity(const Msh *msh, int dim, long tag, int *first)
{
    Entity wanted = {.at = {dim, tag}};
    int low = 0, high = msh->entity_count, count = 0;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (compare_tags(&msh->entities[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    *first = low;
    while (low + count < msh->entity_count && !compare_tags(&msh->entities[low + count], &wanted)) count++;
    return count;
}

/* ---- Nodes ---- */

static int compare_nodes(const void *a, const void *b)
{
    long s = ((const Node *)a)->tag, t = ((const Node *)b)->tag;
    return (s > t) - (s < t);
}

/* parameters: how many numbers follow the coordinates. */
static bool read_point(Msh *msh, int parameters)
{
    double x[3], parameter;
    for (int i = 0; i < 3; i++)
        if (!scan_number(msh->scan, "a coordinate", &x[i])) return false;
    for (int i = 0; i < parameters; i++)
        if (!scan_number(msh->scan, "a parameter", &parameter)) return false;
    reader_add_vertex(msh->reader, x, msh->scan->line);
    return scan_line_ends(msh->scan);
}

static void push_node(Msh *msh, size_t *room, int index, long tag)
{
    msh->nodes = reader_grow(msh->nodes, room, (size_t)index + 1, sizeof *msh->nodes);
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
        if (!line(msh, "$Nodes") || !read_point(msh, parametric ? (int)dim : 0)) return false;
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
        if (!read_point(msh, 0)) return false;
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

/* The row of a type, or NULL with what can be done. */
static const ElementType *find_type(Msh *msh, long type)
{
    for (size_t k = 0; k < sizeof element_types / sizeof *element_types; k++)
        if (element_types[k].type == type) return &element_types[k];
    bool second = type == 8 || type == 9 || type == 10 || type == 16;
    scan_refuse(
        msh->scan,
        "elements of Gmsh's type %ld: a shell is made of triangles and quadrilaterals with straight edges "
        "(types 2 and 3), and lines and points in groups; %s",
        type,
        second ? "mesh it with Mesh.ElementOrder = 1"
               : "mesh surfaces only (gmsh -2), or save only their physical groups");
    return NULL;
}

/* Puts an element into a group: its faces, or the ends of a line, or a point. */
static void put_into(Msh *msh, int group, int dim, const int *corners, int first_face, int end_face)
{
    if (dim < 2) reader_group_add(msh->reader, group, corners);
    for (int f = first_face; dim == 2 && f < end_face; f++) reader_group_add(msh->reader, group, &f);
}

typedef struct ElementKey {
    const Msh *msh;
    const Element *element;
} ElementKey;

static bool same_element(const void *self, int index)
{
    const ElementKey *key = self;
    const Element *a = &key->msh->elements[index], *b = key->element;
    return a->entity == b->entity && a->count == b->count &&
           !memcmp(a->corners, b->corners, sizeof a->corners);
}

/* The faces of an element of 2.2: those that it has already, where it was written for another group before.
 */
static bool add_old_faces(Msh *msh, Element *element)
{
    ElementKey key = {msh, element};
    uint64_t hash = lookup_hash(0, element->corners, sizeof element->corners);
    int known = lookup_find(&msh->element_lookup, hash, same_element, &key);
    if (known >= 0 && msh->elements[known].physical != element->physical) {
        element->first_face = msh->elements[known].first_face,
        element->end_face = msh->elements[known].end_face;
        msh->elements[known].physical = element->physical;
        return true;
    }
    element->first_face = msh->reader->mesh->face_count;
    if (!reader_add_face(msh->reader, msh->scan, element->corners, element->count)) return false;
    element->end_face = msh->reader->mesh->face_count;
    lookup_add(&msh->element_lookup, hash, msh->element_count);
    msh->elements =
        reader_grow(msh->elements, &msh->element_room, (size_t)msh->element_count + 1, sizeof *msh->elements);
    msh->elements[msh->element_count++] = *element;
    return true;
}

/* number type tag-count physical entity .. nodes */
static bool read_old_element(Msh *msh)
{
    long number, type, tags, tag;
    Element element = {0};
    if (!integer(msh, "an element's number", 0, LARGEST, &number) || !integer(msh, "a type", 1, 1000, &type))
        return false;
    const ElementType *row = find_type(msh, type);
    if (!row || !integer(msh, "the number of tags", 0, 100, &tags)) return false;
    for (long k = 0; k < tags; k++) {
        if (!integer(msh, "a tag", -LARGEST, LARGEST, &tag)) return false;
        if (k == 0) element.physical = labs(tag);
        if (k == 1) element.entity = tag;
    }
    element.count = row->corners;
    if (!corners(msh, row->corners, element.corners) || !scan_line_ends(msh->scan)) return false;
    if (row->dim == 2 && !add_old_faces(msh, &element)) return false;
    if (element.physical)
        put_into(msh, group_of(msh, row->dim, element.physical), row->dim, element.corners,
                 element.first_face, element.end_face);
    return true;
}

static bool read_block_element(Msh *msh, int dim, int corner_count, const int *groups, int group_count)
{
    long number;
    int nodes[CORNERS_MAX] = {0}, first = msh->reader->mesh->face_count;
    if (!line(msh, "$Elements") || !integer(msh, "an element's tag", 0, LARGEST, &number) ||
        !corners(msh, corner_count, nodes) || !scan_line_ends(msh->scan))
        return false;
    if (dim == 2 && !reader_add_face(msh->reader, msh->scan, nodes, corner_count)) return false;
    for (int k = 0; k < group_count; k++)
        put_into(msh, groups[k], dim, nodes, first, msh->reader->mesh->face_count);
    return true;
}

static bool read_element_block(Msh *msh)
{
    long dim, entity, type, count;
    int first;
    if (!integer(msh, "a dimension", 0, 3, &dim) || !integer(msh, "an entity", -LARGEST, LARGEST, &entity) ||
        !integer(msh, "a type", 1, 1000, &type))
        return false;
    const ElementType *row = find_type(msh, type);
    if (!row || !integer(msh, "the number of elements", 0, READER_MAX_INDEX, &count)) return false;
    int group_count = groups_of_entity(msh, (int)dim, entity, &first);
    int *groups = mem_alloc((size_t)group_count, sizeof *groups);
    for (int k = 0; k < group_count; k++)
        groups[k] = group_of(msh, row->dim, msh->entities[first + k].physical);
    bool ok = true;
    for (long k = 0; ok && k < count; k++)
        ok = read_block_element(msh, row->dim, row->corners, groups, group_count);
    mem_free(groups);
    return ok;
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
    return !binary ||
           scan_refuse(msh->scan, "a binary file: save it as ASCII (in Gmsh: Mesh.Binary = 0; or with "
                                  "`meshio ascii FILE`)");
}

/* $EndNodes is the end of $Nodes. */
static bool ends_section(Word word, Word name)
{
    return word.length == name.length + 3 && word_begins(word, "$End") &&
           !memcmp(word.text + 4, name.text + 1, (size_t)name.length - 1);
}

static bool skip_section(Msh *msh, Word name)
{
    char section[64];
    snprintf(section, sizeof section, "%.*s", name.length > 60 ? 60 : name.length, name.text);
    for (Word word; line(msh, section);)
        if (scan_word(msh->scan, &word) && ends_section(word, name)) return true;
    return false;
}

/* Where all that a section counts has been read. */
static bool end_section(Msh *msh, Word name)
{
    Word word;
    char section[64];
    snprintf(section, sizeof section, "%.*s", name.length > 60 ? 60 : name.length, name.text);
    if (!line(msh, section)) return false;
    scan_word(msh->scan, &word);
    return ends_section(word, name) ||
           scan_refuse_at(msh->scan, word.text,
                          "'%.*s' where $End%.*s should be: there is more than the section counts",
                          word.length > 40 ? 40 : word.length, word.text,
                          name.length > 40 ? 40 : name.length - 1, name.text + 1);
}

static bool read_section(Msh *msh, Word name)
{
    bool (*read)(Msh *) = word_is(name, "$PhysicalNames")                 ? read_names
                          : word_is(name, "$Nodes")                       ? read_nodes
                          : word_is(name, "$Elements")                    ? read_elements
                          : word_is(name, "$Entities") && msh->new_format ? read_entities
                                                                          : NULL;
    if (word_is(name, "$PartitionedEntities"))
        return scan_refuse(msh->scan, "a partitioned mesh; save it in one part");
    if ((read == read_names || read == read_entities) && msh->reader->mesh->face_count)
        return scan_refuse(msh->scan, "$PhysicalNames and $Entities must come before $Elements");
    if (read == read_names && msh->names) return scan_refuse(msh->scan, "a second $PhysicalNames section");
    return read ? read(msh) && end_section(msh, name) : skip_section(msh, name);
}

static bool read_msh(Msh *msh)
{
    Word word;
    if (!scan_line(msh->scan) || !scan_word(msh->scan, &word) || !word_is(word, "$MeshFormat")) {
        if (msh->scan->line == 0) msh->scan->line = 1;
        return scan_refuse(msh->scan, "a .msh file begins with $MeshFormat");
    }
    if (!read_format(msh) || !end_section(msh, word)) return false;
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
    bool ok = scan_check_text(scan) && read_msh(&msh);
    mem_free(msh.nodes);
    mem_free(msh.names);
    mem_free(msh.entities);
    mem_free(msh.elements);
    lookup_clear(&msh.element_lookup);
    return ok && reader_finish(reader, scan, 1);
}
