/* picture.h - a page that shows one frame of a run: shaded meshes, colours, arrows, targets and the history.
 *
 *     title
 *     lines ...
 *     [ result of case 1 ]  [ its target ]        with two cases or more and no targets beside
 *     [ result of case 2 ]  [ its target ]        them, cases fill the rows of a grid instead
 *     [ colour scale, size of the arrows ]  [ history chart ]
 *     [ chart over time ]  [ chart over time ]
 *
 * All panels have the same camera and scale, so that they can be compared. Knows arrays only: positions in
 * metres, other numbers in the unit named with them. A scene is plain data that borrows everything; start
 * from picture_default() and fill in what there is. */
#pragma once
#include "base/error.h"
#include "view/chart.h"
#include "view/marks.h"
#include "view/raster.h"

/* One load case. */
typedef struct PicturePanel {
    const char *name;           /* "up"; NULL: none                                                        */
    const char *note;           /* e.g. "converged"; NULL: none                                            */
    const double (*x)[3];       /* [vertex] m                                                              */
    const double (*target)[3];  /* [vertex] m; a row of NaN: that vertex has none. NULL: no target         */
    double target_away;         /* m, over the whole body                                                  */
    const double *field;        /* [face] drawn as colour; NaN: none. NULL: a plain surface                */
    const double (*vectors)[3]; /* [face] drawn as arrows, in the world's frame; NULL: none                */
    const double *flux_density; /* [3] T, drawn as an arrow beside the axes; NULL: none                    */
    const double *gravity;      /* [3] its direction, drawn as an arrow beside the axes; NULL, zeros: none */
    Surroundings around;        /* drawn with it, and it shines through them                               */
    Marks marks;                /* drawn over all; the key names those of the first panel                  */
    double time;                /* s, marked in the charts over time                                       */
} PicturePanel;

typedef enum PictureTarget {
    PICTURE_TARGET_AUTO,   /* of a ShowDef: beside, of a motion over */
    PICTURE_TARGET_BESIDE, /* a panel of its own                  */
    PICTURE_TARGET_OVER,   /* as wires over the result            */
    PICTURE_TARGET_BOTH
} PictureTarget;

enum { PICTURE_CHARTS_MAX = 3 };

typedef struct PictureScene {
    const char *title;        /* NULL: none                                                  */
    const char *const *lines; /* small print below it, e.g. scene, status, energies          */
    int line_count;

    int vertex_count, face_count;
    const int (*faces)[3];
    int panel_count; /* 0: the page shows the history only                          */
    const PicturePanel *panels;
    const char *field_name, *field_unit;     /* "magnetization", "A/m" */
    const char *vectors_name, *vectors_unit; /* the same for the arrows */
    double field_low, field_high;            /* the colour scale's ends; both 0: fitted to all panels.
                                                Diverging colours if low = -high */

    PictureTarget target;
    bool same_view;        /* one camera for all panels: moments of one motion             */
    bool edges;            /* draw the mesh's edges                                       */
    double view[3], up[3]; /* direction to the eye, and upwards; zeros: three quarters, z */
    double perspective;    /* camera_fit's; 0: parallel                                   */
    const Chart *history;  /* NULL: none                                                  */
    int chart_count;       /* at most PICTURE_CHARTS_MAX */
    const Chart *charts;   /* over time; the times of the panels are marked in them       */
    int width; /* of the PNG, pixels, 400..4000; a page is 576 pt (8 inches) wide in SVG and PDF */
} PictureScene;

/* Nothing to show, target beside, edges drawn, 1600 pixels wide. */
PictureScene picture_default(void);

/* Writes .png, .svg or .pdf as path's ending says (canvas.h). Nothing is printed; false and a sentence where
 * the file cannot be written or the scene has neither panels nor history. */
bool picture_write(const char *path, const PictureScene *scene, Error *err);

/* Writes an animated .webp: each panel is a page, under the same title, shown for so many seconds; the charts over time mark
 * its time. The history is left out. */
bool picture_animate(const char *path, const PictureScene *scene, double seconds, Error *err);
