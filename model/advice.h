/* advice.h - what is doubtful about a model though it can be run: most likely a slip of the scene. */
#pragma once
#include "model/model.h"

/* Adds warnings to the model's report. */
void advise(Model *model, const Scene *scene);

/* m: over so much the strongest field of the scene bends its strongest magnetisation by about a radian; INFINITY: there
 * is no field, or nothing magnetic. And a cell's size. */
double advice_bending_length(const Model *model, const Scene *scene);
double advice_mean_edge(const Mesh *mesh);
