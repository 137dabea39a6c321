#include "world/water.h"
#include "base/memory.h"
#include "solve/element.h"
#include "world/water_law.h"
#include <assert.h>

static int water_count(const void *self)
{
    return ((const WaterTerm *)self)->count;
}

static int water_size(const void *self)
{
    return 3 * ((const WaterTerm *)self)->law->corners;
}

static void water_dofs(const void *self, int element, int *dof)
{
    const WaterTerm *term = self;
    for (int i = 0; i < water_size(self); i++)
        dof[i] = term->first + 3 * term->law->vertex(term, element, i / 3) + i % 3;
}

/* The elements' own entries of a whole vector. */
static void gather(const WaterTerm *term, int pack, const double *vector, Pack *to)
{
    for (int l = 0; l < PACK_LANES; l++)
        for (int corner = 0; corner < term->law->corners; corner++) {
            int vertex = term->law->vertex(term, water_element(term, pack, l), corner);
            for (int i = 0; i < 3; i++) to[3 * corner + i][l] = vector[term->first + 3 * vertex + i];
        }
}

static Pack3 mean(const WaterTerm *term, const Pack *a)
{
    Pack3 sum = pack3_load(a);
    for (int i = 1; i < term->law->corners; i++) sum = pack3_add(sum, pack3_load(a + 3 * i));
    return pack3_scale(pack_set(1.0 / term->law->corners), sum);
}

/* The same at each corner. */
static void store_corners(const WaterTerm *term, Pack3 v, Pack *to)
{
    for (int i = 0; i < term->law->corners; i++) pack3_store(to + 3 * i, v);
}

/* ---- An element in a step ---- */

typedef struct Moment {
    Pack x[WATER_DOFS];
    Pack3 middle, u; /* where it starts, and the fluid's velocity there */
    Stream s;
    Drag drag;
    Pack3 v; /* the fluid's relative velocity where the step ends */
} Moment;

static Pack3 fluid_velocity(const WaterTerm *term, const Point *at, Pack3 x)
{
    const double *uniform = at->p + term->water.velocity;
    Pack3 u = pack3(pack_set(uniform[0]), pack_set(uniform[1]), pack_set(uniform[2]));
    for (int l = 0; term->water.flow && l < PACK_LANES; l++) {
        double flow[3];
        flux_field_value(term->water.flow, (double[]){x.x[l], x.y[l], x.z[l]}, (FluxPlace){.time = at->time},
                         flow);
        u.x[l] += flow[0], u.y[l] += flow[1], u.z[l] += flow[2];
    }
    return u;
}

/* du/dx, rows du_k/dx. */
static PackMat flow_gradient(const WaterTerm *term, const Point *at, Pack3 x)
{
    PackMat G = pack_mat_diagonal(pack_set(0));
    Pack3 *row[] = {&G.r0, &G.r1, &G.r2};
    for (int l = 0; term->water.flow && l < PACK_LANES; l++) {
        FluxSample sample;
        flux_field_eval(term->water.flow, (double[]){x.x[l], x.y[l], x.z[l]}, (FluxPlace){.time = at->time},
                        &sample);
        for (int k = 0; k < 3; k++)
            row[k]->x[l] = sample.gradient[k][0], row[k]->y[l] = sample.gradient[k][1],
            row[k]->z[l] = sample.gradient[k][2];
    }
    return G;
}

static Stream stream_of(Pack3 direction, Pack3 v)
{
    Stream s = {.size = pack_sqrt(pack3_dot(direction, direction)), .v = v, .V = pack3_dot(v, v)};
    s.inverse = pack_select(s.size > 0, 1 / s.size, pack_set(0));
    s.n = pack3_scale(s.inverse, direction);
    s.q = pack3_dot(s.n, v);
    return s;
}

/* With the numbers in values, which are laid out as p. */
static Drag drag_with(const WaterTerm *term, int pack, const Stream *s, const double *values)
{
    double number[WATER_NUMBERS];
    for (int k = 0; k < term->law->numbers; k++) number[k] = values[term->number[k]];
    return term->law->drag(term, pack, s, number);
}

/* x: elements' dofs where the step ends; NULL: where it starts. */
static Moment moment_at(const WaterTerm *term, int pack, const Point *at, const Pack *x)
{
    Moment m;
    Pack v[WATER_DOFS];
    gather(term, pack, at->x_prev, m.x);
    gather(term, pack, at->v_prev, v);
    m.middle = mean(term, m.x);
    m.u = fluid_velocity(term, at, m.middle);
    m.s = stream_of(term->law->direction(m.x), pack3_sub(m.u, mean(term, v)));
    m.drag = drag_with(term, pack, &m.s, at->p);
    m.v = m.s.v;
    if (x) m.v = pack3_axpy(pack_set(-1 / at->dt), pack3_sub(mean(term, x), m.middle), m.u);
    return m;
}

