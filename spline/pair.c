/* Pairs: E = C/2 int int g(|r1 - r2|) dl1 dl2 over all strokes and themselves. g is finite at 0, so that a
 * stroke may act on itself, and ends at R, so that the energy of a drawing does not grow with its size
 * (Linewise's 1/d, PAIR_COULOMB, has neither: all points act on all others of other strokes). */
#include "spline/pair.h"
#include "base/memory.h"
#include "spline/point_cells.h"
#include "spline/terms.h"

typedef struct PairTerm {
    const SplineModel *model;
    SplineHessian hessian;
    double C;
    SplinePoints points;
    PointForces forces;
    PointCells cells;
    double *x, *y; /* [points] where they stood when pairs were listed; NULL: never yet */
    SegmentPairs pairs, own;
    int *stroke;  /* [points] whose they are; NULL: strokes act on themselves */
    bool coupled; /* the present list was handed out */
} PairTerm;

enum { TASK_POINTS = 128 };

static const double MARGIN = 0.2; /* of R: how far points may go before lists are made anew */

/* Takes the points of p's own stroke out of a pack of those from place k on. */
static void leave_own(const PairTerm *t, int p, int k, int count, Pack *dx, Pack *amount)
{
    for (int l = 0; l < count && l < PACK_LANES; l++)
        if (t->stroke[t->cells.point[k + l]] == t->stroke[p]) (*dx)[l] = 1, (*amount)[l] = 0;
}

static void sum_near(const PairTerm *t, int p)
{
    double x = t->points.x[p], y = t->points.y[p], R = t->model->pair_radius;
    Pack S = {0}, sx = S, sy = S;
    for (int row = -1; row <= 1; row++) {
        PointRun run = point_cells_near(&t->cells, x, y, row);
        for (int k = run.first; k < run.end; k += PACK_LANES) {
            Pack dx, dy, amount, first;
            memcpy(&dx, t->cells.x + k, sizeof dx);
            memcpy(&dy, t->cells.y + k, sizeof dy);
            memcpy(&amount, t->cells.amount + k, sizeof amount);
            for (int l = run.end - k; l < PACK_LANES; l++) amount[l] = 0;
            dx = x - dx, dy = y - dy;
            if (t->stroke) leave_own(t, p, k, run.end - k, &dx, &amount);
            Pack g = pair_kernel_pack(t->model->pair_kernel, dx * dx + dy * dy, R, &first);
            S += amount * g;
            sx += amount * 2 * first * dx;
            sy += amount * 2 * first * dy;
        }
    }
    t->forces.S[p] = t->C * pack_sum(S, PACK_LANES);
    t->forces.x[p] = t->C * pack_sum(sx, PACK_LANES);
    t->forces.y[p] = t->C * pack_sum(sy, PACK_LANES);
}

static void sum_task(void *self, int task)
{
    const PairTerm *t = self;
    for (int p = task * TASK_POINTS; p < (task + 1) * TASK_POINTS && p < t->points.count; p++) sum_near(t, p);
}

/* Between points i and j: the Hessian's blocks in (r1, t1, r2, t2) over C w1 w2 go to the segments' dofs. */
typedef struct PointPair {
    const SplineRule *rule;
    int q[2]; /* which points of the rule */
    double n[2], u[2][2], d[2];
    PairValue g;
    bool positive;
} PointPair;

/* d2/dz_a dz_b of g n1 n2 where z is r or t of the sides' points, axes i and j. */
static double second_derivative(const PointPair *p, int side_a, bool t_a, int i, int side_b, bool t_b, int j)
{
    double sign_a = side_a ? -1 : 1, sign_b = side_b ? -1 : 1, *const n = (double *)p->n;
    double I = i == j;
    if (!t_a && !t_b) {
        double K = 4 * p->g.second * p->d[i] * p->d[j] + (p->positive ? 0 : 2 * p->g.first * I);
        return sign_a * sign_b * n[0] * n[1] * K;
    }
    if (t_a && t_b && side_a == side_b)
        return p->g.g * n[!side_a] * (I - p->u[side_a][i] * p->u[side_a][j]) / n[side_a];
    if (p->positive) return 0;
    if (t_a && t_b) return p->g.g * p->u[side_a][i] * p->u[side_b][j];
    if (t_b) return sign_a * 2 * p->g.first * p->d[i] * n[!side_b] * p->u[side_b][j];
    return sign_b * 2 * p->g.first * p->d[j] * n[!side_a] * p->u[side_a][i];
}

