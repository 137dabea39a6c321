/* Friction with obstacles; and what contact does in all, for results. */
#include "base/memory.h"
#include "world/contact_private.h"
#include <string.h>

/* One sample against one obstacle, lagged: the friction coefficient times the normal force, the plane, and how both change
 * with the place that they are of; and how far the obstacle moves there in the step. */
typedef struct Grip {
    double force, unit;           /* N: with the coefficient, and without       */
    double normal[3], carried[3]; /* carried: m                                 */
    double swell;                 /* d unit/d offset, N/m                       */
    double fall[3];               /* d unit/d place, N/m                        */
    double tilt[3][3];            /* d normal/d place, 1/m                      */
    double turned[3][3];          /* d carried/d place                          */
} Grip;

static void carry(const Contact *c, int k, const Point *at, const double place[3], Grip *grip)
{
    const RigidPose *lag = &poses_lag(&c->poses, at)[k], *end = &c->poses.end[k], *start = &c->poses.start[k];
    double turn[3][3], own[3];
    for (int i = 0; i < 3; i++) {
        own[i] = 0;
        for (int j = 0; j < 3; j++) {
            own[i] += lag->turn[j][i] * (place[j] - lag->shift[j]);
            turn[i][j] = end->turn[i][j] - start->turn[i][j];
        }
    }
    for (int i = 0; i < 3; i++) {
        grip->carried[i] = end->shift[i] - start->shift[i];
        for (int j = 0; j < 3; j++) {
            grip->carried[i] += turn[i][j] * own[j];
            grip->turned[i][j] = 0;
            for (int m = 0; m < 3; m++) grip->turned[i][j] += turn[i][m] * lag->turn[j][m];
        }
    }
}

/* Of sample e at a place; false where they do not touch. */
static bool grip_at(const Contact *c, int k, const Point *at, int e, const double place[3], Grip *grip)
{
    Gap gap;
    const RigidPose *pose = &poses_lag(&c->poses, at)[k];
    if (contact_is_beyond(c, k, pose, e, place)) return false;
    obstacle_gap(&c->def.obstacles[k], pose, place, &gap);
    double depth = c->offset[e] - gap.value, size = 0;
    if (depth <= 0) return false;
    Penalty penalty = penalty_at(depth, c->smoothing[e], at->p[c->def.stiffness]);
    for (int i = 0; i < 3; i++) size += gap.gradient[i] * gap.gradient[i];
    size = sqrt(size);
    if (size == 0) return false; /* in the very middle of a solid, which has no plane */
    grip->unit = penalty.force * size;
    grip->swell = c->def.outside ? penalty_of_offset(&c->def, &penalty) * size : 0;
    grip->force = at->p[c->def.friction + k] * grip->unit;
    for (int i = 0; i < 3; i++) grip->normal[i] = gap.gradient[i] / size;
    for (int i = 0; i < 3; i++) {
        double along = 0;
        for (int j = 0; j < 3; j++) along += gap.hessian[i][j] * grip->normal[j];
        grip->fall[i] = -penalty.slope * size * gap.gradient[i] + penalty.force * along;
        for (int j = 0; j < 3; j++) {
            double pull = 0;
            for (int m = 0; m < 3; m++) pull += grip->normal[m] * gap.hessian[m][j];
            grip->tilt[i][j] = (gap.hessian[i][j] - grip->normal[i] * pull) / size;
        }
    }
    carry(c, k, at, place, grip);
    return true;
}

/* A sample in its step: where it is, and where the lagged quantities are taken. */
typedef struct Moved {
    int pack, lane, sample;
    double now[3], lag[3];
} Moved;

static Moved moved(const Contact *c, int pack, int lane, const Point *at, Pack3 place)
{
    Moved m = {pack, lane, contact_sample(c, pack, lane), {0}, {0}};
    samples_place(&c->def.samples, pack, lane, point_lag(at), m.lag);
    lane_get(place, lane, m.now);
    return m;
}

/* The slip u/dt over the plane, and of the force f(y) u/y on its speed y. */
typedef struct Slip {
    double v[3], u[3]; /* m/s: all of it, and its part in the plane    */
    double psi, fall;  /* f1(y)/y, and (d psi/dy)/y                    */
    double potential;  /* f0(y), m/s                                   */
} Slip;

