/* Obstacles of splines through samples: height fields and tubes. */
#include "base/memory.h"
#include "field/cubic_grid.h"
#include "world/obstacle_shapes.h"
#include "field/surface_patch.h"
#include <math.h>
#include <string.h>

/* ---- Height field ---- */

typedef struct HeightField {
    CubicGrid height;
} HeightField;

static void height_field_gap(const void *self, const double x[3], Gap *gap)
{
    const HeightField *field = self;
    cubic_grid_at(&field->height, x, gap);
    gap->value = x[2] - gap->value;
    for (int i = 0; i < 3; i++) {
        gap->gradient[i] = (i == 2) - gap->gradient[i];
        for (int j = 0; j < 3; j++) gap->hessian[i][j] = -gap->hessian[i][j];
    }
}

static void height_field_destroy(void *self)
{
    HeightField *field = self;
    cubic_grid_clear(&field->height);
    mem_free(field);
}

typedef struct Ground {
    const HeightField *field;
    const double (*box)[3];
} Ground;

static void ground_place(const void *self, double u, double v, double x[3])
{
    const Ground *ground = self;
    const double(*box)[3] = ground->box;
    Gap height;
    x[0] = box[0][0] + u * (box[1][0] - box[0][0]);
    x[1] = box[0][1] + v * (box[1][1] - box[0][1]);
    x[2] = 0;
    cubic_grid_at(&ground->field->height, x, &height);
    x[2] = height.value;
}

/* About a cell for each of the field's. */
static void height_field_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    enum { LEAST = 8, LONGEST = 256, MOST = 8192 }; /* cells along a side, and in all */
    const CubicGrid *grid = &((const HeightField *)self)->height;
    Ground ground = {self, box};
    double count[2];
    for (int i = 0; i < 2; i++)
        count[i] = fmin(fmax(ceil((box[1][i] - box[0][i]) / grid->step[i]), LEAST), LONGEST);
    double part = fmin(sqrt(MOST / (count[0] * count[1])), 1);
    surface_add_patch(surface, (int[2]){(int)(part * count[0]), (int)(part * count[1])}, false, ground_place,
                      &ground);
}

static const ObstacleOps height_field_ops = {.kind = "height_field",
                                             .gap = height_field_gap,
                                             .surface = height_field_surface,
                                             .destroy = height_field_destroy};

/* Largest |grad phi|, at four places of each cell along x and y. */
static double steepest_ground(const HeightField *field, const int cells[2], const double low[2],
                              const double step[2])
{
    enum { PER_CELL = 2 };
    double steepest = 1;
    for (int i = 0; i <= PER_CELL * cells[0]; i++)
        for (int j = 0; j <= PER_CELL * cells[1]; j++) {
            double x[3] = {low[0] + i * step[0] / PER_CELL, low[1] + j * step[1] / PER_CELL};
            Gap height;
            cubic_grid_at(&field->height, x, &height);
            steepest = fmax(steepest, hypot(1, hypot(height.gradient[0], height.gradient[1])));
        }
    return steepest;
}

Obstacle obstacle_height_field(const double range[2][2], const int cells[2], const double *height)
{
    int nodes[3] = {cells[0] + 1, cells[1] + 1, 1};
    double step[3] = {(range[1][0] - range[0][0]) / cells[0], (range[1][1] - range[0][1]) / cells[1], 1},
           low[3] = {range[0][0], range[0][1], 0};
    HeightField *field = mem_alloc(1, sizeof *field);
    field->height = cubic_grid_create(nodes, low, step, height, false);
    return (Obstacle){.ops = &height_field_ops,
                      .self = field,
                      .feature = fmin(step[0], step[1]),
                      .inradius = INFINITY,
                      .steepest = steepest_ground(field, cells, low, step),
                      .motion.pivot = {(range[0][0] + range[1][0]) / 2, (range[0][1] + range[1][1]) / 2, 0}};
}

/* ---- Tube ---- */

typedef struct Tube {
    int axis, across[2];
    CubicGrid radius, center[2];
    double range[2];
} Tube;

/* phi = R - d, d = |w - c|, u = (w - c)/d. With J = dw/dx, rows (-c', 1):
 * grad phi = R' e_s - J^T u, H = (R'' + u . c'') e_s e_s^T - J^T (I - u u^T)/d J. */
static void tube_gap(const void *self, const double x[3], Gap *gap)
{
    const Tube *tube = self;
    const double nothing = 1e-12; /* m */
    double s[3] = {x[tube->axis]}, w[2], J[2][3] = {0}, bend[2];
    Gap radius, center;
    cubic_grid_at(&tube->radius, s, &radius);
    for (int k = 0; k < 2; k++) {
        cubic_grid_at(&tube->center[k], s, &center);
        w[k] = x[tube->across[k]] - center.value;
        J[k][tube->axis] = -center.gradient[0];
        J[k][tube->across[k]] = 1;
        bend[k] = center.hessian[0][0];
    }
    double d = sqrt(w[0] * w[0] + w[1] * w[1]), turn = d < nothing ? 0 : 1 / d;
    double u[2] = {d < nothing ? 1 : w[0] / d, d < nothing ? 0 : w[1] / d}, across[3];
    gap->value = radius.value - d;
    for (int i = 0; i < 3; i++) {
        gap->gradient[i] = (i == tube->axis) * radius.gradient[0] - u[0] * J[0][i] - u[1] * J[1][i];
        across[i] = u[0] * J[1][i] - u[1] * J[0][i]; /* I - u u^T = t t^T, t = (-u1, u0) */
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) gap->hessian[i][j] = -turn * across[i] * across[j];
    gap->hessian[tube->axis][tube->axis] += radius.hessian[0][0] + u[0] * bend[0] + u[1] * bend[1];
}

