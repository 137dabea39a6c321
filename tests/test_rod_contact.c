/* Rods that touch obstacles: what they bear and how they rub, against closed forms. */
#include "tests/rod_world_fixture.h"

static const double G = 9.81;

/* A rod laid on a floor: the floor bears what the clamp does not, and each node its own weight; it sinks in by less than a
 * hundredth of its radius. */
static void test_laid(void **state)
{
    (void)state;
    enum { N = 40 };
    double r = 1e-3, mass = 1200 * M_PI * r * r * 0.1;
    RigDef def = {.strands = 1,
                  .elements = N,
                  .length = 0.1,
                  .radius = r,
                  .young = 1e6,
                  .density = 1200,
                  .stiffness = 1e4,
                  .obstacles = {obstacle_plane((double[]){0, 0, 0}, (double[]){0, 0, 1})},
                  .obstacle_count = 1};
    Rig rig = rig_create(&def);
    rig.p[rig.rod->gravity + 2] = -G;
    rig.p[rig.rod->damping] = 1e-3 / rod_element_length(rig.rod, 0);
    rig.rod->strand[0].position = vec3(0, 0, 2 * r);
    rig_start(&rig, def.young);
    int iterations = rig_march(&rig, 5e-3, 200);
    double floor = rig.force[0][2], clamp = -rig_pull(&rig, 0).z, half = mass / N / 2;
    print_message(
        "laid: floor %.6g + clamp %.6g of %.6g N, %.2f %% of the radius deep, %.1f iterations a step\n",
        floor, clamp, mass * G, 100 * rig.sums.contact.depth / r, iterations / 200.0);
    assert_near(floor + clamp, (mass - half) * G, 1e-9 * mass * G);
    assert_true(rig.sums.contact.depth < 0.01 * r && rig.sums.contact.touching > N / 2);
    double own = mass / N * G, e = 0.01 * r; /* d^2/(2 e) = N/k */
    assert_near(r - rig_place(&rig, N - 5).z, sqrt(2 * e * own / def.stiffness), 1e-3 * r);
    rig_clear(&rig);
}

/* A bar that comes down on the tip of a cantilever: F = 3 EI d/L^3. */
static void test_pressed(void **state)
{
    (void)state;
    enum { N = 50 };
    double r = 1e-3, L = 0.1, young = 1e7, d = 1e-3, bend = young * M_PI * pow(r, 4) / 4;
    RigDef def = {.strands = 1,
                  .elements = N,
                  .length = L,
                  .radius = r,
                  .young = young,
                  .density = 1200,
                  .stiffness = 1e4,
                  .obstacles = {obstacle_cylinder((double[]){L, 0, 6e-3}, (double[]){0, 1, 0}, 5e-3, false)},
                  .obstacle_count = 1};
    def.obstacles[0].motion.move = of_time("0", "0", "-0.001*min(t/0.1, 1)");
    Rig rig = rig_create(&def);
    rig.p[rig.rod->damping] = 1e-3 / rod_element_length(rig.rod, 0);
    rig_start(&rig, young);
    rig_march(&rig, 5e-3, 200);
    double sunk = -rig_place(&rig, N).z, force = -rig.force[0][2];
    print_message("pressed: %.6g N, 3 EI d/L^3 = %.6g N, %.2f %% of the radius deep\n", force,
                  3 * bend * sunk / pow(L, 3), 100 * rig.sums.contact.depth / r);
    assert_near(sunk, d, 1e-2 * r);
    assert_near(force / (3 * bend * sunk / pow(L, 3)), 1, 1e-3);
    rig_clear(&rig);
}

/* A pipe that is pulled along a straight rod, which lies in it with its weight: mu times that. */
static void test_pipe(void **state)
{
    (void)state;
    double r = 1e-3, mu = 0.3;
    RigDef def = {.strands = 1,
                  .elements = 30,
                  .length = 0.1,
                  .radius = r,
                  .young = 1e6,
                  .density = 1200,
                  .friction = mu,
                  .stiffness = 1e4,
                  .obstacles = {obstacle_cylinder((double[]){0, 0, 3 * r}, (double[]){1, 0, 0}, 4 * r, true)},
                  .obstacle_count = 1};
    def.obstacles[0].motion.move = of_time("0.05*t", "0", "0");
    Rig rig = rig_create(&def);
    rig.p[rig.rod->gravity + 2] = -G;
    rig.p[rig.rod->damping] = 1e-3 / rod_element_length(rig.rod, 0);
    rig_start(&rig, def.young);
    rig_march(&rig, 20e-3, 100);
    print_message("pipe: friction %.6g of %.6g N, the clamp holds %.6g\n", rig.force[0][0], rig.force[0][2],
                  rig_pull(&rig, 0).x);
    assert_near(rig.force[0][0], mu * rig.force[0][2], 1e-6 * rig.force[0][2]);
    assert_near(rig_pull(&rig, 0).x, rig.force[0][0], 1e-8 * rig.force[0][2]);
    rig_clear(&rig);
}

/* A rod over half a turning bar, with a load at its end: what the clamp holds is that load times exp(mu pi), or its inverse
 * [Euler, Eytelwein]; a soft one is a rope. */
