/* Outline: psi = R n b(d), d the distance to the region's outline, b the barrier of `wall`. A region is no convex
 * page: control points inside say nothing of the curve between them. So b is taken at places on it, half a pen
 * apart (spline_rule_even): what is between two of them is at most a quarter of a pen outside. */
#include "spline/outline.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "spline/walls.h"
#include <math.h>

enum { MARCHES = 60, SAMPLES = 32 };

/* The spline through the distances is steeper than 1 near their ridges, by less than this. */
static const double STEEPEST = 1.25;

/* A move leaves this part of a point's distance, or what is so near to it. */
static const double RESERVE = 0.1, NEAR = 0.11;

static Pack distance_at(const GridSpline *outline, Pack2 at)
{
    GridSample d;
    grid_spline_sample(outline, at, 0, &d);
    return d.value[0];
}

/* ---- The energy ---- */

static Pack outline_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s,
                        int order, Psi *psi)
{
    const SplineTarget *target = term->model->target;
    GridSample d;
    Pack slope, curvature;
    grid_spline_sample(target->outline, s->r, order, &d);
    Barrier b = {.value = wall_barrier(d.value[0], 2 * target->page.pen, &slope, &curvature)};
    if (order > 0) b.slope = pack2_scale(slope, pack2(d.x[0], d.y[0]));
    if (order > 1) wall_curve(&b, slope, curvature, &d, term->positive);
    return wall_psi_of(term, weights->outline, &b, s, order, psi);
}

static int outline_count(const void *self)
{
    return ((const SegmentTerm *)self)->model->target->outline ? segment_term_count(self) : 0;
}

/* The farthest of three places of a segment from its first node, of a pack of them. */
static Pack extent(const Pack *x)
{
    Pack2 way[3] = {{x[2], x[3]}, {x[4] - x[6] - x[0], x[5] - x[7] - x[1]}, {x[4] - x[0], x[5] - x[1]}};
    Pack most = {0};
    for (int k = 0; k < 3; k++) most = pack_max(most, pack2_dot(way[k], way[k]));
    return pack_sqrt(most);
}

static bool is_positive(Pack a)
{
    for (int l = 0; l < PACK_LANES; l++)
        if (!(a[l] > 0)) return false;
    return true;
}

/* Most segments are so far inside that nothing acts on them. */
static Pack outline_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const SegmentTerm *term = self;
    const SplineTarget *target = term->model->target;
    if (target->outline) {
        Pack d = distance_at(target->outline, pack2(x[0], x[1]));
        if (!is_positive(d - STEEPEST * extent(x) - 2 * target->page.pen))
            return segment_term_eval(self, pack, at, x, g, H);
    }
    if (g) memset(g, 0, 8 * sizeof *g);
    if (H) memset(H, 0, TERM_LOWER(8, 0) * sizeof *H);
    return pack_set(0);
}

/* ---- How far a move may go ---- */

typedef struct Way {
    Pack2 from, step;
} Way;

/* The part of a move by which points of a pack stay inside, with a reserve: none gets nearer to the outline by more
 * than it moves, so that steps of the distance are safe [sphere tracing: Hart 1996]. */
static double march(const GridSpline *outline, const Way *way, double most)
{
    Pack length = pack_sqrt(pack2_dot(way->step, way->step)), start = distance_at(outline, way->from);
    Pack part = pack_set(0), limit = pack_set(most);
    for (int k = 0; k < MARCHES; k++) {
        Pack d = distance_at(outline, pack2_axpy(part, way->step, way->from));
        PackMask going = (d > NEAR * start) & (part < limit);
        if (is_positive(pack_select(going, pack_set(-1), pack_set(1)))) break;
        Pack next = part + (d - RESERVE * start) / (STEEPEST * length + 1e-300);
        part = pack_select(going, pack_select(next > limit, limit, next), part);
    }
    for (int l = 0; l < PACK_LANES; l++) most = fmin(most, part[l]);
    return most;
}

/* Points k, k + 1, .. of the rule along a segment; beyond the last one, that again. */
static Pack2 places(const SplineRule *rule, int k, const double *q)
{
    Pack2 r = {{0}, {0}};
    for (int l = 0; l < PACK_LANES; l++) {
        const double *basis = rule->value[k + l < rule->count ? k + l : rule->count - 1];
        for (int i = 0; i < 4; i++) r.x[l] += basis[i] * q[2 * i], r.y[l] += basis[i] * q[2 * i + 1];
    }
    return r;
}

