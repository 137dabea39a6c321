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

/* 0 where both are 0: nothing is said, and nothing depends on it. */
static double ratio(Worst worst)
{
    return worst.error == 0 ? 0 : worst.error / worst.size;
}

/* A term must have something to check. */
static TermError errors_of(double energy, Worst gradient, Worst hessian)
{
    bool idle = energy == 0 && gradient.size == 0 && hessian.size == 0;
    return (TermError){
        .idle = idle, .gradient = idle ? INFINITY : ratio(gradient), .hessian = ratio(hessian)};
}

/* Central difference of fourth order from values at -2h, -h, h, 2h. */
static Pack difference(const Pack value[4], double h)
{
    return (8 * (value[2] - value[1]) - (value[3] - value[0])) / (12 * h);
}

static const double stencil[4] = {-2, -1, 1, 2}, STEP = 1e-3;

/* A vector on which a term may depend beside its x, and a direction in it. */
typedef struct Line {
    int size;
    double *from, *along, *to; /* to = from + a along */
} Line;

static Line line_create(const double *from, int size)
{
    size_t n = (size_t)size;
    return (Line){size, mem_copy(from, n, sizeof *from), mem_alloc(n, sizeof *from),
                  mem_copy(from, n, sizeof *from)};
}

static void line_move(const Line *line, double a)
{
    for (int i = 0; i < line->size; i++) line->to[i] = line->from[i] + a * line->along[i];
}

static void line_clear(Line *line)
{
    mem_free(line->from);
    mem_free(line->along);
    mem_free(line->to);
}

enum { PARAMETERS, START_X, START_V, LAG, LINES };

typedef struct Check {
    const Term *term;
    Random *random;
    Line lines[LINES];
    Point at; /* of the lines where they are now */
    int pack, lanes, size;
    Pack x[TERM_MAX_DOF], g[TERM_MAX_DOF], H[MAX_LOWER];
    double energy; /* largest */
    Worst gradient, hessian, forward, adjoint, prev_forward, prev, lag_forward, lag;
} Check;

/* The pack's own entries of a whole vector. */
static void gather(const Check *c, const double *vector, Pack *to)
{
    int count = c->term->ops->count(c->term->self);
    for (int l = 0; l < PACK_LANES; l++) {
        int e = c->pack * PACK_LANES + l, dof[TERM_MAX_DOF];
        c->term->ops->dofs(c->term->self, e < count ? e : count - 1, dof);
        for (int i = 0; i < c->size; i++) to[i][l] = vector[dof[i]];
    }
}

static void check_dof(Check *c, int i, double h)
{
    const Term *term = c->term;
    Pack keep = c->x[i], E[4], g[4][TERM_MAX_DOF];
    for (int k = 0; k < 4; k++) {
        c->x[i] = keep + stencil[k] * h;
        E[k] = term->ops->eval(term->self, c->pack, &c->at, c->x, g[k], NULL);
    }
    c->x[i] = keep;
    compare(&c->gradient, c->g[i], difference(E, h), c->lanes);
    for (int j = 0; j < c->size; j++) {
        Pack column[4];
        for (int k = 0; k < 4; k++) column[k] = g[k][j];
        Pack exact = c->H[i > j ? TERM_LOWER(i, j) : TERM_LOWER(j, i)];
        compare(&c->hessian, exact, difference(column, h), c->lanes);
    }
}

/* The elements at the point where the check stands. */
static void update(Check *c)
{
    if (c->term->ops->update) c->term->ops->update(c->term->self, &c->at);
}

