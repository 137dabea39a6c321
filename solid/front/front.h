/* front.h - what the files of this front have of each other: parts of the solid's row (body.c). Model.self is a Solid, Model.mesh
 * its surface, whose vertices are all nodes. */
#pragma once
#include "model/model.h"
#include "solid/front/scene.h"
#include "solid/solid.h"

/* records.c: solids in the journal. */
void solid_add_static(const Model *model, Arrays *list);
void solid_add_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list);
void solid_add_stress(const Model *model, const Snapshot *shot, Arrays *list);
void solid_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);

/* report.c, cost.c */
char *solid_crushed(const Model *model, const Snapshot *shot, bool failed);
char *solid_describe(const Model *model, const Scene *scene);
char *solid_doubt(const Model *model, const Snapshot *shot);
void solid_advise(Model *model, const Scene *scene);
void solid_dof_sizes(const Model *model, double *size);
void solid_cost(const Model *model, Cost *cost);
