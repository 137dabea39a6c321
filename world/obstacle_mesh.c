/* Obstacles of closed triangle meshes. */
#include "base/memory.h"
#include "base/vec3.h"
#include "world/cubic_grid.h"
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

/* The grid around the mesh; false with a sentence where it is too large. */
static bool find_grid(const Mesh *mesh, double cell, const char *path, int nodes[3], double low[3],
                      Error *err)
{
    double high[3], count = 1;
    mesh_bounding_box(mesh, low, high);
    for (int i = 0; i < 3; i++) {
        double cells = ceil((high[i] - low[i]) / cell) + 2 * MARGIN;
        count *= cells + 1;
        if (count <= NODES_MAX) nodes[i] = (int)cells + 1;
        low[i] = (low[i] + high[i] - cells * cell) / 2;
    }
    return count <= NODES_MAX ||
           error_set(
               err, "%s: a grid with cells of %.3g m has %.3g nodes; there are at most %d: take larger cells",
               path, cell, count, NODES_MAX);
}

/* Distances change by no more than a step from node to node. side: -1 of a mesh inside out. */
static double *sample(const Mesh *mesh, const int nodes[3], const double low[3], double cell, double side)
{
    double *values,
        *value = values = mem_alloc((size_t)nodes[0] * (size_t)nodes[1] * (size_t)nodes[2], sizeof *values);
    MeshDistance *distance = mesh_distance_create(mesh);
    for (int i = 0; i < nodes[0]; i++)
        for (int j = 0; j < nodes[1]; j++)
            for (int k = 0; k < nodes[2]; k++, value++) {
                double x[3] = {low[0] + i * cell, low[1] + j * cell, low[2] + k * cell};
                *value = side * mesh_distance_at(distance, x, k ? fabs(value[-1]) + cell : INFINITY);
            }
    mesh_distance_destroy(distance);
    return values;
}

/* NULL where no node is inside. */
static Solid *make_solid(Mesh *mesh, double cell, const int nodes[3], const double low[3])
{
    bool turned = volume(mesh) < 0, inside = false;
    double *values = sample(mesh, nodes, low, cell, turned ? -1 : 1);
    for (long k = 0; k < (long)nodes[0] * nodes[1] * nodes[2]; k++) inside |= values[k] < 0;
    Solid *solid = inside ? mem_alloc(1, sizeof *solid) : NULL;
    if (solid)
        *solid = (Solid){mesh, cubic_grid_create(nodes, low, (double[3]){cell, cell, cell}, values, false),
                         cell, turned};
    mem_free(values);
    return solid;
}

bool obstacle_mesh(const MeshFile *file, double cell, Obstacle *obstacle, Error *err)
{
    const double equal = 1e-12; /* m */
    Mesh *mesh = mesh_create(file, equal, NULL, err);
    int nodes[3];
    double low[3], high[3];
    if (mesh && isnan(cell)) cell = mesh_diagonal(mesh) / 48;
    bool good =
        mesh && check_closed(mesh, file->path, err) && find_grid(mesh, cell, file->path, nodes, low, err);
    Solid *solid = good ? make_solid(mesh, cell, nodes, low) : NULL;
    if (good && !solid)
        error_set(err,
                  "%s: the mesh is thinner than a cell of its grid, %.3g m, all over: give a smaller `cell`",
                  file->path, cell);
    if (!solid) {
        mesh_destroy(mesh);
        return false;
    }
    *obstacle = (Obstacle){.ops = &mesh_ops, .self = solid, .feature = cell};
    mesh_bounding_box(mesh, low, high);
    for (int i = 0; i < 3; i++) obstacle->pivot[i] = (low[i] + high[i]) / 2;
    return true;
}