/* C v */
static Pack3 force_of(const Stream *s, const Drag *drag, Pack3 v)
{
    return pack3_axpy(drag->sigma.value * pack3_dot(s->n, v), s->n, pack3_scale(drag->lambda.value, v));
}

/* ---- Energy ---- */

static bool at_rest(const Point *at)
{
    return !(at->dt > 0) || !at->x_prev;
}

/* d2E/dx_i dx_j = C/(dt corners^2) for all i, j. */
static void hessian(const WaterTerm *term, const Stream *s, const Drag *drag, double dt, Pack *H)
{
    int corners = term->law->corners;
    PackMat C = pack_mat_add(pack_mat_diagonal(drag->lambda.value),
                             pack_mat_outer(pack3_scale(drag->sigma.value, s->n), s->n));
    C = pack_mat_scale(pack_set(1 / (dt * corners * corners)), C);
    for (int i = 0; i < corners; i++) {
        element_add_diagonal(H, i, C);
        for (int j = 0; j < i; j++) element_add_block(H, i, j, C);
    }
}

static Pack water_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const WaterTerm *term = self;
    if (H) element_clear(H, water_size(self));
    if (at_rest(at)) {
        if (g) store_corners(term, (Pack3){0}, g);
        return pack_set(0);
    }
    Moment m = moment_at(term, pack, at, x);
    Pack3 f = force_of(&m.s, &m.drag, m.v);
    if (g) store_corners(term, pack3_scale(pack_set(-1.0 / term->law->corners), f), g);
    if (H) hessian(term, &m.s, &m.drag, at->dt, H);
    return at->dt / 2 * pack3_dot(m.v, f);
}

/* ---- What the forces depend on beside x ----
 *
 * G = W.(C v) = lambda W.v + sigma (n.W) (n.v), W the mean of w over the corners: w.dE/dx = -G. */

/* Derivatives of G to the direction's vector, and to the fluid's relative velocity where the step starts and ends. */
typedef struct Back {
    Pack3 direction, start, end;
} Back;

static Pack3 across(const Stream *s, Pack along, Pack3 a)
{
    return pack3_axpy(-along, s->n, a);
}

static Back back_of(const Stream *s, const Drag *drag, Pack3 v, Pack3 W)
{
    const Slope *l = &drag->lambda, *m = &drag->sigma;
    Pack nW = pack3_dot(s->n, W), nv = pack3_dot(s->n, v), S = pack3_dot(W, v), T = nW * nv;
    Pack size = S * l->size + T * m->size, q = S * l->q + T * m->q, V = S * l->V + T * m->V;
    Pack3 turn = pack3_scale(q, across(s, s->q, s->v));
    turn = pack3_axpy(m->value * nv, across(s, nW, W), turn);
    turn = pack3_axpy(m->value * nW, across(s, nv, v), turn);
    return (Back){.direction = pack3_axpy(s->inverse, turn, pack3_scale(size, s->n)),
                  .start = pack3_axpy(q, s->n, pack3_scale(2 * V, s->v)),
                  .end = force_of(s, drag, W)};
}

static void water_prev(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                       Pack *dv)
{
    const WaterTerm *term = self;
    if (at_rest(at)) {
        store_corners(term, (Pack3){0}, dx), store_corners(term, (Pack3){0}, dv);
        return;
    }
    Moment m = moment_at(term, pack, at, x);
    Back back = back_of(&m.s, &m.drag, m.v, mean(term, w));
    Pack part = pack_set(1.0 / term->law->corners);
    Pack3 move = pack3_scale(pack_set(1 / at->dt), back.end);
    if (term->water.flow)
        move = pack3_add(move,
                         pack_mat_left(pack3_add(back.start, back.end), flow_gradient(term, at, m.middle)));
    store_corners(term, pack3_scale(-part, move), dx);
    term->law->direction_back(m.x, pack3_neg(back.direction), dx);
    store_corners(term, pack3_scale(part, back.start), dv);
}

/* C's change along (direction, start) times v, and C times v's. */
static Pack3 force_rate(const Stream *s, const Drag *drag, Pack3 v, const Back *d)
{
    const Slope *l = &drag->lambda, *m = &drag->sigma;
    Pack size = pack3_dot(s->n, d->direction), nv = pack3_dot(s->n, v);
    Pack3 dn = pack3_scale(s->inverse, across(s, size, d->direction));
    Pack q = pack3_dot(s->n, d->start) + pack3_dot(s->v, dn), V = 2 * pack3_dot(s->v, d->start);
    Pack lambda = l->size * size + l->q * q + l->V * V, sigma = m->size * size + m->q * q + m->V * V;
    Pack3 r = pack3_axpy(lambda, v, force_of(s, drag, d->end));
    r = pack3_axpy(sigma * nv + m->value * pack3_dot(dn, v), s->n, r);
    return pack3_axpy(m->value * nv, dn, r);
}

