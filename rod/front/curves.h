/* curves.h - the curves of a scene's rod, from formulas or files, and the frames along them. */
#pragma once
#include "io/table.h"
#include "model/build.h"
#include "rod/frame.h"
#include "rod/front/scene.h"
#include "rod/samples.h"

typedef struct RodStrands {
    int count;
    RodCurve *curves;  /* [count]           */
    RodFrame **frames; /* [count][stations] */
} RodStrands;

/* Of scene->curve; false after a refusal. To be cleared in any case. */
bool rod_strands_read(const Build *b, const RodScene *scene, RodStrands *strands);
void rod_strands_clear(RodStrands *strands);

/* A file of points, at a key of the scene. */
typedef struct Sampled {
    const char *at, *path;
    double scale;
    NoiseScene noise;
    int elements;
} Sampled;

/* The curve through the points of a file with one polyline, and draws of their noise (NULL: none).
 * Else both to be cleared. */
bool rod_curve_read(const Build *b, Sampled from, RodCurve *curve, RodDraws *draws);

/* Rows by arclength, s first: two at least, s increasing. Are they on a rod of that length? Both at once. Tables are to be
 * cleared in any case. */
bool rod_table_open(const Build *b, const char *at, const char *path, const char *names, Table *table);
bool rod_table_check(const Build *b, const char *at, const char *path, double length, const Table *table);
bool rod_table_read(const Build *b, const char *at, const char *path, const char *names, double length,
                    Table *table);

/* Columns 1, 2, .. of a table at s, its first one, which ascends: linear between the rows, constant beyond.
 */
void rod_table_at(const Table *table, double s, double *values);
