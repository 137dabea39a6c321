/* Obstacles: their gaps against closed forms, gradients and Hessians against differences. */
#include "base/random.h"
#include "tests/obstacle_fixture.h"

/* ---- Fields ---- */

static double hill(double x, double y)
{
    return 0.3 * sin(3 * x + 1) * cos(2 * y) + 0.2 * x * y;
}

static Obstacle hills(int cells)
{
    double *height = mem_alloc((size_t)((cells + 1) * (cells + 1)), sizeof *height);
    for (int i = 0; i <= cells; i++)
        for (int j = 0; j <= cells; j++)
            height[i * (cells + 1) + j] = hill(-1 + 2.0 * i / cells, -0.5 + 1.5 * j / cells);
    Obstacle obstacle =
        obstacle_height_field((const double[2][2]){{-1, -0.5}, {1, 1}}, (int[2]){cells, cells}, height);
    mem_free(height);
    return obstacle;
}

static Obstacle bent_tube(int axis, double wave)
{
    enum { CELLS = 40 };
    double sample[CELLS + 1][3];
    for (int k = 0; k <= CELLS; k++) {
        double s = -1 + 2.0 * k / CELLS;
        memcpy(sample[k],
               (double[3]){0.5 + 0.1 * wave * sin(4 * s), 0.2 * wave * cos(3 * s), 0.1 + 0.3 * wave * s * s},
               sizeof *sample);
    }
    Obstacle obstacle;
    Error err;
    if (!obstacle_tube(axis, (double[2]){-1, 1}, CELLS, (const double(*)[3])sample, &obstacle, &err))
        fail_msg("%s", err.text);
    return obstacle;
}

/* ---- Derivatives ---- */

/* Where an obstacle is asked: a box, and the cells of its splines, whose third derivatives jump in between. */
typedef struct Place {
    double low[3], high[3], origin[3], cell[3]; /* cell 0: none */
} Place;

static void choose(const Place *place, Random *random, double x[3])
{
    for (int i = 0; i < 3; i++) {
        x[i] = place->low[i] + (place->high[i] - place->low[i]) * random_uniform(random);
        if (place->cell[i] > 0)
            x[i] = place->origin[i] + place->cell[i] * (floor((x[i] - place->origin[i]) / place->cell[i]) +
                                                        0.05 + 0.9 * random_uniform(random));
    }
}

/* Differences of fourth order with a step h against gradient and Hessian, in parts of 1 and 1/size. */
static double derivative_error(const Obstacle *obstacle, const RigidPose *pose, const double x[3], double h,
                               double size)
{
    static const double weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12}, step[4] = {-2, -1, 1, 2};
    Gap gap, other;
    double worst = 0;
    obstacle_gap(obstacle, pose, x, &gap);
    assert_finite(&gap, 0.1);
    for (int i = 0; i < 3; i++) {
        double slope = 0, bend[3] = {0};
        for (int k = 0; k < 4; k++) {
            double moved[3] = {x[0], x[1], x[2]};
            moved[i] += step[k] * h;
            obstacle_gap(obstacle, pose, moved, &other);
            slope += weight[k] / h * other.value;
            for (int j = 0; j < 3; j++) bend[j] += weight[k] / h * other.gradient[j];
        }
        worst = fmax(worst, fabs(slope - gap.gradient[i]));
        for (int j = 0; j < 3; j++) worst = fmax(worst, size * fabs(bend[j] - gap.hessian[i][j]));
    }
    return worst;
}

/* As it is, moved, and moved and turned. The obstacle is cleared. */
static void check_derivatives(Obstacle obstacle, Place place, double h, double size)
{
    Random random = random_seed(5);
    double worst[3] = {0};
    for (int way = 0; way < 3; way++) {
        Error err;
        if (way == 1) obstacle.motion.move = of_time("0.3*t", "sin(t)", "-t");
        if (way == 2) obstacle.motion.turn = of_time("t", "0.5*t", "2 - t");
        RigidPose pose;
        assert_true(obstacle_pose(&obstacle, 0.7, &pose, &err));
        for (int n = 0; n < 300; n++) {
            double own[3], x[3];
            choose(&place, &random, own);
            for (int i = 0; i < 3; i++) {
                x[i] = pose.shift[i];
                for (int j = 0; j < 3; j++) x[i] += pose.turn[i][j] * own[j];
            }
            worst[way] = fmax(worst[way], derivative_error(&obstacle, &pose, x, h, size));
        }
    }
    print_message("%-12s derivatives %.1e, moved %.1e, turned %.1e\n", obstacle.ops->kind, worst[0], worst[1],
                  worst[2]);
    for (int way = 0; way < 3; way++) assert_true(worst[way] <= 1e-7);
    obstacle_clear(&obstacle);
}

