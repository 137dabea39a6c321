/* What goes through what in a step of time: found wherever it happens, and not where it does not. */
#include "solve/march.h"
#include "tests/obstacle_fixture.h"
#include "tests/shell_fixture.h"
#include "world/pierce.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- One face, or one element, that goes by (0, 0, -way) ---- */

static const double FACE[9] = {-2e-3, -1e-3, 2e-3, 2e-3, -1e-3, 2e-3, 0, 3e-3, 2e-3};

/* So often in so many steps of 1 s. */
static int passes(const Obstacle *obstacle, int corners, double aside, double way, int steps)
{
    Poses poses = poses_create(obstacle, 1);
    Samples faces = {1, corners, (int[]){0, 1, 2}, 0};
    double from[9], to[9];
    int count = 0;
    for (int k = 1; k <= steps; k++) {
        for (int i = 0; i < 9; i++) {
            from[i] = FACE[i] + (i % 3 == 0 ? aside : 0) - (i % 3 == 2 ? way * (k - 1) / steps : 0);
            to[i] = FACE[i] + (i % 3 == 0 ? aside : 0) - (i % 3 == 2 ? way * k / steps : 0);
        }
        poses_update(&poses, &(Point){.time = k, .dt = 1});
        count += pierce_find(&poses, &faces, from, to).count;
    }
    poses_destroy(&poses);
    return count;
}

/* A ball of 1 mm: however far beyond it the step ends, and however many steps it takes, it goes through once. */
static void test_ball(void **unused)
{
    (void)unused;
    Obstacle ball = obstacle_sphere((double[]){0, 0, 0}, 1e-3, false);
    for (int steps = 1; steps < 3000; steps = 3 * steps + 1) {
        assert_int_equal(passes(&ball, 3, 0, 1e-3, steps), 0);    /* it touches                      */
        assert_int_equal(passes(&ball, 3, 0, 1.45e-3, steps), 0); /* 0.45 mm deep                    */
        assert_int_equal(passes(&ball, 3, 0, 1.7e-3, steps), 1);  /* 0.7 mm                          */
        assert_int_equal(passes(&ball, 3, 0, 4e-3, steps), 1);    /* beyond                          */
        assert_int_equal(passes(&ball, 3, 0, 4, steps), 1);       /* far beyond: between all samples */
        assert_int_equal(passes(&ball, 3, 3.5e-3, 4, steps), 0);  /* beside it                       */
        assert_int_equal(passes(&ball, 2, 0, 4, steps), 0);       /* its edge alone passes by ..     */
    }
    Obstacle larger = obstacle_sphere((double[]){0, 0, 0}, 3e-3, false);
    assert_int_equal(passes(&larger, 2, 0, 4, 1), 1); /* .. unless the ball is larger */
    assert_int_equal(passes(&ball, 3, 0, NAN, 1), 0);
    obstacle_clear(&ball);
    obstacle_clear(&larger);
}

/* What moves with the face does not go through it; what moves alone does. */
static void test_relative(void **unused)
{
    (void)unused;
    Obstacle ball = obstacle_sphere((double[]){0, 0, 0}, 1e-3, false);
    ball.motion.move = of_time("0", "0", "-0.1*t");
    assert_int_equal(passes(&ball, 3, 0, 0.1, 1), 0);
    assert_int_equal(passes(&ball, 3, 0, 0, 1), 0);
    timed_clear(&ball.motion.move);
    ball.motion.move = of_time("0", "0", "0.1*t");
    assert_int_equal(passes(&ball, 3, 0, 0, 1), 1);
    obstacle_clear(&ball);
}

/* A pipe, ground or half space has no other side; a box is as thin as its thinnest side, not as its rounding; a needle ends. */
static void test_kinds(void **unused)
{
    (void)unused;
    Obstacle wall = obstacle_plane((double[]){0, 0, 0}, (double[]){0, 0, 1}),
             pipe = obstacle_cylinder((double[]){0, 0, 2e-3}, (double[]){1, 0, 0}, 5e-3, true),
             plate = obstacle_box((double[]){0, 0, 0}, (double[]){5e-3, 5e-3, 1e-3}, 1e-4),
             needle = obstacle_box((double[]){0, 0, -3e-3}, (double[]){1e-4, 1e-4, 3e-3}, 1e-4);
    assert_int_equal(passes(&wall, 3, 0, 1, 1), 0);
    assert_int_equal(passes(&pipe, 3, 0, 1, 1), 0);
    assert_int_equal(passes(&plate, 3, 0, 1.4e-3, 1), 0);
    assert_int_equal(passes(&plate, 3, 0, 1.6e-3, 1), 1);
    assert_int_equal(passes(&needle, 3, 0, 1.9e-3, 1), 0);
    assert_int_equal(passes(&needle, 3, 0, 2.5e-3, 1), 1);
    assert_int_equal(passes(&needle, 3, 1.7e-3, 2.5e-3, 1), 0);
    Obstacle *all[] = {&wall, &pipe, &plate, &needle};
    for (int k = 0; k < 4; k++) obstacle_clear(all[k]);
}

