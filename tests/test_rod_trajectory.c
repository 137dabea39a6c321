/* The adjoint of a rod's motion: against the tangent, against differences, with kept factors and without; free, held at
 * both ends and hinged, in a uniform field and beside a dipole, over an obstacle with friction, in strands, of Cosserat rods. And the best motion, turns
 * included, is where the next one starts. */
#include "optim/control.h"
#include "tests/motion_fixture.h"
#include "tests/rod_taper.h"
#include "tests/rod_world_fixture.h"
#include <math.h>

typedef struct Swing {
    const char *name;
    RodSupport start, end;
    bool dipole, ground, self, couple, cosserat, moves, tapered;
    int strands;
    double differences; /* at most */
} Swing;

enum { EACH = 12, STEPS = 16 };

static const double length = 0.05, young = 1e6, radius = 0.5e-3;

static Rod *make_rod(const Swing *swing)
{
    RodActs acts = {.couples = swing->couple};
    if (swing->dipole)
        flux_fields_add(&acts.fields,
                        flux_field_dipole((double[]){0.03, 0.03, 0.03}, (double[]){0.2, 0.5, -0.4}));
    const double lengths[2] = {length, length};
    Rod *rod = rod_create_strands(swing->strands, swing->strands * EACH, lengths,
                                  rod_circle(radius, 1, 0.4, 1800), &acts);
    rod->start = swing->start, rod->end = swing->end, rod->cosserat = swing->cosserat;
    if (swing->tapered) rod_taper(rod, 2 * radius, 1.5 * radius, (double[]){0.5, 0.8}, 0.4, 1800);
    if (swing->strands > 1) rod->strand[1].position = vec3(0, 2e-3, 0);
    if (!swing->ground) return rod;
    Obstacle *floor = mem_alloc(1, sizeof *floor);
    *floor = obstacle_plane((double[]){0, 0, -1.2e-3}, (double[]){0.05, 0, 1});
    WorldBody shown = rod_world_body(rod);
    World *world = rod->world = world_create(&shown, floor, 1);
    world->offset = radius, world->slip_speed = 1e-2, world->distance = 2 * radius;
    world->rubs = true, world->self = swing->self;
    world_add_params(world, &rod->params);
    return rod;
}

static double *make_params(Rod *rod, Random *random)
{
    double *p = params_vector(&rod->params);
    rod_default_params(rod, young, p);
    for (int e = 0; e < rod->elements; e++) {
        vec3_store(p + rod->natural_strain + 3 * e,
                   vec3(3 * random_signed(random), 3 + random_signed(random), 2 * random_signed(random)));
        vec3_store(p + rod->magnetization + 3 * e,
                   vec3(2e4, 5e3 * random_signed(random), 5e3 * random_signed(random)));
    }
    vec3_store(p + rod->gravity, vec3(0, 1, -9.81));
    p[rod->damping] = 1e-4 / rod_element_length(rod, 0);
    if (rod->fields.count) p[rod->flux.scale] = 1;
    if (rod->couples) vec3_store(p + rod->couple + 3 * EACH, vec3(5e-7, -8e-7, 6e-7));
    if (!rod->world) return p;
    p[rod->world->friction] = 0.4;
    p[rod->world->stiffness] = 20;
    if (rod->world->self) p[rod->world->self_stiffness] = 20, p[rod->world->self_friction] = 0.3;
    return p;
}

static Control control_of(Params *params, int to)
{
    return (Control){.kind = CONTROL_KNOT,
                     .from = params_add(params, "control", "T", 5, 3, false),
                     .to = to,
                     .rows = 5,
                     .width = 3,
                     .steps = STEPS,
                     .duration = 2e-3 * STEPS};
}

/* Does something touch in the middle of the motion? */
static bool touches(const Rod *rod, Trajectory *t)
{
    State middle = trajectory_frame(t, STEPS / 2);
    WorldSums sums = {0};
    Point at = state_point(&middle, trajectory_params(t, STEPS / 2));
    world_measure(rod->world, &at, &sums);
    return sums.contact.touching > 0;
}

/* The same motion again starts where it ends: no iteration beyond the one that sees that. */
static int iterations_again(const Motion *m, Trajectory *t)
{
    TrajectoryInfo info;
    trajectory_evaluate(t, m->u, NULL, &info);
    return info.march.newton.iterations;
}

/* Ends that move and turn from where they were, each in its way, and nearer to each other. */
typedef struct Sway {
    RodLayout layout;
    bool held[2], turns[2];
    Vec3 place[2];
    Quat frame[2];
} Sway;

static bool sway(void *self, double time, double *x)
{
    const Sway *s = self;
    for (int k = 0; k < 2; k++) {
        int node = k ? s->layout.nodes - 1 : 0;
        double *frame = x + s->layout.reference + 4 * node;
        if (!s->held[k]) continue;
        Vec3 way = vec3(1e-3 * sin(60 * time) - 0.1 * k * time, (0.02 - 0.05 * k) * time,
                        1e-3 * (cos(80 * time) - 1));
        vec3_store(x + s->layout.position + 3 * node, vec3_add(s->place[k], way));
        Quat turned = quat_mul(quat_exp(vec3(9 * time, 5 * time, (3 - 5 * k) * time)), s->frame[k]);
        if (!s->turns[k]) continue;
        frame[0] = turned.w;
        vec3_store(frame + 1, turned.v);
    }
    return true;
}

