#include "spline/revise.h"
#include "base/memory.h"
#include "spline/local.h"
#include "spline/relax_private.h"
#include <math.h>
#include <stdlib.h>

/* A stroke and what its coming or going changes. */
typedef struct Gain {
    double change;
    int stroke;
} Gain;

static int by_change(const void *a, const void *b)
{
    const Gain *x = a, *y = b;
    if (x->change != y->change) return x->change < y->change ? -1 : 1;
    return (x->stroke > y->stroke) - (x->stroke < y->stroke);
}

/* Those strokes that come, or go. */
typedef struct Choice {
    int first, end, least;
    const double *x; /* dofs of all when they come; NULL: they go */
    bool *absent;    /* [strokes] brought up to date              */
} Choice;

static double try_stroke(Local *local, const SplineModel *model, const Choice *c, int stroke)
{
    return local_change(local, stroke, c->x ? c->x + 4 * model->start[stroke] : NULL);
}

/* Where the energy falls, and at least so many. Returns how many. */
static int choose(Local *local, const SplineModel *model, const Choice *c)
{
    int changed = 0, count = c->end - c->first;
    Gain *gains = mem_alloc((size_t)count, sizeof *gains);
    for (int k = 0; k < count; k++) {
        gains[k] = (Gain){try_stroke(local, model, c, c->first + k), c->first + k};
        local_reject(local);
    }
    qsort(gains, (size_t)count, sizeof *gains, by_change);
    for (int i = 0; i < count && (gains[i].change < 0 || changed < c->least); i++) {
        double change = try_stroke(local, model, c, gains[i].stroke);
        if (change < 0 || changed < c->least) {
            local_accept(local);
            c->absent[gains[i].stroke] = !c->x;
            changed++;
        } else {
            local_reject(local);
        }
    }
    mem_free(gains);
    return changed;
}

/* Of the strokes those that are not absent. */
static Strokes present(const Strokes *strokes, const bool *absent)
{
    Strokes left = {0};
    for (int k = 0; k < strokes->count; k++)
        if (!absent[k]) strokes_add_from(&left, strokes, k);
    return left;
}

/* Lets strokes from `candidate` on come or, where there are none, all go. Returns how many did. */
static int revise(const SplineTarget *target, const RelaxDef *def, int candidate, int least, Strokes *strokes)
{
    bool coming = candidate < strokes->count, *absent = mem_alloc((size_t)strokes->count, sizeof *absent);
    for (int k = candidate; k < strokes->count; k++) absent[k] = true;
    double *rest = spline_rest_lengths(target, def, strokes);
    SplineModel *model = spline_model_create(target, strokes, rest, &def->model);
    SplineWeights weights = spline_weights_scaled(def->weights, target->page.pen, target->spacing);
    Local *local = local_create(model, &weights, strokes->q, absent);
    Choice choice = {coming ? candidate : 0, strokes->count, least, coming ? strokes->q : NULL, absent};
    int changed = choose(local, model, &choice);
    local_destroy(local);
    spline_model_destroy(model);
    Strokes left = present(strokes, absent);
    strokes_clear(strokes);
    *strokes = left;
    mem_free(rest);
    mem_free(absent);
    return changed;
}

int spline_remove_strokes(const SplineTarget *target, const RelaxDef *def, int least, Strokes *strokes)
{
    return strokes->count ? revise(target, def, strokes->count, least, strokes) : 0;
}

/* Puts in those of the candidates with which the energy is less, and at least so many, in the same manner.
 * (In a relaxed drawing that lacks ink everywhere there may be none: the others must make room first.)
 * Returns how many. */
static int insert_strokes(const SplineTarget *target, const RelaxDef *def, const Strokes *candidates,
                          int least, Strokes *strokes)
{
    int before = strokes->count;
    strokes_append(strokes, candidates, before ? strokes->layer[0] : 0);
    return candidates->count ? revise(target, def, before, least, strokes) : 0;
}

/* How many strokes are too many, at their rest lengths: a crowd has pressed itself together. */
static int surplus(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes)
{
    double *rest = spline_rest_lengths(target, def, strokes);
    double ink = 2 * strokes->count * spline_pen_cap(&target->page);
    for (int k = 0; k < strokes_segment_count(strokes); k++) ink += rest[k];
    mem_free(rest);
    double excess = ink - spline_ink_budget(target);
    return excess > 0 ? (int)lround(excess * strokes->count / ink) : 0;
}

bool spline_refine_once(const SplineTarget *target, const RelaxDef *def, int segments, Strokes *strokes,
                        RelaxInfo *best, const RelaxObserver *observer)
{
    if (best->status == RELAX_NOT_FINITE) return false; /* nothing can be judged */
    Strokes trial = strokes_copy(strokes), candidates = {0};
    int changed = spline_remove_strokes(target, def, surplus(target, def, strokes), &trial);
    spline_propose_strokes(target, def, &trial, segments, &candidates);
    changed += insert_strokes(target, def, &candidates, candidates.count, &trial);
    strokes_clear(&candidates);
    RelaxInfo info = *best;
    if (changed) info = spline_relax(target, def, &trial, observer);
    bool better = changed && info.energy < best->energy;
    if (info.status == RELAX_STOPPED) best->status = RELAX_STOPPED;
    if (better) {
        Strokes old = *strokes;
        *strokes = trial, trial = old;
        info.iterations += best->iterations;
        info.seconds += best->seconds;
        *best = info;
    }
    strokes_clear(&trial);
    return better && info.status != RELAX_STOPPED;
}

RelaxInfo spline_refine(const SplineTarget *target, const RelaxDef *def, int rounds, int segments,
                        Strokes *strokes, const RelaxObserver *observer)
{
    RelaxInfo best = spline_relax(target, def, strokes, observer);
    bool better = best.status != RELAX_STOPPED;
    for (int round = 0; round < rounds && better; round++)
        better = spline_refine_once(target, def, segments, strokes, &best, observer);
    return best;
}
