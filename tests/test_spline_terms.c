/* Quadrature, fields, and every energy of strokes: against an independent program, against differences,
 * semidefinite where it says so, and the same with any number of threads. */
#include "spline_terms_fixture.h"
#include "solve/check.h"
#include "solve/system.h"
#include "spline/points.h"
#include "spline/tone.h"
#include "tests/spline_reference.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

enum { DOFS = 20, REFERENCES = sizeof spline_reference / sizeof *spline_reference };

static void test_rule(void **state)
{
    (void)state;
    static const int counts[] = {3, 4, 5, 8};
    for (int c = 0; c < 4; c++) {
        SplineRule rule = spline_rule_gauss(counts[c]);
        int degree = 2 * counts[c] - 1;
        for (int d = 0; d <= degree + 1; d++) {
            double sum = 0;
            for (int q = 0; q < rule.count; q++) sum += rule.weight[q] * pow(rule.s[q], d);
            double error = fabs(sum - 1.0 / (d + 1));
            assert_true(d <= degree ? error < 2e-16 : error > 1e-10);
        }
    }
    assert_false(spline_rule_exists(6));
}

/* Length of an arc of 90 degrees by one segment: the errors of a table made beforehand. */
static void test_arc(void **state)
{
    (void)state;
    static const double expected[] = {4e-5, 9e-7, 8e-8, 5e-12};
    static const int counts[] = {3, 4, 5, 8};
    double v = 4.0 / 3 * tan(M_PI / 8), length[4];
    const double x[8] = {1, 0, 0, v, 0, 1, -v, 0};
    SplineRule fine = spline_rule_gauss(8);
    for (int c = 0; c < 4; c++) {
        SplineRule rule = spline_rule_gauss(counts[c]);
        SplinePoints points = spline_points_create(&rule, 1, 0.25);
        spline_points_set(&points, 0, c % 2, true, x);
        length[c] = c % 2 ? -0.5 : -0.25; /* but for the caps */
        for (int q = 0; q < rule.count; q++) length[c] += points.ink[q];
        spline_points_clear(&points);
    }
    double exact = 0; /* 64 times 8 points */
    for (int m = 0; m < 64; m++)
        for (int q = 0; q < 8; q++) {
            double s = (m + fine.s[q]) / 64, u = 1 - s,
                   T[4] = {-6 * u * s, 3 * u * (u - 2 * s), 6 * u * s, 3 * s * (s - 2 * u)};
            exact += fine.weight[q] / 64 *
                     hypot(T[0] * x[0] + T[2] * x[4] + T[3] * x[6], T[1] * x[3] + T[2] * x[5]);
        }
    for (int c = 0; c < 4; c++) {
        double error = fabs(length[c] / exact - 1);
        print_message("%d points, arc of 90 degrees: %.1e of its length\n", counts[c], error);
        assert_true(error < 1.3 * expected[c] && error > 0.5 * expected[c]);
    }
}

static double wave(double x, double y)
{
    return sin(9 * x) * cos(7 * y) + x * y;
}

