/* Ways out of a saddle: the mode of lowest curvature, and how far to go along it. */
#include "base/random.h"
#include "solve/newton_private.h"
#include <float.h>
#include <math.h>

enum { INVERSE_ITERATIONS = 8, CURVATURE_TRIES = 25 };

static const double CURVATURE_STEP = 0.05; /* body's measure: first step along negative curvature */
static const double CURVATURE_LAST = 0.5;  /* ... and the last */
static const double ZERO_CURVATURE = 16 * DBL_EPSILON; /* v'Hv with v'Dv = 1: no more than its rounding */
static const double LIKELY = 1e4;                      /* of the step in a mode's start, against chance */
static const double LEAST_SHIFT = 1e-15;               /* D: below that a factorisation decides by rounding */

/* A factor with as little shift as there may be: the modes of a thin sheet lie closer together than any shift fit for a step
 * (1e-12 of D for a strip of 1/5000), and inverse iteration tells them apart only with one that is smaller still. */
static void near_singular(Search *s)
{
    while (s->shift > LEAST_SHIFT && search_factor(s, s->shift / 16)) s->shift /= 16;
    search_factor(s, s->shift);
}

/* Where several modes are all but equal, as the ways in which a round rod buckles, the forces say which one is
 * downhill: of two or three, an iteration keeps what it was given. */
static void add_step(Search *s)
{
    double size = system_step_size(s->sys, s->step), own = system_step_size(s->sys, s->mode);
    for (int i = 0; size > 0 && i < s->n; i++) s->mode[i] += LIKELY * own / size * s->step[i];
}

/* Inverse iteration with the factor at hand: the mode of lowest curvature v'Hv/v'Dv, scaled to v'Dv = 1 and pointing
 * downhill. Returns its curvature. */
static double lowest_mode(Search *s)
{
    const double *scale = system_scale(s->sys);
    Random random = random_seed(1);
    for (int i = 0; !s->mode_known && i < s->n; i++)
        s->mode[i] = scale[i] > 0 ? random_signed(&random) / sqrt(scale[i]) : 0;
    if (!s->mode_known && s->open) add_step(s);
    s->mode_known = true;
    for (int k = 0; k < INVERSE_ITERATIONS; k++) {
        for (int i = 0; i < s->n; i++) s->product[i] = scale[i] * s->mode[i];
        system_solve(s->sys, s->product, s->mode);
        double norm = 0;
        for (int i = 0; i < s->n; i++) norm += scale[i] * s->mode[i] * s->mode[i];
        norm = 1 / sqrt(norm);
        for (int i = 0; i < s->n; i++) s->mode[i] *= norm;
    }
    for (int i = 0; s->open && i < s->n; i++)
        if (system_is_multiplier(s->sys, i)) s->mode[i] = 0;
    system_multiply(s->sys, s->mode, s->product);
    double curvature = vector_dot(s->n, s->mode, s->product) + gap_curvature(s);
    if (vector_dot(s->n, s->mode, s->gradient) > 0)
        for (int i = 0; i < s->n; i++) s->mode[i] = -s->mode[i];
    return curvature;
}

/* How far along the mode it may go at most. */
static double longest_step(Search *s, double size)
{
    double longest = CURVATURE_LAST / size;
    for (int i = 0; i < s->n; i++) s->product[i] = longest * s->mode[i];
    return longest * system_reach(s->sys, &s->at, s->product);
}

/* A step along the mode that lowers the energy by a quarter of what its curvature promises; 0: none. */
static double curvature_step(Search *s, double curvature)
{
    double size = system_step_size(s->sys, s->mode), slope = vector_dot(s->n, s->gradient, s->mode);
    double longest = longest_step(s, size), a = fmin(CURVATURE_STEP / size, longest);
    for (int k = 0; k < CURVATURE_TRIES; k++, a /= 4) {
        Evaluation trial;
        double energy = search_energy(s, s->mode, a, &trial);
        if (!(energy < s->now.energy + (a * slope + a * a * curvature / 2) / 4)) continue;
        while (2 * a <= longest) {
            double further = search_energy(s, s->mode, 2 * a, &trial);
            if (!(further < energy)) break;
            energy = further;
            a *= 2;
        }
        return a;
    }
    return 0;
}

bool search_leave_saddle(Search *s, bool small, double floor, NewtonStatus *status)
{
    if (small && s->shift > 0) near_singular(s);
    double curvature = lowest_mode(s);
    s->info.curvature = curvature;
    double a = curvature < 0 ? curvature_step(s, curvature) : 0;
    if (a > 0) {
        search_move(s, s->mode, a);
        s->shifted = 0;
        return true;
    }
    if (!small || s->shift == 0) return false;
    if (fabs(curvature) <= ZERO_CURVATURE)
        *status = NEWTON_NEUTRAL;
    else if (s->now.gradient_max <= floor)
        *status = curvature < 0 ? NEWTON_SADDLE : NEWTON_NEUTRAL;
    return *status != NEWTON_MAX_ITERATIONS;
}
