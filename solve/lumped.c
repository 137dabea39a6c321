#include "solve/lumped.h"
#include "base/memory.h"
#include "solve/element.h"
#include "solve/vertex_term.h"

typedef struct Lumped {
    int vertex_count;
    int block;    /* gravity: first of three numbers in p; load: first of three per vertex */
    double *mass; /* [vertex_count]; NULL for loads                                        */
} Lumped;

/* The potential's gradient -f of coordinate i, for values laid out as p. */
static Pack slope(const Lumped *lumped, int pack, int i, const double *values)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) {
        int vertex = vertex_of_lane(lumped, pack, l);
        r[l] = lumped->mass ? -lumped->mass[vertex] * values[lumped->block + i]
                            : -values[lumped->block + 3 * vertex + i];
    }
    return r;
}

static Pack lumped_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    Pack energy = {0};
    for (int i = 0; i < 3; i++) {
        Pack force = slope(self, pack, i, at->p);
        energy += force * x[i];
        if (g) g[i] = force;
    }
    if (H) element_clear(H, 3);
    return energy;
}

static void lumped_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                         double *dp)
{
    (void)at, (void)x;
    const Lumped *lumped = self;
    for (int l = 0; l < lanes; l++)
        for (int i = 0; i < 3; i++) {
            int vertex = vertex_of_lane(lumped, pack, l);
            if (lumped->mass)
                dp[lumped->block + i] -= lumped->mass[vertex] * w[i][l];
            else
                dp[lumped->block + 3 * vertex + i] -= w[i][l];
        }
}

static void lumped_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                                 Pack *r)
{
    (void)at, (void)x;
    for (int i = 0; i < 3; i++) r[i] = slope(self, pack, i, dp);
}

static void lumped_destroy(void *self)
{
    mem_free(((Lumped *)self)->mass);
    mem_free(self);
}

#define LUMPED_OPS(row_name)                                                                                 \
    {                                                                                                        \
        .name = row_name, .count = vertex_term_count, .size = vertex_term_size, .dofs = vertex_term_dofs,    \
        .eval = lumped_eval, .param = lumped_param, .param_forward = lumped_param_forward,                   \
        .destroy = lumped_destroy,                                                                           \
    }

static const TermOps gravity_ops = LUMPED_OPS("gravity");
static const TermOps load_ops = LUMPED_OPS("load");

Term lumped_gravity_term(int vertex_count, const double *mass, int gravity)
{
    Lumped *lumped = mem_alloc(1, sizeof *lumped);
    *lumped = (Lumped){vertex_count, gravity, mem_copy(mass, (size_t)vertex_count, sizeof *mass)};
    return (Term){&gravity_ops, lumped};
}

Term lumped_load_term(int vertex_count, int load)
{
    Lumped *lumped = mem_alloc(1, sizeof *lumped);
    *lumped = (Lumped){vertex_count, load, NULL};
    return (Term){&load_ops, lumped};
}
