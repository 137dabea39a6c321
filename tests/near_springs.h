/* near_springs.h - a Term whose elements change: springs that push vertices apart which were nearer than R to each other
 * at the start of the step,
 *
 *     E = k w (d^2 - R^2)^2/(8 R^2),   w = (1 - d_prev^2/R^2)^3 for d_prev < R,
 *
 * k in p. They come and go smoothly, with x_prev. */
#pragma once
#include "base/memory.h"
#include "solve/element.h"
#include <math.h>

typedef struct NearSprings {
    int vertex_count, stiffness; /* first entry in p */
    double radius, reach;        /* reach: no vertex goes further in one step; 0: as far as it likes */
    double *known;               /* [3*vertex_count] the x_prev that the pairs are of */
    bool any_known;
    int count, room, (*pairs)[2];
    int changes; /* how often they have changed */
} NearSprings;

static inline int near_springs_count(const void *self)
{
    return ((const NearSprings *)self)->count;
}

static inline int near_springs_size(const void *self)
{
    (void)self;
    return 6;
}

static inline void near_springs_dofs(const void *self, int e, int *dof)
{
    const NearSprings *s = self;
    for (int i = 0; i < 6; i++) dof[i] = 3 * s->pairs[e][i / 3] + i % 3;
}

static inline double near_springs_square(const double *x, int i, int j)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (x[3 * i + k] - x[3 * j + k]) * (x[3 * i + k] - x[3 * j + k]);
    return sum;
}

static inline void near_springs_add(NearSprings *s, int i, int j)
{
    if (s->count == s->room) {
        s->pairs = mem_resize(s->pairs, (size_t)s->room, 2 * (size_t)s->room + 8, sizeof *s->pairs);
        s->room = 2 * s->room + 8;
    }
    s->pairs[s->count][0] = i, s->pairs[s->count][1] = j;
    s->count++;
}

/* Without a start of a step there are none. */
static inline bool near_springs_update(void *self, const Point *at)
{
    NearSprings *s = self;
    size_t n = 3 * (size_t)s->vertex_count;
    if (!at->x_prev || (s->any_known && !memcmp(at->x_prev, s->known, n * sizeof *s->known))) return false;
    memcpy(s->known, at->x_prev, n * sizeof *s->known);
    s->any_known = true;
    NearSprings before = *s;
    s->count = s->room = 0, s->pairs = NULL;
    for (int i = 0; i < s->vertex_count; i++)
        for (int j = 0; j < i; j++)
            if (near_springs_square(at->x_prev, i, j) < s->radius * s->radius) near_springs_add(s, i, j);
    bool changed = s->count != before.count ||
                   (s->count && memcmp(s->pairs, before.pairs, (size_t)s->count * sizeof *s->pairs));
    s->changes += changed;
    mem_free(before.pairs);
    return changed;
}

/* What a pack's springs are now. */
typedef struct NearPack {
    Pack3 r, r_prev; /* x_i - x_j                  */
    Pack s, u, k;    /* d^2 - R^2, 1 - d_prev^2/R^2 */
} NearPack;

static inline Pack3 near_springs_difference(const NearSprings *s, int pack, const double *x)
{
    Pack3 r;
    for (int l = 0; l < PACK_LANES; l++) {
        int e = pack * PACK_LANES + l;
        const int *pair = s->pairs[e < s->count ? e : s->count - 1];
        r.x[l] = x[3 * pair[0]] - x[3 * pair[1]];
        r.y[l] = x[3 * pair[0] + 1] - x[3 * pair[1] + 1];
        r.z[l] = x[3 * pair[0] + 2] - x[3 * pair[1] + 2];
    }
    return r;
}

static inline NearPack near_springs_pack(const NearSprings *s, int pack, const Point *at, const Pack *x)
{
    double square = s->radius * s->radius;
    NearPack n = {.r = pack3_sub(pack3_load(x), pack3_load(x + 3)),
                  .r_prev = near_springs_difference(s, pack, at->x_prev),
                  .k = pack_set(at->p[s->stiffness])};
    n.s = pack3_dot(n.r, n.r) - square;
    n.u = 1 - pack3_dot(n.r_prev, n.r_prev) / square;
    n.u = pack_select(n.u > 0, n.u, pack_set(0));
    return n;
}

/* Of dE/dx_i over k: w s r/(2 R^2). */
static inline Pack3 near_springs_slope(const NearSprings *s, const NearPack *n, Pack w)
{
    return pack3_scale(w * n->s / (2 * s->radius * s->radius), n->r);
}

