/* Rods from samples: clean, noisy and few ones, and input that is hardly a curve. */
#include "base/clock.h"
#include "base/memory.h"
#include "base/random.h"
#include "rod/inverse.h"
#include "rod/samples.h"
#include "tests/rod_reference.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const double helix_end = 19.565163762857, conical_end = 7.88691715750555;

/* By Box and Muller. */
static double normal(Random *random)
{
    double size = sqrt(-2 * log(1 - random_uniform(random)));
    return size * cos(2 * M_PI * random_uniform(random));
}

static void shake(Vec3 *x, int count, double sigma, Random *random)
{
    for (int i = 0; i < count; i++) {
        double a = normal(random), b = normal(random), c = normal(random);
        x[i] = vec3_axpy(sigma, vec3(a, b, c), x[i]);
    }
}

/* At equal arclengths. */
static Vec3 *sample(RodCurvePoint *point, double end, int count)
{
    RodCurve curve;
    Vec3 *x = mem_alloc((size_t)count, sizeof *x);
    assert_true(rod_curve_create(point, NULL, 0, end, count - 1, &curve, NULL));
    for (int i = 0; i < count; i++) x[i] = curve.x[2 * i];
    rod_curve_clear(&curve);
    return x;
}

static Vec3 *natural_shape(const RodCurve *curve, double young, double weight)
{
    RodSection section = rod_circle(1.5e-3, young, 0.5, 1200);
    Vec3 *moment = mem_alloc(2 * (size_t)curve->elements + 1, sizeof *moment),
         *natural = mem_alloc((size_t)curve->elements + 1, sizeof *natural);
    rod_moments(curve, (RodLoads){.line = vec3(0, 0, -weight / curve->length)}, moment);
    rod_invert(curve, rod_alike(&section), moment, NULL, natural);
    mem_free(moment);
    return natural;
}

typedef struct Errors {
    double natural, end, curvature, noise;
} Errors;

enum { ELEMENTS = 200 };

/* Of a rod from samples against the exact one at equal parts of the length; both weigh the same. */
static Errors compare(const Vec3 *x, int count, double noise, const RodCurve *exact, double young)
{
    RodSamplesDef def = {.noise = noise};
    RodSamplesInfo info;
    RodCurve curve;
    Error err = {""};
    if (!rod_samples_curve(x, count, &def, ELEMENTS, &curve, &info, &err)) fail_msg("%s", err.text);
    double weight = 9.8 * rod_circle(1.5e-3, young, 0.5, 1200).mass * exact->length, squares = 0;
    Vec3 *is = natural_shape(&curve, young, weight), *should = natural_shape(exact, young, weight);
    Errors errors = {.noise = info.noise};
    for (int k = 0; k <= ELEMENTS; k++) {
        errors.end = vec3_length(vec3_sub(is[k], should[k]));
        errors.natural = fmax(errors.natural, errors.end);
    }
    for (int j = 0; j <= 2 * ELEMENTS; j++) {
        Vec3 off = vec3_sub(curve.c[j], exact->c[j]);
        squares += vec3_dot(off, off) / (2 * ELEMENTS + 1);
    }
    errors.curvature = sqrt(squares);
    mem_free(is);
    mem_free(should);
    rod_curve_clear(&curve);
    return errors;
}

typedef struct Case {
    const char *name;
    RodCurvePoint *point;
    const double *end;
    int samples;
    double young, natural[4];
} Case;

static const double sigmas[4] = {1e-5, 1e-4, 3e-4, 1e-3};

/* Largest errors of the natural shape, m, as measured with another program. */
static const Case cases[] = {
    {"helix", reference_helix, &helix_end, 200, 5e6, {3.4e-5, 2.5e-4, 7.1e-4, 2.1e-3}},
    {"helix", reference_helix, &helix_end, 800, 5e6, {2.5e-5, 1.6e-4, 4.8e-4, 1.3e-3}},
    {"conical", reference_conical, &conical_end, 200, 3.5e6, {3.5e-5, 2.9e-4, 7.4e-4, 2.0e-3}},
    {"conical", reference_conical, &conical_end, 800, 3.5e6, {1.9e-5, 1.3e-4, 3.5e-4, 9.6e-4}},
};

/* Of 8 draws: root mean squares, and the mean of the noise found. */
static Errors mean_errors(const Case *c, double sigma, double noise, Random *random)
{
    enum { DRAWS = 8 };
    Errors mean = {0};
    RodCurve exact;
    assert_true(rod_curve_create(c->point, NULL, 0, *c->end, ELEMENTS, &exact, NULL));
    Vec3 *clean = sample(c->point, *c->end, c->samples);
    for (int draw = 0; draw < DRAWS; draw++) {
        Vec3 *x = mem_copy(clean, (size_t)c->samples, sizeof *x);
        shake(x, c->samples, sigma, random);
        Errors one = compare(x, c->samples, noise, &exact, c->young);
        mean.natural += one.natural * one.natural / DRAWS;
        mean.curvature += one.curvature * one.curvature / DRAWS;
        mean.noise += one.noise / DRAWS;
        mem_free(x);
    }
    mem_free(clean);
    rod_curve_clear(&exact);
    mean.natural = sqrt(mean.natural);
    mean.curvature = sqrt(mean.curvature);
    return mean;
}

