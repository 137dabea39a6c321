/* moments.h - which frames of a result are exported, and where they stand in time. */
#pragma once
#include "base/vec3.h"
#include "export/export.h"
#include "view/show_data.h"

typedef struct Moments {
    int count;
    const int *frames;  /* [count] -1: the final state, which is no frame */
    const float *times; /* [count] s since the first one                  */
} Moments;

/* As the definition says; kept in the data. False and a sentence where there is no such frame. */
bool moments_choose(ShowData *data, const ExportDef *def, Moments *moments, Error *err);

/* Where single precision would show, the middle of all points at all moments x[moment][point], which they are then given
 * from; else the origin: how far they are from it is not many times their size. */
Vec3 moments_middle(const Moments *moments, const double (*const *x)[3], int count);

/* Points at each moment, of the final state those of `final`: the first `count` of them. NULL and a sentence where there are
 * fewer, or one is no number. Kept in the data. */
const double (**moments_points(ShowData *data, const Moments *moments, const char *final, int count,
                               Error *err))[3];
