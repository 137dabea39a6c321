/* drawing_pens.h - the pens of a drawing, and what the scene says of each. */
#pragma once
#include "spline/front/scene.h"
#include "spline/ink_table.h"
#include "spline/plot.h"

/* The width of the finest pen, m. */
double pens_finest(const SplineScene *scene);

/* pens[count], with widths in units of the page, and behind them that of contours where there are any; names are the
 * caller's. False after a refusal. */
bool pens_read(const SplineScene *scene, YamlFile *file, const SplinePage *page, Color *paper,
               SplinePen **pens, int *count);

/* Their inks, each of which may cover all; coats[count] is what the set borrows. */
InkSet pens_inks(Color paper, const SplinePen *pens, int count, Ink *coats);

/* Which of the inks of spline_separate the pen of that name draws; -1: none. */
int pens_ink(const char *name);

/* The densities from which the pens draw, but for the first one's: the caller frees. */
double *pens_limits(const SplineScene *scene);

/* How far the strokes of a pen are turned from the drawing's direction, rad. */
double pens_turn(const SplineScene *scene, const SplinePen *pens, int pen);