static void test_noise_table(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Random random = random_seed(1);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int s = 0; s < 4; s++) {
            const Case *c = &cases[k];
            Errors errors = mean_errors(c, sigmas[s], NAN, &random);
            print_message(
                "%-7s %d samples, noise %.0e m: natural shape off by %.1e m, %.2f of the table; curvature "
                "by %.2f 1/m; noise found %.2f of it\n",
                c->name, c->samples, sigmas[s], errors.natural, errors.natural / c->natural[s],
                errors.curvature, errors.noise / sigmas[s]);
            assert_true(errors.natural < 1.5 * c->natural[s] && fabs(errors.noise / sigmas[s] - 1) < 0.1);
            if (c->samples > 200) continue;
            double known = mean_errors(c, sigmas[s], sigmas[s], &random).natural;
            print_message("    with known noise %.2f of the table\n", known / c->natural[s]);
            assert_true(known < 1.5 * c->natural[s]);
        }
    assert_int_equal(mem_live_count(), blocks);
}

/* At equal distances and at very uneven ones: with those only the chords are a good parameter. */
static void test_clean_samples(void **state)
{
    (void)state;
    enum { SAMPLES = 200 };
    Random random = random_seed(1);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k += 2) {
        const Case *c = &cases[k];
        RodCurve exact;
        assert_true(rod_curve_create(c->point, NULL, 0, *c->end, ELEMENTS, &exact, NULL));
        Vec3 *even = sample(c->point, *c->end, SAMPLES), uneven[SAMPLES];
        for (int i = 0; i < SAMPLES; i++) {
            double moved = i % (SAMPLES - 1) ? 0.4 * random_signed(&random) : 0;
            c->point(NULL, *c->end * (i + moved) / (SAMPLES - 1), &uneven[i]);
        }
        Errors found = compare(even, SAMPLES, NAN, &exact, c->young),
               none = compare(even, SAMPLES, 0, &exact, c->young),
               apart = compare(uneven, SAMPLES, NAN, &exact, c->young);
        print_message("%-7s %d clean samples: natural end off by %.1e m, without cross-validation %.1e, at "
                      "uneven distances %.1e\n",
                      c->name, SAMPLES, found.end, none.end, apart.end);
        assert_true(found.end < 1e-9 && none.end < 1e-9 && apart.end < 1.8e-6 && found.noise < 1e-9);
        mem_free(even);
        rod_curve_clear(&exact);
    }
}

/* Few samples: each more brings the exact curve nearer, and noise does not make the fit collapse. */
static void test_few_samples(void **state)
{
    (void)state;
    static const int counts[] = {4, 6, 8, 12, 20};
    const double end = 2;
    RodCurve exact;
    assert_true(rod_curve_create(reference_helix, NULL, 0, end, ELEMENTS, &exact, NULL));
    double before = INFINITY, worst = 0;
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        Vec3 *x = sample(reference_helix, end, counts[k]);
        double off = compare(x, counts[k], NAN, &exact, 5e6).natural;
        print_message("%d clean samples of a third of a turn: off by %.1e m\n", counts[k], off);
        assert_true(off < before && off < 1e-4);
        before = off;
        mem_free(x);
    }
    rod_curve_clear(&exact);
    assert_true(rod_curve_create(reference_helix, NULL, 0, helix_end, ELEMENTS, &exact, NULL));
    Random random = random_seed(3);
    for (int draw = 0; draw < 16; draw++) {
        Vec3 *x = sample(reference_helix, helix_end, 50);
        shake(x, 50, 1e-4, &random);
        worst = fmax(worst, compare(x, 50, NAN, &exact, 5e6).natural);
        mem_free(x);
    }
    print_message("50 samples, noise 1e-4 m: off by %.1e m at worst\n", worst);
    assert_true(worst < 1e-3);
    rod_curve_clear(&exact);
}