static Sway sway_from(const Rod *rod, const RodLayout *layout, const double *x)
{
    Sway s = {.layout = *layout,
              .held = {true, rod->end != ROD_FREE},
              .turns = {rod->start == ROD_CLAMPED, rod->end == ROD_CLAMPED}};
    for (int k = 0; k < 2; k++) {
        int node = k ? layout->nodes - 1 : 0;
        s.place[k] = vec3_load(x + layout->position + 3 * node);
        s.frame[k] = rod_reference(layout, x, node);
    }
    return s;
}

static void check(const Swing *swing)
{
    long blocks = mem_live_count();
    Random random = random_seed(11);
    Rod *rod = make_rod(swing);
    Control control = control_of(&rod->params, rod->flux.uniform);
    double *p = make_params(rod, &random);
    for (int i = 0; i < 3 * control.rows; i++) p[control.from + i] = 0.02 * random_signed(&random);
    System *sys = rod_system(rod, young, true);
    RodLayout layout = rod_layout(rod, true);
    State start = system_state(sys);
    rod_natural_state(rod, &layout, p, start.x);
    for (int i = 0; i < 3 * layout.nodes; i++)
        if (!system_is_fixed(sys, i)) start.v[i] = 0.05 * random_signed(&random);
    Motion m = motion_create(sys, &rod->params, p, &start, layout.nodes);
    m.problem.controls = &control, m.problem.control_count = 1, m.problem.steps = STEPS;
    m.def.march.newton.step_cap = 1.5;
    Sway moving = sway_from(rod, &layout, start.x);
    if (swing->moves) m.def.march.move = sway, m.def.march.self = &moving;
    motion_unknown(&m, "control", UNKNOWN_LINEAR, 0.01, false);
    motion_unknown(&m, "magnetization", UNKNOWN_LINEAR, 1e4, false);
    motion_unknown(&m, "natural_strain", UNKNOWN_LINEAR, 5, false);
    motion_unknown(&m, "young", UNKNOWN_LOG, 0.5, false);
    if (swing->dipole) motion_unknown(&m, "field_scale", UNKNOWN_LINEAR, 1, false);
    if (swing->couple) motion_unknown(&m, "couple", UNKNOWN_LINEAR, 1e-6, false);
    Trajectory *t = motion_check(&m, swing->name, swing->differences);
    assert_true(!swing->ground || touches(rod, t));
    /* Couples, and last ends that have just been moved off their rod, have no energy by which one start could be told to be
     * better than another. */
    bool told = !swing->couple && !(swing->moves && swing->end != ROD_FREE);
    assert_true(!told || iterations_again(&m, t) <= STEPS);
    trajectory_destroy(t);
    motion_clear(&m);
    state_destroy(&start);
    system_destroy(sys);
    mem_free(p);
    rod_destroy(rod);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_adjoint(void **state)
{
    (void)state;
    static const Swing swings[] = {
        {"free end", ROD_CLAMPED, ROD_FREE, .strands = 1, .differences = 1e-7},
        {"free end, dipole", ROD_CLAMPED, ROD_FREE, .dipole = true, .strands = 1, .differences = 1e-7},
        {"hinged", ROD_PINNED, ROD_FREE, .strands = 1, .differences = 1e-6},
        {"between hinges", ROD_PINNED, ROD_PINNED, .strands = 1, .differences = 1e-6},
        {"between clamps, dipole", ROD_CLAMPED, ROD_CLAMPED, .dipole = true, .strands = 1,
         .differences = 1e-7},
        {"couple at the end", ROD_CLAMPED, ROD_FREE, .couple = true, .strands = 1, .differences = 1e-7},
        {"over a floor", ROD_CLAMPED, ROD_FREE, .ground = true, .strands = 1, .differences = 1e-4},
        {"stretching", ROD_CLAMPED, ROD_FREE, .cosserat = true, .strands = 1, .differences = 1e-7},
        {"stretching between clamps, dipole", ROD_CLAMPED, ROD_CLAMPED, .dipole = true, .cosserat = true,
         .strands = 1, .differences = 1e-7},
        {"stretching between hinges", ROD_PINNED, ROD_PINNED, .cosserat = true, .strands = 1,
         .differences = 1e-6},
        {"stretching over a floor", ROD_CLAMPED, ROD_FREE, .ground = true, .cosserat = true, .strands = 1,
         .differences = 1e-4},
        {"a clamp that moves", ROD_CLAMPED, ROD_FREE, .moves = true, .strands = 1, .differences = 1e-7},
        {"clamps that move, dipole", ROD_CLAMPED, ROD_CLAMPED, .moves = true, .dipole = true, .strands = 1,
         .differences = 1e-7},
        {"stretching between hinges that move", ROD_PINNED, ROD_PINNED, .moves = true, .cosserat = true,
         .strands = 1, .differences = 1e-5},
        {"tapered", ROD_CLAMPED, ROD_FREE, .tapered = true, .strands = 1, .differences = 1e-7},
        {"tapered, stretching, over a floor", ROD_CLAMPED, ROD_FREE, .ground = true, .cosserat = true,
         .tapered = true, .strands = 1, .differences = 1e-4},
        {"two strands over a floor", ROD_CLAMPED, ROD_FREE, .ground = true, .self = true, .strands = 2,
         .differences = 1e-4},
    };
    for (size_t k = 0; k < sizeof swings / sizeof *swings; k++) check(&swings[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_adjoint)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
