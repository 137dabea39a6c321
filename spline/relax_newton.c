/* Newton's method with all couplings, by the solver of shells and rods: first with Gauss-Newton Hessians,
 * which are semidefinite and know no saddles, and from where these hardly gain any more with the exact one,
 * which alone reaches the minimum. */
#include "solve/newton.h"
#include "spline/relax_private.h"

static const double ROUGHLY = 0.1; /* a fall of the energy in 20 iterations: the end of the first part */

typedef struct Watch {
    Relaxation *r;
    double energy_tol;
    NewtonInfo before; /* counts of the first part */
    RelaxPast past;
    RelaxStatus stopped; /* why the observer of Newton's method stopped it */
} Watch;

static bool watch(void *self, const NewtonInfo *newton)
{
    Watch *w = self;
    RelaxInfo *info = &w->r->info;
    info->iterations = w->before.iterations + newton->iterations;
    info->evaluations = w->before.evaluations + newton->evaluations;
    info->factorizations = w->before.factorizations + newton->factorizations;
    info->gradient_max = newton->gradient_max;
    relax_take_energies(w->r);
    w->stopped = RELAX_STOPPED;
    if (!relax_tell(w->r)) return false;
    w->stopped = RELAX_CONVERGED;
    if (info->gradient_max <= w->r->def->gradient_tol) return false;
    w->stopped = RELAX_SETTLED;
    return !relax_has_settled(&w->past, RELAX_WINDOW, info->energy, w->energy_tol);
}

static RelaxStatus status_of(NewtonStatus status, const Watch *watch)
{
    switch (status) {
    case NEWTON_CONVERGED:
        return RELAX_CONVERGED;
    case NEWTON_MAX_ITERATIONS:
    case NEWTON_ASTRAY:
        return RELAX_MAX_ITERATIONS;
    case NEWTON_NOT_FINITE:
        return RELAX_NOT_FINITE;
    case NEWTON_STOPPED:
        return watch->stopped;
    default:
        return RELAX_STALLED;
    }
}

static RelaxStatus minimize(Watch *w)
{
    Relaxation *r = w->r;
    NewtonDef def = newton_default();
    def.step_cap = INFINITY; /* the leash is for each stroke */
    def.max_iterations = r->def->max_iterations - w->before.iterations;
    Point at = relax_point(r, r->strokes->q);
    State state = {.dofs = r->n, .x = r->strokes->q};
    NewtonInfo newton = newton_minimize(r->sys, &def, &at, &state, &(NewtonObserver){watch, w});
    w->before = newton;
    return status_of(newton.status, w);
}

void relax_newton(Relaxation *r)
{
    Watch first = {.r = r, .energy_tol = ROUGHLY};
    r->info.status = minimize(&first);
    if (r->info.status != RELAX_SETTLED && r->info.status != RELAX_STALLED) return;
    relax_create_system(r, SPLINE_EXACT);
    Watch second = {.r = r, .energy_tol = r->def->energy_tol, .before = first.before};
    r->info.status = minimize(&second);
}
