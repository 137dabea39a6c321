#include "solid/tets.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <stdlib.h>
#include <string.h>

/* Outwards, of a positively oriented tetrahedron. */
static const int sides[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

/* Of the middle nodes 4 to 9. */
const int tet_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};

/* Some corners in ascending order, and what they are of. */
typedef struct Corners {
    int of[3], number;
} Corners;

/* What the steps of tets_create share. */
typedef struct Build {
    const MeshFile *file;
    Tets *tets;
    MeshFile nodes; /* all nodes as vertices, the tetrahedra, and groups     */
    Corners *edges; /* [edge_count] by their corners; number: the middle's node */
    int edge_count;
    int (*faces)[3]; /* [face_count] of the surface    */
    int face_count;
    int *face_of_file; /* [file->face_count] -1: none    */
    MeshReport *report;
    Error *err;
} Build;

static void order(int *a, int *b)
{
    if (*a <= *b) return;
    int c = *a;
    *a = *b, *b = c;
}

static Corners corners(int a, int b, int c, int number)
{
    order(&a, &b), order(&b, &c), order(&a, &b);
    return (Corners){{a, b, c}, number};
}

static int compare(const void *a, const void *b)
{
    const Corners *s = a, *t = b;
    for (int i = 0; i < 3; i++)
        if (s->of[i] != t->of[i]) return s->of[i] < t->of[i] ? -1 : 1;
    return 0;
}

static int compare_all(const void *a, const void *b)
{
    int difference = compare(a, b);
    return difference ? difference : ((const Corners *)a)->number - ((const Corners *)b)->number;
}

/* ---- Tetrahedra ---- */

static bool refuse(const Build *build, int tet, const char *what)
{
    const MeshFile *file = build->file;
    const int *v = file->cells + (size_t)tet * (size_t)file->cell_nodes;
    if (file->cell_line)
        return error_set(build->err, "%s:%d: tetrahedron %d (corners %d, %d, %d, %d) %s", file->path,
                         file->cell_line[tet], tet, v[0], v[1], v[2], v[3], what);
    return error_set(build->err, "%s: tetrahedron %d (corners %d, %d, %d, %d) %s", file->path, tet, v[0],
                     v[1], v[2], v[3], what);
}

static double volume_of(const MeshFile *file, const int *v)
{
    Vec3 x[4];
    for (int i = 0; i < 4; i++) x[i] = vec3_load(file->vertices[v[i]]);
    for (int i = 1; i < 4; i++) x[i] = vec3_sub(x[i], x[0]);
    return vec3_dot(x[1], vec3_cross(x[2], x[3])) / 6;
}

static const double FLAT = 1e-9; /* of the longest edge's cube */

static bool measure(const Build *build)
{
    const MeshFile *file = build->file;
    for (int t = 0; t < file->cell_count; t++) {
        const int *v = file->cells + (size_t)t * (size_t)file->cell_nodes;
        double longest = 0, volume = volume_of(file, v);
        for (int e = 0; e < 6; e++)
            longest = fmax(longest, vec3_length(vec3_sub(vec3_load(file->vertices[v[tet_edges[e][0]]]),
                                                         vec3_load(file->vertices[v[tet_edges[e][1]]]))));
        if (fabs(volume) <= FLAT * longest * longest * longest) return refuse(build, t, "is flat");
        if (volume < 0) return refuse(build, t, "is inside out: swap two of its corners");
        build->tets->volume[t] = volume;
    }
    return true;
}

/* ---- Nodes ---- */

static void find_edges(Build *build)
{
    const MeshFile *file = build->file;
    size_t all = 6 * (size_t)file->cell_count;
    build->edges = mem_alloc(all, sizeof *build->edges);
    for (size_t k = 0; k < all; k++) {
        const int *v = file->cells + k / 6 * (size_t)file->cell_nodes;
        int a = v[tet_edges[k % 6][0]], b = v[tet_edges[k % 6][1]];
        order(&a, &b);
        build->edges[k] = (Corners){{a, b, 0}, file->cell_nodes == 10 ? v[4 + k % 6] : -1};
    }
    qsort(build->edges, all, sizeof *build->edges, compare_all);
    for (size_t k = 0; k < all; k++)
        if (k == 0 || compare(&build->edges[k], &build->edges[build->edge_count - 1]))
            build->edges[build->edge_count++] = build->edges[k];
}

