/* Inertia and damping of strokes in motion, as steps of implicit Euler see them. The mass belongs to the
 * material, L0 per segment, not to the length at hand: then the mass matrix is constant. */
#include "spline/relax_private.h"
#include "spline/segment_term.h"

/* int N_k N_l ds over a segment, times 420. */
static const double mass[4][4] = {
    {156, 66, 54, -39}, {66, 36, 39, -27}, {54, 39, 156, -66}, {-39, -27, -66, 36}};

typedef struct Inertia {
    SegmentTerm segment; /* for its elements */
    double damping;
} Inertia;

/* to = L0 M a of a pack, a[8]. */
static void times_mass(const Inertia *inertia, int pack, const Pack *a, Pack *to)
{
    Pack scale = inertia->segment.model->rest_pack[pack] / 420;
    for (int i = 0; i < 8; i++) {
        to[i] = pack_set(0);
        for (int l = 0; l < 4; l++) to[i] += scale * mass[i / 2][l] * a[2 * l + i % 2];
    }
}

/* Dofs of a pack from a whole vector. */
static void gather(const Inertia *inertia, int pack, const double *from, Pack *to)
{
    const SplineModel *model = inertia->segment.model;
    for (int l = 0; l < PACK_LANES; l++) {
        int m = pack * PACK_LANES + l, last = model->segment_count - 1;
        const double *q = from + 4 * model->segment_node[m < last ? m : last];
        for (int i = 0; i < 8; i++) to[i][l] = q[i];
    }
}

static Pack inertia_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Inertia *inertia = self;
    Pack energy = {0}, start[8], v[8], off[8], lag[8], a[8], b[8];
    double c = at->dt > 0 ? 1 / (at->dt * at->dt) : 0, d = at->dt > 0 ? inertia->damping / at->dt : 0;
    if (g) memset(g, 0, 8 * sizeof *g);
    if (H) memset(H, 0, TERM_LOWER(8, 0) * sizeof *H);
    if (!(at->dt > 0)) return energy;
    gather(inertia, pack, at->x_prev, start);
    gather(inertia, pack, at->v_prev, v);
    for (int i = 0; i < 8; i++) lag[i] = x[i] - start[i], off[i] = lag[i] - at->dt * v[i];
    times_mass(inertia, pack, off, a);
    times_mass(inertia, pack, lag, b);
    for (int i = 0; i < 8; i++) {
        energy += c / 2 * off[i] * a[i] + d / 2 * lag[i] * b[i];
        if (g) g[i] = c * a[i] + d * b[i];
    }
    Pack scale = (c + d) / 420 * inertia->segment.model->rest_pack[pack];
    for (int i = 0; H && i < 8; i++)
        for (int j = i % 2; j <= i; j += 2) H[TERM_LOWER(i, j)] = scale * mass[i / 2][j / 2];
    return energy;
}

static void inertia_prev(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                         Pack *dv)
{
    (void)x;
    const Inertia *inertia = self;
    double c = at->dt > 0 ? 1 / at->dt : 0;
    times_mass(inertia, pack, w, dx);
    for (int i = 0; i < 8; i++) {
        dv[i] = -c * dx[i];
        dx[i] *= -c * (c + inertia->damping);
    }
}

/* The derivative is symmetric. */
static void inertia_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                                 const Pack *dv, Pack *r)
{
    (void)x;
    const Inertia *inertia = self;
    double c = at->dt > 0 ? 1 / at->dt : 0;
    Pack change[8];
    for (int i = 0; i < 8; i++) change[i] = -c * ((c + inertia->damping) * dx[i] + dv[i]);
    times_mass(inertia, pack, change, r);
}

static const TermOps inertia_ops = {.name = "inertia",
                                    .count = segment_term_count,
                                    .size = segment_term_size,
                                    .dofs = segment_term_dofs,
                                    .eval = inertia_eval,
                                    .prev = inertia_prev,
                                    .prev_forward = inertia_prev_forward,
                                    .destroy = mem_free};

Term spline_inertia_term(const SplineModel *model, double damping)
{
    Inertia inertia = {{.model = model, .rule = &model->rule}, damping};
    return (Term){&inertia_ops, mem_copy(&inertia, 1, sizeof inertia)};
}

double spline_kinetic_energy(const SplineModel *model, const double *v)
{
    Inertia inertia = {{.model = model}, 0};
    double energy = 0;
    for (int pack = 0; pack * PACK_LANES < model->segment_count; pack++) {
        Pack a[8], b[8], sum = {0};
        gather(&inertia, pack, v, a);
        times_mass(&inertia, pack, a, b);
        for (int i = 0; i < 8; i++) sum += a[i] * b[i];
        int left = model->segment_count - pack * PACK_LANES;
        energy += pack_sum(sum, left < PACK_LANES ? left : PACK_LANES) / 2;
    }
    return energy;
}
