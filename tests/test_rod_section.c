/* Rods of rectangles and given sections, and ones whose section or stiffness varies along them, against closed forms: torsion,
 * bending both ways, shear, taper, weight, vibrations, natural shapes. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NAME "test_rod_section"
#include "tests/rod_taper.h"
#include "tests/rod_fixture.h"
#include "tests/run_fixture.h"

static void assert_near(const char *what, double got, double exact, double off)
{
    print_message("%s: %.9g, %.1e off\n", what, got, fabs(got / exact - 1));
    assert_true(fabs(got / exact - 1) <= off);
}

/* Timoshenko & Goodier's table, the series term by term, and the flat rectangle's limit. */
static void test_torsion_constant(void **state)
{
    (void)state;
    static const double table[][2] = {{1, 0.1406}, {1.5, 0.1958}, {2, 0.2287},
                                      {3, 0.2633}, {5, 0.2913},   {10, 0.3123}};
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        double b = table[k][0], sum = 0, J = rod_rectangle_torsion(b, 1);
        for (int n = 4001; n > 0; n -= 2) sum += tanh(n * M_PI * b / 2) / pow(n, 5);
        assert_float_equal(J / b, table[k][1], 6e-5);
        assert_near("torsion", J, b / 3 - 64 / pow(M_PI, 5) * sum, 1e-14);
        assert_true(rod_rectangle_torsion(1e-3, 1e-3 * b) == rod_rectangle_torsion(1e-3 * b, 1e-3));
    }
    assert_near("flat", rod_rectangle_torsion(1e-4, 1), 1e-12 / 3 * (1 - 0.630249e-4), 1e-9);
}

static const double LENGTH = 0.2, YOUNG = 1e9, POISSON = 0.3;
static const char BEAM[] = "slender: 1\njob: equilibrium\nsolver: {step_tolerance: 1.0e-13}\nrod:\n  "
                           "natural_strain: [0, 0, 0]\n  length: 0.2\n"
                           "  elements: 200\n  poisson: 0.3\n  gravity: [0, 0, 0]\n";

/* The end's place, less where it is without loads. */
static Vec3 end_of(Result *result)
{
    Array x = read_all(result, "slender/rod/x");
    Vec3 end = vec3_load((const double *)x.data + array_count(&x) - 3);
    array_clear(&x);
    result_close(result);
    return vec3(end.x - LENGTH, end.y, end.z);
}

typedef struct Beam {
    const char *name, *lines;
    Vec3 force;
    double bent; /* of F L^3/E: how far the end goes along the force */
    double off;
} Beam;

/* 1 over the second moment of 4 by 1 mm across and along. */
#define FLAT (12 / (4e-3 * 1e-9))
#define EDGE (12 / (1e-3 * 64e-9))
#define DISC (4 / (M_PI * 1e-12))

static const Beam beams[] = {
    {"rectangle, over its height", "section: {width: 4 mm, height: 1 mm}", {0, 0, 1}, FLAT / 3, 2e-5},
    {"rectangle, over its width", "section: {width: 4 mm, height: 1 mm}", {0, 1, 0}, EDGE / 3, 2e-5},
    {"given", "section: {area: 1.0e-6, I1: 2.0e-13, I2: 5.0e-13, J: 1.0e-13}", {0, 0, 1}, 5e12 / 3, 2e-5},
    {"given, the other way",
     "section: {area: 1.0e-6, I1: 2.0e-13, I2: 5.0e-13, J: 1.0e-13}",
     {0, 1, 0},
     2e12 / 3,
     2e-5},
    {"a cone",
     "radius: {formula: \"1.0e-3*(1 - c*s/L)\", where: {c: \"0.6\"}}",
     {0, 1, 0},
     DISC / 3 * 2.5,
     3e-5},
    {"a step", "radius: \"s < L/2 ? 1.0e-3 : 0.5e-3\"", {0, 1, 0}, DISC * 23 / 24, 3e-5},
    {"a triangle",
     "section: {width: \"4.0e-3*(1 - 0.99999999*s/L)\", height: 1 mm}",
     {0, 0, 1},
     FLAT / 2,
     2e-5},
};

