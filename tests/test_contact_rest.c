/* What comes to rest on obstacles, or is pressed by them: a ball that falls, sheets, a ring between plates. */
#include "solve/march.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <stdio.h>

static const double G = 9.81;

/* What obstacles do to the body in a state: N, of each obstacle along z, and how many places touch. */
static double felt(const Built *b, double up[])
{
    const World *world = b->model->world;
    const Case *c = &b->model->cases[0];
    double(*force)[3] = mem_alloc((size_t)world->obstacle_count, sizeof *force);
    WorldSums sums = {.contact = {.force = force}};
    Point at = state_point(&c->state, c->stages[0].p);
    world_measure(world, &at, &sums);
    for (int k = 0; k < world->obstacle_count; k++) up[k] = force[k][2];
    mem_free(force);
    return sums.contact.touching;
}

static double *masses(const Built *b)
{
    double *mass = mem_alloc((size_t)b->model->point_count, sizeof *mass);
    model_masses(b->model, b->model->cases[0].stages[0].p, mass);
    return mass;
}

static double total(const double *mass, int count)
{
    double sum = 0;
    for (int v = 0; v < count; v++) sum += mass[v];
    return sum;
}

static double lowest(const Built *b)
{
    double low = INFINITY;
    for (int v = 0; v < b->model->point_count; v++) low = fmin(low, b->model->cases[0].state.x[3 * v + 2]);
    return low;
}

/* ---- A soft ball falls onto the floor ---- */

static const double FLOOR = -0.01, DT = 1e-3;

static void centre(const Built *b, const double *mass, double at[3])
{
    int count = b->model->point_count;
    for (int i = 0; i < 3; i++) at[i] = 0;
    for (int i = 0; i < 3 * count; i++)
        at[i % 3] += mass[i / 3] * b->model->cases[0].state.x[i] / total(mass, count);
}

/* Kinetic, and all potentials: of a system of statics. */
static double energy_of(const Built *b, System *statics, const double *mass)
{
    const Case *c = &b->model->cases[0];
    Point at = state_point(&c->state, c->stages[0].p);
    double energy = system_energy(statics, &at).energy;
    for (int i = 0; i < 3 * b->model->point_count; i++)
        energy += mass[i / 3] * c->state.v[i] * c->state.v[i] / 2;
    return energy;
}

/* Until it touches: of implicit Euler z_n = z_0 + n dt v_0 - n (n + 1)/2 g dt^2. */
static void check_fall(Built *b, const MarchDef *def, const double *mass, const double start[3])
{
    Case *c = &b->model->cases[0];
    double up, worst = 0, way = 0;
    int n = 0;
    for (;;) {
        MarchInfo info;
        assert_true(march_step(c->sys, def, DT, c->stages[0].p, &c->state, &info));
        if (felt(b, &up) > 0) break;
        double now[3], exact[3] = {start[0] + ++n * DT * 0.02, start[1], 0};
        way = n * (n + 1) / 2 * G * DT * DT;
        exact[2] = start[2] - way;
        centre(b, mass, now);
        for (int i = 0; i < 3; i++) worst = fmax(worst, fabs(now[i] - exact[i]));
    }
    print_message("falls by %g mm in %d steps, off by %.1e m\n", 1e3 * way, n, worst);
    assert_true(n > 25 && worst < 1e-15);
}

