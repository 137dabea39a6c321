#include "solve/lumped.h"
#include "base/memory.h"
#include "solve/element.h"
#include "solve/vertex_term.h"

typedef struct Lumped {
    int vertex_count;
    int block;   /* gravity: first of three numbers in p; load: first of three per vertex */
    Masses mass; /* none of loads                                                         */
} Lumped;

static bool weighs(const Lumped *lumped)
{
    return lumped->mass.count > 0;
}

/* -m times each component of g, of values laid out as p. */
static void weight(const Lumped *lumped, int pack, const double *p, const double *values, Pack force[3])
{
    for (int l = 0; l < PACK_LANES; l++) {
        double mass = masses_at(&lumped->mass, vertex_of_lane(lumped, pack, l), p);
        for (int i = 0; i < 3; i++) force[i][l] = -mass * values[lumped->block + i];
    }
}

static void pull(const Lumped *lumped, int pack, const double *values, Pack force[3])
{
    for (int i = 0; i < 3 * PACK_LANES; i++)
        force[i % 3][i / 3] = -values[lumped->block + 3 * vertex_of_lane(lumped, pack, i / 3) + i % 3];
}

static Pack lumped_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    Pack energy = {0}, slope[3];
    if (weighs(self))
        weight(self, pack, at->p, at->p, slope);
    else
        pull(self, pack, at->p, slope);
    for (int i = 0; i < 3; i++) {
        energy += slope[i] * x[i];
        if (g) g[i] = slope[i];
    }
    if (H) element_clear(H, 3);
    return energy;
}

static void gravity_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    (void)x;
    const Lumped *lumped = self;
    const double *g = at->p + lumped->block;
    for (int l = 0; l < lanes; l++) {
        int vertex = vertex_of_lane(lumped, pack, l);
        double mass = masses_at(&lumped->mass, vertex, at->p), fall = 0;
        for (int i = 0; i < 3; i++) dp[lumped->block + i] -= mass * w[i][l], fall += g[i] * w[i][l];
        masses_add_param(&lumped->mass, vertex, at->p, -fall, dp);
    }
}

static void gravity_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    (void)x;
    const Lumped *lumped = self;
    weight(lumped, pack, at->p, dp, r);
    for (int l = 0; l < PACK_LANES; l++) {
        double change = masses_change(&lumped->mass, vertex_of_lane(lumped, pack, l), at->p, dp);
        for (int i = 0; i < 3; i++) r[i][l] -= change * at->p[lumped->block + i];
    }
}

static void load_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                       double *dp)
{
    (void)at, (void)x;
    const Lumped *lumped = self;
    for (int i = 0; i < 3 * lanes; i++)
        dp[lumped->block + 3 * vertex_of_lane(lumped, pack, i / 3) + i % 3] -= w[i % 3][i / 3];
}

static void load_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                               Pack *r)
{
    (void)at, (void)x;
    pull(self, pack, dp, r);
}

static void lumped_destroy(void *self)
{
    masses_clear(&((Lumped *)self)->mass);
    mem_free(self);
}

#define LUMPED_OPS(row)                                                                                      \
    {                                                                                                        \
        .name = #row, .count = vertex_term_count, .size = vertex_term_size, .dofs = vertex_term_dofs,        \
        .eval = lumped_eval, .param = row##_param, .param_forward = row##_param_forward,                     \
        .destroy = lumped_destroy,                                                                           \
    }

static const TermOps gravity_ops = LUMPED_OPS(gravity);
static const TermOps load_ops = LUMPED_OPS(load);

Term lumped_gravity_term(Masses mass, int gravity)
{
    Lumped *lumped = mem_alloc(1, sizeof *lumped);
    *lumped = (Lumped){mass.count, gravity, mass};
    return (Term){&gravity_ops, lumped};
}

Term lumped_load_term(int vertex_count, int load)
{
    Lumped *lumped = mem_alloc(1, sizeof *lumped);
    *lumped = (Lumped){.vertex_count = vertex_count, .block = load};
    return (Term){&load_ops, lumped};
}
