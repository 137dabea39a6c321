#include "solve/kinetic.h"
#include "base/memory.h"
#include "solve/element.h"
#include "solve/vertex_term.h"

/* Both are c/2 |x - y|^2 with y = x_prev + a v_prev. */
typedef struct Kinetic {
    int vertex_count;
    double *mass; /* [vertex_count]; NULL: damping */
    int damping;  /* first entry in p              */
} Kinetic;

/* c, N/m; 0 in statics. */
static Pack stiffness(const Kinetic *kinetic, int pack, const Point *at)
{
    Pack c = {0};
    for (int l = 0; at->dt > 0 && l < PACK_LANES; l++)
        c[l] = kinetic->mass ? kinetic->mass[vertex_of_lane(kinetic, pack, l)] / (at->dt * at->dt)
                             : at->p[kinetic->damping] / at->dt;
    return c;
}

/* x - y of coordinate i. */
static Pack offset(const Kinetic *kinetic, int pack, const Point *at, int i, Pack x)
{
    for (int l = 0; l < PACK_LANES; l++) {
        int dof = 3 * vertex_of_lane(kinetic, pack, l) + i;
        x[l] -= at->x_prev[dof] + (kinetic->mass ? at->dt * at->v_prev[dof] : 0);
    }
    return x;
}

static Pack kinetic_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    Pack c = stiffness(self, pack, at), energy = {0};
    if (H) element_clear(H, 3);
    for (int i = 0; i < 3; i++) {
        Pack d = at->dt > 0 ? offset(self, pack, at, i, x[i]) : c;
        energy += c * d * d / 2;
        if (g) g[i] = c * d;
        if (H) H[TERM_LOWER(i, i)] = c;
    }
    return energy;
}

static void kinetic_prev(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                         Pack *dv)
{
    (void)x;
    const Kinetic *kinetic = self;
    Pack c = stiffness(kinetic, pack, at), zero = {0};
    for (int i = 0; i < 3; i++) {
        dx[i] = -c * w[i];
        dv[i] = kinetic->mass ? -c * at->dt * w[i] : zero;
    }
}

static void kinetic_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                 const Pack *dv, Pack *r)
{
    (void)x;
    const Kinetic *kinetic = self;
    Pack c = stiffness(kinetic, pack, at);
    for (int i = 0; i < 3; i++) r[i] = -c * (kinetic->mass ? dx[i] + at->dt * dv[i] : dx[i]);
}

/* The force is gamma/dt (x - x_prev). */
static void damping_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    const Kinetic *kinetic = self;
    for (int i = 0; at->dt > 0 && i < 3; i++)
        dp[kinetic->damping] += pack_sum(w[i] * offset(kinetic, pack, at, i, x[i]), lanes) / at->dt;
}

static void damping_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    const Kinetic *kinetic = self;
    for (int i = 0; i < 3; i++)
        r[i] = at->dt > 0 ? dp[kinetic->damping] / at->dt * offset(kinetic, pack, at, i, x[i]) : pack_set(0);
}

static void kinetic_destroy(void *self)
{
    mem_free(((Kinetic *)self)->mass);
    mem_free(self);
}

static const TermOps inertia_ops = {
    .name = "inertia",
    .count = vertex_term_count,
    .size = vertex_term_size,
    .dofs = vertex_term_dofs,
    .eval = kinetic_eval,
    .prev = kinetic_prev,
    .prev_forward = kinetic_prev_forward,
    .destroy = kinetic_destroy,
};

static const TermOps damping_ops = {
    .name = "damping",
    .count = vertex_term_count,
    .size = vertex_term_size,
    .dofs = vertex_term_dofs,
    .eval = kinetic_eval,
    .param = damping_param,
    .param_forward = damping_param_forward,
    .prev = kinetic_prev,
    .prev_forward = kinetic_prev_forward,
    .destroy = kinetic_destroy,
};

Term kinetic_inertia_term(int vertex_count, const double *mass)
{
    Kinetic *kinetic = mem_alloc(1, sizeof *kinetic);
    *kinetic =
        (Kinetic){.vertex_count = vertex_count, .mass = mem_copy(mass, (size_t)vertex_count, sizeof *mass)};
    return (Term){&inertia_ops, kinetic};
}

Term kinetic_damping_term(int vertex_count, int damping)
{
    Kinetic *kinetic = mem_alloc(1, sizeof *kinetic);
    *kinetic = (Kinetic){.vertex_count = vertex_count, .damping = damping};
    return (Term){&damping_ops, kinetic};
}
