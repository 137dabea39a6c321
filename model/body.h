/* body.h - how shells and rods are written into the journal: the functions of BodyOps (model.h). */
#pragma once
#include "model/model.h"

void body_shell_static(const Model *model, Arrays *list);
void body_shell_places(const Model *model, const double *x, double *place);
void body_shell_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list);
void body_shell_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);
void body_shell_final(const Model *model, const Snapshot *shot, int modes, Arrays *list);

void body_rod_static(const Model *model, Arrays *list);
void body_rod_places(const Model *model, const double *x, double *place);
void body_rod_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list);
void body_rod_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);
void body_rod_final(const Model *model, const Snapshot *shot, int modes, Arrays *list);
char *body_rod_doubt(const Model *model, const Snapshot *shot);

/* A block of p as an array of that name. */
Array body_block(const char *name, const ParamBlock *block, const double *p);
