#include "world/touch.h"
#include <math.h>
#include <string.h>

static const double PARALLEL = 1e-3; /* of the squared lengths [Li et al. 2020, 5.3] */

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* psi and its derivatives in e = 1 - d/D. */
static void set_potential(Touch *t)
{
    double u = t->d / t->range, e = 1 - u;
    t->psi = e * e * e / (3 * u);
    t->slope = e * e * (1 + 2 * u) / (3 * u * u);
    t->curve = 2 * e * (1 + u + u * u) / (3 * u * u * u);
}

Touch touch_at(const Neighbours *n, const PairList *list, int k, double stiffness,
               const double x[DISTANCE_DOFS])
{
    const int *pair = list->pairs[k];
    Distance at = neighbours_distance(n, list, k)(x);
    double D = neighbours_range(n, pair, k >= list->points), part = D / n->def.distance;
    if (at.square >= D * D) return (Touch){0};
    Touch t = {.acts = true, .edges = k >= list->points, .at = at, .range = D, .d = sqrt(at.square), .m = 1};
    set_potential(&t);
    stiffness *= part * part * part;
    if (!t.edges) {
        t.scale = stiffness * n->vertex_weight[pair[0]];
        return t;
    }
    t.scale = stiffness * (n->edge_weight[pair[0]] + n->edge_weight[pair[1]]) / 2;
    t.parallel = PARALLEL * n->edge_square[pair[0]] * n->edge_square[pair[1]];
    t.m = parallel_weight(x, t.parallel, t.m_slope, 0, NULL);
    return t;
}

double touch_energy(const Touch *t)
{
    return t->acts ? t->scale * t->m * t->psi : 0;
}

double touch_force(const Touch *t)
{
    return t->acts ? t->scale * t->m * t->slope / t->range : 0;
}

void touch_slopes(const Touch *t, const double x[DISTANCE_DOFS], double g[DISTANCE_DOFS],
                  double H[DISTANCE_LOWER])
{
    memset(g, 0, DISTANCE_DOFS * sizeof *g);
    if (H) memset(H, 0, DISTANCE_LOWER * sizeof *H);
    if (!t->acts) return;
    double a = -t->scale * t->slope / (2 * t->range * t->d); /* dE/d(d^2), without m */
    double b = t->scale * (t->curve / t->range + t->slope / t->d) / (4 * t->range * t->at.square),
           s[DISTANCE_DOFS];
    for (int i = 0; i < DISTANCE_DOFS; i++) {
        s[i] = 2 * t->at.w[i / 3] * t->at.c[i % 3];
        g[i] = t->m * a * s[i] + t->scale * t->psi * t->m_slope[i];
    }
    if (!H) return;
    distance_add_hessian(&t->at, x, t->m * b, t->m * a, H);
    if (!t->edges || t->m == 1) return;
    double unused[DISTANCE_DOFS];
    parallel_weight(x, t->parallel, unused, t->scale * t->psi, H);
    for (int i = 0, k = 0; i < DISTANCE_DOFS; i++)
        for (int j = 0; j <= i; j++, k++) H[k] += a * (s[i] * t->m_slope[j] + t->m_slope[i] * s[j]);
}

void touch_convex(const Touch *t, const double x[DISTANCE_DOFS], double H[DISTANCE_LOWER])
{
    double curve = t->scale * t->m * t->curve / (4 * t->range * t->range * t->at.square);
    memset(H, 0, DISTANCE_LOWER * sizeof *H);
    if (t->acts) distance_add_hessian(&t->at, x, curve, 0, H);
}

Grip touch_grip(const Touch *t)
{
    Grip grip = {.N = touch_force(t)};
    memcpy(grip.w, t->at.w, sizeof grip.w);
    for (int i = 0; i < 3; i++) grip.n[i] = t->at.c[i] / t->d;
    return grip;
}

/* dN/dx = along * w n + across * dm/dx */
static void force_slopes(const Touch *t, double *along, double *across)
{
    *along = -t->scale * t->m * t->curve / (t->range * t->range);
    *across = t->scale * t->slope / t->range;
}

/* The part of a vector across the unit vector n. */
static void across(const double n[3], double v[3])
{
    double along = dot(3, n, v);
    for (int i = 0; i < 3; i++) v[i] -= along * n[i];
}

Grip touch_grip_change(const Touch *t, const double x[DISTANCE_DOFS], const double dx[DISTANCE_DOFS])
{
    Grip grip = touch_grip(t), change = {0};
    Slide s = distance_slide(&t->at, x);
    double rate[2] = {dot(DISTANCE_DOFS, s.q[0], dx), dot(DISTANCE_DOFS, s.q[1], dx)}, along, turn;
    double slide[2] = {-(s.inverse[0] * rate[0] + s.inverse[1] * rate[1]),
                       -(s.inverse[1] * rate[0] + s.inverse[2] * rate[1])};
    force_slopes(t, &along, &turn);
    for (int i = 0; i < 3; i++) {
        double c = 0;
        for (int v = 0; v < 4; v++) c += grip.w[v] * dx[3 * v + i];
        change.N += along * grip.n[i] * c;
        change.n[i] = (c + s.t[0][i] * slide[0] + s.t[1][i] * slide[1]) / t->d;
    }
    change.N += turn * dot(DISTANCE_DOFS, t->m_slope, dx);
    across(grip.n, change.n);
    for (int v = 0; v < 4; v++) change.w[v] = t->at.W[0][v] * slide[0] + t->at.W[1][v] * slide[1];
    return change;
}

void touch_grip_back(const Touch *t, const double x[DISTANCE_DOFS], const Grip *to, double dx[DISTANCE_DOFS])
{
    Grip grip = touch_grip(t);
    Slide s = distance_slide(&t->at, x);
    double h[3], rate[2], along, turn;
    for (int i = 0; i < 3; i++) h[i] = to->n[i] / t->d;
    across(grip.n, h);
    for (int k = 0; k < 2; k++) rate[k] = dot(4, t->at.W[k], to->w) + dot(3, s.t[k], h);
    double slide[2] = {s.inverse[0] * rate[0] + s.inverse[1] * rate[1],
                       s.inverse[1] * rate[0] + s.inverse[2] * rate[1]};
    force_slopes(t, &along, &turn);
    for (int i = 0; i < DISTANCE_DOFS; i++)
        dx[i] = grip.w[i / 3] * (h[i % 3] + to->N * along * grip.n[i % 3]) + to->N * turn * t->m_slope[i] -
                slide[0] * s.q[0][i] - slide[1] * s.q[1][i];
}
