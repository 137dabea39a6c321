/* Whole runs of scenes with `solver: {direct: mumps}`, over the processes that this is started as: what they find is what CHOLMOD's
 * factors lead to. */
#define NAME "test_mumps_runs"
#include "run_fixture.h"
#include "solve/ranks.h"
#include <math.h>

/* What a run leaves that is to be the same, to so many parts of its largest number. */
typedef struct Same {
    const char *path;
    double within;
} Same;

enum { SETTINGS_MOST = 4, SAME_MOST = 4 };

typedef struct Trial {
    const char *scene, *settings[SETTINGS_MOST];
    Same same[SAME_MOST];
} Trial;

static const Trial trials[] = {
    /* a shell, held and stable; its lowest modes */
    {"scenes/cantilever.yaml",
     {"shell.mesh.n=12", "modes=3"},
     {{"slender/state/x", 1e-10},
      {"slender/final/lowest_eigenvalue", 1e-8},
      {"slender/final/eigenvalues", 1e-8}}},
    /* a rod that multipliers hold */
    {"scenes/rod_arch.yaml", {"rod.elements=80"}, {{"slender/state/x", 1e-10}}},
    /* a rod of turns only */
    {"scenes/rod_equilibrium.yaml", {"rod.elements=100"}, {{"slender/state/x", 1e-10}}},
    /* a solid */
    {"scenes/cook.yaml", {0}, {{"slender/state/x", 1e-10}}},
    /* a design: two cases with their adjoints; rounding grows from one iteration to the next */
    {"tests/scene_small.yaml",
     {"shell.mesh.n=5", "design.iterations=1"},
     {{"slender/history/objective", 1e-10},
      {"slender/history/gradient_norm", 1e-10},
      {"slender/state/x", 1e-10}}},
    /* a motion whose path is kept with its factors, and swept back */
    {"tests/scene_trajectory.yaml",
     {"design.iterations=1"},
     {{"slender/history/objective", 1e-8}, {"slender/state/x", 1e-8}}},
};

static void check_same(const Same *same, Result *mumps, Result *cholmod)
{
    Array a = read_all(mumps, same->path), b = read_all(cholmod, same->path);
    const double *x = a.data, *y = b.data;
    size_t count = array_count(&a);
    double most = 0, off = 0;
    assert_int_equal(a.type, ARRAY_FLOAT64);
    assert_true(count > 0 && count == array_count(&b));
    for (size_t k = 0; k < count; k++) most = fmax(most, fabs(y[k])), off = fmax(off, fabs(x[k] - y[k]));
    if (!(off <= same->within * most)) fail_msg("%s is off by %g of %g", same->path, off, most);
    array_clear(&a);
    array_clear(&b);
}

static Result *run_with(const Trial *trial, const char *direct)
{
    const char *settings[SETTINGS_MOST + 1] = {direct};
    int count = 1;
    for (int k = 0; k < SETTINGS_MOST && trial->settings[k]; k++) settings[count++] = trial->settings[k];
    char *path = mem_format("%s/%s", SOURCE_DIR, trial->scene);
    Result *result = run_file(path, settings, count, false);
    mem_free(path);
    return result;
}

static void check_trial(void **state)
{
    const Trial *trial = *state;
    Result *cholmod = run_with(trial, "solver.direct=cholmod"),
           *mumps = run_with(trial, "solver.direct=mumps");
    for (int k = 0; k < SAME_MOST && trial->same[k].path; k++) check_same(&trial->same[k], mumps, cholmod);
    result_close(cholmod);
    result_close(mumps);
}

int main(void)
{
    enum { COUNT = sizeof trials / sizeof *trials };
    struct CMUnitTest tests[COUNT];
    for (int k = 0; k < COUNT; k++)
        tests[k] = (struct CMUnitTest){trials[k].scene, check_trial, NULL, NULL, (void *)&trials[k]};
    ranks_start();
    if (ranks_serve()) return 0;
    int failed = cmocka_run_group_tests(tests, NULL, remove_run);
    ranks_end();
    return failed;
}