static int middle_of(const Build *build, int a, int b)
{
    order(&a, &b);
    Corners key = {{a, b, 0}, 0};
    const Corners *edge = bsearch(&key, build->edges, (size_t)build->edge_count, sizeof key, compare);
    return edge->number;
}

/* The vertices of the file, and of a linear one that is made quadratic the middles of its edges. */
static void place_nodes(Build *build)
{
    const MeshFile *file = build->file;
    bool raise = build->tets->order == TET_QUADRATIC && file->cell_nodes == 4;
    int count = file->vertex_count + (raise ? build->edge_count : 0);
    MeshFile *nodes = &build->nodes;
    nodes->path = mem_text(file->path);
    nodes->vertex_count = count;
    nodes->vertices = mem_alloc((size_t)count, sizeof *nodes->vertices);
    memcpy(nodes->vertices, file->vertices, (size_t)file->vertex_count * sizeof *nodes->vertices);
    if (build->tets->order == TET_LINEAR) return;
    for (int e = 0; e < build->edge_count; e++) {
        Corners *edge = &build->edges[e];
        if (raise) edge->number = file->vertex_count + e;
        for (int i = 0; i < 3; i++)
            nodes->vertices[edge->number][i] =
                (file->vertices[edge->of[0]][i] + file->vertices[edge->of[1]][i]) / 2;
    }
}

static void number_nodes(Build *build)
{
    const MeshFile *file = build->file;
    Tets *tets = build->tets;
    tets->nodes = mem_alloc((size_t)tets->count * (size_t)tets->each, sizeof *tets->nodes);
    for (int t = 0; t < tets->count; t++) {
        const int *v = file->cells + (size_t)t * (size_t)file->cell_nodes;
        int *to = tets->nodes + (size_t)t * (size_t)tets->each;
        memcpy(to, v, 4 * sizeof *to);
        for (int i = 4; i < tets->each; i++)
            to[i] = middle_of(build, v[tet_edges[i - 4][0]], v[tet_edges[i - 4][1]]);
    }
    build->nodes.cell_count = tets->count, build->nodes.cell_nodes = tets->each;
    build->nodes.cells =
        mem_copy(tets->nodes, (size_t)tets->count * (size_t)tets->each, sizeof *build->nodes.cells);
}

/* ---- The surface ---- */

/* The sides of all tetrahedra, number 4 t + side, sorted by their corners. */
static Corners *sorted_sides(const Build *build)
{
    const MeshFile *file = build->file;
    size_t all = 4 * (size_t)file->cell_count;
    Corners *list = mem_alloc(all, sizeof *list);
    for (size_t k = 0; k < all; k++) {
        const int *v = file->cells + k / 4 * (size_t)file->cell_nodes, *side = sides[k % 4];
        list[k] = corners(v[side[0]], v[side[1]], v[side[2]], (int)k);
    }
    qsort(list, all, sizeof *list, compare_all);
    return list;
}

/* Leaves those that no other tetrahedron has, sorted; their number, or -1 after a refusal. The others' tetrahedra are
 * neighbours. */
static int outer_sides(const Build *build, Corners *list)
{
    int all = 4 * build->file->cell_count, count = 0;
    for (int k = 0, end; k < all; k = end) {
        for (end = k + 1; end < all && !compare(&list[k], &list[end]);) end++;
        if (end - k > 2) {
            refuse(build, list[k + 2].number / 4, "has a face that two others have, too");
            return -1;
        }
        int a = list[k].number, b = list[end - 1].number;
        if (end - k == 1)
            list[count++] = list[k];
        else
            build->tets->across[a] = b / 4, build->tets->across[b] = a / 4;
    }
    return count;
}

static int compare_numbers(const void *a, const void *b)
{
    return ((const Corners *)a)->number - ((const Corners *)b)->number;
}

