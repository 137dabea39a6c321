/* Obstacles of closed triangle meshes. */
#include "base/memory.h"
#include "base/vec3.h"
#include "field/cubic_grid.h"
#include "world/mesh_distance.h"
#include "world/obstacle_shapes.h"
#include <math.h>
#include <string.h>

/* How many cells the grid reaches beyond the mesh; and how many nodes it may have: 128 MB. */
enum { MARGIN = 6, NODES_MAX = 1 << 24 };

typedef struct Solid {
    Mesh *mesh;
    CubicGrid distance;
    double smooth; /* m */
    bool turned;   /* the mesh is inside out */
} Solid;

/* The spline, and the distance D = sqrt(t^2 + e^2) - e from where it is evaluated, t the way to there: axis by axis a
 * function of that coordinate alone. */
static void solid_gap(const void *self, const double x[3], Gap *gap)
{
    const Solid *solid = self;
    double t[3][3], square = solid->smooth * solid->smooth;
    cubic_grid_at(&solid->distance, x, gap);
    for (int i = 0; i < 3; i++) {
        cubic_grid_beyond(&solid->distance, i, x[i], t[i]);
        square += t[i][0] * t[i][0];
    }
    double length = sqrt(square);
    gap->value += length - solid->smooth;
    for (int i = 0; i < 3; i++) {
        double slope = t[i][0] / length * t[i][1];
        gap->gradient[i] += slope;
        gap->hessian[i][i] += (t[i][1] * t[i][1] + t[i][0] * t[i][2]) / length;
        for (int j = 0; j < 3; j++) gap->hessian[i][j] -= slope * (t[j][0] / length * t[j][1]) / length;
    }
}

static void solid_destroy(void *self)
{
    Solid *solid = self;
    cubic_grid_clear(&solid->distance);
    mesh_destroy(solid->mesh);
    mem_free(solid);
}

/* From a vertex of the mesh along the gradient to where the spline is 0; where it has none near, it stays. */
static void to_surface(const Solid *solid, double x[3])
{
    double at[3] = {x[0], x[1], x[2]}, away = 0;
    Gap gap = {0};
    for (int k = 0; k < 30; k++) {
        double square = 1e-12;
        solid_gap(solid, at, &gap);
        for (int i = 0; i < 3; i++) square += gap.gradient[i] * gap.gradient[i];
        for (int i = 0; i < 3; i++) at[i] -= gap.value * gap.gradient[i] / square;
    }
    for (int i = 0; i < 3; i++) away += (at[i] - x[i]) * (at[i] - x[i]);
    if (fabs(gap.value) < 1e-9 * solid->smooth && sqrt(away) < 2 * solid->smooth) memcpy(x, at, sizeof at);
}

static void solid_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    const Solid *solid = self;
    const Mesh *mesh = solid->mesh;
    (void)box;
    surface->vertex_count = mesh->vertex_count;
    surface->face_count = mesh->face_count;
    surface->vertices = mem_copy(mesh->rest, (size_t)mesh->vertex_count, sizeof *mesh->rest);
    surface->faces = mem_copy(mesh->faces, (size_t)mesh->face_count, sizeof *mesh->faces);
    for (int v = 0; v < surface->vertex_count; v++) to_surface(solid, surface->vertices[v]);
    for (int f = 0; solid->turned && f < surface->face_count; f++) {
        int *face = surface->faces[f], first = face[0];
        face[0] = face[1], face[1] = first;
    }
}

static const ObstacleOps mesh_ops = {
    .kind = "mesh", .gap = solid_gap, .surface = solid_surface, .destroy = solid_destroy};

static bool check_closed(const Mesh *mesh, const char *path, Error *err)
{
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh_edge_is_boundary(mesh, e))
            return error_set(
                err, "%s: the mesh is not closed: the edge of vertices %d and %d has one face only", path,
                mesh->file_vertex[mesh->edges[e][0]], mesh->file_vertex[mesh->edges[e][1]]);
    return true;
}

/* Six times what it encloses; negative where it is inside out. */
static double volume(const Mesh *mesh)
{
    double sum = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        Vec3 x[3];
        for (int k = 0; k < 3; k++)
            x[k] = vec3_sub(vec3_load(mesh->rest[mesh->faces[f][k]]), vec3_load(mesh->rest[0]));
        sum += vec3_dot(x[0], vec3_cross(x[1], x[2]));
    }
    return sum;
}

/* Nodes around a mesh. */
typedef struct Grid {
    int nodes[3];
    double low[3], cell;
} Grid;

/* False with a sentence where it is too large. */
static bool find_grid(const Mesh *mesh, double cell, const char *path, Grid *grid, Error *err)
{
    double *low = grid->low, high[3], count = 1;
    grid->cell = cell;
    mesh_bounding_box(mesh, low, high);
    for (int i = 0; i < 3; i++) {
        double cells = ceil((high[i] - low[i]) / cell) + 2 * MARGIN;
        count *= cells + 1;
        if (count <= NODES_MAX) grid->nodes[i] = (int)cells + 1;
        low[i] = (low[i] + high[i] - cells * cell) / 2;
    }
    return count <= NODES_MAX ||
           error_set(
               err, "%s: a grid with cells of %.3g m has %.3g nodes; there are at most %d: take larger cells",
               path, cell, count, NODES_MAX);
}