/* Noise that could be everything but the coarsest leaves a parabola in the parameter. */
static void test_heavy_smoothing(void **state)
{
    (void)state;
    RodSamplesDef def = {.noise = 1};
    RodSamplesInfo info;
    RodCurve curve;
    Vec3 x[30];
    for (int i = 0; i < 30; i++) x[i] = vec3(0.01 * i, 2e-4 * i * i, i % 2 ? 1e-3 : -1e-3);
    assert_true(rod_samples_curve(x, 30, &def, 10, &curve, &info, NULL));
    print_message("effective unknowns under heavy smoothing: %.6f\n", info.freedom);
    assert_true(fabs(info.freedom - 3) < 1e-3);
    for (int j = 0; j <= 20; j++)
        assert_true(fabs(curve.x[j].y - 2 * curve.x[j].x * curve.x[j].x) < 1e-7 && fabs(curve.x[j].z) < 2e-4);
    rod_curve_clear(&curve);
}

/* Exact samples of two turns of a helix, few and many: the curve passes through each of them. */
static void test_exact_samples(void **state)
{
    (void)state;
    enum { MOST = 40, N = 20000 };
    static const int counts[] = {3, 5, 6, 7, 9, 12, 16, 24, MOST};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        int count = counts[k];
        RodSamplesDef def = {.noise = 0};
        RodCurve curve;
        Vec3 x[MOST];
        double worst = 0;
        for (int i = 0; i < count; i++) {
            double u = 4 * M_PI * i / (count - 1);
            x[i] = vec3(0.02 * cos(u), 0.02 * sin(u), -0.05 / (4 * M_PI) * u);
        }
        assert_true(rod_samples_curve(x, count, &def, N, &curve, NULL, NULL));
        for (int i = 0; i < count; i++) {
            double nearest = INFINITY;
            for (int j = 0; j <= 2 * N; j++) {
                Vec3 off = vec3_sub(x[i], curve.x[j]);
                nearest = fmin(nearest, vec3_length(vec3_axpy(-vec3_dot(off, curve.t[j]), curve.t[j], off)) +
                                            (vec3_length(off) > curve.length / N));
            }
            worst = fmax(worst, nearest);
        }
        double exact = hypot(4 * M_PI * 0.02, 0.05);
        print_message("%d exact samples: missed by %.1e m, %.1e too long\n", count, worst,
                      curve.length / exact - 1);
        assert_true(worst < 1e-7 && (count < 16 || fabs(curve.length / exact - 1) < 2e-3));
        rod_curve_clear(&curve);
    }
}

/* A drawn outline: straight edges between round corners of many points. Where the edges are too long for
 * those the curve would swing out far: it is refused. */
static void test_uneven_samples(void **state)
{
    (void)state;
    enum { CORNER = 8, N = 2000 };
    for (int far = 0; far < 2; far++) {
        double r = far ? 1e-4 : 0.03;
        Vec3 x[4 * CORNER];
        for (int i = 0; i < 4 * CORNER; i++) {
            double corner = i / CORNER * M_PI / 2, angle = corner + M_PI / 2 * (i % CORNER) / (CORNER - 1);
            Vec3 middle =
                vec3(0.1 * sqrt(2) * cos(corner + M_PI / 4), 0.1 * sqrt(2) * sin(corner + M_PI / 4), 0);
            x[i] = vec3_axpy(r, vec3(cos(angle), sin(angle), 0), middle);
        }
        RodSamplesDef def = {.noise = 0};
        RodCurve curve;
        Error err = {""};
        bool ok = rod_samples_curve(x, 4 * CORNER, &def, N, &curve, NULL, &err);
        print_message("an outline with corners of %g m: %.4f of its length, %s\n", r,
                      ok ? curve.length / (0.6 + 2 * M_PI * r) : 0, err.text);
        assert_true(ok == !far);
        if (ok) assert_true(fabs(curve.length / (0.6 + 2 * M_PI * r) - 1) < 0.1);
        if (!ok) assert_non_null(strstr(err.text, "it needs more samples where long chords meet short ones"));
        rod_curve_clear(&curve);
    }
}

static void check_refused(const Vec3 *x, int count, double noise, const char *why)
{
    RodSamplesDef def = {.noise = noise};
    RodCurve curve;
    Error err = {""};
    assert_false(rod_samples_curve(x, count, &def, 10, &curve, NULL, &err));
    assert_null(curve.x);
    assert_string_equal(err.text, why);
}

