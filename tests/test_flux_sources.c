/* Magnets and coils: their fields against closed forms on the axis and by elliptic integrals, against dipoles far away and the
 * charges and currents that they are; derivatives against differences; where they may be: in every frame, right above an
 * edge; maps. */
#include "base/memory.h"
#include "field/flux_field.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void assert_near(double value, double expected, double little)
{
    if (!(fabs(value - expected) <= little)) fail_msg("%.17g, not %.17g +- %g", value, expected, little);
}

static const double MU_0 = 4e-7 * M_PI;

typedef void Sample(const double x[3], FluxSample *sample);

static const double block_half[3] = {0.01, 0.006, 0.004}, tilted[3] = {0.3, -0.5, 1.1};

static void block(const double x[3], FluxSample *sample)
{
    flux_of_block(block_half, tilted, x, sample);
}

static void cylinder(const double x[3], FluxSample *sample)
{
    flux_of_cylinder(0.01, 0.006, tilted, x, sample);
}

static void solenoid(const double x[3], FluxSample *sample)
{
    flux_of_round_coil(0.01, 0.006, 300, x, sample);
}

static void loop(const double x[3], FluxSample *sample)
{
    flux_of_round_coil(0.01, 0, 300, x, sample);
}

static void rectangle(const double x[3], FluxSample *sample)
{
    flux_of_rectangular_coil(block_half, 300, x, sample);
}

static Sample *const kinds[] = {block, cylinder, solenoid, loop, rectangle};
static const char *const names[] = {"block", "cylinder", "solenoid", "loop", "rectangle"};

/* Outside, above the middle, right above edges and corners, on the axis, beside a face, far away, within. */
static const double places[][3] = {{0.02, 0.015, 0.012},   {0.003, 0.002, 0.012}, {0.01, 0.006, 0.02},
                                   {0.01, 0.002, 0.02},    {0, 0, 0.02},          {0.01, 0, 0.01},
                                   {0.016, 0.001, 0.002},  {0, 0.02, 0},          {0.1, 0.2, -0.3},
                                   {-0.01, -0.006, -0.01}, {0.004, 0.003, 0.001}};