/* Through the pixels; derivatives as differences say; C2 across pixels and the page's edge. */
static void test_grid_spline(void **state)
{
    (void)state;
    SplinePage page = {.width = 1.25, .height = 0.8};
    SplineGrid grid = grid_of(&page, 30, 1, (Surface *[]){wave});
    GridSpline *spline = grid_spline_create(&grid, &page);
    GridSample s, moved[4];
    double worst = 0, derivative = 0, h = 1e-4;
    for (int k = 0; k < 900; k++) {
        double x = (k % 30 + 0.5) / 30 * page.width, y = (k / 30 + 0.5) / 30 * page.height;
        grid_spline_sample(spline, (Pack2){pack_set(x), pack_set(y)}, 0, &s);
        worst = fmax(worst, fabs(s.value[0][k % PACK_LANES] - grid.values[k]));
    }
    Random random = random_seed(1);
    for (int k = 0; k < 500; k++) {
        double x = page.width * random_uniform(&random), y = page.height * random_uniform(&random);
        Pack px = {x - h, x + h, x, x, x, x, x, x}, py = {y, y, y - h, y + h, y, y, y, y};
        grid_spline_sample(spline, (Pack2){px, py}, 2, &s);
        grid_spline_sample(spline, (Pack2){px, py}, 1, &moved[0]);
        derivative = fmax(derivative, fabs((s.value[0][1] - s.value[0][0]) / (2 * h) - s.x[0][4]) / 9);
        derivative = fmax(derivative, fabs((s.value[0][3] - s.value[0][2]) / (2 * h) - s.y[0][4]) / 9);
        derivative = fmax(derivative, fabs((s.x[0][1] - s.x[0][0]) / (2 * h) - s.xx[0][4]) / 81);
        derivative = fmax(derivative, fabs((s.x[0][3] - s.x[0][2]) / (2 * h) - s.xy[0][4]) / 81);
        derivative = fmax(derivative, fabs((s.y[0][3] - s.y[0][2]) / (2 * h) - s.yy[0][4]) / 81);
        assert_true(moved[0].x[0][4] == s.x[0][4]);
    }
    print_message("grid spline: pixels %.1e, derivatives %.1e\n", worst, derivative);
    assert_true(worst < 1e-13 && derivative < 1e-3);
    grid_spline_sample(spline, (Pack2){pack_set(-0.3), pack_set(2)}, 1, &s);
    assert_true(isfinite(s.value[0][0]) && s.x[0][0] == 0 && s.y[0][0] == 0);
    grid_spline_destroy(spline);
    mem_free((void *)grid.values);
}

static double largest(const double *a)
{
    double size = 0;
    for (int i = 0; i < DOFS; i++) size = fmax(size, fabs(a[i]));
    return size;
}

static double distance(const double *a, const double *b)
{
    double size = 0;
    for (int i = 0; i < DOFS; i++) size = fmax(size, fabs(a[i] - b[i]));
    return size / largest(b);
}

/* A system of one energy, by its number in spline_term_rows. */
static System *system_of(const SplineModel *model, int row, SplineHessian hessian)
{
    int dofs = 4 * model->node_count;
    System *sys = system_create(dofs, &(DofClass){.count = dofs, .size = 0.1}, 1);
    if (spline_term_rows[row].term)
        system_add(sys, spline_term_rows[row].term(model, hessian));
    else
        system_add_bulk(sys, spline_term_rows[row].bulk(model, hessian));
    system_prepare(sys);
    return sys;
}

static int row_of(const char *name)
{
    int row = 0;
    while (row < SPLINE_WEIGHT_COUNT && strcmp(spline_term_rows[row].name, name)) row++;
    return row < SPLINE_WEIGHT_COUNT ? row : row_of("pair"); /* by kernel */
}

static void test_reference(void **state)
{
    (void)state;
    for (int k = 0; k < REFERENCES; k++) {
        const SplineReference *reference = &spline_reference[k];
        Fixture f = fixture_create(strcmp(reference->name, "triweight") ? PAIR_WENDLAND : PAIR_TRIWEIGHT);
        set_probes(f.target->probes);
        /* The reference of tone is Gauss-Newton's Hessian. */
        bool tone = !strcmp(reference->name, "tone");
        System *sys = system_of(f.model, row_of(reference->name), tone ? SPLINE_POSITIVE : SPLINE_EXACT);
        double gradient[DOFS], product[DOFS], b[DOFS];
        for (int i = 0; i < DOFS; i++) b[i] = cos(1.7 * i);
        Evaluation e =
            system_hessian(sys, &(Point){.x = f.strokes.q, .p = (const double *)&f.weights}, gradient);
        system_multiply(sys, b, product);
        double energy = fabs(e.energy / reference->energy - 1),
               first = distance(gradient, reference->gradient),
               second = distance(product, reference->product);
        print_message("%-10s energy %.1e  gradient %.1e  Hessian %.1e\n", reference->name, energy, first,
                      second);
        assert_true(energy < 1e-10 && first < 1e-10 && second < 1e-10);
        system_destroy(sys);
        fixture_clear(&f);
    }
}

