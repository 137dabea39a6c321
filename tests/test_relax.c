/* Relaxation of strokes: that all methods lower the same energy, what threads and seeds do to the result,
 * walls, changes of single strokes, Metropolis' distribution, inertia, and the number of strokes. */
#include "energy_fixture.h"
#include "solve/check.h"
#include "spline/local.h"
#include "spline/relax_private.h"
#include "spline/revise.h"
#include "spline/tone.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static double ball(double x, double y)
{
    double d = hypot(x - 0.6, y - 0.4);
    return d < 0.3 ? 0.15 + 0.6 * d / 0.3 : 0.1;
}

/* M = I - v v^T, v at 30 degrees. */
static double m_xx(double x, double y)
{
    return (void)x, (void)y, 0.25;
}
static double m_xy(double x, double y)
{
    return (void)x, (void)y, -0.4330127018922193;
}
static double m_yy(double x, double y)
{
    return (void)x, (void)y, 0.75;
}
static double slope_of(double x, double y)
{
    return -x - 0.5 * y;
}
static double v_x(double x, double y)
{
    return 0.3 * y + 0.1 * x;
}
static double v_y(double x, double y)
{
    return 0.2 - 0.4 * x * y;
}

typedef struct Scene {
    SplinePage page;
    SplineFields fields;
    SplineTarget *target;
    Strokes strokes;
} Scene;

static Scene scene_create(double pen, double budget, int segments, uint64_t seed)
{
    Scene s = {.page = {.width = 1.25, .height = 0.8, .pen = pen}};
    s.fields.density = grid_of(&s.page, 60, 1, (Surface *[]){ball});
    s.fields.align = grid_of(&s.page, 10, 3, (Surface *[]){m_xx, m_xy, m_yy});
    s.fields.potential = grid_of(&s.page, 20, 1, (Surface *[]){slope_of});
    s.fields.flow = grid_of(&s.page, 20, 2, (Surface *[]){v_x, v_y});
    ProbesDef probes = probes_default();
    s.target = spline_target_create(&s.page, &s.fields, &probes);
    Random random = random_seed(seed);
    double rest = 1.2 * s.target->spacing;
    int count = (int)(budget * spline_stroke_budget(s.target, segments, rest));
    s.strokes = random_strokes(&s.page, count, segments, rest, &random);
    return s;
}

static void scene_clear(Scene *s)
{
    strokes_clear(&s->strokes);
    spline_target_destroy(s->target);
    clear_fields(&s->fields);
}

/* The energy, by a system of its own. */
static double energy_of(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes)
{
    double *rest = spline_rest_lengths(target, def, strokes);
    SplineModel *model = spline_model_create(target, strokes, rest, &def->model);
    SplineWeights weights = spline_weights_scaled(def->weights, target->page.pen, target->spacing);
    int dofs = 4 * model->node_count;
    System *sys = system_create(dofs, &(DofClass){.count = dofs, .size = 1}, 1);
    for (int row = 0; row < SPLINE_WEIGHT_COUNT; row++) {
        if (((const double *)&weights)[row] == 0) continue;
        if (spline_term_rows[row].term)
            system_add(sys, spline_term_rows[row].term(model, SPLINE_OWN));
        else
            system_add_bulk(sys, spline_term_rows[row].bulk(model, SPLINE_OWN));
    }
    system_prepare(sys);
    double energy = system_energy(sys, &(Point){.x = strokes->q, .p = (const double *)&weights}).energy;
    system_destroy(sys);
    spline_model_destroy(model);
    mem_free(rest);
    return energy;
}

/* From the same strokes to energies within a tenth of each other. */
static void test_methods(void **state)
{
    (void)state;
    for (RelaxMethod method = RELAX_AUTO; method < RELAX_METHOD_COUNT; method++) {
        Scene s = scene_create(0.02, 1, 4, 1);
        RelaxDef def = relax_default();
        def.method = method;
        def.max_iterations = 2000;
        def.sweeps = 80;
        def.energy_tol = method == RELAX_NEWTON ? 0 : 1e-5;
        double start = energy_of(s.target, &def, &s.strokes);
        RelaxInfo info = spline_relax(s.target, &def, &s.strokes, NULL);
        double end = energy_of(s.target, &def, &s.strokes), sum = 0;
        for (int k = 0; k < SPLINE_WEIGHT_COUNT; k++) sum += info.energies[k];
        print_message(
            "%-11s %-14s E %.3f -> %.4f, |g| %.1e, %4d iterations, %4d evaluations, %4d factors, %.2f s\n",
            relax_method_name(method), relax_status_name(info.status), start, end, info.gradient_max,
            info.iterations, info.evaluations, info.factorizations, info.seconds);
        assert_true(fabs(info.energy - end) < 1e-12 * start && fabs(sum - end) < 1e-12 * start);
        assert_true(end < 0.15 * start);
        assert_true(method != RELAX_NEWTON || (info.status == RELAX_CONVERGED && info.gradient_max <= 1e-6));
        scene_clear(&s);
    }
}

