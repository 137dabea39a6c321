/* Contact and friction with obstacles: derivatives, and what a plate does on a slope. */
#include "solve/check.h"
#include "solve/march.h"
#include "tests/obstacle_fixture.h"
#include "tests/shell_fixture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Derivatives ---- */

enum { POINTS = 24 };

/* So many faces, each of three points in turn, are the body's cells. */
static Outside *random_outside(const Samples *samples, const double *x, int doubled)
{
    int corners[3 * POINTS];
    for (int i = 0; i < 3 * POINTS; i++) corners[i] = (i / 3 + i % 3) % POINTS;
    Samples cells = {POINTS, 3, corners, 0};
    return outside_create(samples, &cells, (const double(*)[3])x, POINTS, NULL, doubled);
}

/* Points about a ball that turns and moves and a floor, as vertices, edges and faces; the same everywhere, or each with a
 * thickness. */
static void check_terms(int corners, bool moving, bool local)
{
    Random random = random_seed(11);
    Obstacle obstacles[] = {obstacle_sphere((double[]){0, 0, 0}, 0.02, false),
                            obstacle_plane((double[]){0, 0, -0.01}, (double[]){0.1, 0, 1})};
    if (moving) {
        obstacles[0].motion.move = of_time("0.02*t", "0.01*sin(3*t)", "0");
        obstacles[0].motion.turn = of_time("t", "2*t", "-t*t");
    }
    double x[3 * POINTS], p[3 + POINTS] = {300, 0.4, 0.7};
    for (int v = 0; v < POINTS; v++) {
        double r = 0.0195 + 5e-4 * random_signed(&random), a[3], size = 0;
        for (int i = 0; i < 3; i++) a[i] = random_signed(&random), size += a[i] * a[i];
        for (int i = 0; i < 3; i++) x[3 * v + i] = r * a[i] / sqrt(size);
    }
    int vertices[POINTS];
    for (int v = 0; v < POINTS; v++) vertices[v] = v;
    Params params = {0};
    params_add(&params, "contact_stiffness", "N/m", 1, 1, false);
    params_add(&params, "friction", "", 2, 1, false);
    if (local) params_add(&params, "thickness", "m", POINTS, 1, false);
    for (int c = 0; c < POINTS; c++) p[3 + c] = local ? 2e-3 * (0.75 + 0.25 * random_signed(&random)) : 0;
    ContactDef def = {.obstacles = obstacles,
                      .obstacle_count = 2,
                      .samples = {POINTS / corners, corners, vertices, 0},
                      .offset = 1e-3,
                      .smoothing = 2e-3,
                      .slip_speed = 0.02,
                      .friction = 1};
    Outside *outside = local ? random_outside(&def.samples, x, 3) : NULL;
    def.outside = outside;
    Point at = {.x = x, .p = p, .time = 0.3, .dt = 0.01};
    double dof_size[9] = {1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4};
    Term terms[] = {contact_term(&def), friction_term(&def)};
    for (int t = 0; t < 2; t++) {
        TermError error = check_term(&terms[t], &params, &at, 3 * POINTS, dof_size, &random);
        print_message("%s, %d corners%s%s: differences %.1e, products %.1e\n", terms[t].ops->name, corners,
                      moving ? ", moving" : "", local ? ", local" : "", check_differences(error),
                      check_products(error));
        assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
        terms[t].ops->destroy(terms[t].self);
    }
    for (int k = 0; k < 2; k++) obstacle_clear(&obstacles[k]);
    outside_destroy(outside);
    params_clear(&params);
}

static void test_derivatives(void **state)
{
    (void)state;
    for (int corners = 1; corners <= 3; corners++)
        for (int k = 0; k < 4; k++) check_terms(corners, k % 2, k / 2);
}

/* ---- A plate on a slope ---- */

static const double G = 9.81, DT = 1e-3, SLIP = 1e-3;

typedef struct Plate {
    Body body;
    MarchDef def;
} Plate;

