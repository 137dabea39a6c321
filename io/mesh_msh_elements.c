/* Gmsh .msh: its elements. */
#include "base/memory.h"
#include "io/mesh_msh.h"
#include <stdlib.h>
#include <string.h>

/* Gmsh's numbers of the element types that are read. Of lines and triangles of second order the corners are kept: the
 * middles belong to the tetrahedra that they are sides of. */
typedef struct ElementType {
    int type, dim, nodes, kept;
} ElementType;

static const ElementType element_types[] = {{1, 1, 2, 2}, {2, 2, 3, 3}, {3, 2, 4, 4},    {4, 3, 4, 4},
                                            {8, 1, 3, 2}, {9, 2, 6, 3}, {11, 3, 10, 10}, {15, 0, 1, 1}};

/* What Gmsh makes besides. */
static const char *name_of_other(long type)
{
    return type == 5 ? " (hexahedra)" : type == 6 ? " (prisms)" : type == 7 ? " (pyramids)" : "";
}

static const ElementType *find_type(Msh *msh, long type)
{
    for (size_t k = 0; k < sizeof element_types / sizeof *element_types; k++)
        if (element_types[k].type == type) return &element_types[k];
    scan_refuse(
        msh->scan,
        "elements of Gmsh's type %ld%s: what is read are triangles and quadrilaterals with straight edges "
        "(types 2 and 3), tetrahedra of 4 or 10 nodes (4 and 11) with their triangles (2 and 9), and "
        "lines and points in groups; %s",
        type, name_of_other(type),
        type == 10 || type == 16 ? "mesh it with Mesh.ElementOrder = 1"
                                 : "mesh it anew, or save only their physical groups");
    return NULL;
}

/* How many faces or cells there are so far. */
static int count_of(const Msh *msh, int dim)
{
    return dim == 2 ? msh->reader->mesh->face_count : dim == 3 ? msh->reader->mesh->cell_count : 0;
}

static bool add_element(Msh *msh, const ElementType *row, const int *nodes)
{
    bool curved = row->dim < 3 && row->kept < row->nodes;
    if (curved && !msh->curved_line) msh->curved_type = row->type, msh->curved_line = msh->scan->line;
    if (row->dim == 2) return reader_add_face(msh->reader, msh->scan, nodes, row->kept);
    return row->dim < 2 || reader_add_cell(msh->reader, msh->scan, nodes, row->kept);
}

/* Puts an element into a group: its faces or cells, or the ends of a line, or a point. */
static void put_into(Msh *msh, int group, int dim, const int *nodes, int first, int end)
{
    if (dim < 2) reader_group_add(msh->reader, group, nodes);
    for (int k = first; k < end; k++) reader_group_add(msh->reader, group, &k);
}

/* ---- 2.2 ---- */

typedef struct ElementKey {
    const Msh *msh;
    const MshElement *element;
} ElementKey;

static bool same_element(const void *self, int index)
{
    const ElementKey *key = self;
    const MshElement *a = &key->msh->elements[index], *b = key->element;
    return a->entity == b->entity && a->dim == b->dim && a->count == b->count &&
           !memcmp(a->nodes, b->nodes, sizeof a->nodes);
}

/* The faces or cells of an element of 2.2: those that it has already, where it was written for another group before. */
static bool add_old_element(Msh *msh, const ElementType *row, MshElement *element)
{
    ElementKey key = {msh, element};
    uint64_t hash = lookup_hash(0, element->nodes, sizeof element->nodes);
    int known = lookup_find(&msh->element_lookup, hash, same_element, &key);
    if (known >= 0 && msh->elements[known].physical != element->physical) {
        element->first = msh->elements[known].first, element->end = msh->elements[known].end;
        msh->elements[known].physical = element->physical;
        return true;
    }
    element->first = count_of(msh, row->dim);
    if (!add_element(msh, row, element->nodes)) return false;
    element->end = count_of(msh, row->dim);
    if (row->dim < 2) return true;
    lookup_add(&msh->element_lookup, hash, msh->element_count);
    msh->elements =
        reader_grow(msh->elements, &msh->element_room, (size_t)msh->element_count + 1, sizeof *msh->elements);
    msh->elements[msh->element_count++] = *element;
    return true;
}

