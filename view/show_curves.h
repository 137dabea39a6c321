/* show_curves.h - what a result of rods has, for its pages: curves, charts over their length, and what is known of their
 * stability.
 *
 * Reads of /slender/rod: input, natural, x [points,3], strands [S+1] (offsets of the strands' points; without it all are one),
 * natural_strain [points,3] over s [points], stable, lowest_eigenvalue, critical_young and morse_index (a number, or one for
 * each strand), identified/..; metrics/.., and of load cases cases/NAME/x, target. */
#pragma once
#include "view/chart.h"
#include "view/show_data.h"
#include "view/show_framings.h"

/* A state of rest: of a load case that is shown, or the only one. */
typedef struct ShowCurvesState {
    const char *name;      /* of several cases; NULL: the only one            */
    const char *load_case; /* NULL: of a result without cases               */
    const double (*x)[3],
        (*target)[3]; /* target: NULL where nothing is to be anywhere, or there is an input */
} ShowCurvesState;

typedef struct ShowCurves {
    ShowData *data;
    int strand_count, point_count;
    const int *strands; /* [strand_count + 1] first point of each */
    const double (*input)[3], (*natural)[3];
    const double (*x)[3]; /* of the first state; its reader may put that of a frame in its place */
    ShowCurvesState *states;
    int state_count;
} ShowCurves;

/* Is it a result of rods? */
bool show_curves_has(const ShowData *data);

/* False and a sentence where they are not as slender writes them. */
bool show_curves_read(ShowCurves *curves, ShowData *data, Error *err);

/* [node] m, how thick strands are, whose first nodes are first[strand_count + 1]: of elements the mean of those beside a node, of
 * an even rod how far its section reaches. Kept in the data; NULL: the result does not say it. */
const double *show_curves_radii(ShowData *data, int strand_count, const int *first);

/* Has any of the states one? */
bool show_curves_have_target(const ShowCurves *curves);

/* Charts over s, of a few strands only: natural strains (how many there are), and how far x is from the input, or the states
 * are from their targets (false: there are no x, nothing of these or no s). */
int show_curves_strains(const ShowCurves *curves, Chart charts[FRAMING_CHARTS]);
bool show_curves_distance(const ShowCurves *curves, Chart *chart);

/* "lowest eigenvalue", "25.8 1/m²"; a value that says it all has no name. */
typedef struct ShowFact {
    const char *name, *value;
} ShowFact;

/* Stability, what was identified, and metrics; of several strands the least or the greatest number. The list is kept in the
 * data. */
int show_curves_facts(const ShowCurves *curves, const ShowFact **facts);
