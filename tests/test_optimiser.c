/* Gauss-Newton at a snap-through: a state of two springs, x1 = 1 - sqrt(1 - u1), which snaps to 1.5 where u1
 * passes 1, and x2 = u2/10. The target of x1 is past the snap; that of x2 can be had, but near the snap the
 * gradient is nearly all of u1. */
#include "optim/optimiser.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const double TARGET[2] = {1.05, 1};

typedef struct Springs {
    double u[2], best[2];
} Springs;

static double state(const double *u, int i)
{
    return i == 1 ? u[1] / 10 : u[0] < 1 ? 1 - sqrt(1 - u[0]) : 1.5;
}

/* H of the springs: dx/du = 1/stiffness. */
static double stiffness(const double *u, int i)
{
    return i == 1 ? 10 : 2 * sqrt(fmax(1 - u[0], 1e-12));
}

static double evaluate(void *self, const double *u, double *gradient)
{
    Springs *springs = self;
    double F = 0;
    memcpy(springs->u, u, sizeof springs->u);
    for (int i = 0; i < 2; i++) {
        double r = state(u, i) - TARGET[i];
        F += r * r;
        gradient[i] = 2 * r / stiffness(u, i);
    }
    return F;
}

static void accept(void *self)
{
    Springs *springs = self;
    memcpy(springs->best, springs->u, sizeof springs->best);
}

static void product(void *self, const double *v, double soft, double *out)
{
    const double *u = ((Springs *)self)->best;
    double pull = 0, softness = 0;
    for (int i = 0; i < 2; i++) {
        double a = 2 * (state(u, i) - TARGET[i]) / stiffness(u, i);
        pull += 2 * a * a, softness += a * a / stiffness(u, i);
    }
    for (int i = 0; i < 2; i++) {
        double H = stiffness(u, i);
        out[i] = (2 + soft * pull / softness / H) * v[i] / (H * H);
    }
}

static bool recall(void *self, double *u)
{
    (void)self, (void)u;
    return false;
}

static bool go_on(void *self)
{
    (void)self;
    return true;
}

/* F of the best of so many evaluations; u ends there. */
static double minimise(bool knows_soft, int evaluations, double u[2])
{
    Springs springs = {0};
    double lower[2] = {-INFINITY, -INFINITY}, upper[2] = {INFINITY, INFINITY};
    Problem problem = {.n = 2,
                       .lower = lower,
                       .upper = upper,
                       .self = &springs,
                       .evaluate = evaluate,
                       .accept = accept,
                       .product = product,
                       .knows_soft = knows_soft,
                       .recall = recall,
                       .go_on = go_on};
    OptimiserDef def = {.method = OPTIMISER_GAUSS_NEWTON, .evaluations = evaluations};
    OptimiserInfo info = optimise(&problem, &def, u);
    print_message("F %.4f after %d evaluations, u %.7f, %.4f\n", info.objective, info.evaluations, u[0],
                  u[1]);
    return info.objective;
}

/* What can be had is had, though the gradient says little of it: F would be 0.26 where conjugate gradients
 * stop at a part of the gradient. */
static void test_thorough(void **unused)
{
    (void)unused;
    double u[2] = {0.9, 0};
    assert_true(minimise(false, 40, u) < 0.203);
    assert_float_equal(u[1], 10, 0.1);
}

/* At the edge x1 is held while x2 goes on; without that every step snaps, and F stays at 1. */
static void test_edge(void **unused)
{
    (void)unused;
    double u[2] = {0.99, 0};
    assert_true(minimise(true, 40, u) < 0.203);
    assert_float_equal(u[1], 10, 0.1);
}

/* ---- Bounds ---- */

enum { COUNT = 60 };

/* |J u - b|^2 with a J that couples all: a smoothing one, and b out of reach. */
typedef struct Smooth {
    double J[COUNT][COUNT], b[COUNT];
} Smooth;

static double smooth_evaluate(void *self, const double *u, double *gradient)
{
    const Smooth *smooth = self;
    double sum = 0;
    for (int i = 0; i < COUNT; i++) gradient[i] = 0;
    for (int k = 0; k < COUNT; k++) {
        double r = -smooth->b[k];
        for (int i = 0; i < COUNT; i++) r += smooth->J[k][i] * u[i];
        for (int i = 0; i < COUNT; i++) gradient[i] += 2 * r * smooth->J[k][i];
        sum += r * r;
    }
    return sum;
}

static void smooth_product(void *self, const double *v, double soft, double *out)
{
    const Smooth *smooth = self;
    (void)soft;
    for (int i = 0; i < COUNT; i++) out[i] = 0;
    for (int k = 0; k < COUNT; k++) {
        double r = 0;
        for (int i = 0; i < COUNT; i++) r += smooth->J[k][i] * v[i];
        for (int i = 0; i < COUNT; i++) out[i] += 2 * r * smooth->J[k][i];
    }
}

static void nothing(void *self)
{
    (void)self;
}

