/* Tetrahedra: nodes, and the meshes of their surface. */
#include "base/memory.h"
#include "base/vec3.h"
#include "solid/tets_private.h"
#include <string.h>

/* ---- Nodes ---- */

static const double CURVED = 1e-6; /* of an edge: files round */

/* How far an edge's node in the file is from its middle. */
static void note_curved(Build *build, const Corners *edge, const double *middle)
{
    const double(*x)[3] = (const double(*)[3])build->file.vertices;
    double by = vec3_length(vec3_sub(vec3_load(x[edge->number]), vec3_load(middle)));
    double part = by / vec3_length(vec3_sub(vec3_load(x[edge->of[0]]), vec3_load(x[edge->of[1]])));
    if (!(part > CURVED)) return;
    build->curved_count++;
    if (part <= build->curved_part) return;
    build->curved_node = edge->number, build->curved_by = by, build->curved_part = part;
}

/* In the middle of the edge, whether the file has them or not. */
static void place_middles(Build *build, bool raise)
{
    double(*x)[3] = build->nodes.vertices;
    for (int e = 0; e < build->edge_count; e++) {
        Corners *edge = &build->edges[e];
        if (raise) edge->number = build->file.vertex_count + e;
        for (int i = 0; i < 3; i++) x[edge->number][i] = (x[edge->of[0]][i] + x[edge->of[1]][i]) / 2;
        if (!raise) note_curved(build, edge, x[edge->number]);
    }
}

/* The vertices of the file, and of a linear one that is made quadratic the middles of its edges. */
static void place_nodes(Build *build)
{
    const MeshFile *file = &build->file;
    bool quadratic = build->tets->order == TET_QUADRATIC, raise = quadratic && file->cell_nodes == 4;
    MeshFile *nodes = &build->nodes;
    nodes->path = mem_text(file->path);
    nodes->vertex_count = file->vertex_count + (raise ? build->edge_count : 0);
    nodes->vertices = mem_alloc((size_t)nodes->vertex_count, sizeof *nodes->vertices);
    memcpy(nodes->vertices, file->vertices, (size_t)file->vertex_count * sizeof *nodes->vertices);
    if (quadratic) place_middles(build, raise);
}

static void number_nodes(Build *build)
{
    Tets *tets = build->tets;
    size_t all = (size_t)tets->count * (size_t)tets->each;
    tets->nodes = mem_alloc(all, sizeof *tets->nodes);
    for (int t = 0; t < tets->count; t++) {
        const int *v = tets_cell(build, t);
        int *to = tets->nodes + (size_t)t * (size_t)tets->each;
        memcpy(to, v, 4 * sizeof *to);
        for (int i = 4; i < tets->each; i++)
            to[i] = tets_middle(build, v[tet_edges[i - 4][0]], v[tet_edges[i - 4][1]]);
    }
    build->nodes.cell_count = tets->count, build->nodes.cell_nodes = tets->each;
    build->nodes.cells = mem_copy(tets->nodes, all, sizeof *build->nodes.cells);
}

/* ---- The meshes ---- */

/* The faces, in four each, for the groups as well; the last part of each joins its middles. */
static void split_faces(const Build *build, MeshFile *skin, int *skin_face)
{
    Mesh *surface = build->tets->surface;
    surface->face_middles = mem_alloc((size_t)build->face_count, sizeof *surface->face_middles);
    skin->face_count = 4 * build->face_count;
    skin->faces = mem_alloc((size_t)skin->face_count, sizeof *skin->faces);
    for (int f = 0; f < build->face_count; f++) {
        const int *v = build->faces[f];
        int ab = tets_middle(build, v[0], v[1]), bc = tets_middle(build, v[1], v[2]),
            ca = tets_middle(build, v[2], v[0]);
        const int parts[4][3] = {{v[0], ab, ca}, {ab, v[1], bc}, {ca, bc, v[2]}, {ab, bc, ca}};
        memcpy(skin->faces[4 * f], parts, sizeof parts);
        memcpy(surface->face_middles[f], parts[3], sizeof parts[3]);
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

static void warn_curved(const Build *build)
{
    if (build->curved_count)
        mesh_warn(build->report,
                  "%s: %d middle node%s put straight, as edges are here; the farthest, node %d, by %.3g m, "
                  "%.2g of its "
                  "edge",
                  mesh_place(&build->file, build->file.vertex_line, build->curved_node).text,
                  build->curved_count, build->curved_count == 1 ? " was" : "s were", build->curved_node,
                  build->curved_by, build->curved_part);
}

static bool fill(Build *build)
{
    if (!tets_check(build)) return false;
    place_nodes(build);
    number_nodes(build);
    if (!tets_find_surface(build)) return false;
    tets_make_groups(build);
    if (!make_surface(build)) return false;
    renumber(build->tets);
    warn_curved(build);
    return true;
}

Tets *tets_create(const MeshFile *file, int order, MeshReport *report, Error *err)
{
    size_t count = (size_t)file->cell_count;
    Tets *tets = mem_alloc(1, sizeof *tets);
    *tets = (Tets){.count = file->cell_count, .order = order, .each = order == TET_QUADRATIC ? 10 : 4};
    tets->volume = mem_alloc(count, sizeof *tets->volume);
    tets->across = mem_alloc(4 * count, sizeof *tets->across);
    for (size_t k = 0; k < 4 * count; k++) tets->across[k] = -1;
    if (report) *report = (MeshReport){0};
    Build build = {.file = *file, .tets = tets, .report = report, .err = err};
    build.file.cells = mem_copy(file->cells, count * (size_t)file->cell_nodes, sizeof *file->cells);
    bool ok = fill(&build);
    mesh_file_clear(&build.nodes);
    mem_free(build.file.cells);
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
    mesh_destroy(tets->surface);
    mesh_destroy(tets->skin);
    mem_free(tets->skin_face);
    mem_free(tets->behind);
    mem_free(tets->nodes);
    mem_free(tets->volume);
    mem_free(tets->across);
    mem_free(tets);
}
