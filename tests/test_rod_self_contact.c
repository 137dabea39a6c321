/* Rods that touch themselves and each other: they do not pass through, and motions with all that they meet have adjoints. */
#include "base/random.h"
#include "optim/path.h"
#include "solve/check.h"
#include "tests/rod_world_fixture.h"

/* Where the second polyline first crosses the other one, as seen from above: how far above it is; INFINITY: nowhere. What
 * swings past may come back below. */
static double height_over(const Rig *rig)
{
    int each = rig->layout.each;
    for (int j = each + 1; j < 2 * each + 1; j++)
        for (int i = 0; i < each; i++) {
            Vec3 a = rig_place(rig, i), b = rig_place(rig, j), u = vec3_sub(rig_place(rig, i + 1), a),
                 v = vec3_sub(rig_place(rig, j + 1), b), w = vec3_sub(b, a);
            double det = u.x * v.y - u.y * v.x, s = (w.x * v.y - w.y * v.x) / det,
                   t = (w.x * u.y - w.y * u.x) / det;
            if (s >= 0 && s <= 1 && t >= 0 && t <= 1) return w.z + t * v.z - s * u.z;
        }
    return INFINITY;
}

/* A rod swings down on another one, faster than its own thickness in a step. */
static void test_thrown(void **state)
{
    (void)state;
    double r = 1e-3;
    for (int k = 0; k < 3; k++) {
        const double speeds[] = {4, 16, 64};
        double speed = speeds[k];
        RigDef def = {.strands = 2,
                      .elements = 20,
                      .length = 0.1,
                      .radius = r,
                      .young = 1e7,
                      .density = 1200,
                      .friction = 0.3 * (k % 2),
                      .self = true};
        Rig rig = rig_create(&def);
        rig.rod->strand[1].position = vec3(0.05, -0.05, 0.01);
        rig.rod->strand[1].frame = quat_from_axes(vec3(0, 1, 0), vec3(-1, 0, 0), vec3(0, 0, 1));
        rig_start(&rig, def.young);
        rig.fast = true;
        for (int i = 0; i <= 20; i++) rig.now.v[3 * (21 + i) + 2] = -speed * i / 20;
        double least = INFINITY, above = INFINITY, torn = 0;
        int iterations = 0;
        for (int step = 0; step < 40; step++) {
            iterations += rig_march(&rig, 2e-3, 1);
            least = fmin(least, rig.sums.self.distance);
            if (step < 3) above = fmin(above, height_over(&rig)); /* later they slip apart */
            torn = fmax(torn, rig_torn(&rig));
            assert_true(rig.sums.crossings == 0);
        }
        print_message("%g m/s: nearest %.3f D, %.3f D above, %.1e m torn, %.1f iterations a step\n", speed,
                      least / (2 * r), above / (2 * r), torn, iterations / 40.0);
        assert_true(least > 0.1 * 2 * r && least < 2 * r && above > 0.2 * 2 * r && torn < 1e-12);
        rig_clear(&rig);
    }
}

/* A trial in which rods have passed through each other is refused as a whole: only turned back would be their positions, and
 * these would no longer follow from the turns. */
static void test_refused(void **state)
{
    (void)state;
    RigDef def = {.strands = 2,
                  .elements = 8,
                  .length = 0.1,
                  .radius = 1e-3,
                  .young = 1e7,
                  .density = 1200,
                  .self = true};
    for (int through = 0; through < 2; through++) {
        Rig rig = rig_create(&def);
        rig.rod->strand[1].position = vec3(0.05, -0.05, 0.01);
        rig.rod->strand[1].frame = quat_from_axes(vec3(0, 1, 0), vec3(-1, 0, 0), vec3(0, 0, 1));
        rig_start(&rig, def.young);
        double *x = mem_copy(rig.now.x, (size_t)rig.layout.dofs, sizeof *x);
        for (int i = 9; i < 18; i++) x[rig.layout.turn + 3 * i + 1] = through ? 0.5 : 0.1; /* down */
        system_project(rig.sys, rig.now.x, x);
        bool finite = true;
        for (int i = 0; i < rig.layout.turn; i++) finite = finite && isfinite(x[i]);
        assert_true(finite == !through);
        mem_free(x);
        rig_clear(&rig);
    }
}

