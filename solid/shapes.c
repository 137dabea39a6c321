#include "solid/shapes.h"
#include "base/memory.h"
#include <limits.h>

/* Corners of a cell on the way from 0 to 7 along the axes in this order; bit i is a step along axis i. The second half is
 * odd: turned round. */
static const int kuhn[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                               {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}};

static int number(const int cells[3], int i, int j, int k)
{
    return i + (cells[0] + 1) * (j + (cells[1] + 1) * k);
}

static void make_cells(const int cells[3], MeshFile *mesh)
{
    int *next = mesh->cells;
    for (int k = 0; k < cells[2]; k++)
        for (int j = 0; j < cells[1]; j++)
            for (int i = 0; i < cells[0]; i++)
                for (int t = 0; t < 6; t++)
                    for (int c = 0; c < 4; c++) {
                        int corner = kuhn[t][c];
                        *next++ = number(cells, i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
                    }
}

/* The nodes where the place along an axis is that number. */
static void add_side(MeshFile *mesh, const char *name, const int cells[3], int axis, int at)
{
    int *members = mem_alloc((size_t)mesh->vertex_count, sizeof *members), count = 0;
    for (int v = 0; v < mesh->vertex_count; v++) {
        const int place[3] = {v % (cells[0] + 1), v / (cells[0] + 1) % (cells[1] + 1),
                              v / (cells[0] + 1) / (cells[1] + 1)};
        if (place[axis] == at) members[count++] = v;
    }
    mesh->groups[mesh->group_count++] = (MeshGroup){mem_text(name), 0, count, members};
}

bool solid_shape_box(const double size[3], const int cells[3], MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    double count = 6;
    for (int i = 0; i < 3; i++) {
        if (!(size[i] > 0)) return error_set(err, "a box has three lengths above 0, not %g", size[i]);
        if (cells[i] < 1)
            return error_set(err, "a box has at least one cell along each axis, not %d", cells[i]);
        count *= cells[i] + 1.0;
    }
    if (count > INT_MAX / 10) return error_set(err, "a box of %.3g tetrahedra is too large", count);
    mesh->path = mem_text("box");
    mesh->vertex_count = (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
    mesh->vertices = mem_alloc((size_t)mesh->vertex_count, sizeof *mesh->vertices);
    for (int k = 0; k <= cells[2]; k++)
        for (int j = 0; j <= cells[1]; j++)
            for (int i = 0; i <= cells[0]; i++) {
                double *x = mesh->vertices[number(cells, i, j, k)];
                x[0] = size[0] * i / cells[0], x[1] = size[1] * j / cells[1], x[2] = size[2] * k / cells[2];
            }
    mesh->cell_count = 6 * cells[0] * cells[1] * cells[2], mesh->cell_nodes = 4;
    mesh->cells = mem_alloc(4 * (size_t)mesh->cell_count, sizeof *mesh->cells);
    make_cells(cells, mesh);
    static const char *const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "top"}};
    mesh->groups = mem_alloc(6, sizeof *mesh->groups);
    for (int i = 0; i < 6; i++) add_side(mesh, names[i / 2][i % 2], cells, i / 2, i % 2 ? cells[i / 2] : 0);
    return true;
}
