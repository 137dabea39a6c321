/* What tetrahedra must be. */
#include "base/memory.h"
#include "base/vec3.h"
#include "solid/tets_private.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const int tet_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};

bool tets_refuse(const Build *build, int tet, const char *format, ...)
{
    char what[400];
    const int *v = tets_cell(build, tet);
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    return error_set(build->err, "%s: tetrahedron %d (corners %d, %d, %d, %d) %s",
                     mesh_place(&build->file, build->file.cell_line, tet).text, tet, v[0], v[1], v[2], v[3],
                     what);
}

/* ---- Corners ---- */

bool tets_sort_corners(int *of, int count)
{
    bool odd = false;
    for (int end = count; end > 1; end--)
        for (int i = 1; i < end; i++) {
            if (of[i - 1] <= of[i]) continue;
            int swapped = of[i];
            of[i] = of[i - 1], of[i - 1] = swapped;
            odd = !odd;
        }
    return odd;
}

int tets_compare_corners(const void *a, const void *b)
{
    const Corners *s = a, *t = b;
    for (int i = 0; i < 3; i++)
        if (s->of[i] != t->of[i]) return s->of[i] < t->of[i] ? -1 : 1;
    return 0;
}

int tets_compare_all(const void *a, const void *b)
{
    const Corners *s = a, *t = b;
    int difference = tets_compare_corners(a, b);
    if (difference) return difference;
    return s->number != t->number ? (s->number > t->number) - (s->number < t->number)
                                  : (s->tet > t->tet) - (s->tet < t->tet);
}

/* ---- Volumes ---- */

static const double FLAT = 1e-9; /* of the longest edge's cube */

/* Its volume with the sign of its orientation; 0 where it is flat. */
static double signed_volume(const Build *build, int tet)
{
    const int *v = tets_cell(build, tet);
    Vec3 x[4];
    double longest = 0;
    for (int i = 0; i < 4; i++) x[i] = vec3_load(build->file.vertices[v[i]]);
    for (int e = 0; e < 6; e++)
        longest = fmax(longest, vec3_length(vec3_sub(x[tet_edges[e][0]], x[tet_edges[e][1]])));
    Vec3 a = vec3_sub(x[1], x[0]), b = vec3_sub(x[2], x[0]), c = vec3_sub(x[3], x[0]);
    double volume = vec3_dot(a, vec3_cross(b, c)) / 6;
    return fabs(volume) > FLAT * longest * longest * longest ? volume : 0;
}

static bool check_different(const Build *build)
{
    for (int t = 0; t < build->file.cell_count; t++) {
        const int *v = tets_cell(build, t);
        for (int e = 0; e < 6; e++)
            if (v[tet_edges[e][0]] == v[tet_edges[e][1]])
                return tets_refuse(build, t, "has one of its corners twice");
    }
    return true;
}

/* Other programs number the corners of all of them the other way round. */
static void turn_all(Build *build)
{
    static const int swapped[3][2] = {
        {1, 2}, {4, 6}, {8, 9}}; /* corners 1 and 2, and the middles that go along */
    int each = build->file.cell_nodes;
    for (int t = 0; t < build->file.cell_count; t++) {
        int *v = build->file.cells + (size_t)t * (size_t)each;
        for (int k = 0; k < (each == 10 ? 3 : 1); k++) {
            int *a = v + swapped[k][0], *b = v + swapped[k][1], old = *a;
            *a = *b, *b = old;
        }
        build->tets->volume[t] *= -1;
    }
}

/* All of the same hand, before any of them is turned. */
static bool measure(Build *build)
{
    int count = build->file.cell_count, inverted = 0, first[2] = {-1, -1};
    for (int t = count - 1; t >= 0; t--) {
        double volume = build->tets->volume[t] = signed_volume(build, t);
        first[volume < 0] = t;
        inverted += volume < 0;
    }
    for (int t = 0; t < count; t++)
        if (build->tets->volume[t] == 0) return tets_refuse(build, t, "is flat: it has no volume");
    if (inverted > 0 && inverted < count) {
        bool minority = 2 * inverted <= count;
        return tets_refuse(
            build, first[minority],
            "is inside out against the others, as are %d of %d: the mesh has folded over there, or two "
            "of its corners are to be swapped",
            minority ? inverted : count - inverted, count);
    }
    if (inverted) turn_all(build);
    return true;
}