/* A straight rod whose natural shape is rings upon each other: it coils up, and its turns press on each other. */
static void test_coiled(void **state)
{
    (void)state;
    enum { N = 100 };
    double r = 1e-3, length = 0.15;
    for (int self = 0; self < 2; self++) {
        RigDef def = {.strands = 1,
                      .elements = N,
                      .length = length,
                      .radius = r,
                      .young = 1e6,
                      .density = 1200,
                      .self = self};
        Rig rig = rig_create(&def);
        rig_start(&rig, def.young);
        for (int e = 0; e < N; e++)
            vec3_store(rig.p + rig.rod->natural_strain + 3 * e, vec3(8 * (e < N / 2 ? 1 : -1), 160, 0));
        rig.p[rig.rod->damping] = 1e-4 / rod_element_length(rig.rod, 0);
        double least = INFINITY;
        int iterations = 0;
        for (int k = 0; k < 50; k++) {
            iterations += rig_march(&rig, 2e-3, 5);
            if (self) least = fmin(least, rig.sums.self.distance);
            assert_true(rig.sums.crossings == 0 || !self);
        }
        rig.rod->world->self = true; /* to measure by */
        rig_march(&rig, 2e-3, 1);
        double now = rig.sums.self.distance / (2 * r);
        print_message(
            "coiled, %s self contact: %g pairs, now %.3f D, nearest %.3f D, %.1f iterations a step\n",
            self ? "with" : "without", rig.sums.pairs, now, least / (2 * r), iterations / 250.0);
        assert_true(self ? least > 1.8 * r && now < 1 && rig.sums.pairs > 20 : now < 0.2);
        rig_clear(&rig);
    }
}

/* ---- Derivatives ---- */

/* Two strands beside each other, on a ball that moves and a floor, about which all terms of a system are active. */
static Rig touching_rig(double smoothing)
{
    double r = 1e-3;
    RigDef def = {.strands = 2,
                  .elements = 10,
                  .length = 0.03,
                  .radius = r,
                  .young = 1e6,
                  .density = 1200,
                  .friction = 0.4,
                  .stiffness = 20,
                  .obstacles = {obstacle_sphere((double[]){0.02, 0, -0.02}, 0.0195, false),
                                obstacle_plane((double[]){0, 0, -5e-4}, (double[]){0.1, 0, 1})},
                  .obstacle_count = 2,
                  .self = true};
    def.obstacles[0].motion.move = of_time("0.02*t", "0.01*sin(3*t)", "0");
    Rig rig = rig_create(&def);
    Rod *rod = rig.rod;
    World *world = rod->world;
    for (int k = 0; k < world->contact_kinds; k++) world->contacts[k].smoothing = smoothing;
    world->slip_speed = 0.02;
    rod->strand[1].position = vec3(5e-3, -1e-3, 1.5e-3);
    rod->strand[1].frame = quat_from_axes(vec3(0.8, 0.6, 0), vec3(-0.6, 0.8, 0), vec3(0, 0, 1));
    rig.p[rod->gravity + 2] = -9.81;
    for (int e = 0; e < 20; e++) rig.p[rod->natural_strain + 3 * e + 1] = 3;
    rig_start(&rig, def.young);
    return rig;
}

static void test_terms(void **state)
{
    (void)state;
    Random random = random_seed(5);
    Rig rig = touching_rig(2e-3);
    double size[TERM_MAX_DOF];
    for (int i = 0; i < TERM_MAX_DOF; i++) size[i] = 1e-4;
    int first = system_term_count(rig.sys) - 4, kinds = 0;
    static const char *const names[] = {"contact", "friction", "self_contact", "self_friction"};
    for (int t = first; t < system_term_count(rig.sys); t++, kinds++) {
        const Term *term = system_term(rig.sys, t);
        Point at = {.x = rig.now.x, .p = rig.p, .memory = rig.now.memory, .time = 0.3, .dt = 0.01};
        at = system_term_point(rig.sys, t, &at);
        assert_string_equal(term->ops->name, names[kinds]);
        TermError error = check_term(term, &rig.rod->params, &at, system_dof_count(rig.sys), size, &random);
        print_message("%-14s differences %.1e, products %.1e\n", term->ops->name, check_differences(error),
                      check_products(error));
        assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
    }
    rig_clear(&rig);
}