/* Walls and boundary near an edge too, where the strokes of the reference are not; with the second kernel within
 * an outline, which the boundary then is; with the third pairs alone differ. */
static void test_derivatives(void **state)
{
    (void)state;
    for (int kernel = PAIR_WENDLAND; kernel <= PAIR_COULOMB; kernel++) {
        Fixture f = fixture_create((PairKernel)kernel);
        if (kernel == PAIR_TRIWEIGHT) add_outline(&f);
        Random random = random_seed(2);
        double dof_size[TERM_MAX_DOF];
        for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = 0.1;
        for (int i = 0; i < DOFS; i++) f.strokes.q[i] += 0.02 * random_signed(&random);
        Point at = {.x = f.strokes.q, .p = (const double *)&f.weights};
        for (int row = 0; row < SPLINE_WEIGHT_COUNT; row++) {
            if (kernel == PAIR_WENDLAND && row == row_of("outline")) continue; /* there is none */
            if (kernel == PAIR_COULOMB && row != row_of("pair")) continue;
            System *sys = system_of(f.model, row, SPLINE_EXACT);
            TermError error = system_term_count(sys) ? check_term(system_term(sys, 0), &(Params){0}, &at,
                                                                  DOFS, dof_size, &random)
                                                     : check_bulk(system_bulk(sys, 0), &at, DOFS, 0.1);
            print_message("%-10s gradient %.1e  Hessian %.1e\n", spline_term_rows[row].name, error.gradient,
                          error.hessian);
            /* Kernels end with a jump of the third derivative. */
            assert_true(error.gradient < 1e-7 && check_differences(error) < 1e-6);
            system_destroy(sys);
        }
        fixture_clear(&f);
    }
}

static double form(System *sys, const double *w, double *product)
{
    double sum = 0;
    system_multiply(sys, w, product);
    for (int i = 0; i < DOFS; i++) sum += w[i] * product[i];
    return sum;
}

/* Value and gradient as ever; the Hessian semidefinite, and with the OWN part of it free of any coupling of
 * strokes. */
static void check_positive(PairKernel kernel, int first, int end)
{
    Fixture f = fixture_create(kernel);
    add_outline(&f);
    Random random = random_seed(3);
    for (int row = first; row < end; row++)
        for (int k = 0; k < 40; k++) {
            double x[DOFS], exact[DOFS], gradient[DOFS], w[DOFS], product[DOFS];
            for (int i = 0; i < DOFS; i++) x[i] = f.strokes.q[i] + 0.05 * random_signed(&random);
            Point at = {.x = x, .p = (const double *)&f.weights};
            System *sys[3];
            for (int h = SPLINE_EXACT; h <= SPLINE_OWN; h++) {
                sys[h] = system_of(f.model, row, (SplineHessian)h);
                system_hessian(sys[h], &at, h == SPLINE_EXACT ? exact : gradient);
                assert_true(h == SPLINE_EXACT || !memcmp(exact, gradient, sizeof exact));
            }
            for (int r = 0; r < 20; r++) {
                for (int i = 0; i < DOFS; i++) w[i] = random_signed(&random);
                assert_true(form(sys[SPLINE_POSITIVE], w, product) >= -1e-12 * largest(product));
                for (int i = 12; i < DOFS; i++) w[i] = 0; /* first stroke only */
                assert_true(form(sys[SPLINE_OWN], w, product) >= -1e-12 * largest(product));
                for (int i = 12; i < DOFS; i++) assert_true(product[i] == 0);
            }
            for (int h = SPLINE_EXACT; h <= SPLINE_OWN; h++) system_destroy(sys[h]);
        }
    fixture_clear(&f);
}

static void test_positive(void **state)
{
    (void)state;
    check_positive(PAIR_WENDLAND, 0, SPLINE_WEIGHT_COUNT);
    check_positive(PAIR_COULOMB, row_of("pair"), row_of("pair") + 1);
}

