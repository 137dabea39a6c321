/* A state is a value: copies of it, an energy that depends on what the state remembers and not on what the
 * System has seen, and states that share a System. */
#include "base/random.h"
#include "solve/march.h"
#include "solve/newton.h"
#include "tests/shell_fixture.h"
#include <math.h>
#include <string.h>

static void assert_same(const State *a, const State *b)
{
    assert_int_equal(a->dofs, b->dofs);
    assert_int_equal(a->memory_count, b->memory_count);
    assert_memory_equal(a->x, b->x, (size_t)a->dofs * sizeof *a->x);
    assert_memory_equal(a->v, b->v, (size_t)a->dofs * sizeof *a->v);
    assert_memory_equal(a->memory, b->memory, (size_t)a->memory_count * sizeof *a->memory);
    assert_memory_equal(&a->time, &b->time, sizeof a->time);
}

static void change_all(State *state, Random *random)
{
    for (int i = 0; i < state->dofs; i++) state->x[i] = random_signed(random);
    for (int i = 0; i < state->dofs; i++) state->v[i] = random_signed(random);
    for (int i = 0; i < state->memory_count; i++) state->memory[i] = random_signed(random);
    state->time = random_signed(random);
}

static void test_copies(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Random random = random_seed(2);
    State a = state_create(7, 3), zero = state_create(7, 3);
    change_all(&a, &random);
    State b = state_clone(&a), c = state_clone(&a);
    assert_same(&a, &b);
    change_all(&b, &random);
    assert_same(&a, &c);
    assert_memory_not_equal(a.x, b.x, 7 * sizeof *a.x);
    state_copy(&a, &b);
    assert_same(&a, &b);
    state_copy(&a, &zero);
    assert_same(&a, &zero);
    state_destroy(&a);
    state_destroy(&b);
    state_destroy(&c);
    state_destroy(&zero);
    assert_int_equal(mem_live_count(), blocks);
}

static const double LENGTH = 0.02;

static Shell *make_sheet(BendingModel bending)
{
    Shell *shell = shell_of_sheet((double[]){LENGTH, LENGTH / 2}, (int[]){4, 2}, PATTERN_RIGHT);
    shell->thickness = 1e-3, shell->poisson = 0.3, shell->density = 1000, shell->bending = bending;
    return shell;
}

/* The half beyond x = LENGTH/2 is turned by so many steps of 20 degrees, each of which is accepted. */
static void fold(const Body *b, int steps, State *state)
{
    const Mesh *mesh = b->shell->mesh;
    for (int k = 1; k <= steps; k++) {
        double angle = k * M_PI / 9;
        for (int v = 0; v < mesh->vertex_count; v++) {
            double arm = fmax(mesh->rest[v][0] - LENGTH / 2, 0);
            state->x[3 * v] = mesh->rest[v][0] - arm * (1 - cos(angle));
            state->x[3 * v + 2] = arm * sin(angle);
        }
        system_accept(b->sys, state->x, state->memory);
    }
}

/* A fold's energy is as the square of its angle: of 20 and 200 degrees, and of what 200 are to a state that
 * never turned that way, 160 the other way. */
static void check_fold(BendingModel bending)
{
    Shell *shell = make_sheet(bending);
    Body b = body_create(shell, shell_system(shell), 1e6);
    size_t dofs = (size_t)b.state.dofs;
    double *force = mem_alloc(3 * dofs, sizeof *force), *other_force = force + dofs,
           *again = other_force + dofs;
    State little = state_clone(&b.state), other = state_clone(&b.state);
    fold(&b, 1, &little);
    fold(&b, 10, &b.state);
    memcpy(other.x, b.state.x, dofs * sizeof *other.x);
    Point at = state_point(&b.state, b.p), at_other = state_point(&other, b.p),
          at_little = state_point(&little, b.p);
    double unit = system_energy(b.sys, &at_little).energy;
    double energy = system_gradient(b.sys, &at, force).energy;
    double other_energy = system_gradient(b.sys, &at_other, other_force).energy;
    assert_true(system_gradient(b.sys, &at, again).energy == energy);
    assert_memory_equal(force, again, dofs * sizeof *force);
    print_message("%s: energies of 200 and of -160 degrees are %.12f and %.12f times that of 20\n",
                  bending == BENDING_HINGE ? "hinge  " : "midedge", energy / unit, other_energy / unit);
    assert_true(fabs(energy / unit - 100) < 1e-9 && fabs(other_energy / unit - 64) < 1e-9);
    assert_memory_not_equal(force, other_force, dofs * sizeof *force);
    mem_free(force);
    state_destroy(&little);
    state_destroy(&other);
    body_clear(&b);
}