/* The nodes of a line of the file; kept are those of the corners, and of a tetrahedron all. */
static bool read_nodes(Msh *msh, const ElementType *row, int *nodes)
{
    if (!msh_vertices(msh, row->nodes, nodes) || !scan_line_ends(msh->scan)) return false;
    for (int i = row->kept; i < row->nodes; i++) nodes[i] = 0;
    return true;
}

/* number type tag-count physical entity .. nodes */
static bool read_old_element(Msh *msh)
{
    long number, type, tags, tag;
    MshElement element = {0};
    if (!msh_integer(msh, "an element's number", 0, MSH_LARGEST, &number) ||
        !msh_integer(msh, "a type", 1, 1000, &type))
        return false;
    const ElementType *row = find_type(msh, type);
    if (!row || !msh_integer(msh, "the number of tags", 0, 100, &tags)) return false;
    for (long k = 0; k < tags; k++) {
        if (!msh_integer(msh, "a tag", -MSH_LARGEST, MSH_LARGEST, &tag)) return false;
        if (k == 0) element.physical = labs(tag);
        if (k == 1) element.entity = tag;
    }
    element.dim = row->dim, element.count = row->kept;
    if (!read_nodes(msh, row, element.nodes) || !add_old_element(msh, row, &element)) return false;
    if (element.physical)
        put_into(msh, msh_group(msh, row->dim, element.physical), row->dim, element.nodes, element.first,
                 element.end);
    return true;
}

/* ---- 4.1 ---- */

static bool read_block_element(Msh *msh, const ElementType *row, const int *groups, int group_count)
{
    long number;
    int nodes[MSH_MAX_NODES] = {0}, first = count_of(msh, row->dim);
    if (!msh_line(msh, "$Elements") || !msh_integer(msh, "an element's tag", 0, MSH_LARGEST, &number) ||
        !read_nodes(msh, row, nodes) || !add_element(msh, row, nodes))
        return false;
    for (int k = 0; k < group_count; k++)
        put_into(msh, groups[k], row->dim, nodes, first, count_of(msh, row->dim));
    return true;
}

static bool read_element_block(Msh *msh)
{
    long dim, entity, type, count;
    int first;
    if (!msh_integer(msh, "a dimension", 0, 3, &dim) ||
        !msh_integer(msh, "an entity", -MSH_LARGEST, MSH_LARGEST, &entity) ||
        !msh_integer(msh, "a type", 1, 1000, &type))
        return false;
    const ElementType *row = find_type(msh, type);
    if (!row || !msh_integer(msh, "the number of elements", 0, READER_MAX_INDEX, &count)) return false;
    int group_count = msh_entity_groups(msh, (int)dim, entity, &first);
    int *groups = mem_alloc((size_t)group_count, sizeof *groups);
    for (int k = 0; k < group_count; k++)
        groups[k] = msh_group(msh, row->dim, msh->entities[first + k].physical);
    bool ok = true;
    for (long k = 0; ok && k < count; k++) ok = read_block_element(msh, row, groups, group_count);
    mem_free(groups);
    return ok;
}

/* ---- Both ---- */

bool msh_read_elements(Msh *msh)
{
    long count;
    msh->element_section = true;
    if (!msh_line(msh, "$Elements") ||
        !msh_integer(msh, "the number of elements", 0, READER_MAX_INDEX, &count))
        return false;
    for (long k = 0; k < count; k++)
        if (!msh_line(msh, "$Elements") ||
            !(msh->new_format ? read_element_block(msh) : read_old_element(msh)))
            return false;
    return true;
}

bool msh_check_order(Msh *msh)
{
    if (!msh->curved_line || msh->reader->mesh->cell_count) return true;
    msh->scan->line = msh->curved_line;
    return scan_refuse(
        msh->scan,
        "elements of Gmsh's type %d, of second order, in a file without tetrahedra: a mesh of triangles "
        "has straight edges; mesh it with Mesh.ElementOrder = 1",
        msh->curved_type);
}
