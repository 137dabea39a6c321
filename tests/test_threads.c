/* One answer for any number of threads: formulas, the terms of a system, and load cases that share a field. */
#include "base/random.h"
#include "optim/static_design.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <string.h>

enum { RUNS = 3 };
static const int threads[RUNS] = {1, 2, 5};

/* ---- Formulas ---- */

enum { TASKS = 64, POINTS = 50 };

typedef struct Evaluated {
    Formula *formula;
    double results[TASKS][POINTS][2];
} Evaluated;

static void evaluate_task(void *self, int task)
{
    Evaluated *o = self;
    for (int k = 0; k < POINTS; k++)
        if (!formula_eval(o->formula, (double[]){0.01 * task, 0.1 * k}, o->results[task][k], NULL))
            o->results[task][k][0] = NAN;
}

static void test_formula(void **state)
{
    (void)state;
    static const char *const expressions[] = {"sin(a)*b", "exp(-a) + x^2*step(y - 2)"}, *const variables[] = {
                                                                                            "x", "y", NULL};
    static const FormulaHelper helpers[] = {{"a", "x*y"}, {"b", "a + cos(y)"}};
    Error err;
    Evaluated *one = mem_alloc(2, sizeof *one), *more = one + 1;
    one->formula = more->formula = formula_create(expressions, 2, helpers, 2, variables, &err);
    workers_run(NULL, TASKS, evaluate_task, one);
    for (int run = 1; run < RUNS; run++) {
        Workers *workers = workers_create(threads[run]);
        workers_run(workers, TASKS, evaluate_task, more);
        assert_memory_equal(one->results, more->results, sizeof one->results);
        workers_destroy(workers);
    }
    formula_destroy(one->formula);
    mem_free(one);
}

/* Each with other names than its neighbour's. */
static void make_task(void *self, int task)
{
    static const char *const names[] = {"alpha", "b", "gamma_long", "d1"};
    const char *name = names[task % 4];
    Formula *formula = formula_create(&name, 1, NULL, 0, (const char *const[]){"other", name, NULL}, NULL);
    ((bool *)self)[task] = formula && formula_uses(formula, name) && !formula_uses(formula, "other");
    formula_destroy(formula);
}

/* muParser has buffers that all parsers share. */
static void test_formulas_at_once(void **state)
{
    (void)state;
    enum { MANY = 20000 };
    bool *good = mem_alloc(MANY, sizeof *good);
    Workers *workers = workers_create(4);
    workers_run(workers, MANY, make_task, good);
    for (int k = 0; k < MANY; k++) assert_true(good[k]);
    workers_destroy(workers);
    mem_free(good);
}

/* ---- Scenes: cases that share spatial fields, and one case that has two ---- */

static const char shell_scene[] =
    "slender: 1\njob: design\n"
    "shell:\n  mesh: {shape: sheet, size: [36 mm, 18 mm], cells: [20, 10]}\n  thickness: 1 mm\n"
    "  young: 0.1 MPa\n  poisson: 0.5\n  density: 1000\n  magnetization: [2.0e+4, 0, 0]\n"
    "fix: [{group: root, clamp: true}]\n"
    "flux_density: [\"0.01*sin(50*x)\", \"0.01*cos(25*y+x)\", \"0.03*(1+8*x)*cos(15*z)\"]\n"
    "cases:\n  - {name: a, gravity: [0, 0, -1], target: [\"x\", \"y\", \"18*x*x\"]}\n"
    "  - {name: b, gravity: [0, 0, 1], target: [\"x\", \"y\", \"24*x*x\"]}\n"
    "  - {name: c, gravity: [0, 1, 1], target: [\"x\", \"y\", \"9*x*x\"]}\n"
    "design:\n  unknowns: {magnetization: {noise: 100, scale: 1.0e+4}}\n  objectives: [{target: 1}]\n"
    "  optimizer: mma\n";

