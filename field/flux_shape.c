#include "field/flux_shape.h"
#include "base/memory.h"
#include "field/surface_patch.h"
#include <math.h>

enum { AROUND = 48, PROFILE = 12 };
static const double THICK = 0.06; /* half of a winding over the coil's radius */

/* A box around a middle, and the side of it that a patch is. */
typedef struct Side {
    double middle[3], half[3];
    int axis, sign;
} Side;

static void side_place(const void *self, double u, double v, double x[3])
{
    const Side *side = self;
    int i = (side->axis + 1) % 3, j = (side->axis + 2) % 3;
    x[side->axis] = side->middle[side->axis] + side->sign * side->half[side->axis];
    x[i] = side->middle[i] + (2 * u - 1) * side->half[i];
    x[j] = side->middle[j] + (2 * v - 1) * side->half[j];
}

static void add_box(Side box, MeshFile *shape)
{
    for (int k = 0; k < 6; k++) {
        box.axis = k / 2, box.sign = k % 2 ? 1 : -1;
        surface_add_patch(shape, (const int[2]){1, 1}, box.sign < 0, side_place, &box);
    }
}

void flux_shape_block(const double half[3], MeshFile *shape)
{
    add_box((Side){.half = {half[0], half[1], half[2]}}, shape);
}

/* A surface around z: its profile goes from v = 0 to 1. */
typedef struct Turned {
    double radius, half;
} Turned;

static void side_of_cylinder(const void *self, double u, double v, double x[3])
{
    const Turned *c = self;
    x[0] = c->radius * cos(2 * M_PI * u), x[1] = c->radius * sin(2 * M_PI * u);
    x[2] = (2 * v - 1) * c->half;
}

/* Its two ends are fans of the side's points; those at u = 0 and 1 are the same. */
void flux_shape_cylinder(double radius, double half, MeshFile *shape)
{
    enum { FAN = AROUND - 2 };
    int first = shape->vertex_count;
    surface_add_patch(shape, (const int[2]){AROUND, 1}, false, side_of_cylinder, &(Turned){radius, half});
    size_t faces = (size_t)shape->face_count;
    shape->faces = mem_resize(shape->faces, faces, faces + 2 * (size_t)FAN, sizeof *shape->faces);
    for (int k = 1; k <= FAN; k++)
        for (int upper = 0; upper < 2; upper++) {
            int *face = shape->faces[shape->face_count++];
            face[0] = first + upper;
            face[1] = first + 2 * (upper ? k : k + 1) + upper;
            face[2] = first + 2 * (upper ? k + 1 : k) + upper;
        }
}

static void coil_place(const void *self, double u, double v, double x[3])
{
    const Turned *c = self;
    double w = THICK * c->radius, r = c->radius + w * cos(2 * M_PI * v);
    x[0] = r * cos(2 * M_PI * u), x[1] = r * sin(2 * M_PI * u);
    x[2] = (c->half + w) * sin(2 * M_PI * v);
}

void flux_shape_round_coil(double radius, double half, MeshFile *shape)
{
    surface_add_patch(shape, (const int[2]){AROUND, PROFILE}, false, coil_place, &(Turned){radius, half});
}

void flux_shape_rectangular_coil(const double half[2], MeshFile *shape)
{
    double w = THICK * fmin(half[0], half[1]);
    for (int k = 0; k < 4; k++) {
        int along = k / 2, across = 1 - along;
        Side beam = {.half = {w, w, w}};
        beam.half[along] = half[along] + w;
        beam.middle[across] = (k % 2 ? 1 : -1) * half[across];
        add_box(beam, shape);
    }
}