static void test_capstan(void **state)
{
    (void)state;
    enum { ROUND = 40, STRAIGHT = 15, N = ROUND + 2 * STRAIGHT };
    double r = 5e-4, R = 0.02, mu = 0.3, pull = 0.02, step = M_PI * (R + r) / ROUND;
    for (int back = 0; back < 2; back++) {
        RigDef def = {.strands = 1,
                      .elements = N,
                      .length = N * step,
                      .radius = r,
                      .young = 1e5,
                      .density = 1200,
                      .friction = mu,
                      .stiffness = 1e3,
                      .obstacles = {obstacle_cylinder((double[]){0, 0, 0}, (double[]){0, 1, 0}, R, false)},
                      .obstacle_count = 1};
        def.obstacles[0].motion.turn = of_time("0", back ? "-2*t" : "2*t", "0");
        Rig rig = rig_create(&def);
        Rod *rod = rig.rod;
        rod->strand[0].position = vec3(-R - r, 0, -STRAIGHT * step);
        rod->strand[0].frame = quat_from_axes(vec3(0, 0, 1), vec3(0, 1, 0), vec3(-1, 0, 0));
        for (int e = STRAIGHT; e < STRAIGHT + ROUND; e++)
            rig.p[rod->natural_strain + 3 * e + 1] = 1 / (R + r);
        rig_start(&rig, def.young);
        for (int e = 0; e < N; e++) rig.p[rod->natural_strain + 3 * e + 1] = 0;
        rig.p[rod->load + 3 * N + 2] = -pull;
        rod_sum_loads(rod, rig.p);
        rig.p[rod->damping] = 1e-4 / rod_element_length(rod, 0);
        rig_march(&rig, 5e-3, 200);
        double held = rig_pull(&rig, 0).z, expected = exp((back ? -mu : mu) * M_PI);
        print_message("capstan: %.5f times the load, exp(mu pi) = %.5f, %.2f %% of the radius deep\n",
                      held / pull, expected, 100 * rig.sums.contact.depth / r);
        assert_near(held / pull / expected, 1, 0.01);
        rig_clear(&rig);
    }
}

/* A heavy rod hung over a smooth bar: all forces balance. */
static void test_hung(void **state)
{
    (void)state;
    double r = 1e-3, mass = 8000 * M_PI * r * r * 0.2;
    RigDef def = {
        .strands = 1,
        .elements = 80,
        .length = 0.2,
        .radius = r,
        .young = 1e7,
        .density = 8000,
        .stiffness = 1e6,
        .obstacles = {obstacle_cylinder((double[]){0.08, 0, -0.02}, (double[]){0, 1, 0}, 0.01, false)},
        .obstacle_count = 1};
    Rig rig = rig_create(&def);
    rig.p[rig.rod->gravity + 2] = -G;
    rig.p[rig.rod->damping] = 1e-3 / rod_element_length(rig.rod, 0);
    rig_start(&rig, def.young);
    rig_march(&rig, 20e-3, 400);
    Vec3 clamp = rig_pull(&rig, 0), bar = vec3_load(rig.force[0]);
    double weight = mass * (1 - 0.5 / 80) * G;
    print_message("hung: bar (%.5g, %.5g), clamp (%.5g, %.5g) N of %.5g, %.2f %% of the radius deep\n", bar.x,
                  bar.z, -clamp.x, -clamp.z, weight, 100 * rig.sums.contact.depth / r);
    assert_near(bar.x - clamp.x, 0, 1e-6 * weight);
    assert_near(bar.z - clamp.z, weight, 1e-6 * weight);
    assert_true(bar.z > 0.3 * weight && rig.sums.contact.depth < 0.01 * r);
    rig_clear(&rig);
}

/* A ball that is shot at a rod pushes it where an element's middle is; halfway between that and a node it goes through, and
 * that is found, at whatever speed. */
static void test_shot(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        bool between = k % 2;
        RigDef def = {
            .strands = 1,
            .elements = 10,
            .length = 0.1,
            .radius = 5e-4,
            .young = 1e6,
            .density = 1300,
            .stiffness = 1e4,
            .obstacles = {obstacle_sphere((double[]){between ? 0.0525 : 0.055, 2e-4, 0.01}, 1e-3, false)},
            .obstacle_count = 1};
        def.obstacles[0].motion.move = of_time("0", "0", k / 2 ? "-100*t" : "-10*t");
        Rig rig = rig_create(&def);
        rig_start(&rig, def.young);
        int passed = 0, steps = k / 2 ? 3 : 20;
        for (int n = 0; n < steps; n++) {
            MarchInfo info;
            assert_true(march_step(rig.sys, &rig.march, 1e-4, rig.p, &rig.now, &info));
            passed += info.passed;
        }
        print_message("shot at %s: goes through in %d steps\n", between ? "a quarter" : "a middle", passed);
        assert_true((passed > 0) == between);
        rig_clear(&rig);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_laid),    cmocka_unit_test(test_pressed),
                                       cmocka_unit_test(test_shot),    cmocka_unit_test(test_pipe),
                                       cmocka_unit_test(test_capstan), cmocka_unit_test(test_hung)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
