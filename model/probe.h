/* probe.h - the scene's probes: numbers that are followed through stages, times or evaluations. */
#pragma once
#include "io/arrays.h"
#include "model/model.h"
#include "optim/objectives.h"

enum { PROBE_POINTS = 3, PROBE_WIDTH = 3 };

typedef struct ProbeKind ProbeKind; /* probe.c */

typedef struct ModelProbe {
    char *name;
    const ProbeKind *kind;
    int point_count;
    Probe points[PROBE_POINTS]; /* whose vectors are its own */
    double axis[3];             /* of an angle               */
    Indices held;               /* of a force: these points, */
    int number;                 /* or this support, or obstacle */
} ModelProbe;

/* The scene's probes, once there is a body; false after a refusal. */
bool model_probes(Model *model, const Scene *scene, YamlFile *file);
void model_clear_probes(Model *model);

/* How many numbers all of them are; their values in a state, one after the other; and those of one: 1, or 3 of a vector. */
int model_probe_count(const Model *model);
void model_measure(const Model *model, const Snapshot *shot, double *values);
int model_probe_width(const ModelProbe *probe);

/* What its rows are: "stage", "time" or "evaluation", of a motion in s. */
const char *model_probe_rows(const Model *model);

/* Values, copied, as arrays probes/NAME, and the number of the row as probes/time, ..: of a frame [1,3], [1] and [1]; of an
 * evaluation with so many cases [rows,3], [rows] and a number, of one case [3] or a number. */
void model_add_probes(const Model *model, const double *values, int rows, bool frame, double number,
                      Arrays *list);

/* The only point of that name (a vertex of the mesh's file, a group of one, a node of a rod; NULL: the centre of mass); to be
 * cleared. */
bool model_find_point(const Model *model, const Build *b, Key at, const char *vertex, Probe *probe);
