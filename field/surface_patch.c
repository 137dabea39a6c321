#include "field/surface_patch.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <string.h>

static void add_vertices(MeshFile *surface, const int cells[2], SurfacePlace *place, const void *self)
{
    size_t old = (size_t)surface->vertex_count, more = (size_t)(cells[0] + 1) * (size_t)(cells[1] + 1);
    surface->vertices = mem_resize(surface->vertices, old, old + more, sizeof *surface->vertices);
    for (int i = 0; i <= cells[0]; i++)
        for (int j = 0; j <= cells[1]; j++)
            place(self, (double)i / cells[0], (double)j / cells[1],
                  surface->vertices[surface->vertex_count++]);
}

void surface_add_patch(MeshFile *surface, const int cells[2], bool opposite, SurfacePlace *place,
                       const void *self)
{
    int first = surface->vertex_count, row = cells[1] + 1;
    size_t old = (size_t)surface->face_count, more = 2 * (size_t)cells[0] * (size_t)cells[1];
    add_vertices(surface, cells, place, self);
    surface->faces = mem_resize(surface->faces, old, old + more, sizeof *surface->faces);
    for (int i = 0; i < cells[0]; i++)
        for (int j = 0; j < cells[1]; j++) {
            int a = first + i * row + j, b = a + row, c = b + 1, d = a + 1;
            int faces[2][3] = {{a, opposite ? c : b, opposite ? b : c},
                               {a, opposite ? d : c, opposite ? c : d}};
            memcpy(surface->faces[surface->face_count], faces, sizeof faces);
            surface->face_count += 2;
        }
}

void surface_frame(const double axis[3], double first[3], double second[3])
{
    Vec3 a = vec3_load(axis), least = vec3(0, 0, 1);
    if (fabs(a.x) <= fabs(a.y) && fabs(a.x) <= fabs(a.z))
        least = vec3(1, 0, 0);
    else if (fabs(a.y) <= fabs(a.z))
        least = vec3(0, 1, 0);
    Vec3 e = vec3_unit(vec3_cross(a, least));
    vec3_store(first, e);
    vec3_store(second, vec3_cross(a, e));
}
