#include "solve/eigen.h"
#include "base/memory.h"
#include "base/random.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS_MAX = 300, STEPS_FIRST = 20 };

static const double RESIDUAL = 1e-10; /* of an eigenvalue, relative                           */
static const double ZERO = 1e-2;      /* of sigma: an eigenvalue that is less is a zero's rounding */
static const double ROUNDING = 1e-5;  /* of sigma: what solves with a sigma of 1e-9 leave of that  */

/* LAPACK: eigenvalues (ascending, into d) and vectors of a symmetric tridiagonal matrix. */
void dstev_(const char *jobz, const int *n, double *d, double *e, double *z, const int *ldz, double *work,
            int *info, size_t jobz_length);

typedef struct Lanczos {
    System *sys;
    int n, positions; /* dofs; the first ones that M counts */
    const double *M;  /* [positions]; NULL: 1               */
    int count, steps;
    double sigma;
    double *basis[STEPS_MAX + 1]; /* [steps + 1][n] M-orthonormal */
    double *alpha, *beta;         /* [STEPS_MAX + 1] the tridiagonal T    */
    double *theta, *ritz;         /* [steps] [steps*steps]                */
} Lanczos;

static double mass(const Lanczos *l, int i)
{
    return l->M ? l->M[i] : 1;
}

static double m_dot(const Lanczos *l, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < l->positions; i++) sum += mass(l, i) * a[i] * b[i];
    return sum;
}

/* y = (H + sigma M)^-1 M v */
static void apply(const Lanczos *l, const double *v, double *y)
{
    for (int i = 0; i < l->n; i++) y[i] = i < l->positions ? mass(l, i) * v[i] : 0;
    system_solve(l->sys, y, y);
}

/* Twice is enough [Parlett]. */
static void orthogonalise(const Lanczos *l, int count, double *v)
{
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < count; k++) {
            const double *q = l->basis[k];
            double c = m_dot(l, q, v);
            for (int i = 0; i < l->n; i++) v[i] -= c * q[i];
        }
}

static bool normalise(const Lanczos *l, double *v, double *length)
{
    *length = sqrt(m_dot(l, v, v));
    if (!(*length > DBL_MIN)) return false;
    for (int i = 0; i < l->n; i++) v[i] /= *length;
    return true;
}

static void start(Lanczos *l)
{
    Random random = random_seed(7);
    double *v = l->basis[0], length;
    for (int i = 0; i < l->n; i++)
        v[i] = i < l->positions && !system_is_fixed(l->sys, i) ? random_signed(&random) : 0;
    normalise(l, v, &length);
}

/* One more vector; false when the space is exhausted. */
static bool extend(Lanczos *l)
{
    int k = l->steps++;
    const double *v = l->basis[k];
    double *next = l->basis[k + 1] = mem_alloc((size_t)l->n, sizeof *next);
    apply(l, v, next);
    l->alpha[k] = m_dot(l, v, next);
    orthogonalise(l, k + 1, next);
    return normalise(l, next, &l->beta[k]) && l->beta[k] > 1e-14 * fabs(l->alpha[0]);
}

/* How well an eigenvalue is to be known. One that is zero is rounding soon; of several the others that are zero, too, come
 * out of this rounding, in their time. */
static double tolerance(const Lanczos *l, double lambda)
{
    if (l->count == 1 && fabs(lambda) < ZERO * l->sigma) return ROUNDING * l->sigma;
    return RESIDUAL * fmax(fabs(lambda), 1e-6 * (l->sigma + fabs(lambda + l->sigma)));
}

/* Ritz values, and whether the wanted ones (the largest theta) have converged. */
static bool converged(Lanczos *l)
{
    int n = l->steps, info;
    double *off = mem_copy(l->beta, (size_t)n, sizeof *off), *work = mem_alloc(2 * (size_t)n, sizeof *work);
    memcpy(l->theta, l->alpha, (size_t)n * sizeof *l->theta);
    dstev_("V", &n, l->theta, off, l->ritz, &n, work, &info, 1);
    mem_free(off);
    mem_free(work);
    bool done = n >= l->count;
    for (int k = 0; done && k < l->count; k++) {
        int j = n - 1 - k;
        double theta = l->theta[j],
               residual = l->beta[n - 1] * fabs(l->ritz[(size_t)j * (size_t)n + (size_t)n - 1]);
        double lambda = 1 / theta - l->sigma; /* d(lambda) = residual/theta^2 */
        done = residual / (theta * theta) <= tolerance(l, lambda);
    }
    return done;
}

static void report(const Lanczos *l, double *values, double *modes)
{
    for (int k = 0; k < l->count; k++) {
        int j = l->steps - 1 - k;
        values[k] = j < 0 ? NAN : 1 / l->theta[j] - l->sigma;
        if (!modes) continue;
        double *mode = modes + (size_t)k * (size_t)l->n;
        memset(mode, 0, (size_t)l->n * sizeof *mode);
        for (int s = 0; j >= 0 && s < l->steps; s++)
            for (int i = 0; i < l->n; i++)
                mode[i] += l->ritz[(size_t)j * (size_t)l->steps + (size_t)s] * l->basis[s][i];
    }
}

static void run(Lanczos *l, double *values, double *modes)
{
    l->basis[0] = mem_alloc((size_t)l->n, sizeof(double));
    l->alpha = mem_alloc(2 * (STEPS_MAX + 1), sizeof(double));
    l->beta = l->alpha + STEPS_MAX + 1;
    l->theta = mem_alloc(STEPS_MAX, sizeof(double));
    l->ritz = mem_alloc((size_t)STEPS_MAX * STEPS_MAX, sizeof(double));
    start(l);
    bool more = true;
    while (more && l->steps < STEPS_MAX) {
        more = extend(l);
        if (!more || l->steps % STEPS_FIRST == 0 || l->steps == STEPS_MAX) more = !converged(l) && more;
    }
    report(l, values, modes);
    for (int k = 0; k <= l->steps; k++) mem_free(l->basis[k]);
    mem_free(l->alpha);
    mem_free(l->theta);
    mem_free(l->ritz);
}

/* What sigma is measured by: the stiffest position, over the mean of M. */
static double unit_of(const Lanczos *l)
{
    double sum = 0;
    for (int i = 0; i < l->positions; i++) sum += mass(l, i);
    return system_scale_mean(l->sys) / (sum / l->positions);
}

bool eigen_lowest(System *sys, const Point *at, const double *M, int count, double *values, double *modes)
{
    Lanczos l = {.sys = sys,
                 .n = system_dof_count(sys),
                 .positions = system_position_count(sys),
                 .M = M,
                 .count = count};
    double *gradient = mem_alloc((size_t)l.n, sizeof *gradient);
    bool ok = system_hessian(sys, at, gradient).finite;
    mem_free(gradient);
    double unit = unit_of(&l), factor = 0;
    while (ok && !system_factor_positions(sys, factor * unit, M)) {
        factor = fmax(1e-9, 4 * factor);
        ok = factor < 1e6;
    }
    if (!ok) return false;
    l.sigma = factor * unit;
    run(&l, values, modes);
    return true;
}