static void test_ball(void **unused)
{
    (void)unused;
    Built b = scene_build(
        mem_format("slender: 1\njob: simulate\nshell:\n  mesh: {file: %s/scenes/meshes/ball.obj}\n"
                   "  thickness: 0.4 mm\n  young: 0.1 MPa\n  poisson: 0.3\n  density: 1000\n"
                   "  gravity: [0, 0, -%g]\n  velocity: [20 mm/s, 0, 0]\n"
                   "obstacles: [{name: floor, plane: {point: [0, 0, %g]}}]\n"
                   "time: {step: 1 ms, steps: 1}\n",
                   SOURCE_DIR, G, FLOOR));
    Case *c = &b.model->cases[0];
    System *statics = b.model->body->ops->system(b.model, false);
    MarchDef def = march_default();
    double *mass = masses(&b), start[3], up, weight = G * total(mass, b.model->point_count),
           worst = -INFINITY;
    centre(&b, mass, start);
    double before = energy_of(&b, statics, mass), first = before;
    check_fall(&b, &def, mass, start);
    c->stages[0].p[params_find(b.model->params, "damping")->offset] = 1e-4; /* 5 ms, from here on */
    for (int n = 0; n < 400; n++) {
        MarchInfo info;
        double now = energy_of(&b, statics, mass);
        worst = fmax(worst, now - before), before = now;
        assert_true(march_step(c->sys, &def, DT, c->stages[0].p, &c->state, &info));
    }
    double touching = felt(&b, &up), speed = 0, sunk = FLOOR + b.model->world->offset - lowest(&b);
    for (int i = 0; i < 3 * b.model->point_count; i++) speed = fmax(speed, fabs(c->state.v[i]));
    print_message(
        "from %.3g to %.3g J, most gained in a step %.1e; rests on %g places, %.1e m deep, with %.2e m/s; "
        "force over weight - 1 %.1e\n",
        first, before, worst, touching, sunk, speed, up / weight - 1);
    assert_true(fabs(up / weight - 1) < 1e-6 && speed < 1e-4);
    assert_true(worst < 1e-9 * (first - before) && before < first - weight * 5e-3);
    assert_true(touching >= 3 && sunk > 0 && sunk < 0.01 * 0.4e-3);
    system_destroy(statics);
    mem_free(mass);
    clear(&b);
}

/* ---- Sheets that rest, in statics ---- */

static NewtonInfo settle(const Built *b, double time)
{
    Case *c = &b->model->cases[0];
    NewtonDef def = newton_default();
    def.step_cap = b->model->step_cap;
    c->state.time = time;
    Point at = {.p = c->stages[0].p, .time = time};
    return newton_minimize(c->sys, &def, &at, &c->state, NULL);
}

static void check_rest(const char *sheet, const char *obstacles, int most)
{
    Built b = scene_build(
        mem_format("slender: 1\njob: equilibrium\nshell:\n  mesh: {%s}\n"
                   "  thickness: 0.3 mm\n  young: 0.1 MPa\n  poisson: 0.3\n  density: 1000\n"
                   "  gravity: [0, 0, -%g]\nobstacles: [%s]\n%s",
                   sheet, G, obstacles, strstr(sheet, "disc") ? "fix: [{group: centre, axes: xy}]\n" : ""));
    NewtonInfo info = settle(&b, 0);
    double *mass = masses(&b), up[2] = {0}, weight = G * total(mass, b.model->point_count);
    double touching = felt(&b, up), low = lowest(&b);
    print_message("%s after %d iterations: lowest at %.3g mm, %g places bear %.3g and %.3g N; off by %.1e\n",
                  newton_status_name(info.status), info.iterations, 1e3 * low, touching, up[0], up[1],
                  (up[0] + up[1]) / weight - 1);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    assert_true(fabs((up[0] + up[1]) / weight - 1) < 1e-9);
    assert_true(touching > 3 && touching <= most);
    mem_free(mass);
    clear(&b);
}

static void test_sheets(void **unused)
{
    (void)unused;
    check_rest("shape: sheet, size: [10 mm, 10 mm], cells: [6, 6]", "{plane: {point: [0, 0, -0.15 mm]}}", 49);
    check_rest("shape: disc, size: 20 mm, n: 6", "{sphere: {center: [0, 0, -5.15 mm], radius: 5 mm}}", 126);
    check_rest("shape: disc, size: 24 mm, n: 6",
               "{sphere: {center: [0, 0, -4.15 mm], radius: 4 mm}}, {plane: {point: [0, 0, -4.15 mm]}}", 126);
}

/* ---- A ring between plates ---- */

static const double RADIUS = 0.01, WIDTH = 1.3e-3, THICKNESS = 2e-4, YOUNG = 1e5;

/* The axis along y; vertex 0 on top. */
static void write_ring(const char *path, int around, int across)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int j = 0; j <= across; j++)
        for (int i = 0; i < around; i++) {
            double a = 2 * M_PI * i / around;
            fprintf(file, "v %.17g %.17g %.17g\n", RADIUS * sin(a), WIDTH * j / across, RADIUS * cos(a));
        }
    for (int j = 0; j < across; j++)
        for (int i = 0; i < around; i++) {
            int a = 1 + around * j + i, b = 1 + around * j + (i + 1) % around, c = a + around, d = b + around;
            if ((i + j) % 2)
                fprintf(file, "f %d %d %d\nf %d %d %d\n", a, b, d, a, d, c);
            else
                fprintf(file, "f %d %d %d\nf %d %d %d\n", a, b, c, b, d, c);
        }
    assert_int_equal(fclose(file), 0);
}

