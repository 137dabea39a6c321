#include "solve/check.h"
#include "base/memory.h"
#include <math.h>

enum { MAX_LOWER = TERM_LOWER(TERM_MAX_DOF, 0) };

typedef struct Worst {
    double error, size;
} Worst;

static void compare(Worst *worst, Pack exact, Pack approximate, int lanes)
{
    for (int l = 0; l < lanes; l++) {
        double error = fabs(exact[l] - approximate[l]);
        worst->error = isfinite(error) ? fmax(worst->error, error) : INFINITY;
        worst->size = fmax(worst->size, fabs(exact[l]));
    }
}

static double ratio(Worst worst)
{
    return worst.error == 0 ? 0 : worst.error / worst.size;
}

/* Central difference of fourth order from values at -2h, -h, h, 2h. */
static Pack difference(const Pack value[4], double h)
{
    return (8 * (value[2] - value[1]) - (value[3] - value[0])) / (12 * h);
}

static const double stencil[4] = {-2, -1, 1, 2};

typedef struct Pair {
    const Term *term;
    const Point *at;
    int pack, lanes, size;
    Pack x[TERM_MAX_DOF], g[TERM_MAX_DOF], H[MAX_LOWER];
} Pair;

static void gather(Pair *p, int count)
{
    for (int l = 0; l < PACK_LANES; l++) {
        int e = p->pack * PACK_LANES + l, dof[TERM_MAX_DOF];
        p->term->ops->dofs(p->term->self, e < count ? e : count - 1, dof);
        for (int i = 0; i < p->size; i++) p->x[i][l] = p->at->x[dof[i]];
    }
    p->lanes = count - p->pack * PACK_LANES < PACK_LANES ? count - p->pack * PACK_LANES : PACK_LANES;
}

static void check_dof(Pair *p, int i, double h, Worst *gradient, Worst *hessian)
{
    const Term *term = p->term;
    Pack keep = p->x[i], E[4], g[4][TERM_MAX_DOF];
    for (int k = 0; k < 4; k++) {
        p->x[i] = keep + stencil[k] * h;
        E[k] = term->ops->eval(term->self, p->pack, p->at, p->x, g[k], NULL);
    }
    p->x[i] = keep;
    compare(gradient, p->g[i], difference(E, h), p->lanes);
    for (int j = 0; j < p->size; j++) {
        Pack column[4];
        for (int k = 0; k < 4; k++) column[k] = g[k][j];
        Pack exact = p->H[i > j ? TERM_LOWER(i, j) : TERM_LOWER(j, i)];
        compare(hessian, exact, difference(column, h), p->lanes);
    }
}

static void check_params(Pair *p, const Params *params, const double *dp, Random *random, Worst *forward, Worst *adjoint)
{
    const TermOps *ops = p->term->ops;
    if (!ops->param_forward) return;
    double *moved = mem_copy(p->at->p, (size_t)params->size, sizeof *moved);
    double *product = mem_alloc((size_t)params->size, sizeof *product);
    Pack r[TERM_MAX_DOF], w[TERM_MAX_DOF], g[4][TERM_MAX_DOF];
    double h = 1e-3;
    Point at = *p->at;
    at.p = moved;
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < params->size; i++) moved[i] = p->at->p[i] + stencil[k] * h * dp[i];
        ops->eval(p->term->self, p->pack, &at, p->x, g[k], NULL);
    }
    ops->param_forward(p->term->self, p->pack, p->at, p->x, dp, r);
    double left = 0, right = 0;
    for (int i = 0; i < p->size; i++) {
        Pack column[4];
        for (int k = 0; k < 4; k++) column[k] = g[k][i];
        compare(forward, r[i], difference(column, h), p->lanes);
        for (int l = 0; l < PACK_LANES; l++) w[i][l] = random_signed(random);
        left += pack_sum(w[i] * r[i], p->lanes);
    }
    ops->param(p->term->self, p->pack, p->lanes, p->at, p->x, w, product);
    for (int i = 0; i < params->size; i++) right += product[i] * dp[i];
    compare(adjoint, pack_set(left), pack_set(right), 1);
    mem_free(moved);
    mem_free(product);
}