static void test_fold(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    check_fold(BENDING_MIDEDGE);
    check_fold(BENDING_HINGE);
    assert_int_equal(mem_live_count(), blocks);
}

enum { STATES = 2, STEPS = 20 };

/* One is folded by 200 degrees and springs open, the other one is flat and shaken. */
static void start_states(const Body *b, State start[STATES])
{
    Random random = random_seed(6);
    for (int s = 0; s < STATES; s++) start[s] = state_clone(&b->state);
    fold(b, 10, &start[0]);
    for (int i = 0; i < system_position_count(b->sys); i++)
        if (!system_is_fixed(b->sys, i)) start[1].v[i] = 0.1 * random_signed(&random);
}

/* Each step has a factor of its own: an older one is the System's, not the state's. */
static void take_step(System *sys, double *p, State *state)
{
    MarchDef def = march_default();
    MarchInfo info;
    def.newton.cg_iterations = 0;
    assert_true(march_step(sys, &def, 1e-4, p, state, &info));
}

static void check_turns(BendingModel bending)
{
    Shell *shell = make_sheet(bending);
    hold_root(shell, true);
    Body b = body_create(shell, shell_dynamic_system(shell), 1e6);
    State alone[STATES], shared[STATES];
    start_states(&b, alone);
    start_states(&b, shared);
    for (int s = 0; s < STATES; s++) {
        System *own = shell_dynamic_system(shell);
        for (int n = 0; n < STEPS; n++) take_step(own, b.p, &alone[s]);
        system_destroy(own);
    }
    for (int n = 0; n < STEPS; n++)
        for (int s = 0; s < STATES; s++) take_step(b.sys, b.p, &shared[s]);
    for (int s = 0; s < STATES; s++) {
        system_accept(b.sys, alone[s].x, alone[s].memory); /* as the last step has left it */
        assert_same(&alone[s], &shared[s]);
        state_destroy(&alone[s]);
        state_destroy(&shared[s]);
    }
    body_clear(&b);
}

static void test_turns(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    check_turns(BENDING_MIDEDGE);
    check_turns(BENDING_HINGE);
    assert_int_equal(mem_live_count(), blocks);
}

/* ---- What a Newton iteration allocates ---- */

enum { ITERATIONS = 20 };

static long counts[ITERATIONS + 1];

static bool note_count(void *self, const NewtonInfo *info)
{
    (void)self;
    if (info->iterations <= ITERATIONS) counts[info->iterations] = mem_total_count();
    return true;
}

/* Nothing, once all that is needed is there. */
static void test_no_allocation(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 2; threads++) {
        Shell *shell = make_sheet(BENDING_MIDEDGE);
        hold_root(shell, true);
        Body b = body_create(shell, shell_system(shell), 1e5);
        Workers *workers = workers_create(threads);
        system_set_workers(b.sys, workers);
        b.p[shell->gravity + 2] = -300;
        NewtonDef def = newton_default();
        NewtonObserver observer = {note_count, NULL};
        NewtonInfo info = newton_minimize(b.sys, &def, &(Point){.p = b.p}, &b.state, &observer);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        assert_true(info.iterations > 5 && info.iterations <= ITERATIONS);
        for (int k = 3; k < info.iterations; k++) assert_int_equal(counts[k], counts[2]);
        body_clear(&b);
        workers_destroy(workers);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_copies), cmocka_unit_test(test_fold),
                                       cmocka_unit_test(test_turns), cmocka_unit_test(test_no_allocation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
