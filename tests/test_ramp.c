/* Load steps: halved where they fail, the same end as in one step, and said where the end is not reached. */
#include "solve/ramp.h"
#include "tests/shell_fixture.h"
#include <math.h>

static Body make_strip_held(bool held)
{
    MeshFile file;
    Error err;
    assert_true(shape_strip(0.04, 0.01, 16, PATTERN_RIGHT, &file, &err));
    Shell *shell = shell_of_mesh(&file);
    shell->thickness = 5e-4, shell->poisson = 0.3, shell->density = 1000;
    if (held) hold_root(shell, true);
    Body b = body_create(shell, shell_system(shell), 1e6);
    b.p[shell->gravity + 2] = -20;
    return b;
}

static Body make_strip(void)
{
    return make_strip_held(true);
}

static double farthest(const Body *a, const Body *b)
{
    double largest = 0;
    for (int i = 0; i < 3 * a->shell->mesh->vertex_count; i++)
        largest = fmax(largest, fabs(a->state.x[i] - b->state.x[i]));
    return largest;
}

/* No way further than 0.6 of what is left. */
static bool move_little(void *self, double from, double to, double *x)
{
    (void)x;
    ++*(int *)self;
    return ramp_part(from, to) <= 0.6 || *(int *)self > 4;
}

static void test_same_end(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Body once = make_strip(), halved = make_strip(), four = make_strip();
    RampDef def = ramp_default();
    RampInfo info = ramp_solve(once.sys, &once.shell->params, &def, NULL, once.p, &once.state);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.steps == 1 && info.refused == 0 &&
                info.reached == 1);
    int asked = 0;
    def.move = move_little, def.self = &asked;
    info = ramp_solve(halved.sys, &halved.shell->params, &def, NULL, halved.p, &halved.state);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.refused > 0 && info.reached == 1);
    def = ramp_default();
    def.steps = 4;
    info = ramp_solve(four.sys, &four.shell->params, &def, NULL, four.p, &four.state);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.steps == 4);
    assert_true(farthest(&once, &halved) < 1e-9 && farthest(&once, &four) < 1e-9);
    body_clear(&once);
    body_clear(&halved);
    body_clear(&four);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_not_reached(void **state)
{
    (void)state;
    Body s = make_strip();
    RampDef def = ramp_default();
    def.newton.max_iterations = 1;
    RampInfo info = ramp_solve(s.sys, &s.shell->params, &def, NULL, s.p, &s.state);
    assert_true(info.newton.status == NEWTON_MAX_ITERATIONS && info.reached < 1);
    assert_true(info.refused == 0 &&
                info.newton.iterations == 1); /* falling: half a load would not be more */
    assert_true(info.part == 1);              /* the iterate is under what was tried */
    body_clear(&s);
}

/* Nothing balances the weight of what nothing holds; the cut is not for want of iterations. */
static void test_astray(void **state)
{
    (void)state;
    Body s = make_strip_held(false);
    RampDef def = ramp_default();
    def.newton.max_iterations = 40;
    RampInfo info = ramp_solve(s.sys, &s.shell->params, &def, NULL, s.p, &s.state);
    assert_true(info.newton.status == NEWTON_ASTRAY && newton_is_used_up(info.newton.status));
    assert_int_equal(info.newton.iterations, 40);
    body_clear(&s);
}

static bool move_some(void *self, double from, double to, double *x)
{
    (void)self, (void)from, (void)x;
    return to < 0.6;
}

/* What gets no further is left under the loads that it is in equilibrium with. */
static void test_stuck(void **state)
{
    (void)state;
    Body stuck = make_strip(), there = make_strip();
    double *p = mem_alloc((size_t)stuck.shell->params.size, sizeof *p);
    RampDef def = ramp_default();
    def.steps = 4, def.move = move_some;
    RampInfo info = ramp_solve(stuck.sys, &stuck.shell->params, &def, NULL, stuck.p, &stuck.state);
    assert_true(!ramp_reached(info.newton.status) && info.reached >= 0.5 && info.part == info.reached);
    assert_true(info.reached == 614. / 1024 && info.refused == 8); /* by steps from 1/4 down to step_min */
    ramp_loads(&stuck.shell->params, NULL, stuck.p, info.part, p);
    def = ramp_default();
    info = ramp_solve(there.sys, &there.shell->params, &def, NULL, p, &there.state);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.part == 1);
    assert_true(farthest(&stuck, &there) < 1e-9);
    mem_free(p);
    body_clear(&stuck);
    body_clear(&there);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_end), cmocka_unit_test(test_not_reached),
                                       cmocka_unit_test(test_astray), cmocka_unit_test(test_stuck)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
