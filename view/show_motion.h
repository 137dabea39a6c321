/* show_motion.h - of a motion, what its pages show beside the body: the curves and places that its points were to follow, their
 * way up to then, and charts of how far they are away, of the uniform field and of the sources' strengths over time.
 *
 * Reads trajectory/followed, trajectory/reference/.., trajectory/flux_density and trajectory/source_strength, of a simulation frames/flux_density
 * (docs/result.md); what a result has not is not drawn. */
#pragma once
#include "view/chart.h"
#include "view/marks.h"
#include "view/show_data.h"

enum { SHOW_MOTION_CHARTS = 3 };

typedef struct ShowMotion {
    ShowData *data;
    double begin, end; /* s */
    int row_count;     /* waypoints and curves; 0: none, and nothing of the next ones */
    int steps;
    const char *names;            /* of the rows, a line each                            */
    const int (*frames)[2];       /* [row] at which it counts                            */
    const int *follows, *offsets; /* [row] its point; [row + 1] into points              */
    const double (*points)[3];    /* m                                                   */
    const double *distance;       /* [row][steps + 1] m                                  */
    int followed_count;
    const double (*followed)[3]; /* [followed_count][steps + 1] m                       */
    int field_count;             /* 0: no field, or one that does not change            */
    const double *times, *field; /* [field_count] s; [field_count][3] T                 */
} ShowMotion;

/* Of what is no motion nothing. False and a sentence where it is not as slender writes it. */
bool show_motion_read(ShowMotion *motion, ShowData *data, Error *err);

/* Of what was to be followed, and of the way. */
typedef struct MotionInk {
    Color reference, path;
    double width; /* of curves that were to be followed, pt */
} MotionInk;

/* At a time, NAN: the end. Places are full when it is their turn. */
Marks show_motion_marks(const ShowMotion *motion, double time, MotionInk ink);

/* How many there are. */
int show_motion_charts(const ShowMotion *motion, Chart charts[SHOW_MOTION_CHARTS]);
