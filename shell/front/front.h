/* front.h - what the files of this front have of each other: parts of the shell's row (body.c). Model.self is a Shell. */
#pragma once
#include "model/model.h"
#include "shell/front/scene.h"
#include "shell/shell.h"

/* records.c: shells in the journal. */
void shell_add_static(const Model *model, Arrays *list);
void shell_add_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list);
void shell_add_stress(const Model *model, const Snapshot *shot, Arrays *list);
void shell_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);

/* report.c, cost.c */
char *shell_crushed(const Model *model, const Snapshot *shot, bool failed);
char *shell_describe(const Model *model, const Scene *scene);
char *shell_doubt(const Model *model, const Snapshot *shot);
void shell_advise(Model *model, const Scene *scene);
void shell_dof_sizes(const Model *model, double *size);
void shell_cost(const Model *model, Cost *cost);
