/* coercivity.h - is what a body calls a hard magnet one in its field?
 *
 * The model has a magnetisation that no field changes. A real one is lost, or turns over, in a field near its coercivity H_c:
 * grains that are magnetised at 45 degrees to it from half of that on [Stoner, Wohlfarth 1948], whatever its sign. */
#pragma once
#include "model/model.h"

/* What is magnetised of a body: elements, each at the mean of its corners. */
typedef struct MagnetPart {
    const char *noun;         /* "face"                                                    */
    double coercivity;        /* A/m; NAN: not known                                       */
    int count, corners, each; /* elements; corners of each, the first of so many points    */
    const int *points;        /* [count][each]                                             */
    int magnetization;        /* first entry in p of its block                             */
} MagnetPart;

/* Of the magnetised element in the largest field in that state: a sentence of the caller's where that is more than half of
 * the coercivity. NULL where it is not, or all of it was known at the start: a uniform field, and no design. */
char *coercivity_doubt(const Model *model, MagnetPart part, const Snapshot *shot);

/* As it is at the start of all cases, with the fields of all stages, and the largest one over the time of a motion: such sentences
 * into the report. */
void coercivity_advise(Model *model, const Scene *scene, MagnetPart part);
