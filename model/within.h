/* within.h - a body that is in a magnet, or at a coil's winding: which no formula of theirs means. */
#pragma once
#include "model/model.h"

/* Tells of each such source, once in a model's life, for places of its points, place[point_count][3] m, with p at a time.
 * The sentence begins with `where`: "case1: the body starts in". */
void model_tell_within(Model *model, const double *p, double time, const double *place, const char *where,
                       void (*tell)(void *self, const char *sentence), void *self);