static inline Pack near_springs_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g,
                                     Pack *H)
{
    const NearSprings *s = self;
    NearPack n = near_springs_pack(s, pack, at, x);
    double square = s->radius * s->radius;
    Pack w = n.k * n.u * n.u * n.u;
    Pack3 f = near_springs_slope(s, &n, w);
    if (g) pack3_store(g, f), pack3_store(g + 3, pack3_neg(f));
    if (H) {
        PackMat A = pack_mat_add(pack_mat_diagonal(w * n.s / (2 * square)),
                                 pack_mat_outer(pack3_scale(w / square, n.r), n.r));
        element_clear(H, 6);
        element_add_diagonal(H, 0, A);
        element_add_diagonal(H, 1, A);
        element_add_block(H, 1, 0, pack_mat_neg(A));
    }
    return w * n.s * n.s / (8 * square);
}

static inline void near_springs_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                                      const Pack *w, double *dp)
{
    const NearSprings *s = self;
    NearPack n = near_springs_pack(s, pack, at, x);
    Pack3 f = near_springs_slope(s, &n, n.u * n.u * n.u);
    dp[s->stiffness] += pack_sum(pack3_dot(f, pack3_sub(pack3_load(w), pack3_load(w + 3))), lanes);
}

static inline void near_springs_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                              const double *dp, Pack *r)
{
    const NearSprings *s = self;
    NearPack n = near_springs_pack(s, pack, at, x);
    Pack3 f = near_springs_slope(s, &n, dp[s->stiffness] * n.u * n.u * n.u);
    pack3_store(r, f), pack3_store(r + 3, pack3_neg(f));
}

/* dw/dr_prev over k, along which w changes. */
static inline Pack3 near_springs_fall(const NearSprings *s, const NearPack *n)
{
    return pack3_scale(-6 * n->u * n->u / (s->radius * s->radius), n->r_prev);
}

static inline void near_springs_prev(const void *self, int pack, const Point *at, const Pack *x,
                                     const Pack *w, Pack *dx, Pack *dv)
{
    const NearSprings *s = self;
    NearPack n = near_springs_pack(s, pack, at, x);
    Pack3 f = near_springs_slope(s, &n, n.k);
    Pack along = pack3_dot(f, pack3_sub(pack3_load(w), pack3_load(w + 3)));
    Pack3 fall = pack3_scale(along, near_springs_fall(s, &n));
    pack3_store(dx, fall), pack3_store(dx + 3, pack3_neg(fall));
    for (int i = 0; i < 6; i++) dv[i] = pack_set(0);
}

static inline void near_springs_prev_forward(const void *self, int pack, const Point *at, const Pack *x,
                                             const Pack *dx, const Pack *dv, Pack *r)
{
    (void)dv;
    const NearSprings *s = self;
    NearPack n = near_springs_pack(s, pack, at, x);
    Pack dw = pack3_dot(near_springs_fall(s, &n), pack3_sub(pack3_load(dx), pack3_load(dx + 3)));
    Pack3 f = near_springs_slope(s, &n, n.k * dw);
    pack3_store(r, f), pack3_store(r + 3, pack3_neg(f));
}

static inline double near_springs_reach(const void *self, const Point *at, const double *d)
{
    (void)at;
    const NearSprings *s = self;
    double largest = 0;
    for (int i = 0; i < 3 * s->vertex_count; i++) largest = fmax(largest, fabs(d[i]));
    return s->reach > 0 && largest > s->reach ? s->reach / largest : 1;
}

static inline void near_springs_destroy(void *self)
{
    NearSprings *s = self;
    mem_free(s->known);
    mem_free(s->pairs);
    mem_free(s);
}

static const TermOps near_springs_ops = {
    .name = "near_springs",
    .count = near_springs_count,
    .size = near_springs_size,
    .dofs = near_springs_dofs,
    .update = near_springs_update,
    .eval = near_springs_eval,
    .param = near_springs_param,
    .param_forward = near_springs_param_forward,
    .prev = near_springs_prev,
    .prev_forward = near_springs_prev_forward,
    .reach = near_springs_reach,
    .destroy = near_springs_destroy,
};

static inline Term near_springs_term(int vertex_count, double radius, int stiffness)
{
    NearSprings *s = mem_alloc(1, sizeof *s);
    *s = (NearSprings){.vertex_count = vertex_count, .radius = radius, .stiffness = stiffness};
    s->known = mem_alloc(3 * (size_t)vertex_count, sizeof *s->known);
    return (Term){&near_springs_ops, s};
}