static double allowed_part(const SegmentTerm *term, const double *from, const double *to, double most)
{
    for (int k = 0; k < term->rule->count; k += PACK_LANES) {
        Pack2 a = places(term->rule, k, from), b = places(term->rule, k, to);
        most = march(term->model->target->outline, &(Way){a, {b.x - a.x, b.y - a.y}}, most);
    }
    return most;
}

/* Of a segment's move: how far any of its points can be from its first node, before or after. */
static double reach_of(const double *from, const double *to)
{
    double most = 0;
    for (int k = 0; k < 2; k++) {
        const double *q = k ? to : from;
        const double place[4][2] = {
            {q[0], q[1]}, {q[0] + q[2], q[1] + q[3]}, {q[4] - q[6], q[5] - q[7]}, {q[4], q[5]}};
        for (int i = 0; i < 4; i++) most = fmax(most, hypot(place[i][0] - from[0], place[i][1] - from[1]));
    }
    return most;
}

/* The part of a move that a stroke may take; most of its segments need no look. */
static double stroke_part(const SegmentTerm *term, int first, int last, const double *from, const double *to)
{
    double part = 1;
    for (int node = first; node < last; node += PACK_LANES) {
        Pack2 at = {{0}, {0}};
        for (int l = 0; l < PACK_LANES; l++) {
            const double *q = from + 4 * (node + l < last ? node + l : last - 1);
            at.x[l] = q[0], at.y[l] = q[1];
        }
        Pack d = distance_at(term->model->target->outline, at);
        for (int l = 0; l < PACK_LANES && node + l < last; l++) {
            const double *a = from + 4 * (node + l), *b = to + 4 * (node + l);
            if (!(d[l] > 2 * STEEPEST * reach_of(a, b))) part = allowed_part(term, a, b, part);
        }
    }
    return part;
}

typedef struct Project {
    const SegmentTerm *term;
    const double *from;
    double *x;
} Project;

static void project_task(void *self, int group)
{
    const Project *p = self;
    const SplineModel *model = p->term->model;
    for (int k = model->group[group]; k < model->group[group + 1]; k++)
        wall_shorten(model, k, p->from, p->x,
                     stroke_part(p->term, model->start[k], model->start[k + 1] - 1, p->from, p->x));
}

static void outline_project(const void *self, const double *from, double *x)
{
    const SegmentTerm *term = self;
    if (!term->model->target->outline) return;
    workers_run(term->model->workers, term->model->group_count, project_task, &(Project){term, from, x});
}

static const TermOps outline_ops = {
    .name = "outline",
    .count = outline_count,
    .size = segment_term_size,
    .dofs = segment_term_dofs,
    .eval = outline_eval,
    .project = outline_project,
    .destroy = mem_free,
};

Term spline_outline_term(const SplineModel *model, SplineHessian hessian)
{
    return wall_term_create(&outline_ops, model, &model->outline_rule, hessian, outline_psi);
}

/* ---- Strokes as they are ---- */

static bool is_inside(const GridSpline *outline, double margin, const SplineRule *rule, const double *q)
{
    for (int k = 0; k < rule->count; k += PACK_LANES)
        if (!is_positive(distance_at(outline, places(rule, k, q)) - margin)) return false;
    return true;
}

void spline_outline_cut(const SplineTarget *target, double margin, Strokes *strokes)
{
    if (!target->outline) return;
    SplineRule rule = spline_rule_even(SAMPLES);
    Strokes left = {0};
    for (int k = 0; k < strokes->count; k++) {
        int first = strokes->start[k], end = strokes->start[k + 1];
        for (int node = first; node < end; node++) {
            if (node + 1 < end && is_inside(target->outline, margin, &rule, strokes->q + 4 * node)) continue;
            if (node > first)
                strokes_add(&left, node - first + 1, (const double(*)[4])(strokes->q + 4 * first),
                            strokes->layer[k]);
            first = node + 1;
        }
    }
    strokes_clear(strokes);
    *strokes = left;
}

double spline_outline_depth(const SplineGrid *distance, const SplinePage *page, const Vec2 bezier[4])
{
    double least = INFINITY, d;
    for (int k = 0; k <= SAMPLES; k++) {
        spline_grid_sample(distance, page, cubic_at(bezier, (double)k / SAMPLES), &d);
        least = fmin(least, d);
    }
    return least;
}

double spline_outline_excess(const SplineGrid *distance, const SplinePage *page, const Strokes *strokes)
{
    double most = 0;
    for (int k = 0; k < strokes->count; k++)
        for (int node = strokes->start[k]; node < strokes->start[k + 1] - 1; node++) {
            Vec2 c[4];
            strokes_bezier(strokes, node, c);
            most = fmax(most, -spline_outline_depth(distance, page, c));
        }
    return most;
}
