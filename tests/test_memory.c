/* Memory that is not there: a call ends with a sentence in the thread that made it, all threads live, and the next call
 * gives what it always gave. Allocations fail by a calloc of our own (the linker's --wrap). */
#include "base/guard.h"
#include "base/workers.h"
#include "io/formula.h"
#include "job/run.h"
#include "tests/scene_fixture.h"
#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);

static atomic_long left = -1; /* allocations that will be had before all fail; negative: all are had */

void *__wrap_calloc(size_t count, size_t size)
{
    if (size > PTRDIFF_MAX) return NULL; /* AddressSanitizer would have a word to say */
    if (atomic_load(&left) < 0) return __real_calloc(count, size);
    if (atomic_fetch_sub(&left, 1) > 0) return __real_calloc(count, size);
    atomic_store(&left, 0);
    return NULL;
}

/* What a call leaves behind when it fails is lost, and may be. */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "detect_leaks=0";
}

/* The same where only so many allocations are to be had. */
static bool call_with(long allocations, void (*work)(void *self), void *self, Error *err)
{
    atomic_store(&left, allocations);
    bool ok = guard_call(work, self, err);
    atomic_store(&left, -1);
    if (!ok && strncmp(err->text, "out of memory", 13)) fail_msg("%s", err->text);
    return ok;
}

/* ---- Guards ---- */

static void ask_too_much(void *self)
{
    *(void **)self = mem_alloc(PTRDIFF_MAX, 1);
}

static void ask_within(void *self)
{
    Error err;
    assert_false(guard_call(ask_too_much, self, &err));
    mem_exhausted("a library");
}

/* The innermost guard is left, then the one around it; after them the hook is the one before. */
static void test_nested(void **state)
{
    (void)state;
    Error err;
    void *block = NULL;
    assert_false(guard_call(ask_within, &block, &err));
    assert_string_equal(err.text, "out of memory in a library");
    assert_null(block);
    assert_null(mem_set_hook((MemHook){0}).call);
}

enum { CALLS = 2000 };

static void *call_often(void *self)
{
    long wrong = 0;
    void *block = NULL;
    for (int k = 0; k < CALLS; k++) wrong += guard_call(ask_too_much, &block, NULL);
    *(long *)self = wrong;
    return NULL;
}

static void test_calls_at_once(void **state)
{
    (void)state;
    enum { THREADS = 3 };
    pthread_t threads[THREADS];
    long wrong[THREADS];
    for (int t = 0; t < THREADS; t++)
        assert_int_equal(pthread_create(&threads[t], NULL, call_often, &wrong[t]), 0);
    for (int t = 0; t < THREADS; t++) assert_true(pthread_join(threads[t], NULL) == 0 && wrong[t] == 0);
}

/* ---- Workers ---- */

enum { TASKS = 50 };

typedef struct Sums {
    Workers *workers;
    long sum[TASKS];
} Sums;

static void add_up(void *self, int k)
{
    long *numbers = mem_alloc(100, sizeof *numbers);
    for (int i = 0; i < 100; i++) numbers[i] = (long)k * i;
    for (int i = 0; i < 100; i++) ((Sums *)self)->sum[k] += numbers[i];
    mem_free(numbers);
}

static void run_tasks(void *self)
{
    workers_run(((Sums *)self)->workers, TASKS, add_up, self);
}

/* Whichever task fails, in whichever thread, and with it all that follow. */
static void test_workers(void **state)
{
    (void)state;
    Workers *workers = workers_create(4);
    for (int round = 0; round < 20; round++)
        for (long k = 0; k <= TASKS; k++) {
            Error err;
            Sums sums = {.workers = workers};
            assert_int_equal(call_with(k, run_tasks, &sums, &err), k == TASKS);
            sums = (Sums){.workers = workers};
            run_tasks(&sums);
            for (int t = 0; t < TASKS; t++) assert_int_equal(sums.sum[t], 4950 * t);
        }
    workers_destroy(workers);
}

typedef struct Alone {
    pthread_t caller;
    atomic_bool asked;
} Alone;

/* Only in a thread that is not the caller's, which waits for it. */
static void fail_elsewhere(void *self, int k)
{
    (void)k;
    Alone *alone = self;
    if (!pthread_equal(pthread_self(), alone->caller)) {
        atomic_store(&alone->asked, true);
        mem_free(mem_alloc(PTRDIFF_MAX, 1));
    }
    while (!atomic_load(&alone->asked)) sched_yield();
}

static void run_alone(void *self)
{
    Alone alone = {.caller = pthread_self()};
    workers_run(self, 2, fail_elsewhere, &alone);
}

static void test_worker_fails(void **state)
{
    (void)state;
    Error err;
    Workers *workers = workers_create(2);
    for (int k = 0; k < 100; k++) {
        err.text[0] = 0;
        assert_false(guard_call(run_alone, workers, &err));
        assert_non_null(strstr(err.text, "blocks of 1 bytes were asked for"));
    }
    workers_destroy(workers);
}