static void water_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                               const Pack *dv, Pack *r)
{
    const WaterTerm *term = self;
    if (at_rest(at)) {
        store_corners(term, (Pack3){0}, r);
        return;
    }
    Moment m = moment_at(term, pack, at, x);
    Pack3 move = mean(term, dx), flow = {0};
    if (term->water.flow) flow = pack_mat_times(flow_gradient(term, at, m.middle), move);
    Back d = {.direction = term->law->direction_rate(m.x, dx),
              .start = pack3_sub(flow, mean(term, dv)),
              .end = pack3_axpy(pack_set(1 / at->dt), move, flow)};
    Pack3 f = force_rate(&m.s, &m.drag, m.v, &d);
    store_corners(term, pack3_scale(pack_set(-1.0 / term->law->corners), f), r);
}

/* C is linear in the fluid's numbers. */
static void water_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                        double *dp)
{
    const WaterTerm *term = self;
    if (at_rest(at)) return;
    Moment m = moment_at(term, pack, at, x);
    Pack3 W = mean(term, w);
    Back back = back_of(&m.s, &m.drag, m.v, W);
    Pack3 velocity = pack3_add(back.start, back.end);
    double *u = dp + term->water.velocity;
    u[0] -= pack_sum(velocity.x, lanes), u[1] -= pack_sum(velocity.y, lanes),
        u[2] -= pack_sum(velocity.z, lanes);
    for (int k = 0; k < term->law->numbers; k++) {
        double one[WATER_NUMBERS] = {0};
        one[k] = 1;
        Drag unit = term->law->drag(term, pack, &m.s, one);
        dp[term->number[k]] -= pack_sum(pack3_dot(W, force_of(&m.s, &unit, m.v)), lanes);
    }
}

static void water_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                                Pack *r)
{
    const WaterTerm *term = self;
    if (at_rest(at)) {
        store_corners(term, (Pack3){0}, r);
        return;
    }
    Moment m = moment_at(term, pack, at, x);
    Drag change = drag_with(term, pack, &m.s, dp);
    const double *u = dp + term->water.velocity;
    Pack3 du = pack3(pack_set(u[0]), pack_set(u[1]), pack_set(u[2]));
    Pack3 f = force_rate(&m.s, &m.drag, m.v, &(Back){.start = du, .end = du});
    f = pack3_add(f, force_of(&m.s, &change, m.v));
    store_corners(term, pack3_scale(pack_set(-1.0 / term->law->corners), f), r);
}

static void water_destroy(void *self)
{
    mem_free(((WaterTerm *)self)->rods);
    mem_free(self);
}

static const TermOps water_ops = {
    .name = "water",
    .count = water_count,
    .size = water_size,
    .dofs = water_dofs,
    .eval = water_eval,
    .param = water_param,
    .param_forward = water_param_forward,
    .prev = water_prev,
    .prev_forward = water_prev_forward,
    .destroy = water_destroy,
};

double water_power(const Term *of, const State *state, const double *p)
{
    assert(of->ops == &water_ops);
    const WaterTerm *term = of->self;
    Point at = {.p = p, .time = state->time, .x_prev = state->x, .v_prev = state->v};
    double power = 0;
    for (int pack = 0; pack * PACK_LANES < term->count; pack++) {
        Moment m = moment_at(term, pack, &at, NULL);
        int left = term->count - pack * PACK_LANES;
        power -= pack_sum(pack3_dot(force_of(&m.s, &m.drag, m.v), pack3_sub(m.u, m.v)),
                          left < PACK_LANES ? left : PACK_LANES);
    }
    return power;
}

static Term make(WaterTerm term)
{
    WaterTerm *self = mem_alloc(1, sizeof *self);
    *self = term;
    self->number[0] = term.water.density, self->number[1] = term.water.viscosity;
    return (Term){&water_ops, self};
}

Term water_term(const WaterDef *def)
{
    return make((WaterTerm){.law = &water_face_law,
                            .count = def->face_count,
                            .first = def->first,
                            .water = def->water,
                            .faces = def->faces,
                            .outer = def->outer});
}

Term rod_water_term(const RodWaterDef *def)
{
    const double drag = 1.1;
    int each = def->element_count / def->strands;
    RodDrag *rods = mem_alloc((size_t)def->element_count, sizeof *rods);
    for (int e = 0; e < def->element_count; e++) {
        double length = def->length[e / each], slenderness = log(length / def->radius[e]);
        assert(length > ROD_WATER_SLENDER * def->radius[e]);
        rods[e] = (RodDrag){.length = length / each,
                            .along = 2 * M_PI / (slenderness - 0.5),
                            .across = 4 * M_PI / (slenderness + 0.5),
                            .cross = drag * def->radius[e]};
    }
    return make((WaterTerm){.law = &water_rod_law,
                            .count = def->element_count,
                            .first = def->first,
                            .water = def->water,
                            .each = each,
                            .rods = rods});
}
