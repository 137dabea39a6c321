/* The adjoint of motions that meet something: every kind of obstacle, at rest or moved and turned, water, self contact;
 * without friction, with lagged and with implicit friction; also where steps are cut. */
#include "tests/motion_fixture.h"
#include "tests/obstacle_fixture.h"
#include "tests/self_fixture.h"

static const double MM = 1e-3;

typedef enum Friction { SMOOTH, LAGGED, IMPLICIT } Friction;

static const char *const frictions[] = {"smooth", "lagged", "implicit"};

/* ---- Obstacles, of which each has the strip, 0 <= x <= 12, 0 <= y <= 4 mm, a quarter of a millimetre above it ---- */

enum { KINDS = 9 };

static const char *const kinds[KINDS] = {"plane", "sphere",       "cavity", "cylinder", "pipe",
                                         "box",   "height field", "tube",   "mesh"};

static Obstacle ripples(void)
{
    enum { CELLS = 12 };
    double height[(CELLS + 1) * (CELLS + 1)];
    for (int j = 0; j <= CELLS; j++)
        for (int i = 0; i <= CELLS; i++)
            height[j * (CELLS + 1) + i] = MM * (0.6 * cos(1.5 * i) * cos(0.9 * j) - 0.85);
    return obstacle_height_field((const double[2][2]){{-6 * MM, -10 * MM}, {18 * MM, 14 * MM}},
                                 (int[]){CELLS, CELLS}, height);
}

static Obstacle bent_tube(void)
{
    enum { CELLS = 16 };
    double sample[CELLS + 1][3];
    Obstacle tube;
    Error err;
    for (int i = 0; i <= CELLS; i++) {
        sample[i][0] = MM * (8 + 0.3 * cos(1.1 * i));
        sample[i][1] = MM * (2 + 0.2 * sin(0.7 * i)), sample[i][2] = MM * (7.2 + 0.2 * sin(0.5 * i));
    }
    assert_true(
        obstacle_tube(0, (double[]){-2 * MM, 14 * MM}, CELLS, (const double(*)[3])sample, &tube, &err));
    return tube;
}

static Obstacle rock(void)
{
    MeshFile block = make_block(3, 10 * MM, 10 * MM);
    for (int v = 0; v < block.vertex_count; v++)
        block.vertices[v][0] += 6 * MM, block.vertices[v][1] += 2 * MM, block.vertices[v][2] -= 9.5 * MM;
    return mesh_obstacle(&block, 1 * MM);
}

static Obstacle make_obstacle(int kind)
{
    switch (kind) {
    case 0:
        return obstacle_plane((double[]){0, 0, -0.25 * MM}, (double[]){0.05, 0.02, 1});
    case 1:
        return obstacle_sphere((double[]){6 * MM, 2 * MM, -20.25 * MM}, 20 * MM, false);
    case 2:
        return obstacle_sphere((double[]){6 * MM, 2 * MM, 18.7 * MM}, 20 * MM, true);
    case 3:
        return obstacle_cylinder((double[]){6 * MM, 0, -10.25 * MM}, (double[]){0.2, 1, 0}, 10 * MM, false);
    case 4:
        return obstacle_cylinder((double[]){0, 2 * MM, 7.4 * MM}, (double[]){1, 0, 0.02}, 8 * MM, true);
    case 5:
        return obstacle_box((double[]){6 * MM, 0, -4.25 * MM}, (double[]){4 * MM, 5 * MM, 4 * MM}, 2 * MM);
    case 6:
        return ripples();
    case 7:
        return bent_tube();
    default:
        return rock();
    }
}

/* ---- A magnetised strip that falls onto one ---- */

static void add_world(Shell *shell, World *world, Friction friction)
{
    shell->world = world;
    world->offset = shell->thickness / 2, world->slip_speed = 0.01;
    world->rubs = friction != SMOOTH, world->implicit = friction == IMPLICIT;
    world_add_params(world, &shell->params);
}

static Body strip_over(Obstacle *list, int count, Friction friction, BendingModel bending, bool wet)
{
    Random random = random_seed(7);
    Shell *shell = shell_of_sheet((double[]){12 * MM, 4 * MM}, (int[]){6, 2}, PATTERN_ALTERNATE);
    shell->thickness = 4e-4, shell->poisson = 0.4, shell->density = 1000, shell->bending = bending;
    for (int k = 0; k < count; k++) list[k].feature = 1 * MM; /* middles of edges and faces touch too */
    WorldBody shown = shell_world_body(shell);
    World *world = world_create(&shown, mem_copy(list, (size_t)count, sizeof *list), count);
    world->wet = wet;
    add_world(shell, world, friction);
    Body body = body_create(shell, shell_dynamic_system(shell), 1e5);
    for (int f = 0; f < shell->mesh->face_count; f++)
        for (int i = 0; i < 3; i++)
            body.p[shell->magnetization + 3 * f + i] = (i == 0 ? 4e4 : 0) + 1e4 * random_signed(&random);
    body.p[shell->flux.uniform + 2] = 0.03;
    body.p[shell->gravity + 2] = -200;
    body.p[world->stiffness] = 100;
    for (int k = 0; k < count; k++) body.p[world->friction + k] = 0.5;
    if (wet) body.p[world->water.density] = 1000, body.p[world->water.velocity] = 0.1;
    for (int i = 0; i < system_position_count(body.sys); i++)
        body.state.v[i] = (i % 3 == 0 ? 0.1 : 0) + 0.02 * random_signed(&random);
    return body;
}

