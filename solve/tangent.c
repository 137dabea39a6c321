#include "solve/tangent.h"
#include "base/memory.h"
#include "solve/gmres.h"
#include <string.h>

static const double TOLERANCE = 1e-14, SHIFT_FIRST = 1e-8, SHIFT_GROWTH = 4, SHIFT_LAST = 1e4; /* D */
enum { ITERATIONS = 100 };

typedef struct Tangent {
    System *sys;
    const Point *at;
    bool transposed, lags;
    double shift;
    double *work; /* [dofs] */
} Tangent;

/* y = A^-1 (L + S) x, or A^-1 (L^T - S) x; with a shift of A, less it. */
static void product(void *self, const double *x, double *y)
{
    Tangent *tangent = self;
    System *sys = tangent->sys;
    int n = system_dof_count(sys);
    memset(tangent->work, 0, (size_t)n * sizeof *tangent->work);
    system_circulate(sys, tangent->at, x, tangent->work);
    const double *D = system_scale(sys);
    double sign = tangent->transposed ? -1 : 1;
    for (int i = 0; i < n; i++) tangent->work[i] = sign * tangent->work[i] - tangent->shift * D[i] * x[i];
    if (tangent->lags && tangent->transposed)
        system_lag(sys, tangent->at, x, tangent->work);
    else if (tangent->lags)
        system_lag_forward(sys, tangent->at, x, tangent->work);
    system_solve(sys, tangent->work, y);
}

/* With so much of the factor's shift taken out. */
static bool solve(System *sys, const Point *at, bool transposed, double shift, const double *b, double *y)
{
    bool lags = at->x_lag && system_lags(sys);
    system_solve(sys, b, y);
    if (!lags && !system_circulates(sys)) return true;
    int n = system_dof_count(sys);
    Tangent tangent = {sys, at, transposed, lags, shift, mem_alloc((size_t)n, sizeof(double))};
    bool solved = gmres_solve(n, product, &tangent, y, TOLERANCE, ITERATIONS, y);
    mem_free(tangent.work);
    return solved;
}

bool tangent_solve(System *sys, const Point *at, bool transposed, const double *b, double *y)
{
    return solve(sys, at, transposed, system_circulates(sys) ? system_shift(sys) : 0, b, y);
}

bool tangent_solve_shifted(System *sys, const Point *at, const double *b, double *y)
{
    return solve(sys, at, false, 0, b, y);
}

bool tangent_factor(System *sys)
{
    double shift = 0;
    while (!system_factor(sys, shift)) {
        shift = shift > 0 ? SHIFT_GROWTH * shift : SHIFT_FIRST;
        if (!system_circulates(sys) || shift > SHIFT_LAST) return false;
    }
    return true;
}
