/* What touches, against what theory says of it: the foot of a buckled strip. */
#include "base/vec3.h"
#include "solve/march.h"
#include "tests/shell_fixture.h"
#include "world/obstacle_shapes.h"
#include <math.h>
#include <string.h>

/* Obstacles, and itself where it is asked for, with friction; before the body's vectors are made. */
static World *meet(Shell *shell, const Obstacle *list, int count, bool self)
{
    WorldBody shown = shell_world_body(shell);
    World *world = shell->world = world_create(&shown, mem_copy(list, (size_t)count, sizeof *list), count);
    world->rubs = true, world->slip_speed = 1e-3, world->offset = shell->thickness / 2;
    world->self = self, world->distance = shell->thickness;
    world_add_params(world, &shell->params);
    return world;
}

/* ---- The elastica, of length and bending stiffness 1, clamped along x, its end pushed back by P and aside by Q ----
 *
 *     theta'' = -(Q cos theta + P sin theta),   theta(0) = 0,   theta'(1) = 0,   y(1) = 0. */

typedef struct Elastica {
    double start, push, ratio; /* theta'(0), P, Q/P          */
    double way;                /* 1 - x(1)                   */
} Elastica;

/* theta'(1) and y(1), which are to be 0. */
static void shoot(Elastica *e, double miss[2])
{
    enum { STEPS = 400 };
    double s[4] = {0, e->start, 0, 0}, h = 1.0 / STEPS; /* theta, theta', x, y */
    for (int n = 0; n < STEPS; n++) {
        double slope[4] = {0}, sum[4] = {0};
        for (int k = 0; k < 4; k++) { /* [Kutta 1901] */
            double at[4], way = k == 0 ? 0 : k == 3 ? h : h / 2;
            for (int i = 0; i < 4; i++) at[i] = s[i] + way * slope[i];
            slope[0] = at[1], slope[1] = -e->push * (e->ratio * cos(at[0]) + sin(at[0]));
            slope[2] = cos(at[0]), slope[3] = sin(at[0]);
            for (int i = 0; i < 4; i++) sum[i] += (k == 0 || k == 3 ? 1 : 2) * slope[i];
        }
        for (int i = 0; i < 4; i++) s[i] += h / 6 * sum[i];
    }
    miss[0] = s[1], miss[1] = s[3], e->way = 1 - s[2];
}

/* Along the branch that leaves the straight one at P = 20.19, up to a ratio. */
static Elastica elastica(double ratio)
{
    enum { WAY = 40 };
    Elastica e = {.push = 20.19};
    for (int n = 1; n <= WAY; n++) {
        e.ratio = ratio * n / WAY;
        if (n == 1) e.start = -20.19 * e.ratio; /* y = Q/(P k) (sin kx - kx + k (1 - cos kx)), tan k = k */
        for (int it = 0; it < 30; it++) {
            double miss[2], other[2], J[2][2];
            shoot(&e, miss);
            for (int j = 0; j < 2; j++) {
                Elastica moved = e;
                double by = 1e-6;
                *(j ? &moved.push : &moved.start) += by;
                shoot(&moved, other);
                for (int i = 0; i < 2; i++) J[i][j] = (other[i] - miss[i]) / by;
            }
            double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
            e.start -= (miss[0] * J[1][1] - miss[1] * J[0][1]) / det;
            e.push -= (miss[1] * J[0][0] - miss[0] * J[1][0]) / det;
        }
    }
    double miss[2];
    shoot(&e, miss);
    assert_true(fabs(miss[0]) < 1e-9 && fabs(miss[1]) < 1e-9);
    return e;
}

static const double LENGTH = 0.02, WIDTH = 1e-3, THICKNESS = 1e-4, MU = 0.2, YOUNG = 1e6;

typedef struct Foot {
    const Shell *shell;
    double far, time; /* the clamp goes down by far (t/time)^2 */
} Foot;

static double clamp_way(const Foot *foot, double time)
{
    return foot->far * pow(time / foot->time, 2);
}

static bool lower(void *self, double time, double *x)
{
    const Foot *foot = self;
    const Mesh *mesh = foot->shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++)
        if (mesh->rest[v][0] < 1e-9) x[3 * v] = clamp_way(foot, time);
    return true;
}

static Body upright(int cells)
{
    Shell *shell = shell_of_sheet((double[]){LENGTH, WIDTH}, (int[]){cells, 1}, PATTERN_ALTERNATE);
    const Mesh *mesh = shell->mesh;
    shell->thickness = THICKNESS, shell->poisson = 0, shell->density = 100;
    hold_root(shell, true);
    Obstacle floor = obstacle_plane((double[]){LENGTH, 0, 0}, (double[]){-1, 0, 0});
    World *world = meet(shell, &floor, 1, false);
    world->slip_speed = 1e-4, world->offset = 0;
    Body body = body_create(shell, shell_dynamic_system(shell), YOUNG);
    body.p[world->stiffness] = 30 * YOUNG * THICKNESS;
    body.p[world->friction] = MU;
    body.p[shell->damping] = 1e-9;
    for (int v = 0; v < mesh->vertex_count; v++) { /* so that it knows where to */
        double s = mesh->rest[v][0] / LENGTH;
        body.state.v[3 * v + 2] = 1e-3 * s * s * (1 - s);
    }
    return body;
}

