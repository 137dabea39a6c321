/* state_arrays.h - all of a state, as arrays of a journal and datasets of a result: whoever has them goes on bit by bit.
 *
 * Under a prefix, all in double precision:
 *
 *     dofs        [n]    State.x: positions (m), then what a body has beside them (edge angles, turns, ..)
 *     velocities  [n]    of motions, m/s
 *     memory      [m]    what terms remember, if they do
 *     time               s
 *     anchor      [k]    of a simulation: where the factor stands that the next step begins with (system_anchor)
 *     loads/BLOCK        the loads that act, each block of p
 *
 * In a result the prefix is slender/state of the last state, slender/cases/NAME/state of the load cases before the
 * last one, and slender/frames of frames that are kept whole, of each dataset a row. */
#pragma once
#include "model/model.h"

/* As `state/..` of a frame, whose arrays are rows; or of what is final. */
void state_arrays_add(const Model *model, const Snapshot *shot, const char *prefix, bool row, Arrays *list);

/* Where a state stands in a result. */
typedef struct StatePlace {
    Result *result;
    char prefix[300];
    int row; /* of frames; -1: there are none */
} StatePlace;

/* One array of it; array->data is NULL where there is none. array_clear. */
bool state_arrays_find(const StatePlace *place, const char *name, Array *array, Error *err);

/* The same into values[count]; *has: it is there, of that length. */
bool state_arrays_get(const StatePlace *place, const char *name, size_t count, double *values, bool *has,
                      Error *err);