/* Straight strokes of so many segments, which begin at x = 0.2, a line each; nodes may lie unevenly. */
static Strokes straight_strokes(int count, int segments, double length, double apart, double uneven)
{
    Strokes strokes = {0};
    for (int line = 0; line < count; line++) {
        double(*q)[4] = strokes_extend(&strokes, segments + 1, 0);
        for (int k = 0; k <= segments; k++) {
            double s = (double)k / segments, slope = 1 + uneven * M_PI * cos(M_PI * s);
            q[k][0] = 0.2 + length * (s + uneven * sin(M_PI * s));
            q[k][1] = 0.3 + apart * line;
            q[k][2] = length * slope / (3 * segments), q[k][3] = 0;
        }
    }
    return strokes;
}

/* The energy of strokes on the fixture's page. */
static double energy_on(Fixture *f, const Strokes *strokes, double rest, PairKernel kernel, const char *name,
                        double *gradient)
{
    SplineModelDef def = spline_model_default();
    double *rests = same_rest(strokes, rest);
    def.pair_kernel = kernel, def.points = 8, def.pair_radius = 0.25 / f->target->spacing;
    SplineModel *model = spline_model_create(f->target, strokes, rests, &def);
    System *sys = system_of(model, row_of(name), SPLINE_EXACT);
    double energy =
        system_hessian(sys, &(Point){.x = strokes->q, .p = (const double *)&f->weights}, gradient).energy;
    system_destroy(sys);
    spline_model_destroy(model);
    mem_free(rests);
    return energy;
}

/* Two parallel strokes: C R int int dx dy/sqrt((x - y)^2 + h^2) = 2 C R (a asinh(a/h) - sqrt(a^2 + h^2) + h). A single one
 * has no energy. */
static void test_coulomb(void **state)
{
    (void)state;
    Fixture f = fixture_create(PAIR_WENDLAND);
    double a = 0.6, gradient[8 * 21];
    for (double h = 0.05; h < 0.3; h *= 2) {
        Strokes strokes = straight_strokes(2, 20, a, h, 0);
        double exact = 2 * f.weights.pair * 0.25 * (a * asinh(a / h) - hypot(a, h) + h);
        double energy = energy_on(&f, &strokes, 0.03, PAIR_COULOMB, "pair", gradient), force = 0;
        for (int k = 0; k <= 20; k++) force += gradient[4 * k + 1];
        double slope = 2 * f.weights.pair * 0.25 * (1 - hypot(a, h) / h); /* dE/dh */
        print_message("lines at %.2f: energy %.1e, force %.1e\n", h, energy / exact - 1, -force / slope - 1);
        assert_true(fabs(energy / exact - 1) < 1e-9 && fabs(-force / slope - 1) < 1e-8);
        strokes.count = 1;
        assert_true(energy_on(&f, &strokes, 0.03, PAIR_COULOMB, "pair", gradient) == 0);
        strokes_clear(&strokes);
    }
    fixture_clear(&f);
}

/* S (L - L0)^2 L/L0^2 of a stroke, wherever its nodes lie along it; of strokes of one segment that of stretch. */
static void test_length(void **state)
{
    (void)state;
    Fixture f = fixture_create(PAIR_WENDLAND);
    double L = 0.6, L0 = 6 * 0.08, one[16], other[16], uneven[28];
    f.weights.stretch = f.weights.length;
    double exact = f.weights.length * (L - L0) * (L - L0) * L / (L0 * L0);
    for (int k = 0; k < 3; k++) {
        Strokes strokes = straight_strokes(1, 6, L, 0, 0.1 * k);
        double energy = energy_on(&f, &strokes, 0.08, PAIR_WENDLAND, "length", uneven),
               pull = f.weights.length * (L - L0) * (3 * L - L0) / (L0 * L0);
        assert_true(fabs(energy / exact - 1) < 1e-13);
        for (int i = 4; i < 24; i++)
            assert_true(fabs(uneven[i]) < 1e-12); /* nothing holds the nodes between */
        assert_true(fabs(uneven[24] / pull - 1) < 1e-12 && fabs(uneven[0] / pull + 1) < 1e-12);
        double held = energy_on(&f, &strokes, 0.08, PAIR_WENDLAND, "stretch", uneven);
        assert_true(k == 0 ? fabs(held / exact - 1) < 1e-12 : held > 1.05 * exact);
        strokes_clear(&strokes);
    }
    Strokes strokes = straight_strokes(2, 1, 0.5, 0.2, 0.1);
    double length = energy_on(&f, &strokes, 0.3, PAIR_WENDLAND, "length", one),
           stretch = energy_on(&f, &strokes, 0.3, PAIR_WENDLAND, "stretch", other);
    assert_true(fabs(length / stretch - 1) < 1e-14);
    for (int i = 0; i < 16; i++) assert_true(fabs(one[i] - other[i]) < 1e-14);
    strokes_clear(&strokes);
    fixture_clear(&f);
}