/* 4 x 4 cells on the plane z = 0, with weight across it, until it rests. */
static Plate plate_create(double mu, bool implicit, Obstacle floor)
{
    Shell *shell = shell_of_sheet((double[]){0.01, 0.01}, (int[]){4, 4}, PATTERN_ALTERNATE);
    shell->thickness = 1e-3, shell->poisson = 0.4, shell->density = 1000;
    WorldBody shown = shell_world_body(shell);
    Obstacle *list = mem_alloc(1, sizeof *list);
    *list = floor;
    World *world = shell->world = world_create(&shown, list, 1);
    world->rubs = mu > 0;
    world->slip_speed = SLIP;
    world_add_params(world, &shell->params);
    Plate plate = {.def = march_default()};
    plate.def.implicit = implicit;
    plate.def.newton.energy_tol = 1e-14;
    plate.body = body_create(shell, shell_dynamic_system(shell), 1e6);
    plate.body.p[world->stiffness] = 1e4;
    plate.body.p[world->friction] = mu;
    return plate;
}

static void plate_march(Plate *plate, const double gravity[3], int steps)
{
    MarchInfo info;
    memcpy(plate->body.p + plate->body.shell->gravity, gravity, 3 * sizeof *gravity);
    for (int n = 0; n < steps; n++) {
        assert_true(march_step(plate->body.sys, &plate->def, DT, plate->body.p, &plate->body.state, &info));
        assert_int_equal(info.refused, 0);
    }
}

/* The mean over the masses, along x. */
static double plate_speed(const Plate *plate)
{
    const Shell *shell = plate->body.shell;
    int count = shell->mesh->vertex_count;
    double *mass = mem_alloc((size_t)count, sizeof *mass), sum = 0, total = 0;
    shell_vertex_mass(shell, plate->body.p, mass);
    for (int v = 0; v < count; v++) sum += mass[v] * plate->body.state.v[3 * v], total += mass[v];
    mem_free(mass);
    return sum / total;
}

static Obstacle floor_at(double z)
{
    return obstacle_plane((double[]){0, 0, z}, (double[]){0, 0, 1});
}

static Plate slope(double mu, double tan_a, bool implicit, double gravity[3])
{
    Plate plate = plate_create(mu, implicit, floor_at(0));
    double a = atan(tan_a);
    gravity[0] = G * sin(a), gravity[1] = 0, gravity[2] = -G * cos(a);
    plate_march(&plate, (double[]){0, 0, gravity[2]}, 50);
    return plate;
}

/* What sticks creeps with v (1 - sqrt(1 - tan a/mu)), v the slip speed. */
static void test_creep(void **state)
{
    (void)state;
    for (int implicit = 0; implicit < 2; implicit++)
        for (double tan_a = 0.3; tan_a < 0.6; tan_a += 0.2) {
            double gravity[3], exact = SLIP * (1 - sqrt(1 - tan_a / 0.6));
            Plate plate = slope(0.6, tan_a, implicit, gravity);
            plate_march(&plate, gravity, 200);
            double error = plate_speed(&plate) / exact - 1;
            print_message("creep at tan a = %.1f, %s: %.7e m/s, off by %.1e\n", tan_a,
                          implicit ? "implicit" : "lagged", plate_speed(&plate), error);
            assert_true(fabs(error) < 1e-4);
            body_clear(&plate.body);
        }
}

static void test_sliding(void **state)
{
    (void)state;
    for (int implicit = 0; implicit < 2; implicit++)
        for (double tan_a = 0.7; tan_a < 1.1; tan_a += 0.3) {
            double gravity[3];
            Plate plate = slope(0.6, tan_a, implicit, gravity);
            plate_march(&plate, gravity, 100);
            double before = plate_speed(&plate);
            plate_march(&plate, gravity, 100);
            double gained = plate_speed(&plate) - before, exact = 100 * DT * (gravity[0] + 0.6 * gravity[2]);
            print_message("sliding at tan a = %.1f, %s: off by %.1e\n", tan_a,
                          implicit ? "implicit" : "lagged", gained / exact - 1);
            assert_true(fabs(gained / exact - 1) < 1e-3);
            body_clear(&plate.body);
        }
}

static void test_threshold(void **state)
{
    (void)state;
    const double mu[2] = {0.505, 0.48};
    for (int k = 0; k < 2; k++) {
        double gravity[3];
        Plate plate = slope(mu[k], 0.5, false, gravity);
        plate_march(&plate, gravity, 200);
        double slides = 200 * DT * (gravity[0] + mu[k] * gravity[2]);
        if (k == 0) assert_true(plate_speed(&plate) < SLIP);
        if (k == 1) assert_true(fabs(plate_speed(&plate) / slides - 1) < 0.05);
        body_clear(&plate.body);
    }
}

