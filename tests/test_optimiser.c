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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_thorough), cmocka_unit_test(test_edge),
                                       cmocka_unit_test(test_bounds), cmocka_unit_test(test_narrow)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