static double third(double x, double y)
{
    return (void)x, (void)y, 1.0 / 3;
}

/* A straight line through the page at distance d from a probe makes rho = pen 4/(pi R) 32/35 (1 -
 * d^2/R^2)^3.5; on a page of even tone all probes away from the edge ask for just that tone, and lines at the
 * right distance give it. */
static void test_tone_of_lines(void **state)
{
    (void)state;
    SplinePage page = {.width = 1, .height = 1, .pen = 0.01};
    SplineFields fields = {.density = grid_of(&page, 8, 1, (Surface *[]){third})};
    ProbesDef def = probes_default();
    SplineTarget *target = spline_target_create(&page, &fields, &def);
    Strokes strokes = {0};
    double at = 0.5123, worst = 0, ripple = 0, R = 1.6 * 0.03;
    for (int line = 0; line < 33; line++) {
        double q[41][4];
        for (int k = 0; k <= 40; k++)
            q[k][0] = k / 40.0, q[k][1] = line ? 0.03 * (line + 0.5) : at, q[k][2] = 1 / 120.0, q[k][3] = 0;
        strokes_add(&strokes, 41, (const double(*)[4])q, 0);
    }
    double *rest = same_rest(&strokes, 1.0 / 40);
    SplineModelDef model_def = spline_model_default();
    for (int lines = 0; lines < 2; lines++) {
        Strokes some = strokes;
        if (lines == 0) some.count = 1;
        if (lines == 1) strokes.q[1] = 0; /* the first one leaves */
        for (int k = 0; lines == 1 && k <= 40; k++) strokes.q[4 * k + 1] = 0.015;
        SplineModel *model = spline_model_create(target, &some, rest, &model_def);
        SplinePoints points = spline_points_create(&model->rule, model->segment_count, 0);
        spline_points_update(&points, model, some.q);
        Tone tone = tone_create(target, NULL);
        tone_update(&tone, &points);
        const Probes *probes = target->probes;
        for (int l = 0; l < probes->level_count; l++)
            for (int j = 0; j < probes->levels[l].rows; j++)
                for (int i = 0; i < probes->levels[l].columns; i++) {
                    const ProbeLevel *level = &probes->levels[l];
                    long k = level->first + (long)j * level->stride + i;
                    double x = (i + 0.5) * level->dx, y = (j + 0.5) * level->dy;
                    if (probes->inverse[k] == 0 || fmin(fmin(x, 1 - x), fmin(y, 1 - y)) < 2 * R) continue;
                    double z = fmax(1 - (y - at) * (y - at) / (R * R), 0);
                    double exact = lines ? 1.0 / 3 : page.pen * 4 / (M_PI * R) * 32 / 35 * pow(z, 3.5);
                    assert_true(fabs(1 / sqrt(probes->inverse[k]) - R) < 1e-12);
                    assert_true(fabs(probes->target[k] - 1.0 / 3) < 1e-12);
                    worst = fmax(worst, lines ? 0 : fabs(tone.ink[k] - exact));
                    ripple = fmax(ripple, lines ? fabs(tone.ink[k] - exact) : 0);
                }
        tone_clear(&tone);
        spline_points_clear(&points);
        spline_model_destroy(model);
    }
    print_message("one line: %.1e of rho; lines at 0.03: ripple %.1e of 1/3; %d probes\n", worst, ripple,
                  target->probes->count);
    assert_true(worst < 1e-4 && ripple < 6e-3);
    mem_free(rest);
    strokes_clear(&strokes);
    spline_target_destroy(target);
    clear_fields(&fields);
}

