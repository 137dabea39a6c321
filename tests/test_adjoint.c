/* dF/du of a quasi-static design against central differences and against the forward tangent, for every kind
 * of unknown and both bending models. */
#include "base/random.h"
#include "optim/objectives.h"
#include "optim/static_design.h"
#include "tests/shell_fixture.h"
#include <math.h>
#include <string.h>

typedef struct Fixture {
    Shell *shell;
    Design design;
    Case cases[2];
    StaticDesign *sd;
    double *u;
} Fixture;

static Shell *make_shell(BendingModel bending)
{
    MeshFile file = {0};
    Error err;
    assert_true(shape_hexagram(0.04, 3, &file, &err));
    Shell *shell = shell_of_mesh(&file);
    const Mesh *mesh = shell->mesh;
    shell->thickness = 1e-3, shell->poisson = 0.4, shell->density = 1000, shell->bending = bending;
    for (int i = 0; i < 3 * mesh->vertex_count; i++)
        if (hypot(mesh->rest[i / 3][0], mesh->rest[i / 3][1]) < 5e-3) shell_fix(shell, i / 3, i % 3);
    return shell;
}

/* What is asked for: places of vertices, those as a cloud, or that of the centre of mass. */
typedef enum Goal { PLACES, CLOUD, CENTER } Goal;

static Objective center_objective(const Shell *shell)
{
    Probe center = probe_center(shell_masses(shell));
    Objective objective = objective_waypoint(&center, (double[]){1e-3, 0, 8e-3}, 1);
    probe_clear(&center);
    return objective;
}

/* The same places without the vertices that they are of, seen along y. */
static Objective seen_outline(const Mesh *mesh, double (*target)[3])
{
    for (int v = 0; v < mesh->vertex_count; v++) target[v][1] = NAN;
    PointCloud cloud = {mesh->edge_count, mesh->vertex_count, mesh->edges, target, 1e-3};
    return objective_cloud(&cloud, 1);
}

static void make_cases(Fixture *f, Random *random, Goal goal)
{
    const Shell *shell = f->shell;
    int count = shell->mesh->vertex_count;
    int *all = mem_alloc((size_t)count, sizeof *all);
    double(*target)[3] = mem_alloc((size_t)count, sizeof *target);
    for (int v = 0; v < count; v++) {
        all[v] = v;
        memcpy(target[v], shell->mesh->rest[v], sizeof *target);
        target[v][2] = 20 * (target[v][0] * target[v][0] + target[v][1] * target[v][1]);
    }
    double *M = mem_alloc(3 * (size_t)shell->mesh->face_count, sizeof *M),
           *x = mem_alloc((size_t)shell_dof_count(shell), sizeof *x);
    for (int i = 0; i < 3 * shell->mesh->face_count; i++) M[i] = 2e4 * random_signed(random);
    for (int c = 0; c < 2; c++) {
        double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
        shell_default_params(shell, p);
        for (int i = 0; i < shell->mesh->face_count; i++) p[shell->young + i] = 1e5;
        memcpy(p + shell->magnetization, M, 3 * (size_t)shell->mesh->face_count * sizeof *M);
        p[shell->gravity + 2] = -0.3;
        p[shell->flux.uniform] = 0.01, p[shell->flux.uniform + 2] = c ? -0.03 : 0.05;
        f->cases[c] = case_create(c ? "down" : "up", p, (size_t)shell->params.size, 0);
        f->cases[c].weight = c ? 0.5 : 1;
        *case_add_objective(&f->cases[c]) = goal == CLOUD ? seen_outline(shell->mesh, target)
                                            : goal == CENTER
                                                ? center_objective(shell)
                                                : objective_target(count, all, (const double(*)[3])target, 1);
        shell_rest_state(shell, x);
        case_start(&f->cases[c], shell_system(shell), x);
        mem_free(p);
    }
    mem_free(all);
    mem_free(target);
    mem_free(x);
    mem_free(M);
}