/* The wall is reached and never crossed, by no point of any curve, after no iteration. */
typedef struct Inside {
    SplinePage page;
    double nearest;
    int iterations;
} Inside;

static bool watch_inside(void *self, const RelaxInfo *info, const Strokes *strokes)
{
    Inside *inside = self;
    (void)info;
    inside->iterations++;
    for (int k = 0; k < strokes->count; k++)
        for (int node = strokes->start[k]; node < strokes->start[k + 1] - 1; node++)
            for (int i = 0; i <= 20; i++) {
                Vec2 c[4];
                strokes_bezier(strokes, node, c);
                double t = i / 20.0, u = 1 - t, w[4] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t},
                       x = 0, y = 0;
                for (int j = 0; j < 4; j++) x += w[j] * c[j].x, y += w[j] * c[j].y;
                double d = fmin(fmin(x, inside->page.width - x), fmin(y, inside->page.height - y));
                inside->nearest = fmin(inside->nearest, d);
            }
    return true;
}

/* A potential pushes everything into a corner; some strokes begin beyond the edge. */
static void test_wall(void **state)
{
    (void)state;
    for (RelaxMethod method = RELAX_AUTO; method < RELAX_METHOD_COUNT; method++) {
        Scene s = scene_create(0.03, 1, 3, 2);
        for (int node = 0; node < 8; node++) s.strokes.q[4 * node] -= 1;
        RelaxDef def = relax_default();
        def.method = method;
        def.max_iterations = 60;
        def.temperatures = 5, def.time_steps = 20, def.sweeps = 20;
        def.weights.potential = 2;
        Inside inside = {s.page, 1, 0};
        RelaxInfo info = spline_relax(s.target, &def, &s.strokes, &(RelaxObserver){watch_inside, &inside});
        print_message("%-11s nearest to the edge %.5f of a pen in %d iterations\n", relax_method_name(method),
                      inside.nearest / s.page.pen, inside.iterations);
        assert_true(info.status != RELAX_NOT_FINITE && inside.iterations > 0 && isfinite(info.energy));
        assert_true(inside.nearest > 0 && inside.nearest < 0.5 * s.page.pen);
        scene_clear(&s);
    }
}

/* The same bits with any number of threads, and for the same seed; by auto in a drawing of several chunks of dofs. */
static void test_repeatable(void **state)
{
    (void)state;
    for (RelaxMethod method = RELAX_AUTO; method < RELAX_METHOD_COUNT; method++) {
        double *first = NULL;
        for (int run = 0; run < 4; run++) {
            Scene s = scene_create(method == RELAX_AUTO ? 0.002 : 0.03, 1, 4, 1);
            RelaxDef def = relax_default();
            def.method = method;
            def.weights.pair = 0.1;
            def.max_iterations = 12, def.temperatures = 2, def.sweeps = 5, def.time_steps = 3;
            def.threads = run < 3 ? 1 + run * run : 1; /* 1, 2, 5 */
            def.seed = run < 3 ? 1 : 2;
            spline_relax(s.target, &def, &s.strokes, NULL);
            size_t bytes = 4 * (size_t)strokes_node_count(&s.strokes) * sizeof(double);
            if (run == 0) first = mem_copy(s.strokes.q, bytes, 1);
            bool same = !memcmp(first, s.strokes.q, bytes);
            assert_true(same == (run < 3 || method != RELAX_MONTE_CARLO));
            scene_clear(&s);
        }
        mem_free(first);
    }
}

