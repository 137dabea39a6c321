/* drawing.h - the drawing of a scene made ready: the page, the pens, and parts, each a tone that one pen
 * covers with strokes of one direction in one region. Parts do not act on each other. */
#pragma once
#include "spline/front/scene.h"
#include "spline/plot.h"
#include "spline/relax.h"
#include "spline/streamlines.h"
#include "spline/target.h"

typedef struct DrawingPart {
    int pen;                      /* layer of its strokes                             */
    SplinePage page;              /* with that pen                                    */
    SplineField tone;             /* width 1                                          */
    double turn;                  /* rad, of its strokes from that direction          */
    const SplineField *direction; /* the region's                         */
    const SplineField *outline;   /* the region's; NULL: the page         */
    Strokes given;                /* to start from, with `start.file`     */
    SplineField
        counts; /* the part of the contours' ink that its tone counts, at each place; no columns: all */
} DrawingPart;

/* Regions do not overlap. */
typedef struct DrawingRegion {
    SplineField cover;     /* how much of each pixel of a tone is in it */
    SplineField outline;   /* signed distance (contour.h)               */
    SplineField direction; /* no columns: the drawing's                 */
    int pen;               /* -1: all                                   */
} DrawingRegion;

typedef struct Drawing {
    SplinePage page; /* with the finest pen */
    int pen_count, part_count, region_count;
    int layer_count; /* the pens, and the contours where they are asked for */
    SplinePen *pens; /* [layer_count] names owned                        */
    Color paper;
    SplineField *tones;    /* [pen_count] what each shall cover, in all its parts; width 1 */
    Strokes contours;      /* fixed (fixed.h); of layer pen_count, drawn by that pen */
    SplineField contoured; /* how much of each pixel of a tone they cover; no columns: there are none */
    DrawingPart *parts;    /* in the order of the pens                         */
    DrawingRegion *regions;
    SplineField outline;   /* of all regions; no columns: there are none, the page is it */
    SplineField direction; /* width 3                                          */
    SplineField potential; /* width 1; no columns: of each part its brightness */
    SplineField flow;      /* width 2, or no columns                           */
    SplineField picture;   /* to be shown, as spline_preview takes it          */
    SplineField
        light; /* width 3, or no columns: where colours are matched, what inks should add to the paper's */
    RelaxDef relax;
    StrokesStart start_kind;
    bool start_given; /* the parts have their strokes */
    SplineStartDef start;
    int rounds;
    bool draft; /* it ends where its iterations do */
    DrawOrder order;
    Plotter plotter, timed; /* timed: with the lift of the slowest of the files asked for */
    char *profile;          /* text of the machine's file; NULL: none                     */
    double at_most;         /* s, what the plot may take; 0: no end                        */
    double thinned;         /* what of its ink the picture keeps for that; 1: all           */
} Drawing;

/* The strokes that a part starts from; the caller's. */
Strokes drawing_first_strokes(const Drawing *drawing, int part);

/* Adds the contours, which are part of every drawing. */
void drawing_add_contours(const Drawing *drawing, Strokes *strokes);

/* What its strokes are to cover of a part's tone, of all parts of a pen: less than 0 where contours cover more. The
 * caller's. */
SplineField drawing_part_left(const Drawing *drawing, int part);
SplineField drawing_pen_left(const Drawing *drawing, int pen);

/* About how many segments its strokes will have. */
double drawing_segments(const DrawingPart *part);

/* Reads the pictures. NULL after a refusal, which is in the file's list. */
Drawing *drawing_create(const SplineScene *scene, YamlFile *file);
void drawing_destroy(Drawing *drawing);

/* The strokes that a part starts from (NULL: not wanted), and what they relax to: the caller's, to clear and destroy.
 * Both at the same time where there are threads; no bit depends on how many. */
void drawing_begin(const Drawing *drawing, int part, int threads, Strokes *strokes, SplineTarget **target);
