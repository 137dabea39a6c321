#include "solve/kinetic.h"
#include "base/memory.h"
#include "solve/element.h"
#include "solve/vertex_term.h"

/* Both are c/2 |x - y|^2 with y = x_prev + a v_prev. */
typedef struct Kinetic {
    int vertex_count;
    Masses weight; /* or shares of damping, which are fixed */
    int damping;   /* first entry in p; -1: inertia         */
} Kinetic;

static bool is_inertia(const Kinetic *kinetic)
{
    return kinetic->damping < 0;
}

static double weight_of(const Kinetic *kinetic, int pack, int lane, const double *p)
{
    return masses_at(&kinetic->weight, vertex_of_lane(kinetic, pack, lane), p);
}

/* c, N/m; 0 in statics. */
static Pack stiffness(const Kinetic *kinetic, int pack, const Point *at)
{
    Pack c = {0};
    for (int l = 0; at->dt > 0 && l < PACK_LANES; l++)
        c[l] = is_inertia(kinetic) ? weight_of(kinetic, pack, l, at->p) / (at->dt * at->dt)
                                   : weight_of(kinetic, pack, l, at->p) * (at->p[kinetic->damping] / at->dt);
    return c;
}

/* x - y of coordinate i. */
static Pack offset(const Kinetic *kinetic, int pack, const Point *at, int i, Pack x)
{
    for (int l = 0; l < PACK_LANES; l++) {
        int dof = 3 * vertex_of_lane(kinetic, pack, l) + i;
        x[l] -= at->x_prev[dof] + (is_inertia(kinetic) ? at->dt * at->v_prev[dof] : 0);
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
        dv[i] = is_inertia(kinetic) ? -c * at->dt * w[i] : zero;
    }
}

static void kinetic_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                 const Pack *dv, Pack *r)
{
    (void)x;
    const Kinetic *kinetic = self;
    Pack c = stiffness(kinetic, pack, at);
    for (int i = 0; i < 3; i++) r[i] = -c * (is_inertia(kinetic) ? dx[i] + at->dt * dv[i] : dx[i]);
}

/* The force is m/dt^2 (x - y). */
static void inertia_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    const Kinetic *kinetic = self;
    Pack work = {0};
    for (int i = 0; at->dt > 0 && i < 3; i++) work += w[i] * offset(kinetic, pack, at, i, x[i]);
    for (int l = 0; at->dt > 0 && l < lanes; l++)
        masses_add_param(&kinetic->weight, vertex_of_lane(kinetic, pack, l), at->p,
                         work[l] / (at->dt * at->dt), dp);
}

static void inertia_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    const Kinetic *kinetic = self;
    Pack change = {0};
    for (int l = 0; at->dt > 0 && l < PACK_LANES; l++)
        change[l] =
            masses_change(&kinetic->weight, vertex_of_lane(kinetic, pack, l), at->p, dp) / (at->dt * at->dt);
    for (int i = 0; i < 3; i++) r[i] = at->dt > 0 ? change * offset(kinetic, pack, at, i, x[i]) : change;
}

static Pack shares(const Kinetic *kinetic, int pack, const double *p)
{
    Pack share;
    for (int l = 0; l < PACK_LANES; l++) share[l] = weight_of(kinetic, pack, l, p);
    return share;
}

/* The force is share gamma/dt (x - x_prev). */
static void damping_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    const Kinetic *kinetic = self;
    Pack share = shares(kinetic, pack, at->p);
    for (int i = 0; at->dt > 0 && i < 3; i++)
        dp[kinetic->damping] += pack_sum(share * w[i] * offset(kinetic, pack, at, i, x[i]), lanes) / at->dt;
}

static void damping_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    const Kinetic *kinetic = self;
    Pack share = shares(kinetic, pack, at->p);
    for (int i = 0; i < 3; i++)
        r[i] = at->dt > 0 ? share * (dp[kinetic->damping] / at->dt) * offset(kinetic, pack, at, i, x[i])
                          : pack_set(0);
}

static void kinetic_destroy(void *self)
{
    masses_clear(&((Kinetic *)self)->weight);
    mem_free(self);
}

static const TermOps inertia_ops = {
    .name = "inertia",
    .count = vertex_term_count,
    .size = vertex_term_size,
    .dofs = vertex_term_dofs,
    .eval = kinetic_eval,
    .param = inertia_param,
    .param_forward = inertia_param_forward,
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

/* Takes the weights. */
static Term make(const TermOps *ops, Masses weight, int damping)
{
    Kinetic *kinetic = mem_alloc(1, sizeof *kinetic);
    *kinetic = (Kinetic){.vertex_count = weight.count, .weight = weight, .damping = damping};
    return (Term){ops, kinetic};
}

Term kinetic_inertia_term(Masses mass)
{
    return make(&inertia_ops, mass, -1);
}

Term kinetic_damping_term(int vertex_count, const double *share, int damping)
{
    Masses weight = {.count = vertex_count, .fixed = mem_alloc((size_t)vertex_count, sizeof(double))};
    for (int v = 0; v < vertex_count; v++) weight.fixed[v] = share ? share[v] : 1;
    return make(&damping_ops, weight, damping);
}