/* Changes of single strokes against energies of whole drawings: moved, gone, come. */
static void check_local(PairKernel kernel)
{
    Scene s = scene_create(0.02, 0.7, 4, 3);
    RelaxDef def = relax_default();
    def.weights =
        (SplineWeights){0.5, 0.1, 0.5, 0.1, 0, 0.2, 0.05, 0.3, 0.4, 0.01, 1, 0.3, 0.2}; /* all but outline */
    def.model.pair_kernel = kernel;
    SplineWeights weights = spline_weights_scaled(def.weights, s.page.pen, s.target->spacing);
    double *rest = spline_rest_lengths(s.target, &def, &s.strokes);
    SplineModel *model = spline_model_create(s.target, &s.strokes, rest, &def.model);
    Local *local = local_create(model, &weights, s.strokes.q, NULL);
    Random random = random_seed(5);
    double before = energy_of(s.target, &def, &s.strokes), worst = 0, q[5][4];
    for (int k = 0; k < 60; k++) {
        int stroke = (int)(random_uniform(&random) * s.strokes.count);
        double *at = s.strokes.q + 4 * s.strokes.start[stroke];
        memcpy(q, at, sizeof q);
        for (int i = 0; i < 20; i++) q[i / 4][i % 4] += 0.01 * random_signed(&random);
        double change = local_change(local, stroke, q[0]);
        if (k % 3 == 0) {
            local_reject(local);
            continue;
        }
        local_accept(local);
        memcpy(at, q, sizeof q);
        double after = energy_of(s.target, &def, &s.strokes);
        if (isfinite(after) || isfinite(change))
            worst = fmax(worst, fabs(after - before - change) / fabs(before));
        before = after;
    }
    print_message("changes of single strokes: %.1e of the energy\n", worst);
    assert_true(worst < 1e-12);
    /* The last one goes, and comes back. */
    Strokes fewer = strokes_copy(&s.strokes);
    fewer.count--;
    double gone = energy_of(s.target, &def, &fewer);
    double change = local_change(local, fewer.count, NULL);
    assert_true(fabs(gone - before - change) < 1e-12 * fabs(before));
    local_accept(local);
    change = local_change(local, fewer.count, s.strokes.q + 4 * s.strokes.start[fewer.count]);
    assert_true(fabs(before - gone - change) < 1e-12 * fabs(before));
    local_reject(local);
    assert_true(local_change(local, fewer.count, NULL) == 0);
    local_reject(local);
    strokes_clear(&fewer);
    local_destroy(local);
    spline_model_destroy(model);
    mem_free(rest);
    scene_clear(&s);
}

static void test_local(void **state)
{
    (void)state;
    check_local(PAIR_WENDLAND);
    check_local(PAIR_COULOMB);
}

/* Sums over samples of one stroke of one segment: energy of bending over T and its square, ends apart
 * squared, place and place squared of an end, length of v squared. */
enum { FIGURES = 6 };

typedef struct Samples {
    double stiffness; /* of |a|^2 over T */
    int skip, count;
    double sum[FIGURES];
} Samples;

static double axis_energy(double a0, double a1)
{
    return (a0 * a0 + a0 * a1 + a1 * a1) / 3;
}

static void add_sample(Samples *s, const double *q)
{
    double energy = 0, apart = 0;
    for (int i = 0; i < 2; i++) {
        double d = q[4 + i] - q[i], v0 = q[2 + i], v1 = q[6 + i];
        energy += s->stiffness * axis_energy(6 * (d - v1 - 2 * v0), 6 * (v0 + 2 * v1 - d));
        apart += d * d;
    }
    double figures[FIGURES] = {energy, energy * energy, apart, q[0], q[1] * q[1], q[2] * q[2] + q[3] * q[3]};
    for (int k = 0; k < FIGURES; k++) s->sum[k] += figures[k];
    s->count++;
}

static bool watch_samples(void *self, const RelaxInfo *info, const Strokes *strokes)
{
    Samples *s = self;
    if (info->iterations > s->skip) add_sample(s, strokes->q);
    return true;
}

static double normal(Random *random)
{
    return sqrt(-2 * log(1 - random_uniform(random))) * cos(2 * M_PI * random_uniform(random));
}

/* The same distribution by rejection: ends anywhere, r'' Gaussian, all control points on the page. */
static void sample_directly(Samples *s, int tries)
{
    SplineRule rule = spline_rule_hull();
    Random random = random_seed(9);
    for (int k = 0; k < tries; k++) {
        double q[8];
        bool inside = true;
        for (int i = 0; i < 2; i++) {
            /* a0^2 + a0 a1 + a1^2 = (a0 + a1/2)^2 + 3/4 a1^2 */
            double scale = sqrt(3 / (2 * s->stiffness)), a1 = scale * sqrt(4.0 / 3) * normal(&random);
            double a0 = scale * normal(&random) - a1 / 2;
            q[i] = random_uniform(&random), q[4 + i] = random_uniform(&random);
            q[2 + i] = (q[4 + i] - q[i] - (2 * a0 + a1) / 6) / 3;
            q[6 + i] = q[2 + i] + (a0 + a1) / 6;
            for (int p = 0; p < rule.count; p++) {
                double r = 0;
                for (int b = 0; b < 4; b++) r += rule.value[p][b] * q[2 * b + i];
                inside = inside && r > 0 && r < 1;
            }
        }
        if (inside) add_sample(s, q);
    }
}