static Fixture make_fixture(BendingModel bending, Unknown unknown, const char *block)
{
    Fixture f = {.shell = make_shell(bending)};
    unknown.block = params_find(&f.shell->params, block); /* the shell outlives the fixture */
    f.design.case_count = 2;
    design_add(&f.design, unknown);
    return f;
}

static void free_fixture(Fixture *f)
{
    static_design_destroy(f->sd);
    for (int c = 0; c < 2; c++) case_clear(&f->cases[c]);
    mem_free(f->u);
    design_clear(&f->design);
    shell_destroy(f->shell);
}

/* dF along v by the tangent dx = -H^-1 (d2E/dx dp) dp at the equilibrium that was accepted. */
static double tangent_slope(const Fixture *f, const double *v)
{
    double slope = 0;
    int dofs = shell_dof_count(f->shell), params = f->shell->params.size;
    double *dp = mem_alloc((size_t)params, sizeof *dp), *dx = mem_alloc((size_t)dofs, sizeof *dx),
           *gx = mem_alloc((size_t)dofs, sizeof *gx), *gp = mem_alloc((size_t)params, sizeof *gp);
    for (int c = 0; c < 2; c++) {
        const Case *load = &f->cases[c];
        double *p = mem_copy(load->stages[0].p, (size_t)f->shell->params.size, sizeof *p);
        design_apply(&f->design, c, f->u, p);
        design_forward(&f->design, c, f->u, v, dp);
        Point at = state_point(&load->state, p);
        system_param_forward(load->sys, &at, dp, dx);
        system_solve(load->sys, dx, dx);
        memset(gx, 0, (size_t)dofs * sizeof *gx);
        memset(gp, 0, (size_t)params * sizeof *gp);
        load->objectives[0].ops->value(load->objectives[0].self, load->weight, load->state.x, p, gx, gp);
        for (int i = 0; i < dofs; i++) slope -= gx[i] * dx[i];
        for (int i = 0; i < params; i++) slope += gp[i] * dp[i];
        mem_free(p);
    }
    mem_free(dp);
    mem_free(dx);
    mem_free(gx);
    mem_free(gp);
    return slope;
}

/* dx = -H^-1 (d2E/dx dp) dp of a case along v, and a = H^-1 dF/dx, at the equilibrium that was accepted; of
 * positions only. */