/* Numbers the outer sides: as the file's triangles if all are among them, else as the tetrahedra. */
static void number_faces(Build *build, Corners *outer, int count)
{
    const MeshFile *file = build->file;
    int *rank = mem_alloc((size_t)count, sizeof *rank), listed = 0;
    build->face_of_file = mem_alloc((size_t)file->face_count, sizeof *build->face_of_file);
    for (int k = 0; k < count; k++) rank[k] = -1;
    for (int f = 0; f < file->face_count; f++) {
        Corners key = corners(file->faces[f][0], file->faces[f][1], file->faces[f][2], f);
        const Corners *side = bsearch(&key, outer, (size_t)count, sizeof key, compare);
        build->face_of_file[f] = side ? (int)(side - outer) : -1;
        if (side && rank[side - outer] < 0) rank[side - outer] = listed++;
    }
    if (listed < count) { /* in the order of the tetrahedra */
        Corners *by_tet = mem_copy(outer, (size_t)count, sizeof *by_tet);
        for (int k = 0; k < count; k++) by_tet[k].of[0] = k;
        qsort(by_tet, (size_t)count, sizeof *by_tet, compare_numbers);
        for (int k = 0; k < count; k++) rank[by_tet[k].of[0]] = k;
        mem_free(by_tet);
    }
    build->face_count = count;
    build->faces = mem_alloc((size_t)count, sizeof *build->faces);
    for (int k = 0; k < count; k++) {
        const int *v = file->cells + outer[k].number / 4 * file->cell_nodes,
                  *side = sides[outer[k].number % 4];
        for (int i = 0; i < 3; i++) build->faces[rank[k]][i] = v[side[i]];
    }
    for (int f = 0; f < file->face_count; f++)
        if (build->face_of_file[f] >= 0) build->face_of_file[f] = rank[build->face_of_file[f]];
    mem_free(rank);
}

static bool find_surface(Build *build)
{
    Corners *list = sorted_sides(build);
    int count = outer_sides(build, list);
    if (count >= 0) number_faces(build, list, count);
    mem_free(list);
    return count >= 0;
}

/* ---- Groups ---- */

static void add_group(MeshFile *to, const char *name, int dim, int *members, int count)
{
    to->groups =
        mem_resize(to->groups, (size_t)to->group_count, (size_t)to->group_count + 1, sizeof *to->groups);
    to->groups[to->group_count++] = (MeshGroup){mem_text(name), dim, count, members};
}

/* The nodes of what the group's members are of: of a face its corners and the middles between, of a tetrahedron all. */
static void add_nodes(Build *build, const MeshGroup *group)
{
    const MeshFile *file = build->file;
    const Tets *tets = build->tets;
    bool *in = mem_alloc((size_t)build->nodes.vertex_count, sizeof *in);
    int *members = mem_alloc((size_t)build->nodes.vertex_count, sizeof *members), count = 0;
    for (int k = 0; k < group->count; k++) {
        int member = group->members[k];
        if (group->dim == 3)
            for (int i = 0; i < tets->each; i++) in[tets->nodes[member * tets->each + i]] = true;
        for (int i = 0; group->dim == 2 && i < 3; i++) {
            const int *v = file->faces[member];
            in[v[i]] = true;
            if (tets->order == TET_QUADRATIC && build->face_of_file[member] >= 0)
                in[middle_of(build, v[i], v[(i + 1) % 3])] = true;
        }
    }
    for (int v = 0; v < build->nodes.vertex_count; v++)
        if (in[v]) members[count++] = v;
    mem_free(in);
    add_group(&build->nodes, group->name, 0, members, count);
}

static void add_faces(Build *build, const MeshGroup *group)
{
    int *members = mem_alloc((size_t)group->count, sizeof *members), count = 0;
    for (int k = 0; k < group->count; k++) {
        int face = build->face_of_file[group->members[k]];
        if (face >= 0) members[count++] = face;
    }
    add_group(&build->nodes, group->name, 2, members, count);
}

/* What a group of faces or tetrahedra is of are nodes, too: so that all that selects vertices knows it. */
static void make_groups(Build *build)
{
    const MeshFile *file = build->file;
    Tets *tets = build->tets;
    for (int g = 0; g < file->group_count; g++) {
        const MeshGroup *group = &file->groups[g];
        if (group->dim == 3) {
            size_t count = (size_t)tets->group_count++;
            tets->groups = mem_resize(tets->groups, count, count + 1, sizeof *tets->groups);
            tets->groups[count] = (MeshGroup){mem_text(group->name), 3, group->count,
                                              mem_copy(group->members, (size_t)group->count, sizeof(int))};
        }
        if (group->dim >= 2) add_nodes(build, group);
        if (group->dim == 2) add_faces(build, group);
        if (group->dim < 2)
            add_group(&build->nodes, group->name, group->dim,
                      mem_copy(group->members, (size_t)group->count * (group->dim == 1 ? 2 : 1), sizeof(int)),
                      group->count);
    }
}

