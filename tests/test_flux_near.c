/* Magnets and coils where a body comes to them, at 1e-3 to 1e-15 m: a cylinder against its definition in 60 digits
 * (flux_reference.py), jumps through faces, sides and windings as Maxwell's equations have them, loops against what a cylinder
 * loses at its ends; on edges, rims and wires nothing is finite. */
#include "field/flux_sources.h"
#include "tests/flux_reference.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static const double radius = 0.01, half = 0.006, tilted[3] = {0.3, -0.5, 1.1}, MU_0 = 4e-7 * M_PI;

static void cylinder(const double x[3], FluxSample *sample)
{
    flux_of_cylinder(radius, half, tilted, x, sample);
}

/* The largest difference of so many numbers, over the larger of the largest of them and a floor. */
static double error_of(const double *found, const double *expected, int count, double floor)
{
    double off = 0, most = floor;
    for (int i = 0; i < count; i++) {
        off = fmax(off, fabs(found[i] - expected[i]));
        most = fmax(most, fabs(expected[i]));
    }
    return off / most;
}

static void test_reference(void **unused)
{
    (void)unused;
    double worst[3] = {0};
    for (int k = 0; k < (int)(sizeof flux_reference / sizeof *flux_reference); k++) {
        const double *row = flux_reference[k], *numbers = row + 2;
        FluxSample at;
        cylinder((double[]){radius + row[0], 0, row[1]}, &at);
        double e[3] = {error_of(at.flux, numbers, 3, 0), error_of(at.gradient[0], numbers + 3, 9, 0),
                       error_of(at.curvature[0][0], numbers + 12, 27, 0)};
        print_message("%8.0e %10.3g: %.1e %.1e %.1e\n", row[0], row[1], e[0], e[1], e[2]);
        for (int i = 0; i < 3; i++) worst[i] = fmax(worst[i], e[i]);
    }
    assert_true(worst[0] < 1e-13 && worst[1] < 1e-13 && worst[2] < 1e-13);
}

static void block(const double x[3], FluxSample *sample)
{
    flux_of_block((double[]){0.01, 0.008, 0.006}, tilted, x, sample);
}

static void solenoid(const double x[3], FluxSample *sample)
{
    flux_of_round_coil(radius, half, 300, x, sample);
}

typedef void Sample(const double x[3], FluxSample *sample);

/* What B steps by as one leaves a magnet through a face, n pointing out, is n (n.B_r) - B_r: B.n and B - B_r along it go on. A
 * winding along z is a magnet without the magnet. The face's own point need not be known but is finite. */
static void test_jumps(void **unused)
{
    (void)unused;
    static const struct {
        Sample *kind;
        double face[3], n[3], remanence[3];
    } rows[] = {{block, {0.01, 0.002, 0.001}, {1, 0, 0}, {0.3, -0.5, 1.1}},
                {block, {0.003, -0.008, 0.00599}, {0, -1, 0}, {0.3, -0.5, 1.1}},
                {block, {0.00999, 0.0, 0.006}, {0, 0, 1}, {0.3, -0.5, 1.1}},
                {cylinder, {0.01, 0, 0.001}, {1, 0, 0}, {0.3, -0.5, 1.1}},
                {cylinder, {0, -0.01, -0.00599}, {0, -1, 0}, {0.3, -0.5, 1.1}},
                {cylinder, {0.004, 0.003, 0.006}, {0, 0, 1}, {0.3, -0.5, 1.1}},
                {cylinder, {0, 0.00999, -0.006}, {0, 0, -1}, {0.3, -0.5, 1.1}},
                {solenoid, {0, 0.01, 0.004}, {0, 1, 0}, {0, 0, 4e-7 * M_PI * 300 / 0.012}}};
    double worst = 0;
    for (int r = 0; r < (int)(sizeof rows / sizeof *rows); r++)
        for (double d = 1e-10; d > 1e-16; d /= 10) {
            FluxSample side[2], on;
            for (int s = 0; s < 2; s++) {
                double x[3];
                for (int i = 0; i < 3; i++) x[i] = rows[r].face[i] + (s ? d : -d) * rows[r].n[i];
                rows[r].kind(x, &side[s]);
            }
            rows[r].kind(rows[r].face, &on);
            double along = 0, step[3], expected[3];
            for (int i = 0; i < 3; i++) along += rows[r].n[i] * rows[r].remanence[i];
            for (int i = 0; i < 3; i++) {
                step[i] = side[1].flux[i] - side[0].flux[i];
                expected[i] = rows[r].n[i] * along - rows[r].remanence[i];
                for (int l = 0; l < 3; l++) {
                    expected[i] += d * (side[0].gradient[i][l] + side[1].gradient[i][l]) * rows[r].n[l];
                    assert_true(isfinite(on.flux[i] + on.gradient[i][l]));
                }
            }
            worst = fmax(worst, error_of(step, expected, 3, 0));
        }
    print_message("jumps through faces: off by %.1e of them\n", worst);
    assert_true(worst < 1e-12); /* places themselves are rounded, in fields of 1e5 T/m beside an edge */
}

/* What changes along the axis of a cylinder without charges is what enters and leaves at its ends: two loops. */
static void test_loops(void **unused)
{
    (void)unused;
    double worst = 0;
    for (double d = 1e-3; d > 1e-13; d /= 10)
        for (int k = 0; k < 8; k++) {
            double angle = M_PI / 4 * k, x[3] = {radius + d * cos(angle), 0, half + d * sin(angle)};
            FluxSample magnet, end[2];
            flux_of_cylinder(radius, half, (double[]){0, 0, 1.2}, x, &magnet);
            for (int e = 0; e < 2; e++)
                flux_of_round_coil(radius, 0, 1.2 / MU_0, (double[]){x[0], 0, x[2] + (e ? -half : half)},
                                   &end[e]);
            double expected[3], gradient[9], found[3], curvature[9];
            for (int i = 0; i < 3; i++) {
                found[i] = magnet.gradient[i][2];
                expected[i] = end[0].flux[i] - end[1].flux[i];
                for (int l = 0; l < 3; l++) {
                    curvature[3 * i + l] = magnet.curvature[i][l][2];
                    gradient[3 * i + l] = end[0].gradient[i][l] - end[1].gradient[i][l];
                }
            }
            worst = fmax(worst, error_of(found, expected, 3, 0));
            worst = fmax(worst, error_of(curvature, gradient, 9, 0));
        }
    print_message("a cylinder's ends against loops: %.1e\n", worst);
    assert_true(worst < 1e-12);
}

/* Only there: an edge, a rim, a wire. */
static void test_edges(void **unused)
{
    (void)unused;
    FluxSample at;
    block((double[]){0.01, 0.002, 0.006}, &at);
    assert_false(isfinite(at.flux[0]));
    cylinder((double[]){radius, 0, half}, &at);
    assert_false(isfinite(at.flux[0]));
    solenoid((double[]){0, radius, -half}, &at);
    assert_false(isfinite(at.flux[1]));
    flux_of_round_coil(radius, 0, 1, (double[]){-radius, 0, 0}, &at);
    assert_false(isfinite(at.flux[2]));
    flux_of_rectangular_coil((double[]){0.01, 0.006}, 1, (double[]){0.01, 0.001, 0}, &at);
    assert_false(isfinite(at.flux[2]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_reference), cmocka_unit_test(test_jumps),
                                       cmocka_unit_test(test_loops), cmocka_unit_test(test_edges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
