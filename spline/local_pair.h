/* local_pair.h - points in cells that come and go one stroke at a time: the pair energy of local.h. */
#pragma once
#include "spline/points.h"

typedef struct LocalPair {
    const SplineModel *model;
    double C;
    int columns, rows, points;
    int *head;              /* [columns rows] first point of each cell, -1: none */
    int *next, *previous;   /* [points] in the cell; previous of the first: -1 - cell */
    double *x, *y, *amount; /* [points] */
} LocalPair;

LocalPair local_pair_create(const SplineModel *model, double C);
void local_pair_clear(LocalPair *pair);

/* Puts the points of a stroke in, from the first one in the list of all; or takes as many out. */
void local_pair_insert(LocalPair *pair, int first, const SplinePoints *points);
void local_pair_remove(LocalPair *pair, int first, int count);

/* Energy of a stroke's points among those that are in, of which they are none, and with themselves. */
double local_pair_energy(const LocalPair *pair, const SplinePoints *points);
