/* curves_picture.h - a page that shows curves in space: rods, bundles of them, strokes.
 *
 *     title
 *     lines ...
 *     names of the curves
 *     [ front: x, z ]  [ side: y, z ]  [ top: x, y ]
 *     [ chart ]  [ chart ]
 *
 * All views have the same scale. They are arranged in a row, in a column or with the top view over the front
 * one, and the charts below them, beside them or in their free corner, so that the curves become as large as
 * they can; of plane curves only the view of their plane is shown. Knows arrays only, positions in metres. A
 * scene is plain data that borrows everything; start from curves_default() and fill in what there is. */
#pragma once
#include "base/error.h"
#include "view/chart.h"
#include "view/holds.h"
#include "view/marks.h"
#include "view/raster.h"

/* Curves of one kind. Many of them are drawn as thin, translucent lines, so that their density is seen. */
typedef struct CurvesSet {
    const char *name; /* NULL: not in the legend                                             */
    int curve_count;
    const int *offsets;        /* [curve_count + 1] first point of each curve                */
    const double (*points)[3]; /* m; a row of NaN interrupts its curve                       */
    Color color;
    double width, dash;  /* of a single curve, pt (canvas.h)                                  */
    bool moment;         /* of a motion: an animation shows these sets one after the other    */
    Surroundings around; /* drawn below all curves: of the sets that are shown those of the last with any */
    Marks marks;         /* drawn above them, alike                                            */
    double time;         /* of a moment, s: marked in the charts of an animation               */
    Holds holds;         /* drawn above all                                                    */
} CurvesSet;

enum { CURVES_CHARTS_MAX = 3 };

typedef struct CurvesScene {
    const char *title;        /* NULL: none                                                  */
    const char *const *lines; /* small print below it                                        */
    int line_count;
    int set_count;
    const CurvesSet *sets; /* later ones lie over earlier ones                               */
    int clamp_count;
    const double (*clamps)[3]; /* m; small squares, beside the sets' holds                   */
    const char *clamps_name;   /* in the legend; NULL: "clamp"                               */
    double gravity[3];         /* its direction, an arrow at each view; zeros: none          */
    double view[3];            /* one view, with this direction to the eye and z upwards;
                                  zeros: front, side and top                                 */
    int chart_count;           /* at most CURVES_CHARTS_MAX                                  */
    const Chart *charts;
    int width; /* of the PNG, pixels, 400..4000; a page is 576 pt (8 inches) wide in SVG and PDF */
} CurvesScene;

/* No curve, 1600 pixels wide. */
CurvesScene curves_default(void);

/* Writes .png, .svg or .pdf as path's ending says (canvas.h). False and a sentence where the file cannot be
 * written or no set has a point. */
bool curves_write(const char *path, const CurvesScene *scene, Error *err);

/* Writes an animated .webp: a page for each set that is a moment, together with the sets that are none, shown
 * for so many seconds; the charts are over time, and mark its time. */
bool curves_animate(const char *path, const CurvesScene *scene, double seconds, Error *err);

/* Where curves are held, of the sets that are shown: all, or those that are no moments and that one. The last set's that has any;
 * NULL: none has. */
const Holds *curves_holds(const CurvesScene *scene, int only);

/* The colour mixed with white: t = 1 is the colour itself, 0 the palest that is still seen. For the moments
 * of a motion over each other. */
Color curves_fade(Color color, double t);