static void test_derivatives(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    double origin[3] = {0.1, -0.2, 0.3}, up[3] = {1, 2, -0.5};
    Place around = {.low = {-2, -2, -2}, .high = {2, 2, 2}};
    check_derivatives(obstacle_plane(origin, up), around, 1e-3, 1);
    /* Away from the centre and the axis. */
    Place aside = {.low = {0.4, 0.2, 0.6}, .high = {2, 2, 2}};
    check_derivatives(obstacle_sphere(origin, 0.7, false), aside, 1e-3, 1);
    check_derivatives(obstacle_sphere(origin, 0.7, true), aside, 1e-3, 1);
    check_derivatives(obstacle_cylinder(origin, (double[3]){0, 3, 0}, 0.7, false), aside, 1e-3, 1);
    check_derivatives(obstacle_cylinder(origin, (double[3]){-1, 2, 0.3}, 0.7, true),
                      (Place){.low = {1, 1, 1}, .high = {2, 1.5, 2}}, 1e-3, 1);
    /* Of a box each of the 27 cells around its core, and the six within. */
    double half[3] = {1, 0.8, 0.6}, core[3] = {0.7, 0.5, 0.3};
    for (int k = 0; k < 27; k++) {
        Place place;
        for (int i = 0; i < 3; i++) {
            int side = (int[3]){k % 3, k / 3 % 3, k / 9}[i] - 1;
            place.low[i] = side < 0 ? -2 : side > 0 ? core[i] + 0.1 : 0.1 - core[i];
            place.high[i] = side < 0 ? -core[i] - 0.1 : side > 0 ? 2 : core[i] - 0.1;
        }
        place.cell[0] = place.cell[1] = place.cell[2] = 0;
        if (k != 13) check_derivatives(obstacle_box((double[3]){0}, half, 0.3), place, 1e-3, 1);
    }
    check_derivatives(obstacle_box((double[3]){0}, half, 0.3),
                      (Place){.low = {-0.1, -0.1, 0.18}, .high = {0.1, 0.1, 0.28}}, 1e-3, 1);
    /* Splines: within their range, and beyond it. */
    check_derivatives(hills(10), (Place){{-2, -1.5, -1}, {2, 2, 1}, {-1, -0.5, 0}, {0.2, 0.15, 0}}, 1e-3, 1);
    for (int axis = 0; axis < 3; axis++) {
        Place place = {{0.6, 0.6, 0.6}, {0.9, 0.9, 0.9}, {0}, {0}}; /* beside the line */
        place.low[axis] = -1.4, place.high[axis] = 1.4;
        place.origin[axis] = -1, place.cell[axis] = 0.05;
        check_derivatives(bent_tube(axis, 1), place, 3e-4, 1);
    }
    MeshFile ball = make_block(4, 1, 1);
    check_derivatives(mesh_obstacle(&ball, 0.125),
                      (Place){{-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5}, {-1, -1, -1}, {0.125, 0.125, 0.125}}, 3e-4,
                      1);
    assert_int_equal(mem_live_count(), blocks);
}

/* ---- Values ---- */

static void test_values(void **state)
{
    (void)state;
    double center[3] = {1, 2, 3};
    Obstacle o = obstacle_plane(center, (double[3]){0, 3, 4});
    assert_near(value_at(&o, 7, 2, 3), 0, 1e-15);
    assert_near(value_at(&o, 0, 3, 4), 1.4, 1e-14);
    assert_true(isinf(o.feature));
    obstacle_clear(&o);
    o = obstacle_sphere(center, 0.5, false);
    assert_near(value_at(&o, 1, 2, 5), 1.5, 1e-14);
    assert_near(value_at(&o, 1, 2, 3), -0.5, 1e-14);
    obstacle_clear(&o);
    o = obstacle_sphere(center, 0.5, true);
    assert_near(value_at(&o, 1, 2, 5), -1.5, 1e-14);
    obstacle_clear(&o);
    o = obstacle_cylinder(center, (double[3]){1, 1, 0}, 0.5, false);
    assert_near(value_at(&o, 1 + 5, 2 + 5, 4), 0.5, 1e-14);
    assert_near(value_at(&o, 1 - 3, 2 + 3, 3), 3 * sqrt(2) - 0.5, 1e-14);
    obstacle_clear(&o);
    o = obstacle_box(center, (double[3]){1, 0.8, 0.6}, 0.1);
    assert_near(value_at(&o, 3, 2.3, 3.2), 1, 1e-14);                                     /* a face    */
    assert_near(value_at(&o, 2, 2, 3), 0, 1e-14);                                         /* on it     */
    assert_near(value_at(&o, 1.9 + 0.3, 2.7 + 0.4, 3), 0.4, 1e-14);                       /* an edge   */
    assert_near(value_at(&o, 1 - 0.9 - 0.2, 2 - 0.7 - 0.3, 3.5 + 0.6), 0.7 - 0.1, 1e-14); /* a corner  */
    assert_near(value_at(&o, 1.2, 2, 3.1), -0.5, 1e-14);                                  /* deep down */
    assert_near(o.feature, 0.1, 0);
    obstacle_clear(&o);
    o = obstacle_box(center, (double[3]){1, 1, 1}, 1); /* a ball */
    assert_near(value_at(&o, 1 + 0.3, 2 - 0.4, 3 + 1.2), 0.3, 1e-14);
    obstacle_clear(&o);
}

