/* front.h - what the files of this front have of each other: parts of the rod's row (body.c). Model.self is a RodModel. */
#pragma once
#include "rod/front/rod_model.h"
#include "rod/front/scene.h"

/* records.c: rods in the journal. */
void rod_add_static(const Model *model, Arrays *list);
void rod_body_places(const Model *model, const double *x, double *place);
void rod_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);
void rod_add_final(const Model *model, const Snapshot *shot, int modes, Arrays *list);
char *rod_doubt(const Model *model, const Snapshot *shot);

/* report.c, cost.c */
char *rod_describe(const Model *model, const Scene *scene);
void rod_advise(Model *model, const Scene *scene);
void rod_dof_sizes(const Model *model, double *size);
void rod_cost(const Model *model, Cost *cost);

/* The rod's own jobs, each in its file. */
extern const JobRow rod_job_simulate, rod_job_invert, rod_job_identify;