static long node_count(const Grid *grid)
{
    return (long)grid->nodes[0] * grid->nodes[1] * grid->nodes[2];
}

static CubicGrid make_spline(const Grid *grid, const double *values)
{
    return cubic_grid_create(grid->nodes, grid->low, (double[3]){grid->cell, grid->cell, grid->cell}, values,
                             false);
}

/* A grid of every fourth node, with the values there and the spline through them. Far away and deep down, where all faces
 * are as near as the nearest one, a search for it takes long; and there nobody needs to know exactly. */
typedef struct Coarse {
    Grid grid;
    double *values;
    CubicGrid cubic;
} Coarse;

enum { COARSER = 4 };

/* The distance at a node (i, j, k), where it is more than 6 cells for sure: it changes by no more than the way to the
 * next node of the coarse grid, which is 3.5 cells at most. */
static bool is_far(const Coarse *coarse, const int node[3], const double x[3], double *value)
{
    const double far = 10.0 / COARSER; /* coarse cells */
    long at = 0;
    for (int i = 0; i < 3; i++) at = at * coarse->grid.nodes[i] + (node[i] + COARSER / 2) / COARSER;
    if (fabs(coarse->values[at]) < far * coarse->grid.cell) return false;
    Gap gap;
    cubic_grid_at(&coarse->cubic, x, &gap);
    *value = gap.value;
    return true;
}

/* coarse NULL: all nodes exactly. side: -1 of a mesh inside out. */
static double *sample(const MeshDistance *distance, double side, const Grid *grid, const Coarse *coarse)
{
    double *values = mem_alloc((size_t)node_count(grid), sizeof *values), *value = values;
    int face = -1, node[3];
    for (node[0] = 0; node[0] < grid->nodes[0]; node[0]++)
        for (node[1] = 0; node[1] < grid->nodes[1]; node[1]++)
            for (node[2] = 0; node[2] < grid->nodes[2]; node[2]++, value++) {
                double x[3];
                for (int i = 0; i < 3; i++) x[i] = grid->low[i] + node[i] * grid->cell;
                if (coarse && is_far(coarse, node, x, value)) continue;
                *value = side * mesh_distance_at(distance, x, &face);
            }
    return values;
}

/* The coarse grid reaches as far, at least. */
static double *sample_coarse_first(const Mesh *mesh, double side, const Grid *grid)
{
    MeshDistance *distance = mesh_distance_create(mesh);
    Coarse coarse = {.grid = *grid};
    coarse.grid.cell *= COARSER;
    for (int i = 0; i < 3; i++) coarse.grid.nodes[i] = (grid->nodes[i] + COARSER - 2) / COARSER + 1;
    coarse.values = sample(distance, side, &coarse.grid, NULL);
    coarse.cubic = make_spline(&coarse.grid, coarse.values);
    double *values = sample(distance, side, grid, &coarse);
    cubic_grid_clear(&coarse.cubic);
    mem_free(coarse.values);
    mesh_distance_destroy(distance);
    return values;
}

/* NULL where no node is inside; the deepest one is `deepest` deep. */
static Solid *make_solid(Mesh *mesh, const Grid *grid, double *deepest)
{
    bool turned = volume(mesh) < 0;
    double *values = sample_coarse_first(mesh, turned ? -1 : 1, grid);
    *deepest = 0;
    for (long k = 0; k < node_count(grid); k++) *deepest = fmax(*deepest, -values[k]);
    Solid *solid = *deepest > 0 ? mem_alloc(1, sizeof *solid) : NULL;
    if (solid) *solid = (Solid){mesh, make_spline(grid, values), grid->cell, turned};
    mem_free(values);
    return solid;
}

/* Cells: as thin may a part of a mesh be that is thick elsewhere. */
static const double THIN = 2;

bool obstacle_mesh(const MeshFile *file, double cell, Obstacle *obstacle, Error *err)
{
    const double equal = 1e-12; /* m */
    Mesh *mesh = mesh_create(file, equal, NULL, err);
    Grid grid;
    double low[3], high[3], deepest;
    if (mesh && isnan(cell)) cell = mesh_diagonal(mesh) / 48;
    bool good = mesh && check_closed(mesh, file->path, err) && find_grid(mesh, cell, file->path, &grid, err);
    Solid *solid = good ? make_solid(mesh, &grid, &deepest) : NULL;
    if (good && !solid)
        error_set(err,
                  "%s: the mesh is thinner than a cell of its grid, %.3g m, all over: give a smaller `cell`",
                  file->path, cell);
    if (!solid) {
        mesh_destroy(mesh);
        return false;
    }
    *obstacle = (Obstacle){.ops = &mesh_ops, .self = solid, .feature = cell, .steepest = 1.2};
    obstacle->inradius = fmin(deepest, THIN * cell);
    mesh_bounding_box(mesh, low, high);
    for (int i = 0; i < 3; i++) obstacle->motion.pivot[i] = (low[i] + high[i]) / 2;
    return true;
}