static const char rod_of[] =
    "slender: 1\njob: design\n"
    "rod:\n  model: %s\n  natural_strain: [0, 2, 0]\n  length: 60 mm\n  elements: 300\n  radius: 0.5 mm\n"
    "  young: 1 MPa\n  poisson: 0.5\n  density: 1800\n  magnetization: [5.0e+4, 0, 0]\n"
    "flux_density: [\"0\", \"1e-3*cos(20*y+x)\", \"3e-3*(1+8*x)*cos(15*z)\"]\n"
    "cases:\n  - {name: a, target: [\"s\", \"0\", \"2*s*s\"]}\n"
    "  - {name: b, gravity: [0, 0, 1], target: [\"s\", \"0\", \"3*s*s\"]}\n"
    "  - {name: c, flux_density: {dipole: {at: [0.1, 0, 0.1], moment: [0, 0, 1]}},\n"
    "     target: [\"s\", \"0\", \"s*s\"]}\n"
    "design:\n  unknowns: {magnetization: {noise: 100, scale: 1.0e+4}}\n  objectives: [{target: 1}]\n"
    "  optimizer: mma\n";

/* Energy, gradient, Hessian times a vector, of a state that is somewhere. */
static void check_system(const char *scene)
{
    Built b = scene_build(mem_text(scene));
    Case *c = &b.model->cases[0];
    System *sys = c->sys;
    size_t n = (size_t)system_dof_count(sys);
    double *work = mem_alloc(5 * n, sizeof *work), *v = work, first = 0;
    Random random = random_seed(5);
    Point point = state_point(&c->state, c->stages[0].p);
    for (size_t i = 0; i < n; i++)
        c->state.x[i] += 1e-4 * random_signed(&random), v[i] = random_signed(&random);
    for (int run = 0; run < RUNS; run++) {
        Workers *workers = workers_create(threads[run]);
        double *g = work + (run ? 3 : 1) * n, *Hv = g + n;
        system_set_workers(sys, workers);
        Evaluation at = system_hessian(sys, &point, g);
        system_multiply(sys, v, Hv);
        assert_true(at.finite && (run == 0 || at.energy == first));
        first = at.energy;
        if (run) assert_memory_equal(work + n, g, 2 * n * sizeof *g);
        system_set_workers(sys, NULL);
        workers_destroy(workers);
    }
    mem_free(work);
    clear(&b);
}

/* Objective and gradient[size] of the scene's start, with so many threads for its cases, and two inside of each where there
 * are many. */
static double evaluate_cases(const char *scene, int thread_count, double **gradient, size_t *size)
{
    Built b = scene_build(mem_text(scene));
    const Model *model = b.model;
    CaseInfo info[3];
    StaticDesignDef def = static_design_default();
    Workers *inside[3] = {NULL};
    def.workers = workers_create(thread_count);
    def.newton.step_cap = model->step_cap;
    *size = (size_t)model->design.size;
    double *u = mem_alloc(*size, sizeof *u);
    *gradient = mem_alloc(*size, sizeof *u);
    for (int c = 0; c < model->case_count; c++) {
        Case *from = &model->cases[c];
        design_read(&model->design, c, from->stages[0].p, u);
        if (thread_count > 2) system_set_workers(from->sys, inside[c] = workers_create(2));
    }
    StaticDesign *sd = static_design_create(&model->design, model->params, model->cases, &def);
    double F = static_design_evaluate(sd, u, *gradient, info);
    static_design_destroy(sd);
    mem_free(u);
    clear(&b);
    workers_destroy(def.workers);
    for (int c = 0; c < 3; c++) workers_destroy(inside[c]);
    return F;
}

static void check_cases(const char *scene)
{
    double *first, *more;
    size_t size;
    double F = evaluate_cases(scene, 1, &first, &size);
    assert_true(isfinite(F));
    for (int run = 1; run < RUNS; run++) {
        assert_true(evaluate_cases(scene, threads[run], &more, &size) == F);
        assert_memory_equal(first, more, size * sizeof *more);
        mem_free(more);
    }
    mem_free(first);
}

static void test_shell(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    check_system(shell_scene);
    check_cases(shell_scene);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_rod(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (int k = 0; k < 2; k++) {
        char *scene = mem_format(rod_of, k ? "cosserat" : "kirchhoff");
        check_system(scene);
        check_cases(scene);
        mem_free(scene);
    }
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_formula),
                                       cmocka_unit_test(test_formulas_at_once), cmocka_unit_test(test_shell),
                                       cmocka_unit_test(test_rod)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