static Slip slip_at(const Contact *c, const Grip *grip, const Moved *m, const Point *at)
{
    Slip s;
    double normal = 0, square = 0, v = c->def.slip_speed, before[3];
    samples_place(&c->def.samples, m->pack, m->lane, at->x_prev, before);
    for (int i = 0; i < 3; i++) {
        s.v[i] = (m->now[i] - before[i] - grip->carried[i]) / at->dt;
        normal += s.v[i] * grip->normal[i];
    }
    for (int i = 0; i < 3; i++) {
        s.u[i] = s.v[i] - normal * grip->normal[i];
        square += s.u[i] * s.u[i];
    }
    double y = sqrt(square);
    if (y < v) {
        s.psi = (2 - y / v) / v;
        s.fall = y > 1e-12 * v ? -1 / (v * v * y) : 0; /* there it meets u u^T, which is nothing */
        s.potential = y * y / v * (1 - y / (3 * v)) + v / 3;
    } else {
        s.psi = 1 / y;
        s.fall = -1 / (y * y * y);
        s.potential = y;
    }
    return s;
}

/* The matrix psi I + fall u u^T times b. */
static void slip_times(const Slip *s, const double b[3], double out[3])
{
    double along = s->u[0] * b[0] + s->u[1] * b[1] + s->u[2] * b[2];
    for (int i = 0; i < 3; i++) out[i] = s->psi * b[i] + s->fall * along * s->u[i];
}

static double rub(const Contact *c, const Point *at, const Moved *m, double g[3], double H[3][3])
{
    double energy = 0;
    for (int i = 0; i < 3; i++) g[i] = 0;
    for (int i = 0; H && i < 9; i++) H[i / 3][i % 3] = 0;
    for (int k = 0; k < c->def.obstacle_count; k++) {
        Grip grip;
        if (!grip_at(c, k, at, m->sample, m->lag, &grip)) continue;
        Slip s = slip_at(c, &grip, m, at);
        energy += at->dt * grip.force * s.potential;
        for (int i = 0; i < 3; i++) {
            g[i] += grip.force * s.psi * s.u[i];
            for (int j = 0; H && j < 3; j++)
                H[i][j] += grip.force / at->dt *
                           (s.psi * ((i == j) - grip.normal[i] * grip.normal[j]) + s.fall * s.u[i] * s.u[j]);
        }
    }
    return energy;
}

static Pack friction_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Contact *c = self;
    int dofs = 3 * c->def.samples.corners;
    if (!(at->dt > 0)) {
        for (int i = 0; g && i < dofs; i++) g[i] = pack_set(0);
        if (H) element_clear(H, dofs);
        return pack_set(0);
    }
    Pack3 place = samples_mean(&c->def.samples, x), force;
    Pack energy;
    PackMat A;
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[3], stiffness[3][3];
        Moved m = moved(c, pack, l, at, place);
        energy[l] = rub(c, at, &m, slope, H ? stiffness : NULL);
        lane_put(&force, l, slope);
        if (H) lane_put_matrix(&A, l, stiffness);
    }
    if (g) samples_spread(&c->def.samples, force, g);
    if (H) samples_spread_matrix(&c->def.samples, A, H);
    return energy;
}

/* ---- What else it depends on ---- */

/* d2E/dx dx_prev is the Hessian with the other sign. */
static Pack3 hessian_times(const Contact *c, int pack, const Point *at, const Pack *x, Pack3 b)
{
    Pack3 place = samples_mean(&c->def.samples, x), r;
    for (int l = 0; l < PACK_LANES; l++) {
        double g[3], H[3][3], from[3], out[3] = {0};
        Moved m = moved(c, pack, l, at, place);
        rub(c, at, &m, g, H);
        lane_get(b, l, from);
        for (int i = 0; i < 9; i++) out[i / 3] += H[i / 3][i % 3] * from[i % 3];
        lane_put(&r, l, out);
    }
    return r;
}

static void friction_prev(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                          Pack *dv)
{
    const Contact *c = self;
    Pack3 r = hessian_times(c, pack, at, x, samples_mean(&c->def.samples, w));
    samples_spread(&c->def.samples, pack3_neg(r), dx);
    for (int i = 0; i < 3 * c->def.samples.corners; i++) dv[i] = pack_set(0);
}