static OptimiserInfo minimise_smooth(OptimiserDef def, double from, double to)
{
    Smooth smooth;
    double lower[COUNT], upper[COUNT], u[COUNT];
    for (int k = 0; k < COUNT; k++) {
        for (int i = 0; i < COUNT; i++) smooth.J[k][i] = exp(-(k - i) * (k - i) / 20.0);
        smooth.b[k] = 6 + 20 * sin(0.4 * k);
        lower[k] = from, upper[k] = to, u[k] = (from + to) / 2;
    }
    Problem problem = {.n = COUNT,
                       .lower = lower,
                       .upper = upper,
                       .self = &smooth,
                       .evaluate = smooth_evaluate,
                       .accept = nothing,
                       .product = smooth_product,
                       .recall = recall,
                       .go_on = go_on};
    OptimiserInfo info = optimise(&problem, &def, u);
    int held = 0;
    for (int i = 0; i < COUNT; i++) held += u[i] == from || u[i] == to;
    print_message("F %.6f after %d evaluations, %d of %d at a bound: %s\n", info.objective, info.evaluations,
                  held, COUNT, optimiser_status_name(info.status));
    return info;
}

/* What is held at a bound is made up for within the step: clipped at its end, it takes 21 evaluations. */
static void test_bounds(void **unused)
{
    (void)unused;
    OptimiserDef def = {.method = OPTIMISER_GAUSS_NEWTON, .evaluations = 12, .gradient_tol = 1e-9};
    assert_int_equal(minimise_smooth(def, -1, 4).status, OPTIMISER_CONVERGED);
}

/* MMA, within bounds next to each other, asks for the same point again and again: it ends all the same. */
static void test_narrow(void **unused)
{
    (void)unused;
    OptimiserDef def = {.method = OPTIMISER_MMA, .evaluations = 30, .gradient_tol = 1e-9};
    assert_true(minimise_smooth(def, 1, 1 + 4e-16).evaluations <= 30);
    assert_true(minimise_smooth(def, 1, 1 + 1e-9).evaluations <= 30);
}

/* ---- Endings ---- */

enum { ENDS = 5 };

/* unit^2 |u^2 - a|^2, or, of a plain sum of u, what has no squares. */
typedef struct Ending {
    double unit, best[ENDS], u[ENDS];
    bool plain;
} Ending;

static double wanted(int i)
{
    return 1 + 0.3 * i;
}

static double ending_value(void *self, const double *u, double *gradient)
{
    Ending *ending = self;
    double F = 0;
    memcpy(ending->u, u, sizeof ending->u);
    for (int i = 0; i < ENDS; i++) {
        double r = ending->unit * (u[i] * u[i] - wanted(i));
        F += ending->plain ? ending->unit * (u[i] - 1) : r * r;
        gradient[i] = ending->plain ? ending->unit : 4 * ending->unit * r * u[i];
    }
    return F;
}

static void ending_accept(void *self)
{
    Ending *ending = self;
    memcpy(ending->best, ending->u, sizeof ending->best);
}

static void ending_product(void *self, const double *v, double soft, double *out)
{
    const Ending *ending = self;
    (void)soft;
    for (int i = 0; i < ENDS; i++)
        out[i] =
            ending->plain ? 0 : 8 * ending->unit * ending->unit * ending->best[i] * ending->best[i] * v[i];
}

/* From so far off the solution. */
static OptimiserInfo end_of(Ending ending, OptimiserMethod method, double off)
{
    double lower[ENDS], upper[ENDS], u[ENDS];
    for (int i = 0; i < ENDS; i++)
        lower[i] = -INFINITY, upper[i] = INFINITY, u[i] = sqrt(wanted(i)) * (1 + off);
    for (int i = 0; i < ENDS && ending.plain; i++) u[i] = 1;
    Problem problem = {.n = ENDS,
                       .lower = lower,
                       .upper = upper,
                       .self = &ending,
                       .evaluate = ending_value,
                       .accept = ending_accept,
                       .product = ending_product,
                       .recall = recall,
                       .go_on = go_on};
    OptimiserDef def = optimiser_default();
    def.method = method, def.evaluations = ending.plain ? 1 : 60;
    return optimise(&problem, &def, u);
}

/* In whatever unit F is, and where it starts at what rounding leaves of it. */
static void test_endings(void **unused)
{
    (void)unused;
    static const double units[] = {1, 1e-4, 1e-9}, offs[] = {0, 1e-15, 1e-9, 1e-4, 0.1};
    for (int method = 0; method < 3; method++)
        for (int k = 0; k < 3; k++)
            for (int o = 0; o < (method == OPTIMISER_MMA ? 1 : 5); o++) { /* MMA goes by F's unit */
                OptimiserInfo info = end_of((Ending){.unit = units[k]}, (OptimiserMethod)method, offs[o]);
                if (info.status != OPTIMISER_CONVERGED)
                    fail_msg("%s, unit %g, off %g: %s, F %g", optimiser_names[method], units[k], offs[o],
                             optimiser_status_name(info.status), info.objective);
            }
    /* A start where F, no sum of squares, happens to be 0. */
    assert_int_equal(end_of((Ending){.unit = 1, .plain = true}, OPTIMISER_LBFGS, 0).status,
                     OPTIMISER_MAX_ITERATIONS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_thorough), cmocka_unit_test(test_edge),
                                       cmocka_unit_test(test_bounds), cmocka_unit_test(test_narrow),
                                       cmocka_unit_test(test_endings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
