#include "solve/element.h"
#include "world/self_pairs.h"
#include <math.h>

/* A pair that slides, at its own places. */
typedef struct Rub {
    Touch touch; /* at x_lag */
    Grip grip;
    double lag[DISTANCE_DOFS], way[DISTANCE_DOFS]; /* way: x - x_prev                   */
    double r[3], along;                            /* sum w way, and its part along n   */
    double u[3], speed;                            /* its part across n, m; |u|/dt      */
    double dt, f0, first, second;                  /* f0, m/s; f1/v, and (f1/v)'/v; s/m, s^3/m^3 */
} Rub;

static double dot3(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool friction_update(void *self, const Point *at)
{
    return self_pairs_update(self, at->dt > 0 ? point_lag(at) : NULL, at->memory);
}

/* f0(v) = v^2/s - v^3/(3 s^2) + s/3 below the slip speed s, v beyond. */
static void set_law(Rub *rub, double slip)
{
    double v = rub->speed;
    bool sticks = v < slip;
    rub->f0 = sticks ? v * v / slip - v * v * v / (3 * slip * slip) + slip / 3 : v;
    rub->first = sticks ? (2 - v / slip) / slip : 1 / v;
    rub->second = v < 1e-12 * slip ? 0 : sticks ? -1 / (slip * slip * v) : -1 / (v * v * v);
}

/* Of a lane; N with stiffness 1. False where it is not there or does not touch. */
static bool rub_of_lane(const SelfPairs *pairs, int pack, int lane, const Point *at, const Pack *x, Rub *rub)
{
    int e = self_pairs_of_lane(pairs, pack, lane);
    self_pairs_gather(pairs, e, point_lag(at), rub->lag);
    rub->touch = touch_at(pairs->n, &pairs->list, e, 1, rub->lag);
    if (!rub->touch.acts) return false;
    rub->grip = touch_grip(&rub->touch);
    self_pairs_gather(pairs, e, at->x_prev, rub->way);
    for (int i = 0; i < DISTANCE_DOFS; i++) rub->way[i] = x[i][lane] - rub->way[i];
    for (int i = 0; i < 3; i++) {
        rub->r[i] = 0;
        for (int v = 0; v < 4; v++) rub->r[i] += rub->grip.w[v] * rub->way[3 * v + i];
    }
    rub->along = dot3(rub->grip.n, rub->r);
    for (int i = 0; i < 3; i++) rub->u[i] = rub->r[i] - rub->along * rub->grip.n[i];
    rub->dt = at->dt;
    rub->speed = sqrt(dot3(rub->u, rub->u)) / at->dt;
    set_law(rub, pairs->n->def.slip_speed);
    return true;
}

/* mu N for stiffness 1. */
static double limit(const Rub *rub, double mu)
{
    return mu * rub->grip.N;
}

/* Force at the pair, for mu N = 1: d(dt f0)/du = f1/v u/dt. */
static void force(const Rub *rub, double F[3])
{
    for (int i = 0; i < 3; i++) F[i] = rub->first * rub->u[i] / rub->dt;
}

/* Its change with u. */
static void force_change(const Rub *rub, const double du[3], double dF[3])
{
    double along = rub->second * dot3(rub->u, du) / (rub->dt * rub->dt);
    for (int i = 0; i < 3; i++) dF[i] = (rub->first * du[i] + along * rub->u[i]) / rub->dt;
}

/* The part across n. */
static void flatten(const Rub *rub, double v[3])
{
    double along = dot3(rub->grip.n, v);
    for (int i = 0; i < 3; i++) v[i] -= along * rub->grip.n[i];
}

/* d2(dt f0)/dr2, 3x3. */
static void curvature(const Rub *rub, double A[3][3])
{
    for (int j = 0; j < 3; j++) {
        double du[3] = {0};
        du[j] = 1;
        flatten(rub, du);
        force_change(rub, du, A[j]);
    }
}

static double factor(const SelfPairs *pairs, const double *p)
{
    return p[pairs->n->def.friction] * p[pairs->n->def.stiffness];
}

static Pack friction_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const SelfPairs *pairs = self;
    Pack energy = {0};
    if (g) memset(g, 0, DISTANCE_DOFS * sizeof *g);
    if (H) element_clear(H, DISTANCE_DOFS);
    for (int l = 0; l < PACK_LANES; l++) {
        Rub rub;
        if (!rub_of_lane(pairs, pack, l, at, x, &rub)) continue;
        double N = limit(&rub, factor(pairs, at->p)), F[3], A[3][3];
        const double *w = rub.grip.w;
        energy[l] = N * rub.dt * rub.f0;
        force(&rub, F);
        for (int i = 0; g && i < DISTANCE_DOFS; i++) g[i][l] = N * w[i / 3] * F[i % 3];
        if (H) curvature(&rub, A);
        for (int i = 0, k = 0; H && i < DISTANCE_DOFS; i++)
            for (int j = 0; j <= i; j++, k++) H[k][l] = N * w[i / 3] * w[j / 3] * A[i % 3][j % 3];
    }
    return energy;
}

/* dE/dx over mu k; 0 where there is none. */
static void slope_of_lane(const SelfPairs *pairs, int pack, int lane, const Point *at, const Pack *x,
                          double slope[DISTANCE_DOFS])
{
    Rub rub;
    double F[3] = {0};
    bool acts = rub_of_lane(pairs, pack, lane, at, x, &rub);
    if (acts) force(&rub, F);
    for (int i = 0; i < DISTANCE_DOFS; i++) slope[i] = acts ? rub.grip.N * rub.grip.w[i / 3] * F[i % 3] : 0;
}