/* F L^3/(3 E I); of a cone times the ends' radii over each other; of a triangle F L^3/(2 E I). */
static void test_cantilevers(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof beams / sizeof *beams; k++) {
        const Beam *beam = &beams[k];
        double F = 1e-4 * YOUNG * LENGTH / (beam->bent * pow(LENGTH, 3)); /* a ten thousandth of the length */
        Vec3 end = end_of(run_text(mem_format(
            "%s  young: 1 GPa\n  density: 1000\n  %s\n  loads: [{point: end, force: [0, %.17g, %.17g]}]\n",
            BEAM, beam->lines, F * beam->force.y, F * beam->force.z)));
        assert_near(beam->name, vec3_dot(end, beam->force), 1e-4 * LENGTH, beam->off);
        assert_float_equal(vec3_dot(end, vec3_cross(beam->force, vec3(1, 0, 0))), 0, 1e-12);
    }
}

/* E (1 + s/L): (4 ln 2 - 5/2) F L^3/(E I), by formula and by a file of it. */
static void test_young(void **state)
{
    (void)state;
    FILE *file = fopen(NAME ".csv", "w");
    assert_non_null(file);
    fprintf(file, "s [mm], young [GPa]\n0, 1\n200, 2\n");
    fclose(file);
    const char *lines[] = {"\"1.0e+9*(1 + s/L)\"", "{file: " NAME ".csv}"};
    for (int k = 0; k < 2; k++) {
        Vec3 end = end_of(run_text(mem_format("%s  young: %s\n  density: 1000\n  radius: 1 mm\n  loads: "
                                              "[{point: end, force: [0, 1.0e-6, 0]}]\n",
                                              BEAM, lines[k])));
        assert_near("stiffer to its end", end.y, (4 * log(2) - 2.5) * 1e-6 * pow(LENGTH, 3) / YOUNG * DISC,
                    2e-5);
    }
    remove(NAME ".csv");
}

/* An end couple C about the rod twists a square by C L/(G 0.1406 a^4), and a rod of varying sides by the integral. */
static void test_torsion(void **state)
{
    (void)state;
    enum { N = 40 };
    for (int k = 0; k < 4; k++) {
        bool positions = k % 2, tapers = k / 2;
        const double a = 2e-3, C = 1e-3, left[] = {0.5, 0.25}, G = YOUNG / (2 * (1 + POISSON));
        Rod *rod = rod_create(N, LENGTH, rod_rectangle(a, a, 1, POISSON, 1000), &(RodActs){.couples = true});
        if (tapers) rod_taper(rod, a, a, left, POISSON, 1000);
        RodLayout layout = rod_layout(rod, positions);
        double *p = params_vector(&rod->params), exact = C * LENGTH / (G * 0.14057701 * pow(a, 4));
        rod_default_params(rod, YOUNG, p);
        p[rod->couple + 3 * N] = C;
        if (tapers) exact = 0;
        for (int e = 0; tapers && e < N; e++) {
            double part = (e + 0.5) / N;
            exact += C * LENGTH / N / (G * rod_rectangle_torsion(a * (1 - part / 2), a * (1 - 0.75 * part)));
        }
        System *sys = positions ? rod_system(rod, YOUNG, false) : rod_hanging_system(rod);
        State now = system_state(sys);
        rod_natural_state(rod, &layout, p, now.x);
        assert_int_equal(rod_relax(rod, sys, 4, p, &now).newton.status, NEWTON_CONVERGED);
        Vec3 strain[N];
        double twist = 0;
        rod_element_strains(rod, &layout, now.x, strain);
        for (int e = 0; e < N; e++) twist += strain[e].x * LENGTH / N;
        assert_near(tapers ? "twist of a tapered rod" : "twist of a square", twist, exact,
                    tapers ? 1e-10 : 1e-7);
        state_destroy(&now);
        system_destroy(sys);
        mem_free(p);
        rod_destroy(rod);
    }
}

