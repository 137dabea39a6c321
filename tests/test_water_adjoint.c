/* The adjoint of a motion in water: against the tangent, against differences, with kept factors and without. */
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include "shell/terms.h"
#include "tests/shell_fixture.h"
#include "tests/water_fixture.h"
#include <math.h>
#include <string.h>

enum { STEPS = 20 };

typedef struct Motion {
    TrajectoryProblem problem;
    TrajectoryDef def;
    Design design;
    Objective objective;
    State start;
    double *u, *v, *gradient;
} Motion;

static void add_unknown(Motion *m, const Params *params, const char *name, double scale)
{
    const ParamBlock *block = params_find(params, name);
    design_add(&m->design, (Unknown){.block = block,
                                     .group_count = block->count,
                                     .map = UNKNOWN_LINEAR,
                                     .scale = scale,
                                     .lower = -INFINITY,
                                     .upper = INFINITY});
}

static Motion motion_create(System *sys, const Params *params, double *p, const State *start, int vertices)
{
    Motion m = {.def = trajectory_default(), .start = state_clone(start)};
    Random random = random_seed(12);
    m.def.march.newton.energy_tol = 1e-15;
    m.design.case_count = 1;
    add_unknown(&m, params, "density", 1000);
    add_unknown(&m, params, "viscosity", 0.01);
    add_unknown(&m, params, "velocity", 0.1);
    size_t size = (size_t)m.design.size;
    m.u = mem_alloc(size, sizeof(double));
    m.v = mem_alloc(size, sizeof(double));
    m.gradient = mem_alloc(size, sizeof(double));
    design_read(&m.design, 0, p, m.u);
    for (size_t i = 0; i < size; i++) m.v[i] = random_signed(&random);
    const int some[] = {0, vertices / 2, vertices - 1};
    const double goal[3][3] = {{0.01, 0.02, 0.03}, {-0.01, 0.01, 0}, {0.02, 0.02, -0.01}};
    m.objective = objective_target(3, some, goal, 1);
    m.objective.first = STEPS / 2, m.objective.last = STEPS;
    m.problem = (TrajectoryProblem){
        .sys = sys, .params = params, .objective_count = 1, .step = 2e-3, .steps = STEPS, .p = p};
    return m;
}

static void motion_clear(Motion *m)
{
    objective_destroy(m->objective);
    design_clear(&m->design);
    state_destroy(&m->start);
    mem_free(m->u);
    mem_free(m->v);
    mem_free(m->gradient);
}

static Trajectory *motion_evaluate(Motion *m, const double *u, double *F)
{
    TrajectoryInfo info;
    m->problem.design = &m->design, m->problem.objectives = &m->objective, m->problem.start = &m->start;
    Trajectory *t = trajectory_create(&m->problem, &m->def);
    *F = trajectory_evaluate(t, u, m->gradient, &info);
    assert_true(isfinite(*F));
    trajectory_accept(t);
    return t;
}

/* dF along v by the tangent. */
static double by_tangent(Motion *m, Trajectory *t)
{
    size_t dofs = (size_t)m->start.dofs;
    double *dx = mem_alloc((STEPS + 1) * dofs, sizeof *dx), *g = mem_alloc(dofs, sizeof *g), slope = 0;
    trajectory_tangent(t, m->v, dx);
    for (int n = m->objective.first; n <= m->objective.last; n++) {
        memset(g, 0, dofs * sizeof *g);
        m->objective.ops->value(m->objective.self, m->objective.weight, trajectory_frame(t, n).x,
                                trajectory_params(t, n), g, NULL);
        for (size_t i = 0; i < dofs; i++) slope += g[i] * dx[(size_t)n * dofs + i];
    }
    mem_free(dx);
    mem_free(g);
    return slope;
}

static double along(const Motion *m)
{
    double sum = 0;
    for (int i = 0; i < m->design.size; i++) sum += m->gradient[i] * m->v[i];
    return sum;
}

static void check_motion(Motion *m, const char *name)
{
    const double h = 1e-3, a[4] = {-2, -1, 1, 2};
    double F[4], unused, u[8];
    Trajectory *t = motion_evaluate(m, m->u, &unused);
    double adjoint = along(m), tangent = by_tangent(m, t);
    trajectory_destroy(t);
    m->def.factor_memory = 0;
    trajectory_destroy(motion_evaluate(m, m->u, &unused));
    assert_true(along(m) == adjoint); /* the same factors, made again */
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < m->design.size; i++) u[i] = m->u[i] + a[k] * h * m->v[i];
        trajectory_destroy(motion_evaluate(m, u, &F[k]));
    }
    double differences = (8 * (F[2] - F[1]) - (F[3] - F[0])) / (12 * h);
    print_message("%s: adjoint against tangent %.1e, against differences %.1e\n", name,
                  fabs(adjoint / tangent - 1), fabs(adjoint / differences - 1));
    assert_true(fabs(adjoint / tangent - 1) < 1e-11 && fabs(adjoint / differences - 1) < 1e-6);
}

/* A magnetised sheet that bends in a field while the water streams. */
static void test_shell_adjoint(void **unused)
{
    (void)unused;
    long blocks = mem_live_count();
    FluxField *flow = shear_flow();
    for (int outer = 0; outer < 2; outer++) {
        Shell *shell = shell_of_sheet((double[]){0.012, 0.004}, (int[]){6, 2}, PATTERN_ALTERNATE);
        const Mesh *mesh = shell->mesh;
        shell->thickness = 4e-4, shell->poisson = 0.4, shell->density = RHO;
        Water water = add_water(&shell->params);
        int positions = 3 * mesh->vertex_count;
        DofClass classes[] = {{.count = positions, .size = mesh_diagonal(mesh)},
                              {.first = positions, .count = mesh->edge_count, .size = 1}};
        System *sys = system_create(shell_dof_count(shell), classes, 2);
        double *mass = mem_alloc((size_t)mesh->vertex_count, sizeof *mass);
        shell_vertex_mass(shell, mass);
        for (int t = 0; t < shell_term_row_count; t++) system_add(sys, shell_term_rows[t].create(shell));
        system_add(sys, kinetic_inertia_term(mesh->vertex_count, mass));
        water.flow = flow;
        system_add(
            sys, water_term(&(WaterDef){
                     .face_count = mesh->face_count, .faces = mesh->faces, .outer = outer, .water = water}));
        system_prepare(sys);
        Body body = body_create(shell, sys, 1e5);
        for (int f = 0; f < mesh->face_count; f++)
            body.p[shell->magnetization + 3 * f] = mesh->rest[mesh->faces[f][0]][0] < 0.006 ? 3e4 : -3e4;
        body.p[shell->flux_density + 2] = 0.02;
        body.p[water.density] = RHO;
        body.p[water.velocity + 2] = -0.05;
        Motion m = motion_create(sys, &shell->params, body.p, &body.state, mesh->vertex_count);
        check_motion(&m, outer ? "shell, outer" : "shell, two");
        motion_clear(&m);
        mem_free(mass);
        body_clear(&body);
    }
    flux_field_destroy(flow);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_rod_adjoint(void **unused)
{
    (void)unused;
    Random random = random_seed(8);
    FluxField *flow = shear_flow();
    Swarm s = rod_create(flow);
    shake(&s, &random, 3e-4, 0.1);
    s.p[s.water.viscosity] = 0.01;
    Motion m = motion_create(s.sys, &s.params, s.p, &s.state, NODES);
    check_motion(&m, "rod");
    motion_clear(&m);
    swarm_clear(&s);
    flux_field_destroy(flow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shell_adjoint),
                                       cmocka_unit_test(test_rod_adjoint)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