static const double STEP = 1e-3;

enum { STEPS = 12 };

/* The most samples, or pairs of parts of the body, that touch at the end of a step. */
static double touching(const Body *body, const Trajectory *t)
{
    double most = 0;
    for (int n = 1; n <= STEPS; n++) {
        WorldSums sums = {0};
        State end = trajectory_frame(t, n);
        Point at = state_point(&end, body->p);
        at.time = n * STEP;
        world_measure(body->shell->world, &at, &sums);
        most = fmax(most, sums.contact.touching + sums.pairs);
    }
    return most;
}

static Motion motion_of(const Body *body, Friction friction)
{
    const Shell *shell = body->shell;
    Motion m = motion_create(body->sys, &shell->params, body->p, &body->state, shell->mesh->vertex_count);
    m.def.march.implicit = friction == IMPLICIT;
    m.problem.step = STEP, m.problem.steps = STEPS;
    motion_unknown(&m, "young", UNKNOWN_LOG, 0.1, false);
    motion_unknown(&m, "flux_density", UNKNOWN_LINEAR, 0.01, false);
    motion_unknown(&m, "magnetization", UNKNOWN_LINEAR, 1e3, false);
    return m;
}

/* Once its own unknowns are there; takes both. */
static void check(Body *body, Motion *m, const char *name, bool cuts)
{
    Trajectory *t = motion_check(m, name, 1e-4);
    double touch = touching(body, t);
    if (!(touch > 5)) fail_msg("%s: only %g touch", name, touch);
    assert_true(!cuts || trajectory_state(t).count > STEPS);
    trajectory_destroy(t);
    motion_clear(m);
    body_clear(body);
}

static void check_strip(Obstacle *list, int count, Friction friction, BendingModel bending, const char *name)
{
    Body body = strip_over(list, count, friction, bending, false);
    Motion m = motion_of(&body, friction);
    motion_unknown(&m, "contact_stiffness", UNKNOWN_LOG, 0.1, false);
    if (friction) motion_unknown(&m, "friction", UNKNOWN_LOG, 0.1, false);
    check(&body, &m, name, false);
}

static void set_moving(Obstacle *obstacle)
{
    obstacle->motion.move = of_time("0.1*t", "0.02*t", "0.05*t");
    obstacle->motion.turn = of_time("10*t", "0-5*t", "20*t");
}

static void test_obstacles(void **unused)
{
    (void)unused;
    long blocks = mem_live_count();
    for (int kind = 0; kind < KINDS; kind++)
        for (Friction friction = SMOOTH; friction <= IMPLICIT; friction++) {
            Obstacle obstacle = make_obstacle(kind);
            bool moves = (kind + friction) % 2;
            if (moves) set_moving(&obstacle);
            char *name = mem_format("%s, %s%s", kinds[kind], frictions[friction], moves ? ", moves" : "");
            check_strip(&obstacle, 1, friction, kind % 2 ? BENDING_HINGE : BENDING_MIDEDGE, name);
            mem_free(name);
        }
    assert_int_equal(mem_live_count(), blocks);
}

/* In streaming water between a floor and a ball that is rolled over it; Newton may take so few iterations that steps are
 * cut. */
static void test_together(void **unused)
{
    (void)unused;
    for (int k = 0; k < 4; k++) {
        bool cuts = k / 2;
        Friction friction = k % 2 ? IMPLICIT : LAGGED;
        Obstacle list[2] = {make_obstacle(0),
                            obstacle_sphere((double[]){8 * MM, 2 * MM, 2.3 * MM}, 2 * MM, false)};
        set_moving(&list[1]);
        Body body = strip_over(list, 2, friction, BENDING_MIDEDGE, true);
        Motion m = motion_of(&body, friction);
        if (cuts) m.def.march.newton.max_iterations = 6;
        motion_unknown(&m, "contact_stiffness", UNKNOWN_LOG, 0.1, false);
        motion_unknown(&m, "friction", UNKNOWN_LOG, 0.1, false);
        motion_unknown(&m, "water_density", UNKNOWN_LOG, 0.1, false);
        motion_unknown(&m, "water_velocity", UNKNOWN_LINEAR, 0.01, false);
        char *name = mem_format("floor, ball, water, %s", frictions[friction]);
        check(&body, &m, name, cuts);
        mem_free(name);
    }
}

/* ---- Self contact ---- */