/* A heavy rod that tapers: both forms have one equilibrium, and its mass is that of the truncated pyramid's elements. */
static void test_weight(void **state)
{
    (void)state;
    enum { N = 30 };
    const double left[] = {0.3, 0.6};
    Rod *rod = rod_create(N, LENGTH, rod_circle(1e-3, 1, POISSON, 1000), NULL);
    rod_taper(rod, 3e-3, 2e-3, left, POISSON, 1000);
    double *p = params_vector(&rod->params), place[2][3 * (N + 1)], sum = 0, off = 0, exact = 0;
    rod_default_params(rod, 2e6, p);
    vec3_store(p + rod->gravity, vec3(0, 3, -9));
    for (int k = 0; k < 2; k++) {
        RodLayout layout = rod_layout(rod, k);
        System *sys = k ? rod_system(rod, 2e6, false) : rod_hanging_system(rod);
        State now = system_state(sys);
        rod_natural_state(rod, &layout, p, now.x);
        assert_int_equal(rod_relax(rod, sys, 10, p, &now).newton.status, NEWTON_CONVERGED);
        rod_places(rod, &layout, now.x, N + 1, place[k]);
        state_destroy(&now);
        system_destroy(sys);
    }
    for (int i = 0; i < 3 * (N + 1); i++) off = fmax(off, fabs(place[1][i] - place[0][i]));
    print_message("with positions and without: %.1e m; the end is at %.3f m\n", off, place[0][3 * N + 2]);
    assert_true(off < 1e-10 && place[0][3 * N + 2] < -0.05);
    Masses masses = rod_masses(rod);
    for (int i = 0; i <= N; i++) sum += masses.fixed[i];
    masses_clear(&masses);
    for (int e = 0; e < N; e++)
        exact += 6e-3 * LENGTH / N * (1 - 0.7 * (e + 0.5) / N) * (1 - 0.4 * (e + 0.5) / N);
    assert_near("mass", sum, exact, 1e-14);
    assert_near("mass", rod_strand_mass(rod, 0), exact, 1e-14);
    mem_free(p);
    rod_destroy(rod);
}

static void modes_of(const char *lines, int count, double *hz)
{
    Result *result =
        run_text(mem_format("%s  young: 1 GPa\n  density: 1000\n  %s\nmodes: %d\n", BEAM, lines, count));
    Array modes = read_all(result, "slender/final/modes_hz");
    memcpy(hz, modes.data, (size_t)count * sizeof *hz);
    array_clear(&modes);
    result_close(result);
}

/* The lowest frequency times 2 pi L^2 sqrt(rho A/E I), at the clamp: 3.5160 of a beam, 5.3151 of a wedge and 8.7193 of a cone
 * [Kirchhoff 1882]. */
static void test_vibrations(void **state)
{
    (void)state;
    double hz[2], scale = 2 * M_PI * LENGTH * LENGTH * sqrt(1000 / YOUNG);
    modes_of("section: {width: 4 mm, height: 1 mm}", 2, hz);
    assert_near("beam", hz[0] * scale * sqrt(12) / 1e-3, 3.516015, 1e-4);
    assert_near("beam, the other way", hz[1] / hz[0], 4, 1e-4);
    modes_of("section: {width: 4 mm, height: \"1.0e-3*(1 - 0.999999*s/L)\"}", 1, hz);
    assert_near("wedge", hz[0] * scale * sqrt(12) / 1e-3, 5.31510, 3e-4);
    modes_of("radius: \"1.0e-3*(1 - 0.999999*s/L)\"", 1, hz);
    assert_near("cone", hz[0] * scale * 2 / 1e-3, 8.71926, 3e-4);
}

static double number_of(Result *result, const char *path)
{
    Array array = read_all(result, path);
    double value = *(const double *)array.data;
    array_clear(&array);
    return value;
}

