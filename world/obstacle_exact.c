/* Obstacles of a closed form: planes, spheres, cylinders and boxes. */
#include "base/memory.h"
#include "base/vec3.h"
#include "world/obstacle_shapes.h"
#include "field/surface_patch.h"
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
                     double feature, double inradius)
{
    Obstacle obstacle = {
        .ops = ops, .self = mem_copy(self, 1, size), .feature = feature, .inradius = inradius};
    memcpy(obstacle.motion.pivot, pivot, sizeof obstacle.motion.pivot);
    return obstacle;
}

/* One that ends, so far from its pivot along each axis. */
static Obstacle bounded(Obstacle obstacle, const double half[3])
{
    obstacle.bounded = true;
    memcpy(obstacle.middle, obstacle.motion.pivot, sizeof obstacle.middle);
    memcpy(obstacle.half, half, sizeof obstacle.half);
    return obstacle;
}

/* ---- Closed surfaces: a point for each direction, from those through the cells of a cube's faces ---- */

typedef void DirectionPlace(const void *self, const double direction[3], double x[3]);

typedef struct CubeFace {
    int axis, side;
    DirectionPlace *place;
    const void *self;
} CubeFace;

static void cube_place(const void *self, double u, double v, double x[3])
{
    const CubeFace *face = self;
    double way[3], unit[3];
    way[face->axis] = face->side;
    way[(face->axis + 1) % 3] = tan(M_PI / 4 * (2 * u - 1)); /* cells of nearly equal angles */
    way[(face->axis + 2) % 3] = tan(M_PI / 4 * (2 * v - 1));
    direction(way, unit);
    face->place(face->self, unit, x);
}

static void add_closed(MeshFile *surface, bool inside, DirectionPlace *place, const void *self)
{
    enum { CELLS = 21 }; /* odd: no direction is along an axis's plane */
    for (int k = 0; k < 6; k++) {
        CubeFace face = {k / 2, k % 2 ? 1 : -1, place, self};
        surface_add_patch(surface, (int[2]){CELLS, CELLS}, inside != (face.side < 0), cube_place, &face);
    }
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

/* A square around the middle of the box, as wide as its diagonal. */
typedef struct Square {
    Vec3 middle, first, second;
} Square;

static void square_place(const void *self, double u, double v, double x[3])
{
    const Square *square = self;
    vec3_store(x, vec3_axpy(u - 0.5, square->first, vec3_axpy(v - 0.5, square->second, square->middle)));
}

static void plane_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    const Plane *plane = self;
    Vec3 low = vec3_load(box[0]), high = vec3_load(box[1]), middle = vec3_scale(0.5, vec3_add(low, high)),
         normal = vec3_load(plane->normal);
    double size = vec3_length(vec3_sub(high, low)), first[3], second[3],
           height = vec3_dot(vec3_sub(middle, vec3_load(plane->point)), normal);
    surface_frame(plane->normal, first, second);
    Square square = {vec3_axpy(-height, normal, middle), vec3_scale(size, vec3_load(first)),
                     vec3_scale(size, vec3_load(second))};
    surface_add_patch(surface, (int[2]){8, 8}, false, square_place, &square);
}

static const ObstacleOps plane_ops = {
    .kind = "plane", .gap = plane_gap, .surface = plane_surface, .destroy = mem_free};

Obstacle obstacle_plane(const double point[3], const double normal[3])
{
    Plane plane;
    memcpy(plane.point, point, sizeof plane.point);
    direction(normal, plane.normal);
    return make(&plane_ops, &plane, sizeof plane, point, INFINITY, INFINITY);
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

static void sphere_place(const void *self, const double direction[3], double x[3])
{
    const Round *sphere = self;
    for (int i = 0; i < 3; i++) x[i] = sphere->point[i] + sphere->radius * direction[i];
}

static void sphere_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    const Round *sphere = self;
    (void)box;
    add_closed(surface, sphere->side < 0, sphere_place, self);
}

static const ObstacleOps sphere_ops = {
    .kind = "sphere", .gap = round_gap, .surface = sphere_surface, .destroy = mem_free};

Obstacle obstacle_sphere(const double center[3], double radius, bool inside)
{
    Round sphere = {.radius = radius, .side = inside ? -1 : 1};
    memcpy(sphere.point, center, sizeof sphere.point);
    Obstacle obstacle = make(&sphere_ops, &sphere, sizeof sphere, center, radius, inside ? INFINITY : radius);
    return inside ? obstacle : bounded(obstacle, (double[]){radius, radius, radius});
}

/* From one end of the box to the other. */
typedef struct Bar {
    Vec3 from, along, first, second;
} Bar;

static void bar_place(const void *self, double u, double v, double x[3])
{
    const Bar *bar = self;
    double angle = 2 * M_PI * v;
    vec3_store(x,
               vec3_axpy(u, bar->along,
                         vec3_axpy(cos(angle), bar->first, vec3_axpy(sin(angle), bar->second, bar->from))));
}

static void cylinder_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    const Round *round = self;
    double middle = 0, length = 0, first[3], second[3];
    for (int i = 0; i < 3; i++) {
        middle += ((box[0][i] + box[1][i]) / 2 - round->point[i]) * round->axis[i];
        length += fabs(round->axis[i]) * (box[1][i] - box[0][i]);
    }
    Vec3 axis = vec3_load(round->axis);
    surface_frame(round->axis, first, second);
    Bar bar = {vec3_axpy(middle - length / 2, axis, vec3_load(round->point)), vec3_scale(length, axis),
               vec3_scale(round->radius, vec3_load(first)), vec3_scale(round->radius, vec3_load(second))};
    surface_add_patch(surface, (int[2]){8, 120}, round->side > 0, bar_place, &bar);
}

static const ObstacleOps cylinder_ops = {
    .kind = "cylinder", .gap = round_gap, .surface = cylinder_surface, .destroy = mem_free};

Obstacle obstacle_cylinder(const double point[3], const double axis[3], double radius, bool inside)
{
    Round cylinder = {.radius = radius, .side = inside ? -1 : 1};
    memcpy(cylinder.point, point, sizeof cylinder.point);
    direction(axis, cylinder.axis);
    return make(&cylinder_ops, &cylinder, sizeof cylinder, point, radius, inside ? INFINITY : radius);
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

/* The rounding's normals; no grid line has one along a face, so that those triangles are the faces. */
static void box_place(const void *self, const double direction[3], double x[3])
{
    const Box *box = self;
    for (int i = 0; i < 3; i++)
        x[i] = box->center[i] + copysign(box->core[i], direction[i]) + box->rounding * direction[i];
}

static void box_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    (void)box;
    add_closed(surface, false, box_place, self);
}

static const ObstacleOps box_ops = {
    .kind = "box", .gap = box_gap, .surface = box_surface, .destroy = mem_free};

Obstacle obstacle_box(const double center[3], const double half[3], double rounding)
{
    Box box = {.rounding = rounding};
    memcpy(box.center, center, sizeof box.center);
    for (int i = 0; i < 3; i++) box.core[i] = half[i] - rounding;
    return bounded(make(&box_ops, &box, sizeof box, center, rounding, fmin(half[0], fmin(half[1], half[2]))),
                   half);
}
