/* predict.h - how long a job of a shell or a rod takes and how much memory, without doing any of it.
 *
 * A Newton iteration is an assembly, some factorisations and solves. What the factor costs follows from its pattern: of
 * up to PREDICT_EXACT unknowns it is ordered and analysed, of more a law says it (nested dissection of a surface: n log n
 * numbers, n^1.5 flops). How fast this machine is, a sheet of 4096 triangles and one dgemm say. The laws and the counts
 * of iterations are measured; `./do bench scale` measures them again and compares. */
#pragma once
#include "model/model.h"

enum { PREDICT_EXACT = 90000 };

typedef struct Prediction {
    double unknowns, numbers, flops, factor_bytes; /* of a factor */
    bool exact;                                    /* they are counted, not a law's */
    double iterations, factorizations;             /* assumed: of the whole job, and of one iteration */
    double start, end;               /* s: pattern and order; stability, result, picture            */
    double iteration, factorization; /* s: of one iteration, all in; of one factorisation          */
    double bytes;                    /* at the peak, of the process */
} Prediction;

/* The model has a case at least. */
Prediction predict(const Model *model, const Scene *scene);

/* start + iterations * iteration + end, s. */
double predict_seconds(const Prediction *prediction);

/* For bodies (BodyOps.cost). The least of some times of one evaluation, one factorisation, one solve, and the time of
 * building the matrix, once. */
void predict_measure(System *sys, const Point *at, int repeats, Cost *cost);
void predict_take_factor(SparseInfo info, Cost *cost);
