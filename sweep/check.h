/* check.h - what is wrong with a sweep's runs, found before the first one starts: each wrong value once, at its place. */
#pragma once
#include "sweep/state.h"

typedef struct Problems {
    int count;
    char **sentences; /* owned */
} Problems;

/* Is the scene right, as `slender check` would say, and are the folders of its outputs there (the sweep's own must be)? Where it is not read: its state is clear. `force`: results of other
 * scenes may be replaced. *state is the caller's to clear. */
bool check_run(const Sweep *sweep, int run, bool force, RunState *state, Problems *problems);

void problems_clear(Problems *problems);