/* ---- Formulas, which keep what threads evaluate them by ---- */

/* Long enough for the others to need evaluators of their own. */
static void evaluate(void *self, int k)
{
    enum { POINTS = 2000 };
    double x[POINTS], value[POINTS];
    for (int i = 0; i < POINTS; i++) x[i] = k;
    formula_eval_all(((void **)self)[1], POINTS, x, value, NULL);
}

static void make_and_evaluate(void *self)
{
    Formula *formula = formula_create((const char *const[]){"2*half"}, 1, &(FormulaHelper){"half", "x/2"}, 1,
                                      (const char *const[]){"x", NULL}, NULL);
    workers_run(self, TASKS, evaluate, (void *[]){self, formula});
    formula_destroy(formula);
}

/* No thread waits for one that has left. */
static void test_formula(void **state)
{
    (void)state;
    Workers *workers = workers_create(4);
    Error err;
    for (int round = 0; round < 10; round++)
        for (long k = 0; k < 24; k++) call_with(k, make_and_evaluate, workers, &err);
    assert_true(call_with(LONG_MAX, make_and_evaluate, workers, &err));
    workers_destroy(workers);
}

/* ---- A job, from its scene to its last array ---- */

static const char scene_text[] =
    "slender: 1\njob: design\n"
    "shell:\n  mesh: {shape: sheet, size: [36 mm, 18 mm], cells: [12, 6]}\n  thickness: 1 mm\n"
    "  young: 0.1 MPa\n  poisson: 0.5\n"
    "fix:\n  - {box: [[-1, -1, -1], [1 mm, 1, 1]]}\n"
    "cases:\n"
    "  - {name: up, flux_density: [0, 0, \"0.05*(1 + x)\"], target: [\"x\", \"y\", \"x^2\"]}\n"
    "  - {name: down, flux_density: [0, 0, -0.05], target: [\"x\", \"y\", \"-x^2\"]}\n"
    "design:\n  unknowns: {magnetization: {noise: 100}}\n  objectives: [{target: 1}]\n"
    "  optimizer: gauss_newton\n  iterations: 2\n";

typedef struct Designed {
    RunStatus status;
    double objective;
} Designed;

static double last_objective(Journal *journal)
{
    Error err;
    Array F;
    int count;
    if (!journal_count(journal, "evaluation", &count, &err) ||
        !journal_get(journal, "evaluation", count - 1, "objective", &F, &err))
        fail_msg("%s", err.text);
    double value = *(const double *)F.data;
    array_clear(&F);
    return value;
}

/* Asserts only where all is well: cmocka would leave the guard's frame. */
static void design(void *self)
{
    Designed *designed = self;
    Error err;
    Built b = scene_build(mem_text(scene_text));
    Run run = {.scene = &b.scene, .model = b.model, .host = &(Host){0}, .threads = 3};
    run.journal = journal_open(NULL, JOURNAL_NEW, &err);
    run_share_threads(&run, 1);
    designed->status = job_run(&run, &err);
    designed->objective = last_objective(run.journal);
    journal_close(run.journal, &err);
    run_release_threads(&run);
    clear(&b);
}

/* Allocations fail one after the other at the beginning, then at distances that grow, up to the end. */
static void test_job(void **state)
{
    (void)state;
    Designed all = {0};
    Error err;
    long before = mem_total_count();
    design(&all);
    long total = mem_total_count() - before, failed = 0;
    assert_true(all.objective > 0 && total > 1000);
    for (long k = 0; k < total; k += 1 + k / 12) {
        Designed cut = {0};
        failed += !call_with(k, design, &cut, &err);
    }
    assert_true(failed > 50);
    Designed again = {0};
    assert_true(guard_call(design, &again, &err));
    assert_memory_equal(&again, &all, sizeof all);
}

static void *guarded_design(void *self)
{
    Error err;
    guard_call(design, self, &err);
    return NULL;
}

/* Jobs of several threads know nothing of each other, nor of what one of them lacks. */
static void test_jobs_at_once(void **state)
{
    (void)state;
    enum { JOBS = 2 };
    Designed alone = {0};
    design(&alone);
    for (long k = 10; k < 1000; k += 1 + k) {
        pthread_t threads[JOBS];
        Designed designed[JOBS] = {0};
        for (int lacking = 1; lacking >= 0; lacking--) {
            atomic_store(&left, lacking ? k : -1);
            for (int j = 0; j < JOBS; j++)
                assert_int_equal(pthread_create(&threads[j], NULL, guarded_design, &designed[j]), 0);
            for (int j = 0; j < JOBS; j++) assert_int_equal(pthread_join(threads[j], NULL), 0);
        }
        for (int j = 0; j < JOBS; j++) assert_memory_equal(&designed[j], &alone, sizeof alone);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nested),      cmocka_unit_test(test_calls_at_once),
        cmocka_unit_test(test_workers),     cmocka_unit_test(test_worker_fails),
        cmocka_unit_test(test_formula),     cmocka_unit_test(test_job),
        cmocka_unit_test(test_jobs_at_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