static double hill_error(int cells)
{
    Obstacle o = hills(cells);
    double worst = 0;
    for (int i = 0; i <= 50; i++)
        for (int j = 0; j <= 50; j++) {
            double x = -1 + 2 * i / 50.0, y = -0.5 + 1.5 * j / 50.0;
            worst = fmax(worst, fabs(value_at(&o, x, y, 0.25) - (0.25 - hill(x, y))));
        }
    obstacle_clear(&o);
    return worst;
}

/* Of fourth order up to its edges; and level beyond them. */
static void test_height_field(void **state)
{
    (void)state;
    double coarse = hill_error(20), fine = hill_error(40);
    print_message("bicubic: %.1e with 20 cells, %.1e with 40, order %.2f\n", coarse, fine,
                  log2(coarse / fine));
    assert_true(log2(coarse / fine) > 3.7 && fine < 1e-5);
    Obstacle o = hills(40);
    Gap gap;
    for (int k = 0; k < 20; k++) {
        double y = -0.5 + 1.5 * k / 19, edge = value_at(&o, 1, y, 0);
        obstacle_gap(&o, &here, (double[3]){1.1 + k, y, 0}, &gap);
        assert_near(gap.gradient[0], 0, 0);
        assert_near(gap.value, value_at(&o, 1e9, y, 0), 0);
        assert_near(gap.value, edge, 0.05); /* one cell's rise */
    }
    obstacle_clear(&o);
    /* Two cells: a parabola. Three: a cubic. */
    for (int cells = 1; cells <= 3; cells++) {
        double height[16];
        for (int i = 0; i <= cells; i++)
            for (int j = 0; j <= cells; j++)
                height[i * (cells + 1) + j] = pow(i / 2.0, cells) - pow(j / 2.0, cells) * i;
        o = obstacle_height_field((const double[2][2]){{0, 0}, {cells / 2.0, cells / 2.0}},
                                  (int[2]){cells, cells}, height);
        assert_near(value_at(&o, 0.3, 0.2, 0), -(pow(0.3, cells) - pow(0.2, cells) * 0.6), 1e-14);
        obstacle_clear(&o);
    }
}

/* A straight one is a pipe, along any axis, also beyond its range. */
static void test_tube(void **state)
{
    (void)state;
    Random random = random_seed(2);
    for (int axis = 0; axis < 3; axis++) {
        double point[3] = {0}, along[3] = {0};
        Obstacle tube = bent_tube(axis, 0);
        along[axis] = 1;
        point[axis == 2 ? 1 : 2] = 0.1;
        Obstacle pipe = obstacle_cylinder(point, along, 0.5, true);
        for (int k = 0; k < 100; k++) {
            double x[3];
            Gap a, b;
            for (int i = 0; i < 3; i++) x[i] = 3 * random_signed(&random);
            obstacle_gap(&tube, &here, x, &a);
            obstacle_gap(&pipe, &here, x, &b);
            assert_near(a.value, b.value, 1e-12);
            for (int i = 0; i < 9; i++) {
                assert_near(a.gradient[i / 3], b.gradient[i / 3], 1e-12);
                assert_near(a.hessian[i / 3][i % 3], b.hessian[i / 3][i % 3], 1e-9);
            }
        }
        assert_near(tube.feature, 0.5, 1e-12);
        obstacle_clear(&tube);
        obstacle_clear(&pipe);
    }
    /* A line that leaves askew goes on so. */
    double sample[3][3] = {{0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 1, 0}};
    Obstacle tube;
    Error err;
    assert_true(obstacle_tube(0, (double[2]){0, 2}, 2, (const double(*)[3])sample, &tube, &err));
    assert_near(value_at(&tube, 9, 4.5, 0.25), 0.25, 1e-12);
    assert_near(value_at(&tube, -4, -2, 0.25), 0.25, 1e-12);
    obstacle_clear(&tube);
    sample[1][0] = -0.1;
    assert_false(obstacle_tube(0, (double[2]){0, 2}, 2, (const double(*)[3])sample, &tube, &err));
    assert_string_equal(err.text, "the tube's radius is -0.1 m at s = 1 m: it must be positive");
    sample[1][0] = 0.25;
    sample[2][0] = 0.001;
    assert_false(obstacle_tube(0, (double[2]){0, 2}, 2, (const double(*)[3])sample, &tube, &err));
    assert_string_equal(err.text, "the tube closes within a cell beyond s = 2 m: end its range before");
}