/* Of eighth order, as in field/formula_jet.c. */
static double difference(const double *plus, const double *minus, double h)
{
    static const double c[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    double sum = 0;
    for (int k = 0; k < 4; k++) sum += c[k] * (plus[k] - minus[k]);
    return sum / h;
}

typedef struct Errors {
    double gradient, curvature, trace, curl; /* over the largest of their kind */
} Errors;

static Errors errors_at(Sample *kind, const double x[3])
{
    const double h = 1e-4;
    FluxSample at, side[3][2][4];
    kind(x, &at);
    for (int l = 0; l < 3; l++)
        for (int k = 0; k < 8; k++) {
            double y[3] = {x[0], x[1], x[2]};
            y[l] += (k % 2 ? -1 : 1) * (k / 2 + 1) * h;
            kind(y, &side[l][k % 2][k / 2]);
        }
    Errors e = {0};
    double largest[2] = {0};
    for (int i = 0; i < 3; i++)
        for (int l = 0; l < 3; l++) {
            double plus[4][4], minus[4][4];
            for (int k = 0; k < 4; k++) {
                plus[0][k] = side[l][0][k].flux[i], minus[0][k] = side[l][1][k].flux[i];
                for (int m = 0; m < 3; m++)
                    plus[1 + m][k] = side[l][0][k].gradient[i][m],
                             minus[1 + m][k] = side[l][1][k].gradient[i][m];
            }
            e.gradient = fmax(e.gradient, fabs(difference(plus[0], minus[0], h) - at.gradient[i][l]));
            e.curl = fmax(e.curl, fabs(at.gradient[i][l] - at.gradient[l][i]));
            largest[0] = fmax(largest[0], fabs(at.gradient[i][l]));
            for (int m = 0; m < 3; m++) {
                double expected = difference(plus[1 + m], minus[1 + m], h);
                e.curvature = fmax(e.curvature, fabs(expected - at.curvature[i][m][l]));
                largest[1] = fmax(largest[1], fabs(expected));
            }
        }
    e.trace = fabs(at.gradient[0][0] + at.gradient[1][1] + at.gradient[2][2]) / largest[0];
    e.gradient /= largest[0], e.curl /= largest[0], e.curvature /= largest[1];
    return e;
}

static void test_derivatives(void **unused)
{
    (void)unused;
    for (int k = 0; k < 5; k++)
        for (int q = 0; q < (int)(sizeof places / sizeof *places); q++) {
            Errors e = errors_at(kinds[k], places[q]);
            print_message("%s %d: gradient %.1e curvature %.1e trace %.1e curl %.1e\n", names[k], q,
                          e.gradient, e.curvature, e.trace, e.curl);
            assert_true(e.gradient < 2e-7 &&
                        e.curvature < 2e-6); /* of the differences, three millimetres from a wire */
            assert_true(e.trace < 1e-12 && e.curl < 1e-12);
        }
}

/* On their axis [Jackson 5.3]. */
static void test_axis(void **unused)
{
    (void)unused;
    const double a = 0.01, h = 0.006, I = 300;
    for (double z = -0.03; z < 0.03; z += 0.0017) {
        FluxSample sample;
        double x[3] = {0, 0, z}, low = z + h, high = z - h;
        double spread = low / hypot(a, low) - high / hypot(a, high);
        solenoid(x, &sample);
        assert_near(sample.flux[2], MU_0 * I / (4 * h) * spread, 1e-14);
        flux_of_cylinder(a, h, (double[]){0, 0, 1.2}, x, &sample);
        assert_near(sample.flux[2], 0.6 * spread, 1e-14);
        loop(x, &sample);
        assert_near(sample.flux[2], MU_0 * I * a * a / (2 * pow(a * a + z * z, 1.5)), 1e-15);
        rectangle(x, &sample); /* of sides 2 p, 2 q: four wires */
        double p = block_half[0], q = block_half[1], r = p * p + q * q + z * z;
        assert_near(sample.flux[2],
                    MU_0 * I / M_PI * p * q / sqrt(r) * (1 / (p * p + z * z) + 1 / (q * q + z * z)), 1e-15);
    }
}

/* Complete elliptic integrals by the arithmetic-geometric mean [Bulirsch 1965]: cel(k_c, p, a, b). */
static double cel(double kc, double p, double a, double b)
{
    double k = fabs(kc), e = k, m = 1;
    p = sqrt(p), b /= p;
    double f = a;
    a += b / p;
    double g = e / p;
    b += f * g, b += b, p += g;
    g = m, m += k;
    while (fabs(g - k) > 1e-15 * g) {
        k = 2 * sqrt(e), e = k * m, f = a;
        a += b / p;
        g = e / p;
        b += f * g, b += b, p += g;
        g = m, m += k;
    }
    return M_PI / 2 * (b + a * m) / (m * (m + p));
}

/* A cylinder magnetised along its axis [Derby & Olbert 2010, eqs. 4 to 8]. */
static void by_elliptic_integrals(double a, double h, double remanence, double rho, double z, double B[2])
{
    double gamma = (a - rho) / (a + rho), part[2][2];
    for (int k = 0; k < 2; k++) {
        double side = k ? z - h : z + h, root = sqrt(side * side + (rho + a) * (rho + a));
        double kc = sqrt((side * side + (a - rho) * (a - rho)) / (side * side + (a + rho) * (a + rho)));
        part[k][0] = a / root * cel(kc, 1, 1, -1);
        part[k][1] = side / root * cel(kc, gamma * gamma, 1, gamma);
    }
    B[0] = remanence / M_PI * (part[0][0] - part[1][0]);
    B[1] = remanence / M_PI * a / (a + rho) * (part[0][1] - part[1][1]);
}

static void test_elliptic(void **unused)
{
    (void)unused;
    const double a = 0.01, h = 0.006;
    double worst = 0;
    for (double rho = 0.0003; rho < 0.04; rho += 0.00137)
        for (double z = -0.03; z < 0.03; z += 0.00171) {
            if (hypot(rho - a, fmax(0, fabs(z) - h)) < 0.02 * a) continue;
            double expected[2], azimuth = 0.7 + rho * 100;
            FluxSample sample;
            by_elliptic_integrals(a, h, 1.2, rho, z, expected);
            double x[3] = {rho * cos(azimuth), rho * sin(azimuth), z};
            flux_of_cylinder(a, h, (double[]){0, 0, 1.2}, x, &sample);
            worst = fmax(worst, fabs(sample.flux[0] - expected[0] * cos(azimuth)));
            worst = fmax(worst, fabs(sample.flux[1] - expected[0] * sin(azimuth)));
            worst = fmax(worst, fabs(sample.flux[2] - expected[1]));
        }
    print_message("cylinder against elliptic integrals: %.1e T of 1.2 T\n", worst);
    assert_true(worst < 1e-12);
}

/* A cube of half its remanence in space: N = 1/3 in the middle; all are dipoles far away, to order (size/distance)^2. */
static void test_limits(void **unused)
{
    (void)unused;
    FluxSample sample, dipole;
    flux_of_block((double[]){0.01, 0.01, 0.01}, tilted, (double[3]){0}, &sample);
    for (int i = 0; i < 3; i++) assert_near(sample.flux[i], 2.0 / 3 * tilted[i], 1e-15);
    double far[3] = {1.1, -0.7, 1.9}, volume[2] = {8 * 0.01 * 0.006 * 0.004, M_PI * 1e-4 * 0.012}, moment[3];
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) moment[i] = tilted[i] * volume[k] / MU_0;
        kinds[k](far, &sample);
        flux_of_dipole(moment, far, &dipole);
        for (int i = 0; i < 3; i++) assert_near(sample.flux[i] / dipole.flux[i], 1, 1e-4);
    }
}