static void find_directions(const Fixture *f, int c, const double *v, double *dx, double *a)
{
    const Case *load = &f->cases[c];
    int dofs = shell_dof_count(f->shell);
    double *p = mem_copy(load->stages[0].p, (size_t)f->shell->params.size, sizeof *p);
    double *dp = mem_alloc((size_t)f->shell->params.size, sizeof *dp);
    design_apply(&f->design, c, f->u, p);
    design_forward(&f->design, c, f->u, v, dp);
    Point at = state_point(&load->state, p);
    system_param_forward(load->sys, &at, dp, dx);
    system_solve(load->sys, dx, dx);
    memset(a, 0, (size_t)dofs * sizeof *a);
    load->objectives[0].ops->value(load->objectives[0].self, load->weight, load->state.x, p, a, dp);
    system_solve(load->sys, a, a);
    for (int i = system_position_count(load->sys); i < dofs; i++) dx[i] = a[i] = 0;
    mem_free(p);
    mem_free(dp);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* The product's two parts, with the target of all positions: 2 |dx|^2, and dx'H^-1 dx 2 a'a/a'H^-1 a. */
static void check_product(Fixture *f, const double *v, double *out)
{
    int n = f->design.size, dofs = shell_dof_count(f->shell);
    double plain = 0, soft = 0;
    double *dx = mem_alloc(3 * (size_t)dofs, sizeof *dx), *a = dx + dofs, *y = a + dofs;
    for (int c = 0; c < 2; c++) {
        System *sys = f->cases[c].sys;
        double weight = f->cases[c].weight;
        find_directions(f, c, v, dx, a);
        plain += 2 * weight * dot(dofs, dx, dx);
        system_solve(sys, a, y);
        double pull = 2 * weight * dot(dofs, a, a) / dot(dofs, a, y);
        system_solve(sys, dx, y);
        soft += pull * dot(dofs, dx, y);
    }
    static_design_product(f->sd, v, 0, out);
    double off = dot(n, v, out) / plain - 1;
    static_design_product(f->sd, v, 0.5, out);
    double soft_off = (dot(n, v, out) - plain) / (0.5 * soft) - 1;
    print_message("product %.1e, of soft modes %.1e (%.2f of it)\n", fabs(off), fabs(soft_off), soft / plain);
    assert_true(fabs(off) < 1e-10 && fabs(soft_off) < 1e-8);
    mem_free(dx);
}

static void check(BendingModel bending, const char *block, Unknown unknown, Goal goal)
{
    long blocks = mem_live_count();
    Random random = random_seed(5);
    Fixture f = make_fixture(bending, unknown, block);
    make_cases(&f, &random, goal);
    int n = f.design.size;
    f.u = mem_alloc((size_t)n, sizeof *f.u);
    for (int c = 0; c < 2; c++) design_read(&f.design, c, f.cases[c].stages[0].p, f.u);
    StaticDesignDef def = static_design_default();
    f.sd = static_design_create(&f.design, &f.shell->params, f.cases, &def);

    double *g = mem_alloc((size_t)n, sizeof *g), *v = mem_alloc((size_t)n, sizeof *v),
           *moved = mem_alloc((size_t)n, sizeof *v);
    CaseInfo info[2];
    double F = static_design_evaluate(f.sd, f.u, g, info), slope = 0, F4[4];
    assert_true(isfinite(F));
    static_design_accept(f.sd);
    for (int i = 0; i < n; i++) v[i] = random_signed(&random), slope += g[i] * v[i];
    if (goal == PLACES) check_product(&f, v, moved);
    double tangent = tangent_slope(&f, v), h = 1e-3;
    for (int k = 0; k < 4; k++) {
        static const double steps[4] = {-2, -1, 1, 2};
        for (int i = 0; i < n; i++) moved[i] = f.u[i] + steps[k] * h * v[i];
        F4[k] = static_design_evaluate(f.sd, moved, NULL, info);
    }
    double difference = (8 * (F4[2] - F4[1]) - (F4[3] - F4[0])) / (12 * h);
    print_message("%-14s %s: tangent %.1e, differences %.1e\n", block,
                  bending == BENDING_HINGE ? "hinge  " : "midedge", fabs(slope / tangent - 1),
                  fabs(slope / difference - 1));
    assert_true(fabs(slope / tangent - 1) < 1e-10);
    assert_true(fabs(slope / difference - 1) < 1e-6);
    mem_free(g);
    mem_free(v);
    mem_free(moved);
    free_fixture(&f);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_gradients(void **state)
{
    (void)state;
    for (BendingModel bending = BENDING_MIDEDGE; bending <= BENDING_HINGE; bending++) {
        Unknown open = {.lower = -INFINITY, .upper = INFINITY, .scale = 1e4};
        check(bending, "magnetization", open, PLACES);
        open.limit = 5e4, open.map = UNKNOWN_CAPPED_LENGTH;
        check(bending, "magnetization", open, PLACES);
        open.limit = 2e4, open.map = UNKNOWN_FIXED_LENGTH;
        check(bending, "magnetization", open, PLACES);
        check(bending, "young", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1e4, .upper = 1e8},
              PLACES);
        check(bending, "young", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1e4, .upper = 1e8},
              CLOUD);
        check(bending, "thickness", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1e-4, .upper = 1e-2},
              PLACES);
        check(bending, "density", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1, .upper = 1e5},
              PLACES);
        check(bending, "thickness", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1e-4, .upper = 1e-2},
              CENTER);
        check(bending, "density", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1, .upper = 1e5},
              CENTER);
        check(bending, "fold", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 0.01, .upper = 100},
              PLACES);
        check(bending, "flux_density", (Unknown){.scale = 0.05, .lower = -1, .upper = 1, .per_case = true},
              PLACES);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gradients)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