/* block[8][8] += scale times the part with the dofs of side a and of side b. */
static void add_part(const PointPair *p, int a, int b, double scale, double *block)
{
    const SplineRule *rule = p->rule;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            double rr = scale * second_derivative(p, a, false, i, b, false, j);
            double rt = scale * second_derivative(p, a, false, i, b, true, j);
            double tr = scale * second_derivative(p, a, true, i, b, false, j);
            double tt = scale * second_derivative(p, a, true, i, b, true, j);
            for (int k = 0; k < 4; k++)
                for (int l = 0; l < 4; l++) {
                    double Na = rule->value[p->q[a]][k], Ta = rule->first[p->q[a]][k];
                    double Nb = rule->value[p->q[b]][l], Tb = rule->first[p->q[b]][l];
                    block[8 * (2 * k + i) + 2 * l + j] +=
                        Na * Nb * rr + Na * Tb * rt + Ta * Nb * tr + Ta * Tb * tt;
                }
        }
}

/* Blocks aa, bb, ab of a pair of segments; of a segment with itself everything is in the first. */
static void pair_blocks(const PairTerm *t, int a, int b, double blocks[3][64])
{
    const SplineRule *rule = t->points.rule;
    const SplinePoints *points = &t->points;
    double R = t->model->pair_radius, reach = t->model->pair_reach;
    memset(blocks, 0, 3 * sizeof *blocks);
    for (int i = 0; i < rule->count; i++)
        for (int j = 0; j < rule->count; j++) {
            int p1 = a * rule->count + i, p2 = b * rule->count + j;
            PointPair p = {.rule = rule,
                           .q = {i, j},
                           .n = {points->n[p1], points->n[p2]},
                           .positive = t->hessian != SPLINE_EXACT};
            p.d[0] = points->x[p1] - points->x[p2], p.d[1] = points->y[p1] - points->y[p2];
            double d2 = p.d[0] * p.d[0] + p.d[1] * p.d[1];
            if (!(d2 < reach * reach)) continue;
            p.u[0][0] = points->tx[p1] / p.n[0], p.u[0][1] = points->ty[p1] / p.n[0];
            p.u[1][0] = points->tx[p2] / p.n[1], p.u[1][1] = points->ty[p2] / p.n[1];
            p.g = pair_kernel_at(t->model->pair_kernel, d2, R);
            double scale = t->C * rule->weight[i] * rule->weight[j] / (a == b ? 2 : 1);
            add_part(&p, 0, 0, scale, blocks[0]);
            add_part(&p, 1, 1, scale, blocks[a == b ? 0 : 1]);
            add_part(&p, 0, 1, scale, blocks[a == b ? 0 : 2]);
            if (a == b) add_part(&p, 1, 0, scale, blocks[0]);
        }
}

static bool has_moved(const PairTerm *t)
{
    double margin = MARGIN * t->model->pair_reach;
    for (int p = 0; p < t->points.count; p++) {
        double dx = t->points.x[p] - t->x[p], dy = t->points.y[p] - t->y[p];
        if (!(4 * (dx * dx + dy * dy) < margin * margin)) return true;
    }
    return false;
}

/* Segments that come within R + margin of one with a lower number; the cells are that large. */
static void list_pairs(PairTerm *t)
{
    int Q = t->points.rule->count, segments = t->model->segment_count;
    double reach = t->cells.size;
    int *mark = mem_alloc((size_t)segments, sizeof *mark);
    for (int p = 0; p < t->points.count; p++)
        for (int row = -1; row <= 1; row++) {
            PointRun run = point_cells_near(&t->cells, t->points.x[p], t->points.y[p], row);
            for (int k = run.first; k < run.end; k++) {
                int m = p / Q, other = t->cells.point[k] / Q;
                double dx = t->cells.x[k] - t->points.x[p], dy = t->cells.y[k] - t->points.y[p];
                if (t->stroke && t->stroke[p] == t->stroke[t->cells.point[k]]) continue;
                if (other > m || mark[other] == m + 1 || dx * dx + dy * dy >= reach * reach) continue;
                mark[other] = m + 1;
                spline_pairs_add(&t->pairs, m, other);
            }
        }
    mem_free(mark);
}