static void friction_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                  const Pack *dv, Pack *r)
{
    (void)dv;
    const Contact *c = self;
    Pack3 out = hessian_times(c, pack, at, x, samples_mean(&c->def.samples, dx));
    samples_spread(&c->def.samples, pack3_neg(out), r);
}

/* L b, or L^T b, with L = dF/d lag of the force F on a sample:
 *     F = force psi u,   u = (I - n n^T) v,   du = -(n (v.tilt) + (n.v) tilt) d lag - (I - n n^T) turned d lag/dt. */
static void lag_times(const Contact *c, const Point *at, const Moved *m, bool transposed, const double b[3],
                      double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = 0;
    for (int k = 0; k < c->def.obstacle_count; k++) {
        Grip grip;
        if (!grip_at(c, k, at, m->sample, m->lag, &grip)) continue;
        Slip s = slip_at(c, &grip, m, at);
        double mu = at->p[c->def.friction + k], normal = 0, du[3][3], L[3][3];
        for (int i = 0; i < 3; i++) normal += grip.normal[i] * s.v[i];
        for (int j = 0; j < 3; j++) {
            double tilt = 0, turned = 0;
            for (int i = 0; i < 3; i++) {
                tilt += s.v[i] * grip.tilt[i][j];
                turned += grip.normal[i] * grip.turned[i][j];
            }
            for (int i = 0; i < 3; i++)
                du[i][j] = -grip.normal[i] * tilt - normal * grip.tilt[i][j] -
                           (grip.turned[i][j] - grip.normal[i] * turned) / at->dt;
        }
        for (int j = 0; j < 3; j++) {
            double column[3] = {du[0][j], du[1][j], du[2][j]}, f[3];
            slip_times(&s, column, f);
            for (int i = 0; i < 3; i++) L[i][j] = grip.force * f[i] + mu * s.psi * s.u[i] * grip.fall[j];
        }
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) out[i] += (transposed ? L[j][i] : L[i][j]) * b[j];
    }
}

static Pack3 lag_product(const Contact *c, int pack, const Point *at, const Pack *x, bool transposed, Pack3 b)
{
    Pack3 place = samples_mean(&c->def.samples, x), r;
    for (int l = 0; l < PACK_LANES; l++) {
        double from[3], out[3];
        Moved m = moved(c, pack, l, at, place);
        lane_get(b, l, from);
        lag_times(c, at, &m, transposed, from, out);
        lane_put(&r, l, out);
    }
    return r;
}

static void friction_lag(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx)
{
    const Contact *c = self;
    Pack3 r = lag_product(c, pack, at, x, true, samples_mean(&c->def.samples, w));
    samples_spread(&c->def.samples, r, dx);
}

static void friction_lag_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                 Pack *r)
{
    const Contact *c = self;
    Pack3 out = lag_product(c, pack, at, x, false, samples_mean(&c->def.samples, dx));
    samples_spread(&c->def.samples, out, r);
}

/* The force of each obstacle is linear in its coefficient, and in the stiffness: d(stiffness), d(coefficient) and w.F. */
static void friction_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const Contact *c = self;
    if (!(at->dt > 0)) return;
    Pack3 place = samples_mean(&c->def.samples, x), b = samples_mean(&c->def.samples, w);
    for (int l = 0; l < lanes; l++) {
        Moved m = moved(c, pack, l, at, place);
        double from[3];
        lane_get(b, l, from);
        for (int k = 0; k < c->def.obstacle_count; k++) {
            Grip grip;
            if (!grip_at(c, k, at, m.sample, m.lag, &grip)) continue;
            Slip s = slip_at(c, &grip, &m, at);
            double along = s.psi * (s.u[0] * from[0] + s.u[1] * from[1] + s.u[2] * from[2]);
            dp[c->def.friction + k] += grip.unit * along;
            dp[c->def.stiffness] += grip.force * along / at->p[c->def.stiffness];
            if (c->def.outside)
                outside_back(c->def.outside, m.sample, at->p[c->def.friction + k] * grip.swell * along, dp);
        }
    }
}

