/* Obstacles of a closed form: planes, spheres, cylinders and boxes. */
#include "base/memory.h"
#include "world/obstacle_shapes.h"
#include <math.h>
#include <string.h>

/* A vector's length, and its direction; of one without, any. */
static double direction(const double w[3], double u[3])
{
    const double nothing = 1e-12; /* m */
    double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int i = 0; i < 3; i++) u[i] = length < nothing ? i == 2 : w[i] / length;
    return length < nothing ? 0 : length;
}

static Obstacle make(const ObstacleOps *ops, const void *self, size_t size, const double pivot[3],
                     double feature)
{
    Obstacle obstacle = {.ops = ops, .self = mem_copy(self, 1, size), .feature = feature};
    memcpy(obstacle.pivot, pivot, sizeof obstacle.pivot);
    return obstacle;
}

/* ---- Plane ---- */

typedef struct Plane {
    double point[3], normal[3];
} Plane;

static void plane_gap(const void *self, const double x[3], Gap *gap)
{
    const Plane *plane = self;
    *gap = (Gap){0};
    for (int i = 0; i < 3; i++) {
        gap->value += (x[i] - plane->point[i]) * plane->normal[i];
        gap->gradient[i] = plane->normal[i];
    }
}

static const ObstacleOps plane_ops = {.kind = "plane", .gap = plane_gap, .destroy = mem_free};

Obstacle obstacle_plane(const double point[3], const double normal[3])
{
    Plane plane;
    memcpy(plane.point, point, sizeof plane.point);
    direction(normal, plane.normal);
    return make(&plane_ops, &plane, sizeof plane, point, INFINITY);
}

/* ---- Sphere and cylinder: how far it is from a point or an axis ---- */

typedef struct Round {
    double point[3], axis[3]; /* of a sphere 0 */
    double radius, side;      /* -1: inside is free */
} Round;

/* phi = s (r - R), r = |P (x - c)| with P = I - a a^T: s u, s (P - u u^T)/r. */
static void round_gap(const void *self, const double x[3], Gap *gap)
{
    const Round *round = self;
    double w[3], u[3], along = 0;
    for (int i = 0; i < 3; i++) along += (x[i] - round->point[i]) * round->axis[i];
    for (int i = 0; i < 3; i++) w[i] = x[i] - round->point[i] - along * round->axis[i];
    double r = direction(w, u), bend = r > 0 ? round->side / r : 0;
    gap->value = round->side * (r - round->radius);
    for (int i = 0; i < 3; i++) {
        gap->gradient[i] = round->side * u[i];
        for (int j = 0; j < 3; j++)
            gap->hessian[i][j] = bend * ((i == j) - round->axis[i] * round->axis[j] - u[i] * u[j]);
    }
}

static const ObstacleOps sphere_ops = {.kind = "sphere", .gap = round_gap, .destroy = mem_free};

Obstacle obstacle_sphere(const double center[3], double radius, bool inside)
{
    Round sphere = {.radius = radius, .side = inside ? -1 : 1};
    memcpy(sphere.point, center, sizeof sphere.point);
    return make(&sphere_ops, &sphere, sizeof sphere, center, radius);
}

static const ObstacleOps cylinder_ops = {.kind = "cylinder", .gap = round_gap, .destroy = mem_free};

Obstacle obstacle_cylinder(const double point[3], const double axis[3], double radius, bool inside)
{
    Round cylinder = {.radius = radius, .side = inside ? -1 : 1};
    memcpy(cylinder.point, point, sizeof cylinder.point);
    direction(axis, cylinder.axis);
    return make(&cylinder_ops, &cylinder, sizeof cylinder, point, radius);
}

/* ---- Rounded box ---- */

typedef struct Box {
    double center[3], core[3], rounding; /* the core's halves */
} Box;

/* The distance from the core, whose corners are sharp, less the rounding: q = |x - c| - core, l = |max(q, 0)|. Within the
 * core phi = max q - rounding. */
static void box_gap(const void *self, const double x[3], Gap *gap)
{
    const Box *box = self;
    double q[3], side[3], out[3], u[3];
    int nearest = 0;
    *gap = (Gap){0};
    for (int i = 0; i < 3; i++) {
        side[i] = x[i] < box->center[i] ? -1 : 1;
        q[i] = fabs(x[i] - box->center[i]) - box->core[i];
        out[i] = fmax(q[i], 0);
        if (q[i] > q[nearest]) nearest = i;
    }
    double l = direction(out, u);
    if (l == 0) {
        gap->value = q[nearest] - box->rounding;
        gap->gradient[nearest] = side[nearest];
        return;
    }
    gap->value = l - box->rounding;
    for (int i = 0; i < 3; i++) {
        gap->gradient[i] = side[i] * u[i];
        for (int j = 0; j < 3; j++)
            gap->hessian[i][j] = side[i] * side[j] * ((i == j && q[i] > 0) - u[i] * u[j]) / l;
    }
}

static const ObstacleOps box_ops = {.kind = "box", .gap = box_gap, .destroy = mem_free};

Obstacle obstacle_box(const double center[3], const double half[3], double rounding)
{
    Box box = {.rounding = rounding};
    memcpy(box.center, center, sizeof box.center);
    for (int i = 0; i < 3; i++) box.core[i] = half[i] - rounding;
    return make(&box_ops, &box, sizeof box, center, rounding);
}