/* Every bit the same with 1, 2 and 5 threads: energies, gradient, Hessian. */
static void test_threads(void **state)
{
    (void)state;
    SplinePage page = {.width = 1.25, .height = 0.8, .pen = 0.005};
    SplineFields fields = {.density = grid_of(&page, 60, 1, (Surface *[]){tone_of}),
                           .align = grid_of(&page, 60, 3, (Surface *[]){m_xx, m_xy, m_yy})};
    ProbesDef probes = probes_default();
    SplineTarget *target = spline_target_create(&page, &fields, &probes);
    Random random = random_seed(4);
    Strokes strokes = random_strokes(&page, 300, 5, 0.012, &random);
    int dofs = 4 * strokes_node_count(&strokes);
    double *rest = same_rest(&strokes, 0.012), *first = mem_alloc(3 * (size_t)dofs, sizeof *first),
           *w = first + dofs, *product = w + dofs, *again = mem_alloc(2 * (size_t)dofs, sizeof *again);
    SplineWeights weights = spline_weights_default();
    weights.pair = 1;
    weights = spline_weights_scaled(weights, page.pen, target->spacing);
    for (int i = 0; i < dofs; i++) w[i] = random_signed(&random);
    double energy = 0;
    for (int run = 0; run < 3; run++) {
        static const int threads[] = {1, 2, 5};
        SplineModelDef def = spline_model_default();
        def.workers = workers_create(threads[run]);
        assert_int_equal(workers_count(def.workers), threads[run]);
        SplineModel *model = spline_model_create(target, &strokes, rest, &def);
        System *sys = system_create(dofs, &(DofClass){.count = dofs, .size = 0.1}, 1);
        for (int row = 0; row < SPLINE_WEIGHT_COUNT; row++) {
            if (((const double *)&weights)[row] == 0) continue;
            if (spline_term_rows[row].term)
                system_add(sys, spline_term_rows[row].term(model, SPLINE_EXACT));
            else
                system_add_bulk(sys, spline_term_rows[row].bulk(model, SPLINE_EXACT));
        }
        system_set_workers(sys, def.workers);
        system_prepare(sys);
        Point at = {.x = strokes.q, .p = (const double *)&weights};
        Evaluation e = system_hessian(sys, &at, run ? again : first);
        system_multiply(sys, w, run ? again + dofs : product);
        assert_true(e.finite && (run == 0 || e.energy == energy));
        assert_true(run == 0 || !memcmp(first, again, (size_t)dofs * sizeof *first));
        assert_true(run == 0 || !memcmp(product, again + dofs, (size_t)dofs * sizeof *first));
        energy = e.energy;
        system_destroy(sys);
        spline_model_destroy(model);
        workers_destroy(def.workers);
    }
    mem_free(rest);
    mem_free(first);
    mem_free(again);
    strokes_clear(&strokes);
    spline_target_destroy(target);
    clear_fields(&fields);
}

static void count_task(void *self, int k)
{
    ((int *)self)[k]++;
}

static void test_workers(void **state)
{
    (void)state;
    Workers *workers = workers_create(3);
    int done[1000] = {0};
    for (int run = 0; run < 200; run++) workers_run(workers, 5 * run, count_task, done);
    for (int k = 0; k < 1000; k++) assert_int_equal(done[k], k < 995 ? 199 - k / 5 : 0);
    workers_run(NULL, 10, count_task, done);
    assert_int_equal(done[9], 199);
    workers_destroy(workers);
}

static void test_leaks(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rule),          cmocka_unit_test(test_arc),
        cmocka_unit_test(test_grid_spline),   cmocka_unit_test(test_reference),
        cmocka_unit_test(test_derivatives),   cmocka_unit_test(test_positive),
        cmocka_unit_test(test_coulomb),       cmocka_unit_test(test_length),
        cmocka_unit_test(test_tone_of_lines), cmocka_unit_test(test_threads),
        cmocka_unit_test(test_workers),       cmocka_unit_test(test_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
