#include "job/predict.h"
#include "base/clock.h"
#include "base/memory.h"
#include "model/sequence.h"
#include "optim/trajectory_adjoint.h"
#include <math.h>

/* ---- What one thing takes ---- */

static double lap(double *last)
{
    double now = clock_thread_seconds(), seconds = now - *last;
    *last = now;
    return seconds;
}

/* The least of some times, but for the matrix, which is built once. */
void predict_measure(System *sys, const Point *at, int repeats, Cost *least)
{
    double *gradient = mem_alloc((size_t)system_dof_count(sys), sizeof *gradient);
    least->build = least->hessian = least->factor = least->solve = INFINITY;
    double time = clock_thread_seconds();
    system_build(sys);
    least->build = lap(&time);
    for (int k = 0; k < repeats; k++) {
        system_hessian(sys, at, gradient);
        least->hessian = fmin(least->hessian, lap(&time));
        bool factored =
            system_factor(sys, 0) || system_factor(sys, 1e-6); /* not where forces are no numbers */
        least->factor = fmin(least->factor, lap(&time));
        if (factored) system_solve(sys, gradient, gradient);
        least->solve = fmin(least->solve, lap(&time));
    }
    mem_free(gradient);
}

void predict_take_factor(SparseInfo info, Cost *cost)
{
    cost->numbers = (double)info.factor_nonzeros;
    cost->flops = info.factor_flops;
    cost->factor_bytes = fmax((double)info.factor_bytes, 8 * cost->numbers);
}

/* ---- What a job does ---- */

static double stage_count(const Model *model)
{
    double stages = 0;
    for (int k = 0; k < model->case_count; k++) stages += model->cases[k].stage_count;
    return stages;
}

static double iteration_count(const Model *model, const Scene *scene, const Effort *effort)
{
    double solves = stage_count(model), firsts = model->case_count;
    if (model->job->rest && !model->job->design) solves *= sequence_load_steps(model, scene);
    if (model->job->motion) solves *= scene->time.steps;
    if (scene->design) solves *= scene->design->iterations + 1, firsts *= scene->design->iterations + 1;
    return firsts * effort->first + (solves - firsts) * effort->more;
}

static double frame_count(const Model *model, const Scene *scene)
{
    if (!model->job->motion) return stage_count(model) * sequence_frames_each(scene);
    return 1 + (scene->output.every > 0 ? scene->time.steps / scene->output.every : 0);
}

/* ---- After the job: stability, result, picture ---- */

static const double LANCZOS_SOLVES = 30;
static const double PROGRAM_SECONDS = 0.1, ELEMENT_SECONDS = 2e-6; /* of a frame, or picture */

/* What a frame takes beside its elements, in the journal and the result: that of rest has what a stage has, and stresses. */
typedef struct FrameCost {
    double seconds, bytes, element_bytes;
} FrameCost;

static const FrameCost FRAME_OF_REST = {1.9e-3, 4000, 90}, FRAME_OF_MOTION = {0.8e-3, 7000, 9};

static const FrameCost *frame_cost(const Model *model)
{
    return model->job->motion ? &FRAME_OF_MOTION : &FRAME_OF_REST;
}

static double end_seconds(const Cost *cost, double frames, const FrameCost *frame)
{
    double seconds =
        PROGRAM_SECONDS + frames * frame->seconds + cost->elements * ELEMENT_SECONDS * (1 + frames);
    if (!cost->stability) return seconds;
    return seconds + cost->picture + cost->hessian + cost->factor + LANCZOS_SOLVES * cost->solve;
}

/* ---- Memory ---- */

/* Bytes of the program; of a triangle or element in the mesh, the arrays and the result; of a factor's byte while it is
 * made. */
static const double PROGRAM_BYTES = 30e6, ELEMENT_BYTES = 1300, WORK = 1.65;

static double peak_bytes(const Model *model, const Scene *scene, const Cost *cost)
{
    const FrameCost *frame = frame_cost(model);
    double dofs = system_dof_count(model->cases[0].sys), steps = model->job->path ? scene->time.steps : 0,
           kept = fmin(2 * steps * cost->factor_bytes, (double)trajectory_default().factor_memory);
    return PROGRAM_BYTES + cost->effort.picture + cost->elements * ELEMENT_BYTES +
           frame_count(model, scene) * (frame->bytes + cost->elements * frame->element_bytes) +
           8 * stage_count(model) * model->params->size +
           model->case_count * (cost->elements * cost->system_bytes + WORK * cost->factor_bytes) +
           32 * steps * dofs + kept;
}

/* ---- The whole ---- */

Prediction predict(const Model *model, const Scene *scene)
{
    Cost cost = {.effort = model->job->effort};
    model->body->ops->cost(model, &cost);
    const Effort *effort = &cost.effort;
    return (Prediction){
        .unknowns = system_free_count(model->cases[0].sys),
        .numbers = cost.numbers,
        .flops = cost.flops,
        .factor_bytes = cost.factor_bytes,
        .exact = cost.exact,
        .iterations = iteration_count(model, scene, effort),
        .factorizations = effort->factorizations,
        .start = model->case_count * cost.build,
        .end = end_seconds(&cost, frame_count(model, scene), frame_cost(model)),
        .iteration = cost.hessian + effort->factorizations * cost.factor + effort->solves * cost.solve,
        .factorization = cost.factor,
        .bytes = peak_bytes(model, scene, &cost),
    };
}

double predict_seconds(const Prediction *r)
{
    return r->start + r->iterations * r->iteration + r->end;
}