/* ---- Everywhere ---- */

static void test_finite(void **state)
{
    (void)state;
    MeshFile file = make_block(2, 1, 0);
    double zero[3] = {0}, one[3] = {1, 1, 1}, along[3] = {0, 0, 1};
    Obstacle all[] = {obstacle_plane(zero, along),
                      obstacle_sphere(zero, 1, false),
                      obstacle_sphere(zero, 1, true),
                      obstacle_cylinder(zero, along, 1, false),
                      obstacle_cylinder(zero, along, 1, true),
                      obstacle_box(zero, one, 0.1),
                      obstacle_box(zero, one, 1),
                      hills(10),
                      bent_tube(2, 0),
                      bent_tube(0, 1),
                      mesh_obstacle(&file, 0.2)};
    static const double far[] = {0, 1e-300, 1e-13, 0.1, 0.9, 1, 1e9, 1e60};
    enum { FAR = sizeof far / sizeof *far };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        for (int i = 0; i < 8 * FAR * FAR * FAR; i++) {
            double x[3] = {far[i % FAR], far[i / FAR % FAR], far[i / FAR / FAR % FAR]};
            for (int j = 0; j < 3; j++) x[j] *= i / FAR / FAR / FAR & 1 << j ? -1 : 1;
            Gap gap;
            obstacle_gap(&all[k], &here, x, &gap);
            assert_finite(&gap, strcmp(all[k].ops->kind, "mesh") ? 0.9 : 0); /* 0 in a cube's middle */
        }
        obstacle_clear(&all[k]);
    }
}

/* A floor that moves and turns is a wall elsewhere. */
static void test_pose(void **state)
{
    (void)state;
    double point[3] = {1, 0, 2};
    Obstacle o = obstacle_plane(point, (double[3]){0, 0, 1});
    o.motion.move = of_time("0", "t", "0.5*t");
    o.motion.turn = of_time("0", "pi/4*t", "0");
    RigidPose pose;
    Gap gap;
    Error err;
    assert_true(obstacle_pose(&o, 2, &pose, &err));
    obstacle_gap(&o, &pose, (double[3]){4, 7, 9}, &gap);
    assert_near(gap.value, 3, 1e-14);
    assert_near(gap.gradient[0], 1, 1e-15);
    assert_near(gap.gradient[2], 0, 1e-15);
    timed_clear(&o.motion.move);
    o.motion.move = of_time("1/(t - 1)", "0", "0");
    o.name = mem_text("lid");
    assert_false(obstacle_pose(&o, 1, &pose, &err));
    assert_string_equal(err.text, "obstacle 'lid': move: \"1/(t - 1)\" is not a finite number at t = 1");
    obstacle_clear(&o);
}

static void test_surfaces(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    double center[3] = {0.3, -0.2, 0.1}, askew[3] = {1, -2, 3};
    struct {
        Obstacle obstacle;
        double area, part;
    } all[] = {{obstacle_plane(center, askew), 48, 1e-12},
               {obstacle_plane(center, (double[3]){0, -1, 0}), 48, 1e-12},
               {obstacle_sphere(center, 0.5, false), M_PI, 0.02},
               {obstacle_sphere(center, 0.5, true), M_PI, 0.02},
               {obstacle_cylinder(center, (double[3]){0, 0, -1}, 0.5, false), 4 * M_PI, 0.01},
               {obstacle_cylinder(center, askew, 0.5, true), M_PI * 24 / sqrt(14), 0.01},
               {obstacle_box(center, (double[3]){1, 0.8, 0.6}, 0.1), /* faces, edges, corners */
                8 * (0.9 * 0.7 + 0.9 * 0.5 + 0.7 * 0.5) + 0.2 * M_PI * 2 * (0.9 + 0.7 + 0.5) + 0.04 * M_PI,
                0.01},
               {hills(10), 16.6, 0.05},
               {bent_tube(0, 0), 2 * M_PI, 0.02},
               {bent_tube(1, 0), 2 * M_PI, 0.02},
               {bent_tube(2, 1), 7.5, 0.1}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        check_surface(&all[k].obstacle, all[k].area, all[k].part);
        obstacle_clear(&all[k].obstacle);
    }
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives),  cmocka_unit_test(test_values),
                                       cmocka_unit_test(test_height_field), cmocka_unit_test(test_tube),
                                       cmocka_unit_test(test_finite),       cmocka_unit_test(test_pose),
                                       cmocka_unit_test(test_surfaces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