/* One step; what the floor did to the body in it, N. */
static void step_on(Body *body, const MarchDef *def, double dt, double force[3])
{
    MarchInfo info;
    State before = state_clone(&body->state);
    assert_true(march_step(body->sys, def, dt, body->p, &body->state, &info));
    double forces[1][3] = {{0}};
    WorldSums sums = {.contact = {.force = forces}};
    Point at = state_point(&body->state, body->p);
    at.x_prev = before.x, at.v_prev = before.v, at.dt = dt;
    if (def->implicit) at.x_lag = at.x;
    world_measure(body->shell->world, &at, &sums);
    memcpy(force, forces[0], sizeof forces[0]);
    state_destroy(&before);
}

/* The floor holds its foot by friction, until that is all used up. */
static void check_foot(double dt, bool implicit, const Elastica *exact)
{
    Body body = upright(32);
    const Shell *shell = body.shell;
    Foot foot = {shell, 1.5 * exact->way * LENGTH, 1};
    MarchDef def = march_default();
    def.move = lower, def.self = &foot, def.implicit = implicit;
    int tip = mesh_group(shell->mesh, "tip", 0)->members[0];
    double unit = YOUNG * WIDTH * pow(THICKNESS, 3) / 12 / (LENGTH * LENGTH), force[3] = {0}, speed = 0;
    while (body.state.time < foot.time && !(speed > shell->world->slip_speed)) {
        step_on(&body, &def, dt, force);
        speed =
            body.state.time > 0.1 ? fabs(body.state.v[3 * tip + 2]) : 0; /* while it buckles it may move */
    }
    double way = clamp_way(&foot, body.state.time) / LENGTH, push = -force[0] / unit;
    print_message("%g ms, %s: slips at %.4f of its length, exactly %.4f; P %.3f, exactly %.3f; Q/P %.4f\n",
                  1e3 * dt, implicit ? "implicit" : "lagged", way, exact->way, push, exact->push,
                  force[2] / -force[0]);
    assert_true(fabs(way / exact->way - 1) < 0.02 && fabs(push / exact->push - 1) < 0.02);
    assert_true(fabs(fabs(force[2] / force[0]) - MU) < 0.01 * MU);
    body_clear(&body);
}

static void test_foot(void **unused)
{
    (void)unused;
    Elastica exact = elastica(MU);
    for (int k = 0; k < 4; k++) check_foot(k % 2 ? 1e-3 : 1e-2, k / 2, &exact);
}

/* ---- A sheet that is thrown onto the floor tumbles, and never gains ---- */

/* Kinetic, and all potentials: of a system of statics, in which friction is nothing. */
static double energy_of(Body *body, System *statics, const double *mass)
{
    Point at = state_point(&body->state, body->p);
    double energy = system_energy(statics, &at).energy;
    for (int i = 0; i < 3 * body->shell->mesh->vertex_count; i++)
        energy += mass[i / 3] * body->state.v[i] * body->state.v[i] / 2;
    return energy;
}

static Body thrown(double gravity)
{
    const double mm = 1e-3, young = 1e6;
    Shell *shell = shell_of_sheet((double[]){20 * mm, 20 * mm}, (int[]){8, 8}, PATTERN_ALTERNATE);
    shell->thickness = 0.3 * mm, shell->poisson = 0.3, shell->density = 1000;
    Obstacle floor = obstacle_plane((double[]){0, 0, -3 * mm}, (double[]){0, 0, 1});
    World *world = meet(shell, &floor, 1, true);
    Body body = body_create(shell, shell_dynamic_system(shell), young);
    body.p[world->stiffness] = 30 * young * shell->thickness;
    body.p[world->friction] = body.p[world->self_friction] = 0.4;
    body.p[world->self_stiffness] = young * pow(world->distance, 3);
    body.p[shell->gravity + 2] = -gravity;
    for (int v = 0; v < shell->mesh->vertex_count; v++) { /* it turns about its middle, and flies */
        const double *x = shell->mesh->rest[v], speed[3] = {0.5, 0.1, -1};
        Vec3 from = {x[0] - 10 * mm, x[1] - 10 * mm, x[2]}, turning = {40, 120, 25};
        vec3_store(body.state.v + 3 * v, vec3_add(vec3_load(speed), vec3_cross(turning, from)));
    }
    return body;
}

static void check_tumbling(double dt, double gravity, bool implicit)
{
    Body body = thrown(gravity);
    const Shell *shell = body.shell;
    System *statics = shell_system(shell);
    double *mass = mem_alloc((size_t)shell->mesh->vertex_count, sizeof *mass);
    shell_vertex_mass(shell, body.p, mass);
    MarchDef def = march_default();
    def.implicit = implicit;
    double before = energy_of(&body, statics, mass), first = before, worst = -INFINITY;
    int touched = 0;
    for (int n = 0; n < 120; n++) {
        double force[3], now;
        step_on(&body, &def, dt, force);
        now = energy_of(&body, statics, mass);
        worst = fmax(worst, (now - before) / first);
        before = now, touched += force[2] > 0;
    }
    print_message("%g ms, %g m/s^2, %s: %d steps touch, from %.3g to %.3g J, most gained in a step %.1e\n",
                  1e3 * dt, gravity, implicit ? "implicit" : "lagged", touched, first, before, worst);
    assert_true(touched > 5 && worst < 1e-9);
    system_destroy(statics);
    mem_free(mass);
    body_clear(&body);
}

static void test_tumbling(void **unused)
{
    (void)unused;
    const double dt[3] = {1e-4, 1e-3, 5e-3};
    for (int k = 0; k < 12; k++) check_tumbling(dt[k % 3], k / 3 % 2 ? 9.81 : 0, k / 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_foot), cmocka_unit_test(test_tumbling)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