static void friction_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const Contact *c = self;
    Pack3 place = samples_mean(&c->def.samples, x), sum;
    for (int l = 0; l < PACK_LANES; l++) {
        double f[3] = {0};
        Moved m = {0};
        double grown = c->def.outside ? outside_change(c->def.outside, contact_sample(c, pack, l), dp) : 0;
        if (at->dt > 0) m = moved(c, pack, l, at, place);
        for (int k = 0; at->dt > 0 && k < c->def.obstacle_count; k++) {
            Grip grip;
            if (!grip_at(c, k, at, m.sample, m.lag, &grip)) continue;
            Slip s = slip_at(c, &grip, &m, at);
            double change = grip.unit * dp[c->def.friction + k] +
                            grip.force * dp[c->def.stiffness] / at->p[c->def.stiffness] +
                            at->p[c->def.friction + k] * grip.swell * grown;
            for (int i = 0; i < 3; i++) f[i] += change * s.psi * s.u[i];
        }
        lane_put(&sum, l, f);
    }
    samples_spread(&c->def.samples, sum, r);
}

#define FRICTION_OPS                                                                                         \
    .name = "friction", .idles = true, .count = contact_count, .size = contact_size, .dofs = contact_dofs,   \
    .eval = friction_eval, .param = friction_param, .param_forward = friction_param_forward,                 \
    .prev = friction_prev, .prev_forward = friction_prev_forward, .lag = friction_lag,                       \
    .lag_forward = friction_lag_forward, .destroy = contact_destroy

static const TermOps still_ops = {FRICTION_OPS}, changing_ops = {FRICTION_OPS, .update = contact_update};

Term friction_term(const ContactDef *def)
{
    Contact *c = contact_create(def);
    return (Term){contact_changes(c) ? &changing_ops : &still_ops, c};
}

/* ---- Sums ---- */

/* What the obstacles do to sample e; `pushed` is over its corners. */
static void measure_sample(const Contact *c, const Point *at, int e, const double place[3], const Moved *m,
                           ContactSums *sums, double pushed[3])
{
    bool touches = false;
    for (int k = 0; k < c->def.obstacle_count; k++) {
        Gap gap;
        Grip grip;
        double f[3] = {0};
        obstacle_gap(&c->def.obstacles[k], &c->poses.end[k], place, &gap);
        double depth = c->offset[e] - gap.value;
        touches = touches || depth > 0;
        sums->depth = fmax(sums->depth, depth);
        if (depth > 0)
            for (int i = 0; i < 3; i++)
                f[i] = gap.gradient[i] * penalty_at(depth, c->smoothing[e], at->p[c->def.stiffness]).force;
        if (m && grip_at(c, k, at, e, m->lag, &grip)) {
            Slip s = slip_at(c, &grip, m, at);
            for (int i = 0; i < 3; i++) {
                f[i] -= grip.force * s.psi * s.u[i];
                sums->friction += grip.force * s.psi * s.u[i] * s.u[i] * at->dt;
            }
        }
        for (int i = 0; i < 3; i++) {
            pushed[i] += f[i];
            if (sums->force) sums->force[k][i] += f[i];
        }
    }
    sums->touching += touches;
}

void contact_measure(const ContactDef *def, const Point *at, ContactSums *sums)
{
    Contact *c = contact_create(def);
    contact_update(c, at);
    const Samples *samples = &def->samples;
    for (int e = 0; e < samples->count; e++) {
        int pack = e / PACK_LANES, lane = e % PACK_LANES, dof[TERM_MAX_DOF];
        double place[3], pushed[3] = {0};
        samples_place(samples, pack, lane, at->x, place);
        Pack3 here = pack3(pack_set(place[0]), pack_set(place[1]), pack_set(place[2]));
        Moved m = {0};
        if (at->dt > 0) m = moved(c, pack, lane, at, here);
        measure_sample(c, at, e, place, at->dt > 0 ? &m : NULL, sums, pushed);
        samples_dofs(samples, e, dof);
        for (int i = 0; sums->point && i < 3 * samples->corners; i++)
            sums->point[dof[i]] += pushed[i % 3] / samples->corners;
    }
    contact_destroy(c);
}
