/* Load steps: halved where they fail, the same end as in one step, and said where the end is not reached. */
#include "base/memory.h"
#include "shell/shapes.h"
#include "shell/shell.h"
#include "solve/ramp.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

typedef struct Strip {
    Shell *shell;
    System *sys;
    double *p, *x;
} Strip;

static Strip make_strip(void)
{
    Strip s;
    MeshFile file;
    Error err;
    assert_true(shape_strip(0.04, 0.01, 16, PATTERN_RIGHT, &file, &err));
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    s.shell = shell_create(mesh);
    s.shell->thickness = 5e-4, s.shell->poisson = 0.3, s.shell->density = 1000;
    for (int i = 0; i < 3 * mesh->vertex_count; i++)
        if (mesh->rest[i / 3][0] < 1e-9) shell_fix(s.shell, i / 3, i % 3);
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh->rest[mesh->edges[e][0]][0] < 1e-9 && mesh->rest[mesh->edges[e][1]][0] < 1e-9)
            shell_clamp(s.shell, e);
    s.sys = shell_system(s.shell);
    s.p = mem_alloc((size_t)s.shell->params.size, sizeof *s.p);
    s.x = mem_alloc((size_t)shell_dof_count(s.shell), sizeof *s.x);
    shell_default_params(s.shell, s.p);
    shell_rest_state(s.shell, s.x);
    s.p[s.shell->gravity + 2] = -20;
    return s;
}

static void free_strip(Strip *s)
{
    system_destroy(s->sys);
    shell_destroy(s->shell);
    mem_free(s->p);
    mem_free(s->x);
}

static double farthest(const Strip *a, const Strip *b)
{
    double largest = 0;
    for (int i = 0; i < 3 * a->shell->mesh->vertex_count; i++)
        largest = fmax(largest, fabs(a->x[i] - b->x[i]));
    return largest;
}

/* No way further than 0.6 of what is left. */
static bool move_little(void *self, double part, double *x)
{
    (void)x;
    ++*(int *)self;
    return part <= 0.6 || *(int *)self > 4;
}

static void test_same_end(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Strip once = make_strip(), halved = make_strip(), four = make_strip();
    RampDef def = ramp_default();
    RampInfo info = ramp_solve(once.sys, &once.shell->params, &def, NULL, once.p, 0, once.x);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.steps == 1 && info.refused == 0 &&
                info.reached == 1);
    int asked = 0;
    def.move = move_little, def.self = &asked;
    info = ramp_solve(halved.sys, &halved.shell->params, &def, NULL, halved.p, 0, halved.x);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.refused > 0 && info.reached == 1);
    def = ramp_default();
    def.steps = 4;
    info = ramp_solve(four.sys, &four.shell->params, &def, NULL, four.p, 0, four.x);
    assert_true(info.newton.status == NEWTON_CONVERGED && info.steps == 4);
    assert_true(farthest(&once, &halved) < 1e-9 && farthest(&once, &four) < 1e-9);
    free_strip(&once);
    free_strip(&halved);
    free_strip(&four);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_not_reached(void **state)
{
    (void)state;
    Strip s = make_strip();
    RampDef def = ramp_default();
    def.newton.max_iterations = 1;
    RampInfo info = ramp_solve(s.sys, &s.shell->params, &def, NULL, s.p, 0, s.x);
    assert_true(info.newton.status == NEWTON_MAX_ITERATIONS && info.reached < 1);
    assert_true(info.refused == 0 &&
                info.newton.iterations == 1); /* falling: half a load would not be more */
    free_strip(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_end), cmocka_unit_test(test_not_reached)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