/* Brings the list up to date with points and cells. */
static void couple_now(PairTerm *t)
{
    if (t->x && !has_moved(t)) return;
    size_t count = (size_t)t->points.count;
    mem_free(t->x);
    t->x = mem_alloc(2 * count, sizeof *t->x);
    t->y = t->x + count;
    memcpy(t->x, t->points.x, count * sizeof *t->x);
    memcpy(t->y, t->points.y, count * sizeof *t->y);
    spline_pairs_clear(&t->pairs);
    list_pairs(t);
    if (t->hessian != SPLINE_OWN) t->coupled = false;
}

static void add_hessian(PairTerm *t, const BulkMatrix *H)
{
    double blocks[3][64];
    couple_now(t);
    for (long k = 0; k < t->pairs.count; k++) {
        int a = t->pairs.pairs[k][0], b = t->pairs.pairs[k][1];
        pair_blocks(t, a, b, blocks);
        spline_add_block(H, t->model, a, a, blocks[0]);
        if (a == b) continue;
        spline_add_block(H, t->model, b, b, blocks[1]);
        if (t->hessian != SPLINE_OWN) spline_add_block(H, t->model, a, b, blocks[2]);
    }
}

static void locate(PairTerm *t, const double *x)
{
    spline_points_update(&t->points, t->model, x);
    point_cells_update(&t->cells, &t->points);
}

static double pair_eval(void *self, const Point *at, double *g, const BulkMatrix *H)
{
    PairTerm *t = self;
    const SplineRule *rule = t->points.rule;
    t->C = ((const SplineWeights *)at->p)->pair;
    locate(t, at->x);
    workers_run(t->model->workers, (t->points.count + TASK_POINTS - 1) / TASK_POINTS, sum_task, t);
    double energy = 0;
    for (int p = 0; p < t->points.count; p++)
        energy += rule->weight[p % rule->count] * t->points.n[p] * t->forces.S[p] / 2;
    if (g) spline_points_add_gradient(&t->points, t->model, &t->forces, g);
    if (H) add_hessian(t, H);
    return energy;
}

static bool pair_couple(void *self, const double *x, BulkCoupling *coupling)
{
    PairTerm *t = self;
    locate(t, x);
    couple_now(t);
    if (t->coupled) return false;
    t->coupled = true;
    if (t->hessian != SPLINE_OWN) {
        *coupling = spline_pairs_coupling(&t->pairs, t->model);
        return true;
    }
    for (int m = 0; m < t->model->segment_count; m++) spline_pairs_add(&t->own, m, m);
    *coupling = spline_pairs_coupling(&t->own, t->model);
    return true;
}

static void pair_destroy(void *self)
{
    PairTerm *t = self;
    spline_points_clear(&t->points);
    point_forces_clear(&t->forces);
    point_cells_clear(&t->cells);
    spline_pairs_clear(&t->pairs);
    spline_pairs_clear(&t->own);
    mem_free(t->x);
    mem_free(t->stroke);
    mem_free(t);
}

static const BulkOps pair_ops = {
    .name = "pair", .eval = pair_eval, .couple = pair_couple, .destroy = pair_destroy};

static int *strokes_of_points(const SplinePoints *points, const SplineModel *model)
{
    int *stroke = mem_alloc((size_t)points->count, sizeof *stroke), Q = points->rule->count;
    for (int k = 0; k < model->stroke_count; k++)
        for (int p = Q * spline_first_segment(model, k); p < Q * spline_first_segment(model, k + 1); p++)
            stroke[p] = k;
    return stroke;
}

Bulk spline_pair_bulk(const SplineModel *model, SplineHessian hessian)
{
    PairTerm *t = mem_alloc(1, sizeof *t);
    *t = (PairTerm){.model = model,
                    .hessian = hessian,
                    .points = spline_points_create(&model->rule, model->segment_count, 0)};
    t->forces = point_forces_create(t->points.count);
    t->cells = point_cells_create(&model->target->page, (1 + MARGIN) * model->pair_reach, t->points.count);
    if (!pair_kernel_has_own(model->pair_kernel)) t->stroke = strokes_of_points(&t->points, model);
    return (Bulk){&pair_ops, t};
}