/* ---- Motions ---- */

/* A sheet of 10 mm, held all around or as a whole, and a ball that comes from below at that speed, m/s, and stops 3 mm
 * above it. */
static Body shot_at(double radius, double speed, bool whole)
{
    const double mm = 1e-3, young = 1e6;
    Shell *shell = shell_of_sheet((double[]){10 * mm, 10 * mm}, (int[]){8, 8}, PATTERN_ALTERNATE);
    const Mesh *mesh = shell->mesh;
    shell->thickness = 0.2 * mm, shell->poisson = 0.3, shell->density = 1000;
    for (int v = 0; v < mesh->vertex_count; v++) {
        const double *x = mesh->rest[v];
        bool rim = fabs(x[0] - 5 * mm) > 4.9 * mm || fabs(x[1] - 5 * mm) > 4.9 * mm;
        for (int i = 0; i < 3 && (rim || whole); i++) shell_fix(shell, v, i);
    }
    char z[80];
    snprintf(z, sizeof z, "min(%g*t, %g)", speed, radius + 5 * mm);
    Obstacle ball = obstacle_sphere((double[]){5.2 * mm, 4.7 * mm, -radius - 2 * mm}, radius, false);
    ball.name = mem_text("ball");
    ball.motion.move = of_time("0", "0", z);
    WorldBody shown = shell_world_body(shell);
    World *world = shell->world = world_create(&shown, mem_copy(&ball, 1, sizeof ball), 1);
    world->slip_speed = 1e-3, world->offset = shell->thickness / 2;
    world_add_params(world, &shell->params);
    Body body = body_create(shell, shell_dynamic_system(shell), young);
    body.p[world->stiffness] = 300 * young * shell->thickness;
    body.p[shell->damping] = 1e-6;
    return body;
}

typedef struct Seen {
    const World *world;
    State before;
    const double *p;
    WorldSums sums;
} Seen;

static void see(void *self, const State *state, double dt)
{
    Seen *seen = self;
    Point at = state_point(state, seen->p);
    at.x_prev = seen->before.x, at.v_prev = seen->before.v, at.dt = dt;
    world_measure(seen->world, &at, &seen->sums);
    state_copy(&seen->before, state);
}

/* Is the sheet above a place: does the ray up from there meet it? */
static bool is_above(const Mesh *mesh, const double *x, const double place[3])
{
    int met = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        const double *a = x + 3 * mesh->faces[f][0], *b = x + 3 * mesh->faces[f][1],
                     *c = x + 3 * mesh->faces[f][2];
        double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        double u = ((place[0] - a[0]) * (c[1] - a[1]) - (place[1] - a[1]) * (c[0] - a[0])) / area,
               v = ((b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0])) / area;
        bool within = u >= 0 && v >= 0 && u + v <= 1;
        met += within && a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]) > place[2];
    }
    return met % 2;
}

/* Either the ball stays below, or it is said that it went through. */
static int check_shot(double radius, double speed, double dt, bool whole)
{
    Body body = shot_at(radius, speed, whole);
    const Mesh *mesh = body.shell->mesh;
    Seen seen = {.world = body.shell->world, .before = state_clone(&body.state), .p = body.p};
    MarchDef def = march_default();
    def.stored = see, def.self = &seen;
    int refused = 0, passed = 0;
    double end = (radius + 5e-3) / speed + 2 * dt;
    while (body.state.time < end) {
        MarchInfo info;
        assert_true(march_step(body.sys, &def, dt, body.p, &body.state, &info));
        refused += info.refused, passed += info.passed;
    }
    double middle[3] = {5.2e-3, 4.7e-3, 3e-3};
    bool held_back = is_above(mesh, body.state.x, middle);
    print_message("ball of %g mm at %g m/s, steps of %g ms, %s: %s, pierced %d, %d steps refused\n",
                  1e3 * radius, speed, 1e3 * dt, whole ? "held" : "rim held",
                  held_back ? "below" : "went through", seen.sums.pierced.count, refused);
    assert_true(held_back || seen.sums.pierced.count > 0);
    assert_true((passed > 0) == (seen.sums.pierced.count > 0));
    int count = seen.sums.pierced.count;
    state_destroy(&seen.before);
    body_clear(&body);
    return count;
}

static void test_shots(void **unused)
{
    (void)unused;
    const double speeds[] = {1, 10, 100};
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 2; n++) {
            int count = check_shot(2e-3, speeds[k], n ? 1e-4 : 1e-3, false);
            assert_true(count == 0 || k == 2);                   /* faster than its waves */
            check_shot(2e-4, speeds[k], n ? 1e-4 : 1e-3, false); /* between its vertices, perhaps */
            assert_true(check_shot(2e-3, speeds[k], n ? 1e-4 : 1e-3, true) > 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_relative),
        cmocka_unit_test(test_kinds),
        cmocka_unit_test(test_shots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
