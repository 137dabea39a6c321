/* A rod's state from another run, whatever form it had there. */
#include "rod/front/front.h"
#include "rod/pbd.h"
#include <string.h>

#define START_ELSEWHERE "its first end is elsewhere, or clamped along another direction, than the scene's"
#define END_ELSEWHERE   "its other end is not where rod.end holds it"

/* Where ends move it depends on the time. */
static bool refuse_elsewhere(const Model *model, Error *err, const char *what, const char *then)
{
    if (!rod_ends_move(model->self)) return error_set(err, "%s%s", what, then);
    return error_set(err, "%s at t = %g s%s", what, model->time, then);
}

static bool take_preview(const Model *model, const double *from, int dofs, Error *err)
{
    RodModel *rm = model->self;
    const Rod *rod = rm->rod;
    if (dofs != pbd_rod_state_count(rod->elements))
        return error_set(err, "its state is not that of `solver: pbd`, which goes on from its own only");
    const RodStrand *strand = &rod->strand[0];
    if (!rod_is_near(vec3_load(from), strand->position, strand->length))
        return refuse_elsewhere(model, err, START_ELSEWHERE, "");
    if (!rod_last_is_near(rm, model->time, vec3_load(from + 3 * rod->elements)))
        return refuse_elsewhere(model, err, END_ELSEWHERE, "");
    rm->moving = mem_copy(from, (size_t)dofs, sizeof *from);
    return true;
}

/* The form of a state of so many dofs: of turns only or with places, of the rod or (`cosserat`) of the other kind; none: of
 * no dofs. */
static RodLayout form_of(const Rod *rod, bool cosserat, int dofs)
{
    Rod other = *rod;
    other.cosserat = cosserat;
    RodLayout turns = rod_layout(&other, false), places = rod_layout(&other, true);
    return dofs == turns.dofs ? turns : dofs == places.dofs ? places : (RodLayout){0};
}

/* A rod that stretches may go on from where one that does not is; not the other way. */
bool rod_take_state(const Model *model, const double *from, int dofs, double *x, Error *err)
{
    RodModel *rm = model->self;
    const Rod *rod = rm->rod;
    if (rm->preview) return take_preview(model, from, dofs, err);
    if (dofs == pbd_rod_state_count(rod->elements))
        return error_set(err, "its state is that of `solver: pbd`, from which only that goes on");
    RodLayout own = form_of(rod, rod->cosserat, dofs);
    if (!own.dofs) own = form_of(rod, !rod->cosserat, dofs);
    if (!own.dofs) return error_set(err, "its state is no rod's of %d elements", rod->elements);
    if (own.strain >= 0 && !rod->cosserat)
        return error_set(err, "its rod stretches: only model: cosserat goes on from it");
    if (dofs == rm->layout.dofs)
        memcpy(x, from, (size_t)dofs * sizeof *x);
    else
        rod_copy_state(rod, &own, from, &rm->layout, x);
    for (int k = 0; k < rod->strands && !(rm->base && rod_leads_ends(model)); k++) {
        const RodStrand *strand = &rod->strand[k];
        const Quat *frame = rod->start == ROD_CLAMPED ? &strand->frame : NULL;
        if (!rod_is_at(&own, from, k * (own.each + 1), strand->position, frame, strand->length))
            return refuse_elsewhere(model, err, START_ELSEWHERE, "");
    }
    return rod_leads_ends(model) || rod_end_is_held(rm, model->time, x) ||
           refuse_elsewhere(model, err, END_ELSEWHERE, ": an equilibrium leads it there");
}