static void test_refused_samples(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    RodSamplesDef def = rod_samples_default();
    RodCurve once, twice;
    Vec3 *x = sample(reference_conical, conical_end, 60), doubled[120];
    for (int i = 0; i < 120; i++) doubled[i] = x[i / 2];
    assert_true(rod_samples_curve(x, 60, &def, 20, &once, NULL, NULL));
    assert_true(rod_samples_curve(doubled, 120, &def, 20, &twice, NULL, NULL));
    for (int j = 0; j <= 40; j++) assert_memory_equal(&once.x[j], &twice.x[j], sizeof(Vec3));
    rod_curve_clear(&once);
    rod_curve_clear(&twice);

    check_refused(x, 1, NAN, "a rod's curve needs 2 different samples at least, not 1");
    check_refused(doubled, 2, 0, "a rod's curve needs 2 different samples at least, not 1");
    check_refused(x, 0, NAN, "a rod's curve needs 2 different samples at least, not 0");
    check_refused(x, 60, -1e-3,
                  "the noise of a rod's samples is -0.001 m; it must be finite and not negative");
    x[41].y = NAN;
    check_refused(x, 60, NAN, "sample 42 of the rod is not finite");
    x[41].y = INFINITY;
    check_refused(x, 60, NAN, "sample 42 of the rod is not finite");
    mem_free(x);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_lines_and_planes(void **state)
{
    (void)state;
    enum { SAMPLES = 60, N = 20 };
    RodSamplesDef def = rod_samples_default();
    RodCurve curve;
    Random random = random_seed(4);
    Vec3 x[SAMPLES], way = vec3_unit(vec3(1, -2, 3)), up = vec3_unit(vec3(1, 1, 2));
    for (int i = 0; i < SAMPLES; i++) x[i] = vec3_axpy(0.1 + 2e-4 * i * i, way, vec3(5, 6, 7));
    assert_true(rod_samples_curve(x, SAMPLES, &def, N, &curve, NULL, NULL));
    double off = fabs(curve.length - 2e-4 * (SAMPLES - 1) * (SAMPLES - 1)), bend = 0;
    for (int j = 0; j <= 2 * N; j++) {
        off = fmax(off, vec3_length(vec3_sub(curve.x[j], vec3_axpy(curve.length * j / (2 * N), way, x[0]))));
        bend = fmax(bend, vec3_length(curve.c[j]));
    }
    for (int count = 2; count <= 3; count++) {
        RodCurve line;
        Vec3 ends[] = {x[0], vec3_axpy(0.25, way, x[0]), vec3_axpy(1, way, x[0])};
        if (count == 2) ends[1] = ends[2];
        assert_true(rod_samples_curve(ends, count, &def, N, &line, NULL, NULL));
        assert_true(fabs(line.length - 1) < 1e-14 &&
                    vec3_length(vec3_sub(line.x[2 * N], ends[count - 1])) < 1e-14);
        for (int j = 0; j <= 2 * N; j++)
            assert_true(vec3_length(line.c[j]) < 1e-12 && vec3_length(vec3_sub(line.t[j], way)) < 1e-13);
        rod_curve_clear(&line);
    }
    print_message("straight samples: off by %.1e m, curvature %.1e 1/m\n", off, bend);
    assert_true(off < 1e-13 && bend < 1e-9);
    rod_curve_clear(&curve);
    for (int tilted = 0; tilted < 2; tilted++) {
        for (int i = 0; i < SAMPLES; i++) {
            x[i] = vec3(0.01 * i + 1e-4 * normal(&random), 0.05 * sin(0.2 * i), 0.25);
            if (tilted) x[i] = vec3_axpy(-vec3_dot(x[i], up), up, x[i]);
        }
        assert_true(rod_samples_curve(x, SAMPLES, &def, N, &curve, NULL, NULL));
        for (int j = 0; j <= 2 * N; j++)
            if (tilted)
                assert_true(fabs(vec3_dot(curve.x[j], up)) < 1e-15 && fabs(vec3_dot(curve.t[j], up)) < 1e-13);
            else
                assert_true(curve.x[j].z == 0.25 && curve.t[j].z == 0 && curve.c[j].z == 0);
        rod_curve_clear(&curve);
    }
}

static void test_many_samples(void **state)
{
    (void)state;
    enum { SAMPLES = 10000 };
    Random random = random_seed(6);
    RodCurve exact;
    assert_true(rod_curve_create(reference_helix, NULL, 0, helix_end, ELEMENTS, &exact, NULL));
    Vec3 *x = sample(reference_helix, helix_end, SAMPLES);
    shake(x, SAMPLES, 1e-4, &random);
    double start = clock_seconds();
    Errors errors = compare(x, SAMPLES, NAN, &exact, 5e6);
    print_message("%d samples, noise 1e-4 m: off by %.1e m, %.0f ms\n", SAMPLES, errors.natural,
                  1e3 * (clock_seconds() - start));
    assert_true(errors.natural < 1.5e-4);
    mem_free(x);
    rod_curve_clear(&exact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clean_samples),   cmocka_unit_test(test_noise_table),
        cmocka_unit_test(test_few_samples),     cmocka_unit_test(test_heavy_smoothing),
        cmocka_unit_test(test_many_samples),    cmocka_unit_test(test_refused_samples),
        cmocka_unit_test(test_exact_samples),   cmocka_unit_test(test_uneven_samples),
        cmocka_unit_test(test_lines_and_planes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
