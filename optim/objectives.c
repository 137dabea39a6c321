#include "optim/objectives.h"
#include "base/memory.h"
#include <math.h>

typedef struct Vertices {
    int count;
    int *vertices;
    double (*target)[3]; /* NULL for heights             */
    double at;           /* m, of a height that is given */
} Vertices;

static double target_value(const void *self, double weight, const double *x, const double *p, double *dx,
                           double *dp)
{
    (void)p, (void)dp;
    const Vertices *chosen = self;
    double sum = 0;
    for (int k = 0; k < chosen->count; k++)
        for (int i = 0; i < 3; i++) {
            if (isnan(chosen->target[k][i])) continue;
            double distance = x[3 * chosen->vertices[k] + i] - chosen->target[k][i];
            sum += distance * distance;
            if (dx) dx[3 * chosen->vertices[k] + i] += 2 * weight * distance;
        }
    return sum;
}

/* Twice J^T J, as the gradient is 2 J^T r. */
static void target_product(const void *self, double weight, const double *x, const double *p,
                           const double *vx, const double *vp, double *hx, double *hp)
{
    (void)x, (void)p, (void)vp, (void)hp;
    const Vertices *chosen = self;
    for (int k = 0; k < chosen->count; k++)
        for (int i = 0; i < 3; i++) {
            int dof = 3 * chosen->vertices[k] + i;
            if (!isnan(chosen->target[k][i])) hx[dof] += 2 * weight * vx[dof];
        }
}

static double height_value(const void *self, double weight, const double *x, const double *p, double *dx,
                           double *dp)
{
    (void)p, (void)dp;
    const Vertices *chosen = self;
    double sum = 0;
    for (int k = 0; k < chosen->count; k++) {
        int dof = 3 * chosen->vertices[k] + 2;
        sum += x[dof] / chosen->count;
        if (dx) dx[dof] += weight / chosen->count;
    }
    return sum;
}

static void add_height(const Vertices *chosen, double amount, double *dx)
{
    for (int k = 0; k < chosen->count; k++) dx[3 * chosen->vertices[k] + 2] += amount / chosen->count;
}

static double height_at_value(const void *self, double weight, const double *x, const double *p, double *dx,
                              double *dp)
{
    const Vertices *chosen = self;
    double off = height_value(self, 0, x, p, NULL, dp) - chosen->at;
    if (dx) add_height(chosen, 2 * weight * off, dx);
    return off * off;
}

static void height_at_product(const void *self, double weight, const double *x, const double *p,
                              const double *vx, const double *vp, double *hx, double *hp)
{
    (void)x, (void)vp;
    add_height(self, 2 * weight * height_value(self, 0, vx, p, NULL, hp), hx);
}

static void vertices_destroy(void *self)
{
    Vertices *chosen = self;
    mem_free(chosen->vertices);
    mem_free(chosen->target);
    mem_free(chosen);
}

static const ObjectiveOps target_ops = {"target", target_value, target_product, vertices_destroy};
static const ObjectiveOps height_ops = {"height", height_value, NULL, vertices_destroy};
static const ObjectiveOps height_at_ops = {"height", height_at_value, height_at_product, vertices_destroy};

static Vertices *choose(int count, const int *vertices)
{
    Vertices *chosen = mem_alloc(1, sizeof *chosen);
    chosen->count = count;
    chosen->vertices = mem_copy(vertices, (size_t)count, sizeof *vertices);
    return chosen;
}

Objective objective_target(int count, const int *vertices, const double (*target)[3], double weight)
{
    Vertices *chosen = choose(count, vertices);
    chosen->target = mem_copy(target, (size_t)count, sizeof *target);
    return (Objective){&target_ops, chosen, weight, 0, 0};
}

Objective objective_height(int count, const int *vertices, double weight)
{
    return (Objective){&height_ops, choose(count, vertices), weight, 0, 0};
}

Objective objective_height_at(int count, const int *vertices, double at, double weight)
{
    Vertices *chosen = choose(count, vertices);
    chosen->at = at;
    return (Objective){&height_at_ops, chosen, weight, 0, 0};
}