static double tenth(double x, double y)
{
    return (void)x, (void)y, 0.1;
}

/* One stroke that bends, between hard walls, at one temperature: its distribution is known. */
static void test_balance(void **state)
{
    (void)state;
    static const char *const names[FIGURES] = {"E/T", "(E/T)^2", "|p1 - p0|^2", "x", "y^2", "|v|^2"};
    SplinePage page = {.width = 1, .height = 1, .pen = 0.05};
    SplineFields fields = {.density = grid_of(&page, 4, 1, (Surface *[]){tenth})};
    ProbesDef probes = probes_default();
    SplineTarget *target = spline_target_create(&page, &fields, &probes);
    RelaxDef def = relax_default();
    Samples annealed = {.stiffness = 3, .skip = 20000}, direct = annealed;
    double L0 = spline_segment_length(def.rest, target->spacing), T = 1;
    def.method = RELAX_MONTE_CARLO;
    def.weights = (SplineWeights){.wall = 1e-9};
    def.weights.bend = annealed.stiffness * T * L0 * L0 * L0 / (0.5 * target->spacing * target->spacing);
    def.temperature_first = def.temperature_last = T / target->spacing;
    def.temperatures = 16, def.sweeps = 20000;
    Strokes strokes = {0};
    strokes_add(&strokes, 2, (const double[2][4]){{0.3, 0.4, 0.1, 0}, {0.6, 0.4, 0.1, 0}}, 0);
    spline_relax(target, &def, &strokes, &(RelaxObserver){watch_samples, &annealed});
    sample_directly(&direct, 400000);
    for (int k = 0; k < FIGURES; k++) {
        double a = annealed.sum[k] / annealed.count, b = direct.sum[k] / direct.count;
        print_message("%-11s %.4f, directly %.4f\n", names[k], a, b);
        assert_true(fabs(a / b - 1) < (k == 1 ? 0.06 : 0.03));
    }
    strokes_clear(&strokes);
    spline_target_destroy(target);
    clear_fields(&fields);
}

/* Derivatives; the energy of a rigid motion; the products for adjoints. */
static void test_inertia(void **state)
{
    (void)state;
    Scene s = scene_create(0.05, 1, 3, 4);
    RelaxDef def = relax_default();
    double *rest = spline_rest_lengths(s.target, &def, &s.strokes), length = 0;
    SplineModel *model = spline_model_create(s.target, &s.strokes, rest, &def.model);
    int n = 4 * model->node_count;
    Random random = random_seed(6);
    double *x = mem_copy(s.strokes.q, (size_t)n, sizeof *x), *v = mem_alloc((size_t)n, sizeof *v),
           dof_size[TERM_MAX_DOF];
    for (int i = 0; i < n; i++) v[i] = i % 4 == 0 ? 0.3 : i % 4 == 1 ? -0.4 : 0;
    for (int m = 0; m < model->segment_count; m++) length += rest[m];
    assert_true(fabs(spline_kinetic_energy(model, v) - length * 0.25 / 2) < 1e-14 * length);
    for (int i = 0; i < n; i++) x[i] += 0.02 * random_signed(&random), v[i] += 0.1 * random_signed(&random);
    for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = 0.1;
    Term term = spline_inertia_term(model, 2);
    Point at = {.x = x, .x_prev = s.strokes.q, .v_prev = v, .dt = 0.1};
    TermError error = check_term(&term, &(Params){0}, &at, n, dof_size, &random);
    print_message("inertia: differences %.1e  prev %.1e\n", check_differences(error), error.prev);
    assert_true(check_differences(error) < 1e-10 && check_products(error) < 1e-11);
    System *sys = system_create(n, &(DofClass){.count = n, .size = 1}, 1);
    system_add(sys, term);
    system_prepare(sys);
    double *work = mem_alloc(7 * (size_t)n, sizeof *work), *w = work, *dx = w + n, *dv = dx + n, *r = dv + n,
           *g[2] = {r + n, r + 2 * n};
    for (int i = 0; i < n; i++) w[i] = random_signed(&random);
    system_prev(sys, &at, w, dx, dv); /* minus the transposed products */
    double *start = mem_copy(s.strokes.q, (size_t)n, sizeof *start), along = 0, difference = 0;
    for (int side = 0; side < 2; side++) { /* linear: one difference is exact */
        for (int i = 0; i < n; i++)
            start[i] += (side ? 2e-3 : -1e-3) * cos(i), v[i] += (side ? 2e-3 : -1e-3) * sin(2 * i);
        at.x_prev = start;
        system_gradient(sys, &at, g[side]);
    }
    for (int i = 0; i < n; i++) {
        along -= dx[i] * cos(i) + dv[i] * sin(2 * i);
        difference += w[i] * (g[1][i] - g[0][i]) / 2e-3;
    }
    assert_true(fabs(along / difference - 1) < 1e-9);
    for (int i = 0; i < n; i++) dx[i] = cos(i), dv[i] = sin(2 * i);
    system_prev_forward(sys, &at, dx, dv, r);
    along = 0;
    for (int i = 0; i < n; i++) along += w[i] * r[i];
    assert_true(fabs(along / difference - 1) < 1e-9);
    mem_free(start);
    mem_free(work);
    system_destroy(sys);
    mem_free(x);
    mem_free(v);
    spline_model_destroy(model);
    mem_free(rest);
    scene_clear(&s);
}