/* A random direction, each block scaled by its largest value. */
static double *direction(const Params *params, const double *p, Random *random)
{
    double *dp = mem_alloc((size_t)params->size, sizeof *dp);
    for (int b = 0; b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        int end = block->offset + block->count * block->width;
        double size = 0;
        for (int i = block->offset; i < end; i++) size = fmax(size, fabs(p[i]));
        for (int i = block->offset; i < end; i++) dp[i] = (size > 0 ? size : 1) * random_signed(random);
    }
    return dp;
}

TermError check_term(const Term *term, const Params *params, const Point *at, const double *dof_size, Random *random)
{
    Worst gradient = {0}, hessian = {0}, forward = {0}, adjoint = {0};
    int count = term->ops->count(term->self);
    double *dp = direction(params, at->p, random);
    Pair p = {.term = term, .at = at, .size = term->ops->size(term->self)};
    for (p.pack = 0; p.pack * PACK_LANES < count; p.pack++) {
        gather(&p, count);
        term->ops->eval(term->self, p.pack, at, p.x, p.g, p.H);
        for (int i = 0; i < p.size; i++) check_dof(&p, i, 1e-3 * dof_size[i], &gradient, &hessian);
        check_params(&p, params, dp, random, &forward, &adjoint);
    }
    mem_free(dp);
    return (TermError){ratio(gradient), ratio(hessian), ratio(forward), ratio(adjoint)};
}

typedef struct Dense {
    int n;
    double *entries; /* [n][n] */
} Dense;

static void add_dense(void *self, int row, int column, int n, const double *block)
{
    Dense *dense = self;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            dense->entries[(row + i) * dense->n + column + j] += block[i * n + j];
            if (row != column) dense->entries[(column + j) * dense->n + row + i] += block[i * n + j];
        }
}

/* Energy at x with dof i moved; the gradient goes to g[n]. */
static double moved_bulk(const Bulk *bulk, const Point *at, double *x, int i, double step, Dense g)
{
    double keep = x[i];
    Point moved = *at;
    moved.x = x;
    x[i] += step;
    memset(g.entries, 0, (size_t)g.n * sizeof *g.entries);
    double energy = bulk->ops->eval(bulk->self, &moved, g.entries, NULL);
    x[i] = keep;
    return energy;
}

TermError check_bulk(const Bulk *bulk, const Point *at, int dof_count, double dof_size)
{
    size_t n = (size_t)dof_count;
    double *x = mem_copy(at->x, n, sizeof *x), *g = mem_alloc(5 * n, sizeof *g), h = 1e-3 * dof_size;
    Dense H = {dof_count, mem_alloc(n * n, sizeof(double))};
    Worst gradient = {0}, hessian = {0};
    bulk->ops->eval(bulk->self, at, g, &(BulkMatrix){add_dense, &H});
    for (int i = 0; i < dof_count; i++) {
        Pack E[4] = {{0}}, column[4] = {{0}};
        for (int k = 0; k < 4; k++)
            E[k][0] = moved_bulk(bulk, at, x, i, stencil[k] * h, (Dense){dof_count, g + (size_t)(k + 1) * n});
        compare(&gradient, pack_set(g[i]), difference(E, h), 1);
        for (int j = 0; j < dof_count; j++) {
            for (int k = 0; k < 4; k++) column[k][0] = g[(size_t)(k + 1) * n + (size_t)j];
            compare(&hessian, pack_set(H.entries[j * dof_count + i]), difference(column, h), 1);
        }
    }
    mem_free(x);
    mem_free(g);
    mem_free(H.entries);
    return (TermError){.gradient = ratio(gradient), .hessian = ratio(hessian)};
}
