/* design_run.h - an optimiser at work on a journal: what quasi-static and trajectory designs have in common.
 *
 * Every evaluation is a unit of the journal. A resumed run feeds the recorded ones to the optimiser, which
 * goes the same way without solving anything; the state of the best design is kept in two slots by turns,
 * each written before the evaluation that it belongs to, so that one of them always fits. */
#pragma once
#include "job/run.h"

/* What an evaluation was, beside F and its gradient. */
typedef struct Evaluated {
    int newton_iterations;
    bool aborted;                  /* interrupted on the way                    */
    NewtonStatus status;           /* of what failed, where F is infinite       */
    const double *case_objectives; /* [case_count] borrowed until the next one  */
    int case_count;
    const double *probes; /* [case_count][model_probe_count], borrowed likewise; NULL: none */
} Evaluated;

/* One kind of design. Those that return bool set the error. */
typedef struct DesignOps {
    double (*evaluate)(void *self, const double *u, double *gradient, Evaluated *evaluated);
    void (*accept)(void *self);
    void (*product)(void *self, const double *v, double soft, double *out);
    bool knows_soft; /* Problem.knows_soft */

    /* The best design's state in a slot; get_best makes u, with that state, the best design, if the slot *has
     * it. */
    bool (*put_best)(void *self, int slot, Error *err);
    bool (*get_best)(void *self, int slot, const double *u, bool *has, Error *err);

    /* A frame of the best design as number `index` of the frames, where improvements are shown; may be NULL.
     */
    bool (*put_frame)(void *self, int index, Error *err);

    /* Everything final; frames from number `first` on. */
    bool (*put_results)(void *self, int first, const char *status, Error *err);
} DesignOps;

/* From u[size of the model's design] on. */
RunStatus design_run(Run *run, const DesignOps *ops, void *self, const double *u, Error *err);

/* As the scene and the result have it: rows of a field over time are its flux_density. */
const char *design_unknown_name(const Model *model, const ParamBlock *block);

/* design/gradient/<name> of an unknown block; the values are borrowed until the list is put. */
void design_add_gradient(Arrays *list, const char *name, const char *unit, const double *values, int count,
                         int width);
