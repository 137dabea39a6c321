/* What a rod's evaluation and factor take. */
#include "job/predict.h"
#include "rod/front/front.h"

/* As measured on scenes/: a rod's load steps need few iterations, and its picture is small. */
static const Effort rest = {5, 5, 1.2, 1.2, 5e6};
static const double SYSTEM_BYTES = 4200;

/* A rod's matrix is a band: all of it takes as long as its elements are many. */
void rod_cost(const Model *model, Cost *cost)
{
    const Case *c = &model->cases[0];
    Point at = state_point(&c->state, c->stages[0].p);
    predict_measure(c->sys, &at, 1, cost);
    cost->exact = true;
    predict_take_factor(system_info(c->sys), cost);
    cost->elements = ((const RodModel *)model->self)->rod->elements;
    cost->system_bytes = SYSTEM_BYTES;
    if (model->job->rest && !model->job->design) cost->effort = rest;
}