/* The gradient's change along some of the lines against r; of w, chosen at random, returns w.r. */
static double check_forward(Check *c, int first, int last, const Pack *r, Pack *w, Worst *forward)
{
    Pack g[4][TERM_MAX_DOF];
    double product = 0;
    for (int k = 0; k < 4; k++) {
        for (int n = first; n <= last; n++) line_move(&c->lines[n], stencil[k] * STEP);
        if (first == PARAMETERS) update(c); /* what a term keeps of them */
        c->term->ops->eval(c->term->self, c->pack, &c->at, c->x, g[k], NULL);
    }
    for (int n = first; n <= last; n++) line_move(&c->lines[n], 0);
    if (first == PARAMETERS) update(c);
    for (int i = 0; i < c->size; i++) {
        compare(forward, r[i], difference((Pack[]){g[0][i], g[1][i], g[2][i], g[3][i]}, STEP), c->lanes);
        for (int l = 0; l < PACK_LANES; l++) w[i][l] = random_signed(c->random);
        product += pack_sum(w[i] * r[i], c->lanes);
    }
    return product;
}

/* Functions that are not there say that nothing depends on it: their products are 0. */
static void check_params(Check *c)
{
    const TermOps *ops = c->term->ops;
    const Line *p = &c->lines[PARAMETERS];
    if (!p->size) return;
    Pack r[TERM_MAX_DOF] = {{0}}, w[TERM_MAX_DOF];
    double *product = mem_alloc((size_t)p->size, sizeof *product), sum = 0;
    if (ops->param_forward) ops->param_forward(c->term->self, c->pack, &c->at, c->x, p->along, r);
    double forward = check_forward(c, PARAMETERS, PARAMETERS, r, w, &c->forward);
    if (ops->param) ops->param(c->term->self, c->pack, c->lanes, &c->at, c->x, w, product);
    for (int i = 0; i < p->size; i++) sum += product[i] * p->along[i];
    compare(&c->adjoint, pack_set(forward), pack_set(sum), 1);
    mem_free(product);
}

static void check_prev(Check *c)
{
    const TermOps *ops = c->term->ops;
    Pack dx[TERM_MAX_DOF], dv[TERM_MAX_DOF], r[TERM_MAX_DOF] = {{0}}, w[TERM_MAX_DOF];
    Pack back_x[TERM_MAX_DOF] = {{0}}, back_v[TERM_MAX_DOF] = {{0}};
    double sum = 0;
    gather(c, c->lines[START_X].along, dx);
    gather(c, c->lines[START_V].along, dv);
    if (ops->prev_forward) ops->prev_forward(c->term->self, c->pack, &c->at, c->x, dx, dv, r);
    double forward = check_forward(c, START_X, START_V, r, w, &c->prev_forward);
    if (ops->prev) ops->prev(c->term->self, c->pack, &c->at, c->x, w, back_x, back_v);
    for (int i = 0; i < c->size; i++) sum += pack_sum(back_x[i] * dx[i] + back_v[i] * dv[i], c->lanes);
    compare(&c->prev, pack_set(forward), pack_set(sum), 1);
}

static void check_lag(Check *c)
{
    const TermOps *ops = c->term->ops;
    Pack dx[TERM_MAX_DOF], r[TERM_MAX_DOF] = {{0}}, w[TERM_MAX_DOF], back[TERM_MAX_DOF] = {{0}};
    double sum = 0;
    gather(c, c->lines[LAG].along, dx);
    if (ops->lag_forward) ops->lag_forward(c->term->self, c->pack, &c->at, c->x, dx, r);
    double forward = check_forward(c, LAG, LAG, r, w, &c->lag_forward);
    if (ops->lag) ops->lag(c->term->self, c->pack, &c->at, c->x, w, back);
    for (int i = 0; i < c->size; i++) sum += pack_sum(back[i] * dx[i], c->lanes);
    compare(&c->lag, pack_set(forward), pack_set(sum), 1);
}

/* A random direction, each block scaled by its largest value. */
static void choose_direction(const Params *params, const Line *p, Random *random)
{
    for (int b = 0; b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        int end = block->offset + block->count * block->width;
        double size = 0;
        for (int i = block->offset; i < end; i++) size = fmax(size, fabs(p->from[i]));
        for (int i = block->offset; i < end; i++) p->along[i] = (size > 0 ? size : 1) * random_signed(random);
    }
}

