/* world_report.h - what a scene says of the world, in words, and what is doubtful about it; of all bodies. */
#pragma once
#include "model/model.h"

/* Lines on obstacles, contact, self contact and water; the caller's. NULL: it meets nothing. */
char *world_describe(const Model *model, const Scene *scene);

/* Warnings into the model's report. */
void world_advise(Model *model);