typedef struct Falling {
    double total;
    bool ever_rose;
} Falling;

static bool watch_falling(void *self, const RelaxInfo *info, const Strokes *strokes)
{
    Falling *f = self;
    (void)strokes;
    double total = info->energy + info->kinetic;
    if (f->total > 0 && total > f->total * 1.001) f->ever_rose = true;
    f->total = total;
    return info->iterations < 30;
}

/* Energy and motion together never grow; the observer can stop it. */
static void test_dynamics(void **state)
{
    (void)state;
    Scene s = scene_create(0.02, 1, 4, 1);
    RelaxDef def = relax_default();
    def.method = RELAX_DYNAMICS;
    def.damping = 0;
    Falling falling = {0};
    RelaxInfo info = spline_relax(s.target, &def, &s.strokes, &(RelaxObserver){watch_falling, &falling});
    assert_true(!falling.ever_rose && info.status == RELAX_STOPPED && info.iterations == 30);
    scene_clear(&s);
}

/* Too few and too many strokes that hold their length: both come near the budget, with less energy. */
static void test_refine(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        Scene s = scene_create(0.015, k ? 1.4 : 0.6, 4, 7);
        RelaxDef def = relax_default();
        def.weights.strain = 5;
        Strokes plain = strokes_copy(&s.strokes);
        RelaxInfo once = spline_relax(s.target, &def, &plain, NULL);
        RelaxInfo info = spline_refine(s.target, &def, 6, 4, &s.strokes, NULL);
        double ink = strokes_length(&s.strokes) + 2 * s.strokes.count * spline_pen_cap(&s.target->page);
        ink /= spline_ink_budget(s.target);
        assert_true(info.energy < (k ? 1 : 0.6) * once.energy && fabs(ink - 1) < 0.08);
        assert_true(fabs(info.energy - energy_of(s.target, &def, &s.strokes)) < 1e-12);
        strokes_clear(&plain);
        scene_clear(&s);
    }
}

/* Nothing to do, and nothing that can be done. */
static void test_status(void **state)
{
    (void)state;
    Scene s = scene_create(0.05, 1, 3, 4);
    RelaxDef def = relax_default();
    Strokes none = {0};
    assert_int_equal(spline_relax(s.target, &def, &none, NULL).status, RELAX_CONVERGED);
    assert_int_equal(spline_remove_strokes(s.target, &def, 3, &none), 0);
    for (int i = 0; i < 4; i++)
        s.strokes.q[4 + i] = s.strokes.q[8 + i] = s.strokes.q[12 + i] = s.strokes.q[i];
    s.strokes.q[2] = s.strokes.q[3] = s.strokes.q[6] = s.strokes.q[7] = s.strokes.q[10] = s.strokes.q[11] =
        s.strokes.q[14] = s.strokes.q[15] = 0;
    RelaxInfo info = spline_relax(s.target, &def, &s.strokes, NULL);
    assert_int_equal(info.status, RELAX_NOT_FINITE);
    scene_clear(&s);
}

static void test_leaks(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_methods),  cmocka_unit_test(test_wall),    cmocka_unit_test(test_repeatable),
        cmocka_unit_test(test_local),    cmocka_unit_test(test_balance), cmocka_unit_test(test_inertia),
        cmocka_unit_test(test_dynamics), cmocka_unit_test(test_refine),  cmocka_unit_test(test_status),
        cmocka_unit_test(test_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
