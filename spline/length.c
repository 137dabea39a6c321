/* Linewise's strain as printed, of each stroke by its whole length L, L0 the sum of its segments' rest lengths: E = S (L -
 * L0)^2 L/L0^2. It holds no segment: nodes slide along their stroke at no cost, and short strokes collapse as under
 * `stretch`. Its Hessian couples all segments of a stroke. */
#include "spline/length.h"
#include "base/memory.h"
#include "spline/points.h"
#include "spline/terms.h"
#include <math.h>

typedef struct LengthTerm {
    const SplineModel *model;
    SplineHessian hessian;
    SplinePoints points;
    PointForces forces;
    double (*slope)[8]; /* [segments] of a segment's length in its dofs */
    SegmentPairs pairs;
    bool coupled; /* the list, which lasts, was handed out */
} LengthTerm;

/* Of a stroke. */
typedef struct Energy {
    double value, first, second; /* E and its derivatives in L */
} Energy;

static Energy energy_of(double S, double L, double L0)
{
    S /= L0 * L0;
    return (Energy){S * (L - L0) * (L - L0) * L, S * (L - L0) * (3 * L - L0), S * (6 * L - 4 * L0)};
}

static double length_of(const SplinePoints *points, int first, int end)
{
    double L = 0;
    for (int p = first; p < end; p++) L += points->rule->weight[p % points->rule->count] * points->n[p];
    return L;
}

static double rest_of(const SplineModel *model, int stroke)
{
    double rest = 0;
    for (int m = spline_first_segment(model, stroke); m < spline_first_segment(model, stroke + 1); m++)
        rest += model->rest[m];
    return rest;
}

double spline_length_energy(const SplineModel *model, double S, int stroke, const SplinePoints *points)
{
    return energy_of(S, length_of(points, 0, points->count), rest_of(model, stroke)).value;
}

/* block[8][8] = factor times the second derivatives of a segment's length, and its slope. */
static void length_block(const LengthTerm *t, int segment, double factor, double *block, double slope[8])
{
    const SplineRule *rule = t->points.rule;
    memset(block, 0, 64 * sizeof *block);
    memset(slope, 0, 8 * sizeof *slope);
    for (int q = 0; q < rule->count; q++) {
        int p = segment * rule->count + q;
        double n = t->points.n[p], u[2] = {t->points.tx[p] / n, t->points.ty[p] / n};
        for (int k = 0; k < 8; k++) {
            double Tk = rule->weight[q] * rule->first[q][k / 2];
            slope[k] += Tk * u[k % 2];
            for (int l = 0; l < 8; l++)
                block[8 * k + l] +=
                    factor * Tk * rule->first[q][l / 2] * ((k % 2 == l % 2) - u[k % 2] * u[l % 2]) / n;
        }
    }
}

/* A positive one leaves out what bends the energy down. */
static void add_hessian(const LengthTerm *t, int stroke, Energy E, const BulkMatrix *H)
{
    double own[64], block[64];
    int begin = spline_first_segment(t->model, stroke), end = spline_first_segment(t->model, stroke + 1);
    if (t->hessian != SPLINE_EXACT) E.first = fmax(E.first, 0), E.second = fmax(E.second, 0);
    for (int a = begin; a < end; a++) {
        length_block(t, a, E.first, own, t->slope[a]);
        for (int b = t->hessian == SPLINE_OWN ? a : begin; b <= a; b++) {
            for (int k = 0; k < 64; k++)
                block[k] = (a == b ? own[k] : 0) + E.second * t->slope[a][k / 8] * t->slope[b][k % 8];
            spline_add_block(H, t->model, a, b, block);
        }
    }
}

static double length_eval(void *self, const Point *at, double *g, const BulkMatrix *H)
{
    LengthTerm *t = self;
    const SplineModel *model = t->model;
    int Q = t->points.rule->count;
    double energy = 0, S = ((const SplineWeights *)at->p)->length;
    spline_points_update(&t->points, model, at->x);
    for (int k = 0; k < model->stroke_count; k++) {
        int first = Q * spline_first_segment(model, k), end = Q * spline_first_segment(model, k + 1);
        Energy E = energy_of(S, length_of(&t->points, first, end), rest_of(model, k));
        for (int p = first; p < end; p++) t->forces.S[p] = E.first;
        if (H) add_hessian(t, k, E, H);
        energy += E.value;
    }
    if (g) spline_points_add_gradient(&t->points, model, &t->forces, g);
    return energy;
}

static bool length_couple(void *self, const double *x, BulkCoupling *coupling)
{
    LengthTerm *t = self;
    (void)x;
    if (t->coupled) return false;
    t->coupled = true;
    for (int k = 0; k < t->model->stroke_count; k++) {
        int begin = spline_first_segment(t->model, k), end = spline_first_segment(t->model, k + 1);
        for (int a = begin; a < end; a++)
            for (int b = t->hessian == SPLINE_OWN ? a : begin; b <= a; b++) spline_pairs_add(&t->pairs, a, b);
    }
    *coupling = spline_pairs_coupling(&t->pairs, t->model);
    return true;
}

static void length_destroy(void *self)
{
    LengthTerm *t = self;
    spline_points_clear(&t->points);
    point_forces_clear(&t->forces);
    spline_pairs_clear(&t->pairs);
    mem_free(t->slope);
    mem_free(t);
}

static const BulkOps length_ops = {
    .name = "length", .eval = length_eval, .couple = length_couple, .destroy = length_destroy};

Bulk spline_length_bulk(const SplineModel *model, SplineHessian hessian)
{
    LengthTerm *t = mem_alloc(1, sizeof *t);
    *t = (LengthTerm){.model = model,
                      .hessian = hessian,
                      .points = spline_points_create(&model->rule, model->segment_count, 0),
                      .slope = mem_alloc((size_t)model->segment_count, sizeof *t->slope)};
    t->forces = point_forces_create(t->points.count);
    return (Bulk){&length_ops, t};
}