static bool check_used(const Build *build)
{
    const MeshFile *file = &build->file;
    bool *used = mem_alloc((size_t)file->vertex_count, sizeof *used), ok = true;
    for (int i = 0; i < file->cell_count * file->cell_nodes; i++) used[file->cells[i]] = true;
    for (int v = 0; ok && v < file->vertex_count; v++)
        if (!used[v])
            ok = error_set(
                build->err,
                "%s: node %d is in no tetrahedron: take it out (in Gmsh: make the volume a physical group, "
                "so that only what belongs to it is saved)",
                mesh_place(file, file->vertex_line, v).text, v);
    mem_free(used);
    return ok;
}

/* ---- Edges ---- */

/* Each edge's middle is its own, and no corner. */
static bool check_middles(const Build *build)
{
    enum { FREE, CORNER, MIDDLE };
    const MeshFile *file = &build->file;
    char *role = mem_alloc((size_t)file->vertex_count, sizeof *role);
    bool ok = true;
    for (int t = 0; t < file->cell_count; t++)
        for (int i = 0; i < 4; i++) role[tets_cell(build, t)[i]] = CORNER;
    for (int e = 0; ok && e < build->edge_count; e++) {
        const Corners *edge = &build->edges[e];
        char *of = &role[edge->number];
        if (*of)
            ok =
                tets_refuse(build, edge->tet, "has node %d in the middle of its edge from %d to %d: it is %s",
                            edge->number, edge->of[0], edge->of[1],
                            *of == CORNER ? "a corner, too" : "that of another edge, too");
        *of = MIDDLE;
    }
    mem_free(role);
    return ok;
}

static bool find_edges(Build *build)
{
    bool middles = build->file.cell_nodes == 10;
    size_t all = 6 * (size_t)build->file.cell_count;
    build->edges = mem_alloc(all, sizeof *build->edges);
    for (size_t k = 0; k < all; k++) {
        int tet = (int)(k / 6), side = (int)(k % 6);
        const int *v = tets_cell(build, tet), *end = tet_edges[side];
        build->edges[k] = (Corners){{v[end[0]], v[end[1]], 0}, middles ? v[4 + side] : -1, tet};
        tets_sort_corners(build->edges[k].of, 2);
    }
    qsort(build->edges, all, sizeof *build->edges, tets_compare_all);
    for (size_t k = 0; k < all; k++) {
        Corners edge = build->edges[k], *last = &build->edges[build->edge_count - 1];
        if (k == 0 || tets_compare_corners(&edge, last))
            build->edges[build->edge_count++] = edge;
        else if (edge.number != last->number)
            return tets_refuse(
                build, edge.tet,
                "has node %d in the middle of its edge from %d to %d, and tetrahedron %d node %d",
                edge.number, edge.of[0], edge.of[1], last->tet, last->number);
    }
    return !middles || check_middles(build);
}

int tets_middle(const Build *build, int a, int b)
{
    Corners key = {{a, b, 0}, 0, 0};
    tets_sort_corners(key.of, 2);
    const Corners *edge = NULL;
    if (build->edge_count)
        edge = bsearch(&key, build->edges, (size_t)build->edge_count, sizeof key, tets_compare_corners);
    return edge ? edge->number : -1;
}

/* ---- All ---- */

bool tets_check(Build *build)
{
    const MeshFile *file = &build->file;
    if (file->cell_count < 1)
        return error_set(build->err, "%s: there are no tetrahedra in it; a solid is made of them",
                         file->path);
    bool middles = build->tets->order == TET_QUADRATIC || file->cell_nodes == 10;
    return mesh_check_file(file, build->err) && check_different(build) && measure(build) &&
           (!middles || find_edges(build)) && check_used(build);
}