static void friction_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const SelfPairs *pairs = self;
    const SelfContactDef *def = &pairs->n->def;
    for (int l = 0; l < lanes; l++) {
        double slope[DISTANCE_DOFS], sum = 0;
        slope_of_lane(pairs, pack, l, at, x, slope);
        for (int i = 0; i < DISTANCE_DOFS; i++) sum += slope[i] * w[i][l];
        dp[def->friction] += at->p[def->stiffness] * sum;
        dp[def->stiffness] += at->p[def->friction] * sum;
    }
}

static void friction_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const SelfPairs *pairs = self;
    const SelfContactDef *def = &pairs->n->def;
    double change = at->p[def->stiffness] * dp[def->friction] + at->p[def->friction] * dp[def->stiffness];
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[DISTANCE_DOFS];
        slope_of_lane(pairs, pack, l, at, x, slope);
        for (int i = 0; i < DISTANCE_DOFS; i++) r[i][l] = change * slope[i];
    }
}

/* r = -d2E/dx2 . d: x and x_prev stand in E as their difference. */
static void against(const SelfPairs *pairs, int pack, const Point *at, const Pack *x, const Pack *d, Pack *r)
{
    memset(r, 0, DISTANCE_DOFS * sizeof *r);
    for (int l = 0; l < PACK_LANES; l++) {
        Rub rub;
        if (!rub_of_lane(pairs, pack, l, at, x, &rub)) continue;
        double N = limit(&rub, factor(pairs, at->p)), du[3] = {0}, dF[3];
        for (int i = 0; i < DISTANCE_DOFS; i++) du[i % 3] += rub.grip.w[i / 3] * d[i][l];
        flatten(&rub, du);
        force_change(&rub, du, dF);
        for (int i = 0; i < DISTANCE_DOFS; i++) r[i][l] = -N * rub.grip.w[i / 3] * dF[i % 3];
    }
}

static void friction_prev(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                          Pack *dv)
{
    against(self, pack, at, x, w, dx);
    memset(dv, 0, DISTANCE_DOFS * sizeof *dv);
}

static void friction_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                  const Pack *dv, Pack *r)
{
    (void)dv;
    against(self, pack, at, x, dx, r);
}

/* w . dE/dx = mu N V.F with V = sum w_i v_i, v the given vector: its derivatives to N, the weights and n. */
static void friction_lag(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx)
{
    const SelfPairs *pairs = self;
    memset(dx, 0, DISTANCE_DOFS * sizeof *dx);
    for (int l = 0; l < PACK_LANES; l++) {
        Rub rub;
        if (!rub_of_lane(pairs, pack, l, at, x, &rub)) continue;
        double mu = factor(pairs, at->p), N = limit(&rub, mu), V[3] = {0}, F[3], B[3], own[DISTANCE_DOFS];
        for (int i = 0; i < DISTANCE_DOFS; i++) V[i % 3] += rub.grip.w[i / 3] * w[i][l];
        force(&rub, F);
        force_change(&rub, V, B); /* symmetric */
        Grip to = {.N = mu * dot3(V, F)};
        for (int i = 0; i < 3; i++) to.n[i] = -N * (rub.along * B[i] + dot3(B, rub.grip.n) * rub.r[i]);
        flatten(&rub, B);
        for (int i = 0; i < DISTANCE_DOFS; i++)
            to.w[i / 3] += N * (w[i][l] * F[i % 3] + B[i % 3] * rub.way[i]);
        touch_grip_back(&rub.touch, rub.lag, &to, own);
        for (int i = 0; i < DISTANCE_DOFS; i++) dx[i][l] = own[i];
    }
}

static void friction_lag_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                 Pack *r)
{
    const SelfPairs *pairs = self;
    memset(r, 0, DISTANCE_DOFS * sizeof *r);
    for (int l = 0; l < PACK_LANES; l++) {
        Rub rub;
        if (!rub_of_lane(pairs, pack, l, at, x, &rub)) continue;
        double mu = factor(pairs, at->p), N = limit(&rub, mu), du[3] = {0}, F[3], dF[3], own[DISTANCE_DOFS];
        for (int i = 0; i < DISTANCE_DOFS; i++) own[i] = dx[i][l];
        Grip d = touch_grip_change(&rub.touch, rub.lag, own);
        for (int i = 0; i < DISTANCE_DOFS; i++) du[i % 3] += d.w[i / 3] * rub.way[i];
        flatten(&rub, du);
        for (int i = 0; i < 3; i++) du[i] -= rub.along * d.n[i] + dot3(d.n, rub.r) * rub.grip.n[i];
        force(&rub, F);
        force_change(&rub, du, dF);
        for (int i = 0; i < DISTANCE_DOFS; i++)
            r[i][l] = (mu * d.N * rub.grip.w[i / 3] + N * d.w[i / 3]) * F[i % 3] +
                      N * rub.grip.w[i / 3] * dF[i % 3];
    }
}

static const TermOps friction_ops = {
    .name = "self_friction",
    .idles = true,
    .count = self_pairs_count,
    .size = self_pairs_size,
    .dofs = self_pairs_dofs,
    .update = friction_update,
    .eval = friction_eval,
    .param = friction_param,
    .param_forward = friction_param_forward,
    .prev = friction_prev,
    .prev_forward = friction_prev_forward,
    .lag = friction_lag,
    .lag_forward = friction_lag_forward,
    .accept = self_pairs_accept,
    .memory = self_pairs_memory,
    .destroy = self_pairs_destroy,
};

Term self_friction_term(const SelfContactDef *def)
{
    return (Term){&friction_ops, self_pairs_create(def)};
}
