#include "surface/loads.h"
#include "base/memory.h"
#include "base/vec3.h"

static void add_force(double *load, int vertex, double amount, const double *force)
{
    for (int i = 0; i < 3; i++) load[3 * vertex + i] += amount * force[i];
}

int loads_on_edges(const Mesh *mesh, const Indices *on, const double line[3], double *load)
{
    Indices edges = select_boundary_edges(mesh, on);
    for (int k = 0; k < edges.count; k++) {
        const int *v = mesh->edges[edges.items[k]];
        double length = vec3_length(vec3_sub(vec3_load(mesh->rest[v[0]]), vec3_load(mesh->rest[v[1]])));
        add_force(load, v[0], length / 2, line);
        add_force(load, v[1], length / 2, line);
    }
    mem_free(edges.items);
    return edges.count;
}

int loads_on_faces(const Mesh *mesh, const Indices *on, const double area[3], double *load)
{
    bool *chosen = mem_alloc((size_t)mesh->vertex_count, sizeof *chosen);
    int count = 0;
    for (int k = 0; k < on->count; k++) chosen[on->items[k]] = true;
    for (int f = 0; f < mesh->face_count; f++) {
        const int *v = mesh->faces[f];
        if (!chosen[v[0]] || !chosen[v[1]] || !chosen[v[2]]) continue;
        const int *bear = mesh->face_middles ? mesh->face_middles[f] : v;
        for (int i = 0; i < 3; i++) add_force(load, bear[i], mesh->rest_area[f] / 3, area);
        count++;
    }
    mem_free(chosen);
    return count;
}

int loads_on_vertices(const Indices *on, const double force[3], double *load)
{
    for (int k = 0; k < on->count; k++) add_force(load, on->items[k], 1.0 / on->count, force);
    return on->count;
}
