#include "world/self_contact.h"
#include "base/vec3.h"
#include "solve/element.h"
#include "world/self_pairs.h"
#include <math.h>

static const double KEEP_STEP = 0.1;   /* of a distance, in a step of Newton's        */
static const double KEEP_TRIAL = 0.02; /* in any trial: less, so that steps pass      */

static bool contact_update(void *self, const Point *at)
{
    return self_pairs_update(self, at->x, at->memory);
}

static void lane_of(const Pack *x, int lane, double own[DISTANCE_DOFS])
{
    for (int i = 0; i < DISTANCE_DOFS; i++) own[i] = x[i][lane];
}

static Touch touch_of_lane(const SelfPairs *pairs, int pack, int lane, double stiffness, const Pack *x,
                           double own[DISTANCE_DOFS])
{
    lane_of(x, lane, own);
    return touch_at(pairs->n, &pairs->list, self_pairs_of_lane(pairs, pack, lane), stiffness, own);
}

/* The gap of two boxes, per lane: that of vertices 0 .. second - 1 and that of the others; a NAN where a place is none. */
static Pack gap_square(const Pack *x, int second)
{
    Pack sum = {0}, zero = {0};
    for (int i = 0; i < 3; i++) {
        Pack low[2] = {x[i], x[9 + i]}, high[2] = {x[i], x[9 + i]};
        for (int v = 1; v < 3; v++) {
            int side = v >= second;
            Pack at = x[3 * v + i];
            low[side] = pack_select(at < low[side], at, low[side]);
            high[side] = pack_select(at > high[side], at, high[side]);
        }
        Pack up = low[0] - high[1], down = low[1] - high[0], gap = pack_select(up > down, up, down);
        sum += pack_select(gap < 0, zero, gap) * pack_select(gap < 0, zero, gap);
    }
    for (int i = 0; i < DISTANCE_DOFS; i++) sum += 0 * x[i];
    return sum;
}

/* Which lanes may act: their boxes are nearer than D. */
static PackMask may_act(const SelfPairs *pairs, int pack, const Pack *x)
{
    double D = pairs->n->def.distance;
    int points = pairs->list.points - pack * PACK_LANES;
    PackMask far = {0};
    if (points > 0) far = gap_square(x, 1) >= D * D;
    if (points < PACK_LANES) {
        PackMask edges = gap_square(x, 2) >= D * D;
        for (int l = points > 0 ? points : 0; l < PACK_LANES; l++) far[l] = edges[l];
    }
    return ~far;
}

static Pack contact_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const SelfPairs *pairs = self;
    Pack energy = {0};
    if (g) memset(g, 0, DISTANCE_DOFS * sizeof *g);
    if (H) element_clear(H, DISTANCE_DOFS);
    PackMask near = may_act(pairs, pack, x);
    for (int l = 0; l < PACK_LANES; l++) {
        if (!near[l]) continue;
        double own[DISTANCE_DOFS], slope[DISTANCE_DOFS], curve[DISTANCE_LOWER];
        Touch touch = touch_of_lane(pairs, pack, l, at->p[pairs->n->def.stiffness], x, own);
        if (!touch.acts) continue;
        energy[l] = touch_energy(&touch);
        if (g) touch_slopes(&touch, own, slope, H && !at->convex ? curve : NULL);
        if (H && at->convex) touch_convex(&touch, own, curve);
        for (int i = 0; g && i < DISTANCE_DOFS; i++) g[i][l] = slope[i];
        for (int i = 0; H && i < DISTANCE_LOWER; i++) H[i][l] = curve[i];
    }
    return energy;
}

static void contact_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    (void)at;
    const SelfPairs *pairs = self;
    for (int l = 0; l < lanes; l++) {
        double own[DISTANCE_DOFS], slope[DISTANCE_DOFS];
        Touch touch = touch_of_lane(pairs, pack, l, 1, x, own);
        touch_slopes(&touch, own, slope, NULL);
        for (int i = 0; i < DISTANCE_DOFS; i++) dp[pairs->n->def.stiffness] += slope[i] * w[i][l];
    }
}

static void contact_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    (void)at;
    const SelfPairs *pairs = self;
    for (int l = 0; l < PACK_LANES; l++) {
        double own[DISTANCE_DOFS], slope[DISTANCE_DOFS];
        Touch touch = touch_of_lane(pairs, pack, l, 1, x, own);
        touch_slopes(&touch, own, slope, NULL);
        for (int i = 0; i < DISTANCE_DOFS; i++) r[i][l] = dp[pairs->n->def.stiffness] * slope[i];
    }
}