/* On a belt that runs it is carried along, and stays on it. */
static void test_belt(void **state)
{
    (void)state;
    for (int implicit = 0; implicit < 2; implicit++) {
        Obstacle belt = floor_at(0);
        belt.motion.move = of_time("0.1*t", "0", "0");
        Plate plate = plate_create(0.5, implicit, belt);
        plate_march(&plate, (double[]){0, 0, -G}, 100);
        assert_true(fabs(plate_speed(&plate) - 0.1) < 1e-3 * SLIP);
        body_clear(&plate.body);
    }
}

/* However fast it flies at a thin wall, it does not pass through. */
static void test_thrown(void **state)
{
    (void)state;
    for (double speed = 1; speed < 101; speed *= 10) {
        Obstacle wall = obstacle_box((double[]){0, 0, -2e-3}, (double[]){0.05, 0.05, 1e-4}, 1e-4);
        Plate plate = plate_create(0, false, wall);
        Body *body = &plate.body;
        for (int v = 0; v < body->shell->mesh->vertex_count; v++) body->state.v[3 * v + 2] = -speed;
        plate.def.newton.energy_tol = 1e-10;
        plate_march(&plate, (double[]){0, 0, 0}, 20);
        double lowest = INFINITY;
        for (int v = 0; v < body->shell->mesh->vertex_count; v++)
            lowest = fmin(lowest, body->state.x[3 * v + 2]);
        print_message("thrown at %g m/s: lowest at %.3g mm\n", speed, 1e3 * lowest);
        assert_true(lowest > -2e-3);
        body_clear(body);
    }
}

/* What it rests on with all its weight it sinks into by N/k + e/2. */
static void test_depth(void **state)
{
    (void)state;
    Plate plate = plate_create(0, false, floor_at(0));
    plate_march(&plate, (double[]){0, 0, -G}, 200);
    const Shell *shell = plate.body.shell;
    double force[1][3] = {{0}}, weight = 0.01 * 0.01 * 1e-3 * 1000 * G;
    WorldSums sums = {.contact = {.force = force}};
    Point at = state_point(&plate.body.state, plate.body.p);
    world_measure(shell->world, &at, &sums);
    print_message("%g touch, deepest %.3g m, force %.6g of %.6g N\n", sums.contact.touching,
                  sums.contact.depth, force[0][2], weight);
    assert_true(fabs(force[0][2] / weight - 1) < 1e-9 && fabs(force[0][0]) < 1e-9 * weight);
    assert_true(sums.contact.touching == shell->mesh->vertex_count);
    body_clear(&plate.body);
}

/* On a floor that moves and turns: a system that has the state and the anchor alone goes on bit by bit. */
static void test_restored(void **state)
{
    (void)state;
    for (int implicit = 0; implicit < 2; implicit++) {
        Plate plates[2];
        for (int k = 0; k < 2; k++) {
            Obstacle floor = floor_at(0);
            floor.motion.move = of_time("0.1*t", "0", "0"),
            floor.motion.turn = of_time("2*t", "0-3*t", "9*t");
            plates[k] = plate_create(0.5, implicit, floor);
            plates[k].def.newton.energy_tol = 1e-10;
        }
        State *whole = &plates[0].body.state, *other = &plates[1].body.state;
        System *sys = plates[0].body.sys;
        for (int n = 0; n < 60; n++) {
            state_copy(other, whole);
            system_restore_factor(plates[1].body.sys, system_anchor(sys), plates[1].body.p);
            for (int k = 0; k < 2; k++) plate_march(&plates[k], (double[]){0, 0, -G}, 1);
            assert_memory_equal(whole->x, other->x, (size_t)whole->dofs * sizeof(double));
        }
        for (int k = 0; k < 2; k++) body_clear(&plates[k].body);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives), cmocka_unit_test(test_creep),
                                       cmocka_unit_test(test_sliding),     cmocka_unit_test(test_threshold),
                                       cmocka_unit_test(test_belt),        cmocka_unit_test(test_thrown),
                                       cmocka_unit_test(test_depth),       cmocka_unit_test(test_restored)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