/* Two sheets that fly at each other, one of them onto a ball. */
static Body sheets(Friction friction, bool ball, bool wet)
{
    Random random = random_seed(5);
    MeshFile both = two_sheets(4, false);
    Shell *shell = shell_of_mesh(&both);
    shell->thickness = 5e-4, shell->poisson = 0.4, shell->density = 1000, shell->bending = BENDING_HINGE;
    Obstacle *list = ball ? mem_alloc(1, sizeof *list) : NULL;
    if (ball) *list = obstacle_sphere((double[]){6 * MM, 6 * MM, -3.5 * MM}, 3 * MM, false);
    WorldBody shown = shell_world_body(shell);
    World *world = world_create(&shown, list, ball);
    world->self = true, world->distance = shell->thickness, world->wet = wet;
    add_world(shell, world, friction);
    Body body = body_create(shell, shell_dynamic_system(shell), 1e5);
    body.p[world->self_stiffness] = 1e5 * pow(world->distance, 3);
    body.p[world->self_friction] = 0.4;
    if (ball) body.p[world->stiffness] = 1000, body.p[world->friction] = 0.5;
    if (wet) body.p[world->water.density] = 20;
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        bool second = shell->mesh->vertex_component[v];
        const double way[3] = {second ? 0.2 : 0, 0, second ? -1 : 1};
        for (int i = 0; i < 3; i++) body.state.v[3 * v + i] = way[i] + 0.02 * random_signed(&random);
    }
    return body;
}

static void check_sheets(Friction friction, bool ball, bool cuts)
{
    Body body = sheets(friction, ball, ball);
    Motion m = motion_of(&body, friction);
    if (cuts) m.def.march.newton.max_iterations = 7;
    motion_unknown(&m, "self_stiffness", UNKNOWN_LOG, 0.1, false);
    if (friction) motion_unknown(&m, "self_friction", UNKNOWN_LOG, 0.1, false);
    if (ball) motion_unknown(&m, "contact_stiffness", UNKNOWN_LOG, 0.1, false);
    char *name = mem_format("sheets%s, %s", ball ? ", ball, water" : "", frictions[friction]);
    check(&body, &m, name, cuts);
    mem_free(name);
}

static void test_self(void **unused)
{
    (void)unused;
    for (Friction friction = SMOOTH; friction <= IMPLICIT; friction++) {
        check_sheets(friction, friction != SMOOTH, false);
        if (friction) check_sheets(friction, false, true);
    }
}

/* ---- A strip whose thickness is looked for: a taper, of which obstacles feel each place's own ---- */

static Body taper_over(Obstacle *list, int count, Friction friction)
{
    Random random = random_seed(9);
    Shell *shell = shell_of_sheet((double[]){12 * MM, 4 * MM}, (int[]){6, 2}, PATTERN_ALTERNATE);
    const Mesh *mesh = shell->mesh;
    shell->thickness = 5e-4, shell->poisson = 0.4, shell->density = 1000, shell->bending = BENDING_MIDEDGE;
    shell->outsides = mem_alloc((size_t)mesh->face_count, sizeof *shell->outsides);
    for (int f = 0; f < mesh->face_count; f++)
        shell->outsides[f] = 2.5e-4 * (1 - mesh->rest[mesh->faces[f][0]][0] / (18 * MM));
    for (int k = 0; k < count; k++) list[k].feature = 1 * MM;
    WorldBody shown = shell_world_body(shell);
    World *world = world_create(&shown, mem_copy(list, (size_t)count, sizeof *list), count);
    world->local = true;
    add_world(shell, world, friction);
    Body body = body_create(shell, shell_dynamic_system(shell), 1e5);
    for (int f = 0; f < mesh->face_count; f++) body.p[shell->face_thickness + f] = 2 * shell->outsides[f];
    body.p[shell->gravity + 2] = -200;
    body.p[world->stiffness] = 100;
    for (int k = 0; k < count; k++) body.p[world->friction + k] = 0.5;
    for (int i = 0; i < system_position_count(body.sys); i++)
        body.state.v[i] = (i % 3 == 0 ? 0.1 : 0) + 0.02 * random_signed(&random);
    return body;
}

static void test_thickness(void **unused)
{
    (void)unused;
    for (Friction friction = SMOOTH; friction <= IMPLICIT; friction++) {
        Obstacle list[2] = {make_obstacle(0), make_obstacle(1)};
        if (friction) set_moving(&list[1]);
        Body body = taper_over(list, 2, friction);
        Motion m =
            motion_create(body.sys, &body.shell->params, body.p, &body.state, body.shell->mesh->vertex_count);
        m.def.march.implicit = friction == IMPLICIT;
        m.problem.step = STEP, m.problem.steps = STEPS;
        motion_unknown(&m, "thickness", UNKNOWN_LOG, 0.1, false);
        motion_unknown(&m, "contact_stiffness", UNKNOWN_LOG, 0.1, false);
        char *name = mem_format("thickness, %s", frictions[friction]);
        check(&body, &m, name, false);
        mem_free(name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_obstacles), cmocka_unit_test(test_together),
                                       cmocka_unit_test(test_self), cmocka_unit_test(test_thickness)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