static double contact_reach(const void *self, const Point *at, const double *d)
{
    const SelfPairs *pairs = self;
    const SelfContactDef *def = &pairs->n->def;
    const double *from = at->x + def->first, *way = d + def->first;
    for (int i = 0; i < 3 * def->vertex_count; i++) pairs->to[i] = from[i] + way[i];
    return self_pairs_reach(pairs, from, pairs->to, KEEP_STEP);
}

/* Held vertices are where they are to be, and what follows from other dofs would be alone in going back: a trial in which
 * these would have to be pulled back is none. */
static void contact_project(const void *self, const double *from, double *x)
{
    const SelfPairs *pairs = self;
    const SelfContactDef *def = &pairs->n->def;
    from += def->first, x += def->first;
    if (self_pairs_reach(pairs, from, x, KEEP_TRIAL) >= 1) return;
    double reach = self_pairs_reach(pairs, from, x, KEEP_STEP);
    for (int i = 0; i < 3 * def->vertex_count; i++) {
        bool held = def->derived || (def->fixed && def->fixed[i] && x[i] != from[i]);
        x[i] = held ? NAN : from[i] + reach * (x[i] - from[i]);
    }
}

/* Newton's way to the end of a step may lead around a rim that the straight way does not. */
static bool contact_passes(const void *self, const Point *at)
{
    const SelfPairs *pairs = self;
    int first = pairs->n->def.first;
    return self_pairs_reach(pairs, at->x_prev + first, at->x + first, KEEP_TRIAL) < 1;
}

static bool contact_convexes(const void *self)
{
    return ((const SelfPairs *)self)->list.count > 0;
}

static const TermOps contact_ops = {
    .name = "self_contact",
    .idles = true,
    .convexes = contact_convexes,
    .count = self_pairs_count,
    .size = self_pairs_size,
    .dofs = self_pairs_dofs,
    .update = contact_update,
    .eval = contact_eval,
    .param = contact_param,
    .param_forward = contact_param_forward,
    .reach = contact_reach,
    .project = contact_project,
    .passes = contact_passes,
    .accept = self_pairs_accept,
    .memory = self_pairs_memory,
    .destroy = self_pairs_destroy,
};

Term self_contact_term(const SelfContactDef *def)
{
    return (Term){&contact_ops, self_pairs_create(def)};
}

SelfContactFigures self_contact_figures(const Term *self_contact, const double *x, double stiffness)
{
    const SelfPairs *pairs = self_contact->self;
    const SelfContactDef *def = &pairs->n->def;
    SelfContactFigures figures = {.distance = INFINITY};
    PairList near = {0};
    neighbours_find(pairs->n, x + def->first, def->distance, &near);
    for (int k = 0; k < near.count; k++) {
        int vertices[4];
        double own[DISTANCE_DOFS];
        neighbours_vertices(pairs->n, &near, k, vertices);
        neighbours_gather(vertices, x + def->first, own);
        Touch touch = touch_at(pairs->n, &near, k, stiffness, own);
        if (!touch.acts) continue;
        figures.pairs++;
        figures.distance = fmin(figures.distance, touch.d);
        figures.force += touch_force(&touch);
    }
    pair_list_clear(&near);
    return figures;
}

double self_contact_nearest(const SelfContactDef *def, const double *x, double parts, int vertices[2])
{
    Neighbours *n = neighbours_create(def);
    PairList near = {0};
    double least = INFINITY;
    neighbours_find(n, x + def->first, parts * def->distance, &near);
    for (int k = 0; k < near.count; k++) {
        int of[4];
        double own[DISTANCE_DOFS];
        neighbours_vertices(n, &near, k, of);
        neighbours_gather(of, x + def->first, own);
        double distance = sqrt(neighbours_distance(n, &near, k)(own).square);
        if (!(distance < least && distance < parts * neighbours_range(n, near.pairs[k], k >= near.points)))
            continue;
        least = distance;
        vertices[0] = of[0], vertices[1] = of[k < near.points ? 1 : 2];
    }
    pair_list_clear(&near);
    neighbours_destroy(n);
    return least;
}

double self_contact_nothing(const SelfContactDef *def)
{
    Box box = box_empty();
    for (int v = 0; v < def->vertex_count; v++) {
        if (def->part && def->part[v] != def->part[0]) return INFINITY;
        box_add(&box, def->rest[v]);
    }
    Vec3 size = vec3_sub(vec3_load(box.high), vec3_load(box.low));
    double distance = def->distance;
    for (int v = 0; def->vertex_outside && v < def->vertex_count; v++)
        distance = fmin(distance, 2 * def->vertex_outside[v]);
    return vec3_length(size) <= SELF_CONTACT_REST * distance ? vec3_length(size) : INFINITY;
}