/* A cylinder of any remanence is the sum of blocks that fill it, in the limit: here a ring of coils, and a block is four
 * sheets of rectangular coils. */
static void test_block_of_coils(void **unused)
{
    (void)unused;
    enum { SHEETS = 4000 };
    const double remanence = 0.9, *half = block_half, x[3] = {0.013, 0.004, 0.007};
    FluxSample magnet, sum = {0};
    flux_of_block(half, (double[]){0, 0, remanence}, x, &magnet);
    for (int k = 0; k < SHEETS; k++) { /* the midpoint rule */
        FluxSample sheet;
        double y[3] = {x[0], x[1], x[2] + half[2] - 2 * half[2] * (k + 0.5) / SHEETS};
        flux_of_rectangular_coil(half, remanence / MU_0 * 2 * half[2] / SHEETS, y, &sheet);
        for (int i = 0; i < 3; i++) sum.flux[i] += sheet.flux[i];
    }
    for (int i = 0; i < 3; i++) assert_near(sum.flux[i], magnet.flux[i], 1e-8);
}

/* ---- Where they stand ---- */

static Timed of_t(const char *x, const char *y, const char *z)
{
    Error err;
    const char *const t[] = {"t", NULL};
    Timed timed = {.first = TIMED_ALONE,
                   .formula = formula_create((const char *[]){x, y, z}, 3, NULL, 0, t, &err)};
    assert_non_null(timed.formula);
    return timed;
}

/* A magnet that has turned by a quarter about z is one whose remanence and sides have; moves by p come on top. */
static void test_frames(void **unused)
{
    (void)unused;
    const double at[3] = {0.01, -0.02, 0.005}, x[3] = {0.03, 0.01, 0.02};
    FluxField *magnet = flux_field_block(at, (double[]){0.02, 0.01, 0.006}, (double[]){0.2, 0.3, 1}),
              *turned = flux_field_block((double[]){0.012, -0.02, 0.005}, (double[]){0.01, 0.02, 0.006},
                                         (double[]){-0.3, 0.2, 1});
    flux_field_set_move(magnet, of_t("0.001*t", "0", "0"), of_t("0", "0", "pi/4*t"));
    FluxSample expected, sample;
    flux_field_eval(turned, x, (FluxPlace){0}, &expected);
    flux_field_eval(magnet, x, (FluxPlace){.time = 2}, &sample);
    double move[3] = {0.001, 0, 0}, turn[3] = {0, 0, M_PI / 4}, middle[3];
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) assert_near(sample.flux[i], expected.flux[i], 1e-15);
        for (int i = 0; i < 9; i++)
            assert_near(sample.gradient[i / 3][i % 3], expected.gradient[i / 3][i % 3], 1e-12);
        for (int i = 0; i < 27; i++)
            assert_near(sample.curvature[i / 9][i / 3 % 3][i % 3],
                        expected.curvature[i / 9][i / 3 % 3][i % 3], 1e-9);
        flux_field_eval(magnet, x, (FluxPlace){1, move, turn}, &sample);
    }
    flux_field_middle(magnet, (FluxPlace){1, move, turn}, middle);
    assert_near(middle[0], 0.012, 1e-16);
    flux_field_destroy(magnet);
    flux_field_destroy(turned);
}

/* A coil around x is one around z, turned. */
static void test_axes(void **unused)
{
    (void)unused;
    const double at[3] = {0.01, 0, 0};
    FluxSample along, own;
    FluxField *coils[2] = {
        flux_field_round_coil(at, (double[]){2, 0, 0}, 0.01, 0.004, 50),
        flux_field_rectangular_coil(at, (double[]){2, 0, 0}, (double[]){0.02, 0.012}, 50),
    };
    for (int k = 0; k < 2; k++) {
        flux_field_eval(coils[k], (double[]){0.02, 0.004, 0.003}, (FluxPlace){0}, &along);
        if (k == 0)
            flux_of_round_coil(0.01, 0.002, 50, (double[]){0.004, 0.003, 0.01}, &own);
        else
            flux_of_rectangular_coil((double[]){0.01, 0.006}, 50, (double[]){0.004, 0.003, 0.01}, &own);
        for (int i = 0; i < 3; i++) assert_near(along.flux[(i + 1) % 3], own.flux[i], 1e-17);
        flux_field_destroy(coils[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives),
                                       cmocka_unit_test(test_axis),
                                       cmocka_unit_test(test_elliptic),
                                       cmocka_unit_test(test_limits),
                                       cmocka_unit_test(test_block_of_coils),
                                       cmocka_unit_test(test_frames),
                                       cmocka_unit_test(test_axes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