/* What the inversion finds for a rod that varies by the moments' integral it finds by the strain equation, too, and the
 * discrete rod rests on the curve. */
static void test_inversion(void **state)
{
    (void)state;
    const char *lines[] = {"radius: \"1.5e-3*(1 - s/(2*L))\"",
                           "section: {width: \"3.0e-3*(1 - s/(2*L))\", height: 2 mm}"};
    for (int k = 0; k < 2; k++) {
        Result *result =
            run_text(mem_format("slender: 1\njob: invert\nrod:\n  curve: {formula: [\"0.015*cos(u)\", "
                                "\"0.015*sin(u)\", \"-0.00318*u\"], range: [0, 19.565163762857]}\n"
                                "  elements: 200\n  %s\n  young: \"5.0e+6*(1 + s/L)\"\n  poisson: 0.5\n  "
                                "density: 1200\n"
                                "checks: [stability, round_trip]\n",
                                lines[k]));
        double route = number_of(result, "slender/metrics/strain_route"),
               trip = number_of(result, "slender/metrics/round_trip");
        print_message("%s: two ways to the strains %.1e apart; rests %.1e m from the curve\n", lines[k],
                      route, trip);
        assert_true(route < 1e-6 && trip < 1e-12);
        result_close(result);
    }
}

/* kappa G A of a rectangle, and F L/(kappa G A) of what is given. */
static void test_shear(void **state)
{
    (void)state;
    double nu = 0.3;
    RodSection unit = rod_rectangle(3e-3, 1e-3, 1, nu, 1);
    assert_near("kappa", unit.shear1 * 2 * (1 + nu) / 3e-6, 10 * (1 + nu) / (12 + 11 * nu), 1e-14);
    assert_true(unit.shear1 == unit.shear2);
    double F = 1, area = 4e-3, G = YOUNG / (2 * (1 + POISSON)), I = 1e-5;
    Vec3 end = end_of(run_text(mem_format(
        "%s  young: 1 GPa\n  density: 1000\n  model: cosserat\n  section: {area: 4.0e-3, I1: 1.0e-5, I2: "
        "1.0e-5, J: 1.0e-5, kappa: [0.7, 0.5]}\n  loads: [{point: end, force: [0, 0, 1]}]\n",
        BEAM)));
    assert_near("Timoshenko", end.z, F * LENGTH / (0.5 * G * area) + F * pow(LENGTH, 3) / (3 * YOUNG * I),
                2e-5);
}

/* What the result says of a rod that varies. */
static void test_result(void **state)
{
    (void)state;
    Result *result = run_text(mem_format(
        "%s  young: \"1.0e+9*(1 + s/L)\"\n  density: 1000\n  radius: \"1.0e-3*(1 - s/(2*L))\"\n", BEAM));
    Array K = read_all(result, "slender/rod/stiffness"), mass = read_all(result, "slender/rod/line_density"),
          radius = read_all(result, "slender/rod/radius");
    double part = 120.5 / 200, r = 1e-3 * (1 - part / 2), E = 1e9 * (1 + part);
    const double *k = (const double *)K.data + 3 * 120;
    assert_near("EI", k[1], E * M_PI * pow(r, 4) / 4, 1e-13);
    assert_near("GJ", k[0], k[2] / 1.3, 1e-13);
    assert_near("line density", ((const double *)mass.data)[120], 1000 * M_PI * r * r, 1e-13);
    assert_near("radius", ((const double *)radius.data)[120], r, 1e-13);
    array_clear(&K);
    array_clear(&mass);
    array_clear(&radius);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_torsion_constant),
                                       cmocka_unit_test(test_cantilevers),
                                       cmocka_unit_test(test_young),
                                       cmocka_unit_test(test_torsion),
                                       cmocka_unit_test(test_weight),
                                       cmocka_unit_test(test_vibrations),
                                       cmocka_unit_test(test_inversion),
                                       cmocka_unit_test(test_shear),
                                       cmocka_unit_test(test_result)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
