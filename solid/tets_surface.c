/* The surface of tetrahedra, and the groups on it. */
#include "base/memory.h"
#include "solid/tets_private.h"
#include <stdlib.h>
#include <string.h>

/* Outwards, of a positively oriented tetrahedron. */
static const int sides[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

/* The corners of a side that is numbered 4 tet + side. */
static void side_corners(const Build *build, int number, int *corners)
{
    const int *v = tets_cell(build, number / 4);
    for (int i = 0; i < 3; i++) corners[i] = v[sides[number % 4][i]];
}

/* The sides of all tetrahedra, number 4 tet + side, sorted by their corners. */
static Corners *sorted_sides(const Build *build)
{
    int all = 4 * build->file.cell_count;
    Corners *list = mem_alloc((size_t)all, sizeof *list);
    for (int k = 0; k < all; k++) {
        side_corners(build, k, list[k].of);
        tets_sort_corners(list[k].of, 3);
        list[k].number = k, list[k].tet = k / 4;
    }
    qsort(list, (size_t)all, sizeof *list, tets_compare_all);
    return list;
}

/* Seen from outside a side runs the other way than from the tetrahedron behind it. */
static bool runs_odd(const Build *build, const Corners *side)
{
    int corners[3];
    side_corners(build, side->number, corners);
    return tets_sort_corners(corners, 3);
}

/* Leaves those that no other tetrahedron has, sorted; their number, or -1 after a refusal. Others lead across. */
static int outer_sides(const Build *build, Corners *list)
{
    int all = 4 * build->file.cell_count, count = 0;
    for (int k = 0, end; k < all; k = end) {
        for (end = k + 1; end < all && !tets_compare_corners(&list[k], &list[end]);) end++;
        if (end - k > 2) {
            tets_refuse(build, list[k + 2].tet,
                        "has a side that the tetrahedra %d and %d have, too: two at most", list[k].tet,
                        list[k + 1].tet);
            return -1;
        }
        if (end - k == 2 && runs_odd(build, &list[k]) == runs_odd(build, &list[k + 1])) {
            tets_refuse(build, list[k + 1].tet, "lies in tetrahedron %d: on the same side of a side of both",
                        list[k].tet);
            return -1;
        }
        if (end - k == 1) {
            list[count++] = list[k];
        } else {
            build->tets->across[list[k].number] = list[k + 1].tet;
            build->tets->across[list[k + 1].number] = list[k].tet;
        }
    }
    return count;
}

static int compare_numbers(const void *a, const void *b)
{
    return ((const Corners *)a)->number - ((const Corners *)b)->number;
}

/* rank[side of the sorted list]: in the order of the tetrahedra. */
static void rank_by_tet(const Corners *outer, int count, int *rank)
{
    Corners *by_tet = mem_copy(outer, (size_t)count, sizeof *by_tet);
    for (int k = 0; k < count; k++) by_tet[k].of[0] = k;
    qsort(by_tet, (size_t)count, sizeof *by_tet, compare_numbers);
    for (int k = 0; k < count; k++) rank[by_tet[k].of[0]] = k;
    mem_free(by_tet);
}

/* Numbers the outer sides: as the file's triangles if all are among them, else as the tetrahedra. */
static void number_faces(Build *build, const Corners *outer, int count)
{
    const MeshFile *file = &build->file;
    int *rank = mem_alloc((size_t)count, sizeof *rank), listed = 0;
    build->face_of_file = mem_alloc((size_t)file->face_count, sizeof *build->face_of_file);
    for (int k = 0; k < count; k++) rank[k] = -1;
    for (int f = 0; f < file->face_count; f++) {
        Corners key = {.number = f};
        memcpy(key.of, file->faces[f], sizeof key.of);
        tets_sort_corners(key.of, 3);
        const Corners *side = NULL;
        if (count) side = bsearch(&key, outer, (size_t)count, sizeof key, tets_compare_corners);
        build->face_of_file[f] = side ? (int)(side - outer) : -1;
        if (side && rank[side - outer] < 0) rank[side - outer] = listed++;
    }
    if (listed < count) rank_by_tet(outer, count, rank);
    build->face_count = count;
    build->faces = mem_alloc((size_t)count, sizeof *build->faces);
    build->tets->behind = mem_alloc((size_t)count, sizeof *build->tets->behind);
    for (int k = 0; k < count; k++) {
        side_corners(build, outer[k].number, build->faces[rank[k]]);
        build->tets->behind[rank[k]] = outer[k].tet;
    }
    for (int f = 0; f < file->face_count; f++)
        if (build->face_of_file[f] >= 0) build->face_of_file[f] = rank[build->face_of_file[f]];
    mem_free(rank);
}

bool tets_find_surface(Build *build)
{
    Corners *list = sorted_sides(build);
    int count = outer_sides(build, list);
    if (count >= 0) number_faces(build, list, count);
    mem_free(list);
    return count >= 0;
}

/* ---- Groups ---- */

/* Takes the members; a group without any says nothing. */
static void add_group(MeshFile *to, const MeshGroup *like, int dim, int *members, int count)
{
    if (count)
        to->groups[to->group_count++] = (MeshGroup){mem_text(like->name), dim, count, members};
    else
        mem_free(members);
}

static int *copy(const int *members, int count)
{
    return mem_copy(members, (size_t)count, sizeof *members);
}

/* The faces of a group that are on the surface. */
static void add_faces(Build *build, const MeshGroup *group)
{
    int *members = mem_alloc((size_t)group->count, sizeof *members), count = 0;
    for (int k = 0; k < group->count; k++) {
        int face = build->face_of_file[group->members[k]];
        if (face >= 0) members[count++] = face;
    }
    add_group(&build->nodes, group, 2, members, count);
}

/* Nodes that are gathered from groups of one name, each once. */
typedef struct NodeSet {
    int *stamp; /* [node] the last set that it was in */
    int *nodes, count, set;
    size_t room;
} NodeSet;

static void put(NodeSet *to, int node)
{
    if (node < 0 || to->stamp[node] == to->set) return;
    to->stamp[node] = to->set;
    if ((size_t)to->count == to->room) {
        to->nodes = mem_resize(to->nodes, to->room, 2 * to->room + 64, sizeof *to->nodes);
        to->room = 2 * to->room + 64;
    }
    to->nodes[to->count++] = node;
}

/* The corners of an edge or face, and the middles between. */
static void put_sides(const Build *build, NodeSet *to, const int *corners, int count)
{
    for (int i = 0; i < count; i++) {
        put(to, corners[i]);
        if (build->tets->order == TET_QUADRATIC)
            put(to, tets_middle(build, corners[i], corners[(i + 1) % count]));
    }
}

static void put_group(const Build *build, NodeSet *to, const MeshGroup *group)
{
    const Tets *tets = build->tets;
    for (int k = 0; k < group->count; k++) {
        const int *member = group->members + (group->dim == 1 ? 2 : 1) * k;
        if (group->dim == 0) put(to, *member);
        if (group->dim == 1) put_sides(build, to, member, 2);
        if (group->dim == 2) put_sides(build, to, build->file.faces[*member], 3);
        for (int i = 0; group->dim == 3 && i < tets->each; i++)
            put(to, tets->nodes[*member * tets->each + i]);
    }
}

static int compare_names(const void *a, const void *b, void *groups)
{
    const MeshGroup *s = (MeshGroup *)groups + *(const int *)a, *t = (MeshGroup *)groups + *(const int *)b;
    int order = strcmp(s->name, t->name);
    return order ? order : *(const int *)a - *(const int *)b;
}

static int compare_ints(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* All that goes by one name are nodes, too: so that what selects vertices knows it, middles and those within as well. */
static void add_nodes(Build *build)
{
    const MeshFile *file = &build->file;
    int count = file->group_count, *order = mem_alloc((size_t)count, sizeof *order);
    NodeSet set = {.stamp = mem_alloc((size_t)build->nodes.vertex_count, sizeof *set.stamp)};
    for (int g = 0; g < count; g++) order[g] = g;
    if (count) qsort_r(order, (size_t)count, sizeof *order, compare_names, file->groups);
    for (int g = 0, end; g < count; g = end) {
        const MeshGroup *first = &file->groups[order[g]];
        set.count = 0, set.set = g + 1;
        for (end = g; end < count && !strcmp(file->groups[order[end]].name, first->name); end++)
            put_group(build, &set, &file->groups[order[end]]);
        if (set.count) qsort(set.nodes, (size_t)set.count, sizeof *set.nodes, compare_ints);
        add_group(&build->nodes, first, 0, copy(set.nodes, set.count), set.count);
    }
    mem_free(set.stamp);
    mem_free(set.nodes);
    mem_free(order);
}

void tets_make_groups(Build *build)
{
    const MeshFile *file = &build->file;
    build->nodes.groups = mem_alloc(2 * (size_t)file->group_count, sizeof *build->nodes.groups);
    for (int g = 0; g < file->group_count; g++) {
        const MeshGroup *group = &file->groups[g];
        if (group->dim == 1)
            add_group(&build->nodes, group, 1, copy(group->members, 2 * group->count), group->count);
        if (group->dim == 2) add_faces(build, group);
        if (group->dim == 3)
            add_group(&build->nodes, group, 3, copy(group->members, group->count), group->count);
    }
    add_nodes(build);
}
