/* within.h - a body that is in a magnet, or at a coil's winding: which no formula of theirs means. */
#pragma once
#include "model/model.h"

/* Where fields are asked for a body in the state x: at its points, then in the middles of its mesh's faces, where fields that
 * vary act on shells; place[count][3] m, the caller's. */
double *model_field_places(const Model *model, const double *x, int *count);

/* Tells of each such source, once in a model's life, for the body's places in the state x, with p at a time. The sentence begins with `where`: "case1: the body starts in". */
void model_tell_within(Model *model, const double *p, double time, const double *x, const char *where,
                       void (*tell)(void *self, const char *sentence), void *self);