static void tube_destroy(void *self)
{
    Tube *tube = self;
    cubic_grid_clear(&tube->radius);
    for (int k = 0; k < 2; k++) cubic_grid_clear(&tube->center[k]);
    mem_free(tube);
}

static void tube_place(const void *self, double u, double v, double x[3])
{
    const Tube *tube = self;
    double s[3] = {tube->range[0] + u * (tube->range[1] - tube->range[0])}, angle = 2 * M_PI * v;
    Gap radius, center;
    cubic_grid_at(&tube->radius, s, &radius);
    x[tube->axis] = s[0];
    for (int k = 0; k < 2; k++) {
        cubic_grid_at(&tube->center[k], s, &center);
        x[tube->across[k]] = center.value + radius.value * (k ? sin(angle) : cos(angle));
    }
}

static void tube_surface(const void *self, const double box[2][3], MeshFile *surface)
{
    const Tube *tube = self;
    (void)box;
    surface_add_patch(surface, (int[2]){96, 48}, tube->axis == 1, tube_place, self);
}

static const ObstacleOps tube_ops = {
    .kind = "tube", .gap = tube_gap, .surface = tube_surface, .destroy = tube_destroy};

static CubicGrid tube_spline(const Tube *tube, int cells, const double (*sample)[3], int column)
{
    double *values = mem_alloc((size_t)cells + 1, sizeof *values);
    for (int k = 0; k <= cells; k++) values[k] = sample[k][column];
    CubicGrid grid =
        cubic_grid_create((int[3]){cells + 1, 1, 1}, (double[3]){tube->range[0]},
                          (double[3]){(tube->range[1] - tube->range[0]) / cells, 1, 1}, values, column > 0);
    mem_free(values);
    return grid;
}

/* The smallest radius of it, or of a bend of its wall or line; and the largest |grad phi|. */
static double tube_feature(const Tube *tube, double step, int steps, double *steepest)
{
    double feature = INFINITY;
    *steepest = 1;
    for (int k = 0; k <= steps; k++) {
        double s[3] = {tube->range[0] + k * step};
        Gap radius, center[2];
        cubic_grid_at(&tube->radius, s, &radius);
        for (int i = 0; i < 2; i++) cubic_grid_at(&tube->center[i], s, &center[i]);
        double bend = fabs(radius.hessian[0][0]) + hypot(center[0].hessian[0][0], center[1].hessian[0][0]);
        feature = fmin(feature, fmin(radius.value, 1 / bend));
        double lean = hypot(center[0].gradient[0], center[1].gradient[0]);
        *steepest = fmax(*steepest, hypot(1, fabs(radius.gradient[0]) + lean));
    }
    return feature;
}

/* Is it open all along, and beyond its ends? */
static bool check_open(const Tube *tube, double step, int steps, double beyond, Error *err)
{
    double least = INFINITY, at = 0;
    Gap radius;
    for (int k = 0; k <= steps; k++) {
        double s[3] = {tube->range[0] + k * step};
        cubic_grid_at(&tube->radius, s, &radius);
        if (radius.value < least) least = radius.value, at = s[0];
    }
    if (!(least > 0))
        return error_set(err, "the tube's radius is %.3g m at s = %.6g m: it must be positive", least, at);
    for (int k = 0; k < 2; k++) {
        double s[3] = {tube->range[k] + (k ? beyond : -beyond)};
        cubic_grid_at(&tube->radius, s, &radius);
        if (!(radius.value > 0))
            return error_set(err, "the tube closes within a cell beyond s = %.6g m: end its range before",
                             tube->range[k]);
    }
    return true;
}

bool obstacle_tube(int axis, const double range[2], int cells, const double (*sample)[3], Obstacle *obstacle,
                   Error *err)
{
    static const int others[3][2] = {{1, 2}, {0, 2}, {0, 1}};
    Tube *tube = mem_alloc(1, sizeof *tube);
    *tube = (Tube){axis, {others[axis][0], others[axis][1]}, .range = {range[0], range[1]}};
    tube->radius = tube_spline(tube, cells, sample, 0);
    for (int k = 0; k < 2; k++) tube->center[k] = tube_spline(tube, cells, sample, 1 + k);
    *obstacle = (Obstacle){.ops = &tube_ops, .self = tube, .inradius = INFINITY};
    double middle[3] = {(range[0] + range[1]) / 2};
    obstacle->motion.pivot[axis] = middle[0];
    for (int k = 0; k < 2; k++) {
        Gap center;
        cubic_grid_at(&tube->center[k], middle, &center);
        obstacle->motion.pivot[tube->across[k]] = center.value;
    }
    enum { PER_CELL = 4 };
    double cell = (range[1] - range[0]) / cells, step = cell / PER_CELL;
    obstacle->feature = tube_feature(tube, step, cells * PER_CELL, &obstacle->steepest);
    if (check_open(tube, step, cells * PER_CELL, 2 * cell, err)) return true;
    obstacle_clear(obstacle);
    return false;
}
