/* state.h - where a body is: a value, from which whoever has it goes on bit by bit.
 *
 * What a frame, a step of time, a load step, a best design and a resumed run keep is this and nothing else. */
#pragma once

typedef struct State {
    int dofs, memory_count;
    double *x;      /* [dofs] positions (m) and other dofs                                       */
    double *v;      /* [dofs] m/s; 0 where there is no inertia, and in statics                   */
    double *memory; /* [memory_count] what the terms remember beside x, each its part (term.h)   */
    double time;    /* s                                                                         */
} State;

/* All zero; system_state gives one in which the terms remember what they do at rest. */
State state_create(int dofs, int memory_count);
void state_destroy(State *state);

/* Of the same size; from may be a view without velocities, which are then 0. */
void state_copy(State *to, const State *from);

/* One more of the same. */
State state_clone(const State *from);