/* A start of the step that is not x, and directions, at the natural sizes of the dofs. */
static void choose_start(Check *c, const double *dof_size)
{
    Line *x = &c->lines[START_X], *v = &c->lines[START_V], *lag = &c->lines[LAG];
    for (int e = 0; e < c->term->ops->count(c->term->self); e++) {
        int dof[TERM_MAX_DOF];
        c->term->ops->dofs(c->term->self, e, dof);
        for (int i = 0; i < c->size; i++) {
            double size = dof_size[i];
            x->from[dof[i]] = c->at.x[dof[i]] + size * random_signed(c->random);
            v->from[dof[i]] = size / c->at.dt * random_signed(c->random);
            x->along[dof[i]] = size * random_signed(c->random);
            v->along[dof[i]] = size / c->at.dt * random_signed(c->random);
        }
    }
    /* Drawn after the start, which stays that of terms that lag nothing. */
    for (int i = 0; i < lag->size; i++) {
        double size = fabs(x->from[i] - lag->from[i]);
        lag->from[i] += size * random_signed(c->random);
        lag->along[i] = size * random_signed(c->random);
    }
    line_move(x, 0);
    line_move(v, 0);
    line_move(lag, 0);
}

static void check_pack(Check *c, const double *dof_size)
{
    const Term *term = c->term;
    int left = term->ops->count(term->self) - c->pack * PACK_LANES;
    c->lanes = left < PACK_LANES ? left : PACK_LANES;
    gather(c, c->at.x, c->x);
    Pack energy = term->ops->eval(term->self, c->pack, &c->at, c->x, c->g, c->H);
    for (int l = 0; l < c->lanes; l++) c->energy = fmax(c->energy, fabs(energy[l]));
    for (int i = 0; i < c->size; i++) check_dof(c, i, STEP * dof_size[i]);
    check_params(c);
    check_prev(c);
    check_lag(c);
}

TermError check_term(const Term *term, const Params *params, const Point *at, int dof_count,
                     const double *dof_size, Random *random)
{
    Check c = {.term = term, .random = random, .at = *at, .size = term->ops->size(term->self)};
    c.lines[PARAMETERS] = line_create(at->p, params->size);
    c.lines[START_X] = line_create(at->x, dof_count);
    c.lines[START_V] = line_create(at->x, dof_count);
    c.lines[LAG] = line_create(at->x, dof_count);
    if (params->size) c.at.p = c.lines[PARAMETERS].to;
    c.at.x_prev = c.lines[START_X].to, c.at.v_prev = c.lines[START_V].to, c.at.x_lag = c.lines[LAG].to;
    if (!(at->dt > 0)) c.at.dt = 1;
    choose_direction(params, &c.lines[PARAMETERS], random);
    update(&c);
    choose_start(&c, dof_size);
    update(&c);
    for (; c.pack * PACK_LANES < term->ops->count(term->self); c.pack++) check_pack(&c, dof_size);
    for (int n = 0; n < LINES; n++) line_clear(&c.lines[n]);
    TermError error = errors_of(c.energy, c.gradient, c.hessian);
    error.forward = ratio(c.forward), error.adjoint = ratio(c.adjoint);
    error.prev_forward = ratio(c.prev_forward), error.prev = ratio(c.prev);
    error.lag_forward = ratio(c.lag_forward), error.lag = ratio(c.lag);
    return error;
}

double check_differences(TermError error)
{
    return fmax(fmax(fmax(error.gradient, error.hessian), fmax(error.forward, error.prev_forward)),
                error.lag_forward);
}

double check_products(TermError error)
{
    return fmax(fmax(error.adjoint, error.prev), error.lag);
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
    double *x = mem_copy(at->x, n, sizeof *x), *g = mem_alloc(5 * n, sizeof *g), h = STEP * dof_size;
    Dense H = {dof_count, mem_alloc(n * n, sizeof(double))};
    Worst gradient = {0}, hessian = {0};
    double energy = bulk->ops->eval(bulk->self, at, g, &(BulkMatrix){add_dense, &H});
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
    return errors_of(energy, gradient, hessian);
}