/* An inextensible elastica that is a circle of radius 1 without forces, pressed by P EI between two plates. From where it
 * leaves a plate to half its height, theta its slope and k its curvature at the plate,
 *
 *     theta'^2 = k^2 + P sin theta,   0 < theta < pi/2.
 *
 * With these on the way: the length and the height, theta = pi u^2/2 so that nothing is singular where k = 0. */
static void quarter(double P, double k2, double *length, double *height)
{
    enum { PIECES = 2000 };
    *length = *height = 0;
    for (int n = 0; n < PIECES; n++) {
        double u = (n + 0.5) / PIECES, theta = M_PI / 2 * u * u,
               ds = M_PI * u / sqrt(k2 + P * sin(theta)) / PIECES;
        *length += ds, *height += sin(theta) * ds;
    }
}

/* The distance of the plates: they touch along a line as long as k > 0, then along flat parts, in which k = 0. */
static double exact_height(double P)
{
    double low = 0, high = 1, length, height;
    for (int n = 0; n < 60; n++) {
        double k2 = (low + high) / 2;
        quarter(P, k2, &length, &height);
        *(length > M_PI / 2 ? &low : &high) = k2;
    }
    return 2 * height;
}

/* P of the meshed ring between plates at these distances, which become less. */
static void press(int around, int across, int count, const double *distance, double *P)
{
    write_ring("ring.obj", around, across);
    Built b = scene_build(mem_format(
        "slender: 1\njob: equilibrium\nshell:\n  mesh: ring.obj\n  thickness: %g\n  young: %g\n  poisson: 0\n"
        "fix: [{vertices: [0, %d, %d, %d], axes: x}, {vertices: [0], axes: y}]\n"
        "contact: {offset: 0}\nobstacles:\n  - {name: table, plane: {point: [0, 0, %g]}}\n"
        "  - {name: press, plane: {point: [0, 0, %g], normal: [0, 0, -1]}, move: [\"0\", \"0\", \"-t\"]}\n",
        THICKNESS, YOUNG, around / 2, around * across, around * across + around / 2, -RADIUS, RADIUS));
    double way = 0, unit = YOUNG * WIDTH * pow(THICKNESS, 3) / 12 / (RADIUS * RADIUS), up[2];
    for (int k = 0; k < count; k++) {
        double end = (2 - distance[k]) * RADIUS;
        for (int steps = (int)ceil((end - way) / (THICKNESS / 2)); steps > 0; steps--) {
            way += (end - way) / steps;
            NewtonInfo info = settle(&b, way);
            if (info.status != NEWTON_CONVERGED)
                fail_msg("at %g: %s", 2 - way / RADIUS, newton_status_text(info.status));
        }
        felt(&b, up);
        assert_true(fabs(up[0] + up[1]) < 1e-6 * up[0]);
        P[k] = up[0] / unit;
    }
    clear(&b);
}

static void test_ring(void **unused)
{
    (void)unused;
    enum { COUNT = 5 };
    const double exact[COUNT] = {0.1, 1, 2.5, 4, 7}; /* it lies flat from 2.786 on */
    double distance[COUNT], coarse[COUNT], fine[COUNT];
    for (int k = 0; k < COUNT; k++) distance[k] = exact_height(exact[k]);
    press(48, 1, COUNT, distance, coarse);
    press(96, 2, COUNT, distance, fine);
    for (int k = 0; k < COUNT; k++)
        print_message("distance %.4f: P %.4f, finer %.4f, exactly %.4f\n", distance[k], coarse[k], fine[k],
                      exact[k]);
    for (int k = 0; k < COUNT; k++) {
        assert_true(fabs(coarse[k] / fine[k] - 1) < 0.03);
        assert_true(fabs(fine[k] / exact[k] - 1) < 0.02);
    }
    /* Beside the circle [Timoshenko & Young]; and flat, where all quarters have one shape. */
    assert_true(fabs((2 - distance[0]) / exact[0] / (M_PI / 4 - 2 / M_PI) - 1) < 0.02);
    assert_true(fabs(distance[4] * sqrt(exact[4]) / 2.3962804694711844 - 1) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ball), cmocka_unit_test(test_sheets),
                                       cmocka_unit_test(test_ring)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