/* ---- The meshes ---- */

/* The faces, in four each, for the groups as well. */
static void split_faces(const Build *build, MeshFile *skin, int *skin_face)
{
    skin->face_count = 4 * build->face_count;
    skin->faces = mem_alloc((size_t)skin->face_count, sizeof *skin->faces);
    for (int f = 0; f < build->face_count; f++) {
        const int *v = build->faces[f];
        int ab = middle_of(build, v[0], v[1]), bc = middle_of(build, v[1], v[2]),
            ca = middle_of(build, v[2], v[0]);
        const int parts[4][3] = {{v[0], ab, ca}, {ab, v[1], bc}, {ca, bc, v[2]}, {ab, bc, ca}};
        memcpy(skin->faces[4 * f], parts, sizeof parts);
        for (int i = 0; i < 4; i++) skin_face[4 * f + i] = f;
    }
}

static bool make_skin(Build *build)
{
    Tets *tets = build->tets;
    MeshFile skin = build->nodes; /* without groups: they are the surface's */
    skin.group_count = 0;
    tets->skin_face = mem_alloc(4 * (size_t)build->face_count, sizeof *tets->skin_face);
    if (tets->order == TET_QUADRATIC) {
        split_faces(build, &skin, tets->skin_face);
    } else {
        skin.face_count = build->face_count, skin.faces = build->faces;
        for (int f = 0; f < build->face_count; f++) tets->skin_face[f] = f;
    }
    tets->skin = mesh_create(&skin, 0, NULL, build->err);
    if (tets->order == TET_QUADRATIC) mem_free(skin.faces);
    return tets->skin != NULL;
}

static bool make_surface(Build *build)
{
    MeshFile surface = build->nodes;
    surface.face_count = build->face_count, surface.faces = build->faces;
    build->tets->surface = mesh_create(&surface, 0, build->report, build->err);
    return build->tets->surface && make_skin(build);
}

/* From the file's numbers to those of the meshes: where vertices that are in nothing were left out. */
static void renumber(Tets *tets)
{
    for (int i = 0; i < tets->count * tets->each; i++)
        tets->nodes[i] = tets->surface->vertex_of_file[tets->nodes[i]];
}

static bool fill(Build *build)
{
    if (!measure(build)) return false;
    if (build->tets->order == TET_QUADRATIC) find_edges(build);
    place_nodes(build);
    number_nodes(build);
    if (!find_surface(build)) return false;
    make_groups(build);
    if (!make_surface(build)) return false;
    renumber(build->tets);
    return true;
}

Tets *tets_create(const MeshFile *file, int order, MeshReport *report, Error *err)
{
    Tets *tets = mem_alloc(1, sizeof *tets);
    *tets = (Tets){.count = file->cell_count, .order = order, .each = order == TET_QUADRATIC ? 10 : 4};
    tets->volume = mem_alloc((size_t)tets->count, sizeof *tets->volume);
    tets->across = mem_alloc(4 * (size_t)tets->count, sizeof *tets->across);
    for (int k = 0; k < 4 * tets->count; k++) tets->across[k] = -1;
    if (report) *report = (MeshReport){0};
    Build build = {.file = file, .tets = tets, .report = report, .err = err};
    bool ok = fill(&build);
    mesh_file_clear(&build.nodes);
    mem_free(build.edges);
    mem_free(build.faces);
    mem_free(build.face_of_file);
    if (ok) return tets;
    tets_destroy(tets);
    return NULL;
}

void tets_destroy(Tets *tets)
{
    if (!tets) return;
    for (int g = 0; g < tets->group_count; g++) {
        mem_free(tets->groups[g].name);
        mem_free(tets->groups[g].members);
    }
    mem_free(tets->groups);
    mesh_destroy(tets->surface);
    mesh_destroy(tets->skin);
    mem_free(tets->skin_face);
    mem_free(tets->nodes);
    mem_free(tets->volume);
    mem_free(tets->across);
    mem_free(tets);
}

const MeshGroup *tets_group(const Tets *tets, const char *name)
{
    for (int g = 0; g < tets->group_count; g++)
        if (!strcmp(tets->groups[g].name, name)) return &tets->groups[g];
    return NULL;
}
