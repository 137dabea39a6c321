/* Gmsh .msh 2.2 and 4.1, ASCII: its sections, nodes and names. */
#include "base/memory.h"
#include "io/mesh_msh.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Groups ---- */

static int compare_tags(const void *a, const void *b)
{
    const MshTag *s = a, *t = b;
    return s->dim != t->dim ? (s->dim > t->dim) - (s->dim < t->dim) : (s->tag > t->tag) - (s->tag < t->tag);
}

/* Between the first and the last quote of the line: Gmsh writes a quote within a name as it is. */
static bool read_name(Msh *msh, MshPhysical *name)
{
    long dim;
    if (!msh_line(msh, "$PhysicalNames") || !msh_integer(msh, "a dimension", 0, 3, &dim) ||
        !msh_integer(msh, "a tag", -MSH_LARGEST, MSH_LARGEST, &name->at.tag))
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
    if (!msh_line(msh, "$PhysicalNames") || !msh_integer(msh, "the number of names", 0, 100000, &count))
        return false;
    msh->names = mem_resize(msh->names, 0, (size_t)count, sizeof *msh->names);
    for (; msh->name_count < count; msh->name_count++)
        if (!read_name(msh, &msh->names[msh->name_count])) return false;
    qsort(msh->names, (size_t)count, sizeof *msh->names, compare_tags);
    return true;
}

int msh_group(Msh *msh, int dim, long physical)
{
    char unnamed[40];
    MshPhysical wanted = {.at = {dim, physical}};
    const MshPhysical *named = NULL;
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
    if (!msh_line(msh, "$Entities") || !msh_integer(msh, "an entity's tag", -MSH_LARGEST, MSH_LARGEST, &tag))
        return false;
    for (int i = 0; i < (dim == 0 ? 3 : 6); i++)
        if (!scan_number(msh->scan, "a bound", &number)) return false;
    if (!msh_integer(msh, "the number of physical tags", 0, 100000, &count)) return false;
    for (long k = 0; k < count; k++) {
        if (!msh_integer(msh, "a physical tag", -MSH_LARGEST, MSH_LARGEST, &physical)) return false;
        msh->entities = reader_grow(msh->entities, &msh->entity_room, (size_t)msh->entity_count + 1,
                                    sizeof *msh->entities);
        msh->entities[msh->entity_count++] = (MshEntity){{dim, tag}, labs(physical)};
    }
    return true;
}

static bool read_entities(Msh *msh)
{
    long counts[4];
    if (!msh_line(msh, "$Entities")) return false;
    for (int d = 0; d < 4; d++)
        if (!msh_integer(msh, "a number of entities", 0, READER_MAX_INDEX, &counts[d])) return false;
    for (int d = 0; d < 4; d++)
        for (long k = 0; k < counts[d]; k++)
            if (!read_entity(msh, d)) return false;
    if (msh->entity_count)
        qsort(msh->entities, (size_t)msh->entity_count, sizeof *msh->entities, compare_tags);
    return true;
}

int msh_entity_groups(const Msh *msh, int dim, long tag, int *first)
{
    MshEntity wanted = {.at = {dim, tag}};
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
    long s = ((const MshNode *)a)->tag, t = ((const MshNode *)b)->tag;
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
    msh->nodes[index] = (MshNode){tag, index};
}

/* 4.1: tags first, then as many points. */
static bool read_node_block(Msh *msh, size_t *room)
{
    long dim, entity, parametric, count, tag;
    if (!msh_line(msh, "$Nodes") || !msh_integer(msh, "a dimension", 0, 3, &dim) ||
        !msh_integer(msh, "an entity", -MSH_LARGEST, MSH_LARGEST, &entity) ||
        !msh_integer(msh, "the parametric flag", 0, 1, &parametric) ||
        !msh_integer(msh, "the number of nodes", 0, READER_MAX_INDEX, &count))
        return false;
    int first = msh->reader->mesh->vertex_count;
    for (long k = 0; k < count; k++) {
        if (!msh_line(msh, "$Nodes") || !msh_integer(msh, "a node's tag", 0, MSH_LARGEST, &tag)) return false;
        push_node(msh, room, first + (int)k, tag);
    }
    for (long k = 0; k < count; k++)
        if (!msh_line(msh, "$Nodes") || !read_point(msh, parametric ? (int)dim : 0)) return false;
    return true;
}

static bool read_nodes(Msh *msh)
{
    long count, tag;
    size_t room = 0;
    if (msh->nodes) return scan_refuse(msh->scan, "a second $Nodes section");
    if (!msh_line(msh, "$Nodes") || !msh_integer(msh, "the number of nodes", 0, READER_MAX_INDEX, &count))
        return false;
    for (long k = 0; k < count; k++) {
        if (msh->new_format) {
            if (!read_node_block(msh, &room)) return false;
            continue;
        }
        if (!msh_line(msh, "$Nodes") || !msh_integer(msh, "a node's number", 0, MSH_LARGEST, &tag))
            return false;
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

bool msh_vertices(Msh *msh, int count, int *vertices)
{
    for (int i = 0; i < count; i++) {
        MshNode wanted = {0};
        if (!msh_integer(msh, "a node", 0, MSH_LARGEST, &wanted.tag)) return false;
        const MshNode *node = NULL;
        if (msh->reader->mesh->vertex_count)
            node = bsearch(&wanted, msh->nodes, (size_t)msh->reader->mesh->vertex_count, sizeof *msh->nodes,
                           compare_nodes);
        if (!node) return scan_refuse(msh->scan, "node %ld does not exist", wanted.tag);
        vertices[i] = node->vertex;
    }
    return true;
}

/* ---- The file ---- */

static bool read_format(Msh *msh)
{
    Word version;
    long binary;
    if (!msh_line(msh, "$MeshFormat") || !scan_word(msh->scan, &version)) return false;
    msh->new_format = word_is(version, "4.1");
    if (!msh->new_format && !word_is(version, "2.2"))
        return scan_refuse(msh->scan, "version %.*s: save it as 2.2 or 4.1 (gmsh -format msh41)",
                           version.length > 10 ? 10 : version.length, version.text);
    if (!msh_integer(msh, "the file type", 0, 1, &binary)) return false;
    if (binary)
        return scan_refuse(msh->scan, "a binary file: save it as ASCII (in Gmsh: Mesh.Binary = 0; or with "
                                      "`meshio ascii FILE`)");
    return scan_check_text(msh->scan); /* of a binary one it would say other things */
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
    for (Word word; msh_line(msh, section);)
        if (scan_word(msh->scan, &word) && ends_section(word, name)) return true;
    return false;
}

/* Where all that a section counts has been read. */
static bool end_section(Msh *msh, Word name)
{
    Word word;
    char section[64];
    snprintf(section, sizeof section, "%.*s", name.length > 60 ? 60 : name.length, name.text);
    if (!msh_line(msh, section)) return false;
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
                          : word_is(name, "$Elements")                    ? msh_read_elements
                          : word_is(name, "$Entities") && msh->new_format ? read_entities
                                                                          : NULL;
    if (word_is(name, "$PartitionedEntities"))
        return scan_refuse(msh->scan, "a partitioned mesh; save it in one part");
    if ((read == read_names || read == read_entities) && msh->element_section)
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
    bool ok = read_msh(&msh);
    mem_free(msh.nodes);
    mem_free(msh.names);
    mem_free(msh.entities);
    mem_free(msh.elements);
    lookup_clear(&msh.element_lookup);
    ok = ok && msh_check_order(&msh);
    return ok && reader_finish(reader, scan, 1);
}
