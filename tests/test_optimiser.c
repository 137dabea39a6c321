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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_thorough), cmocka_unit_test(test_edge)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