/* Along random parameters and a random start velocity: what places of the last states become, by the tangent and by the
 * adjoint. */
static void test_adjoint(void **state)
{
    (void)state;
    enum { STEPS = 25 };
    Random random = random_seed(6);
    Rig rig = touching_rig(1e-4);
    rig.march.newton.energy_tol = 1e-15;
    size_t dofs = (size_t)rig.layout.dofs, size = (size_t)rig.rod->params.size;
    TrajectoryProblem problem = {.sys = rig.sys,
                                 .params = &rig.rod->params,
                                 .start = &rig.now,
                                 .step = 2e-3,
                                 .steps = STEPS,
                                 .p = rig.p};
    Path path = path_create(&problem, &rig.march, 0);
    memcpy(path.p, rig.p, size * sizeof *rig.p);
    MarchInfo info = {0};
    int reached;
    assert_true(path_march(&path, NULL, NULL, &info, &reached));
    double *dp = mem_alloc(2 * size, sizeof *dp), *gp = dp + size, *dv = mem_alloc(2 * dofs, sizeof *dv),
           *gv = dv + dofs;
    double *dx = mem_alloc(2 * dofs * (STEPS + 1), sizeof *dx), *seed = dx + dofs * (STEPS + 1);
    for (int b = 0; b < rig.rod->params.block_count; b++) {
        const ParamBlock *block = &rig.rod->params.blocks[b];
        double largest = 0;
        for (int i = 0; i < block->count * block->width; i++)
            largest = fmax(largest, fabs(rig.p[block->offset + i]));
        for (int i = 0; i < block->count * block->width; i++)
            dp[block->offset + i] = (largest > 0 ? largest : 1e-3) * random_signed(&random);
    }
    for (size_t i = 0; i < (size_t)rig.layout.turn; i++)
        if (!system_is_fixed(rig.sys, (int)i)) dv[i] = 0.01 * random_signed(&random);
    for (int k = STEPS / 2; k <= STEPS; k++)
        for (int i = 0; i < rig.layout.turn; i++) seed[(size_t)k * dofs + (size_t)i] = random_signed(&random);
    double *weight = mem_copy(seed, dofs * (STEPS + 1), sizeof *seed), tangent = 0, adjoint = 0;
    path_tangent(&path, dp, dv, dx);
    for (size_t i = 0; i < dofs * (STEPS + 1); i++) tangent += weight[i] * dx[i];
    path_adjoint(&path, seed, gp, gv);
    for (size_t i = 0; i < size; i++) adjoint += gp[i] * dp[i];
    for (size_t i = 0; i < dofs; i++) adjoint += gv[i] * dv[i];
    rig_march(&rig, 2e-3, STEPS);
    print_message("adjoint against tangent: %.1e; %g contacts, %g pairs at the end\n",
                  fabs(adjoint / tangent - 1), rig.sums.contact.touching, rig.sums.pairs);
    assert_true(fabs(adjoint / tangent - 1) < 1e-11);
    assert_true(rig.sums.contact.touching > 5 && rig.sums.pairs > 2);
    for (int b = 0; b < rig.rod->params.block_count; b++) { /* all that is at work has a derivative */
        const ParamBlock *block = &rig.rod->params.blocks[b];
        if (!strcmp(block->name, "friction") || !strcmp(block->name, "self_friction") ||
            !strcmp(block->name, "contact_stiffness") || !strcmp(block->name, "self_stiffness"))
            assert_true(gp[block->offset] != 0);
    }
    path_destroy(&path);
    mem_free(dp);
    mem_free(dv);
    mem_free(dx);
    mem_free(weight);
    rig_clear(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_thrown), cmocka_unit_test(test_coiled),
                                       cmocka_unit_test(test_refused), cmocka_unit_test(test_terms),
                                       cmocka_unit_test(test_adjoint)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
