/* sweep.h - many runs of one scene: what a sweep's file says, as a list of runs.
 *
 * Run r gives each key a value: choice r / stride % count of the key's. Keys that go together have the same stride; the
 * last one steps fastest, so that values added to the first one add runs at the end. */
#pragma once
#include "io/file_sum.h"
#include "model/scene.h"

enum { SWEEP_RUNS_MAX = 100000, SWEEP_KEYS_MAX = 60 };

typedef struct SweepValue {
    char *text, *where; /* "0.5 mm", "sweep.yaml:5:21" */
} SweepValue;

typedef struct SweepKey {
    char *name; /* as for --set */
    int count, stride;
    SweepValue *values; /* [count] */
} SweepKey;

/* All is owned. */
typedef struct Sweep {
    char *path, *scene; /* the sweep's file, the scene's */
    FileSum sum;        /* of the scene as it was then */
    char *meaning;      /* the first run's effective scene, then; NULL: it cannot be loaded */
    char *name;         /* of the folder of results and of the tables, NAME.csv and NAME.h5 */
    int key_count, run_count, collect_count;
    SweepKey *keys;
    char **collect; /* paths in results */
    char *best;     /* the path of what says which run is the best; NULL: nothing does */
    bool least;     /* the least is */
} Sweep;

extern const YamlTable sweep_table;

/* Reads a sweep's file; name NULL: the file's, without its ending. False with *report, the caller's: all that is wrong.
 * Clear it in any case. */
bool sweep_read(const char *path, const char *name, Sweep *sweep, char **report);
void sweep_clear(Sweep *sweep);

/* The run's value of a key; "key=value"; NAME/0001, of run 0, without ending. The caller frees the texts. */
const SweepValue *sweep_value(const Sweep *sweep, int run, int key);
char *sweep_assignment(const Sweep *sweep, int run, int key);
char *sweep_run_name(const Sweep *sweep, int run);

/* Does the scene say something else than it did when the sweep was read? Remarks may change. */
bool sweep_has_changed(const Sweep *sweep);

/* All that `slender run` is to be told, as for --set: the run's values, and its `output` as a whole; returns how many. */
enum { SWEEP_ASSIGNMENTS_MAX = SWEEP_KEYS_MAX + 1 };
int sweep_assignments(const Sweep *sweep, int run, char *assignments[SWEEP_ASSIGNMENTS_MAX]);

/* The run's scene; clear and destroy it in any case. The files that its `output` names are the run's own: plot.gcode is
 * 0001_plot.gcode. */
bool sweep_load(const Sweep *sweep, int run, YamlFile **file, Scene *scene);
