/* drawing.h - the drawing of a scene made ready: the page, the pens, and parts, each a tone that one pen
 * covers with strokes of one direction. Parts do not act on each other. */
#pragma once
#include "spline/front/scene.h"
#include "spline/plot.h"
#include "spline/relax.h"
#include "spline/streamlines.h"
#include "spline/target.h"

typedef struct DrawingPart {
    int pen;          /* layer of its strokes                             */
    SplinePage page;  /* with that pen                                    */
    SplineField tone; /* width 1                                          */
    double turn;      /* rad, of its strokes from the drawing's direction */
} DrawingPart;

typedef struct Drawing {
    SplinePage page; /* with the finest pen */
    int pen_count, part_count;
    SplinePen *pens;       /* names owned                                      */
    SplineField *tones;    /* [pen_count] what each shall cover, in all its parts; width 1 */
    DrawingPart *parts;    /* in the order of the pens                         */
    SplineField direction; /* width 3                                          */
    SplineField potential; /* width 1; no columns: of each part its brightness */
    SplineField flow;      /* width 2, or no columns                           */
    SplineField picture;   /* to be shown, as spline_preview takes it          */
    RelaxDef relax;
    StrokesStart start_kind;
    SplineStartDef start;
    int rounds;
    DrawOrder order;
    Plotter plotter;
} Drawing;

/* About how many segments its strokes will have. */
double drawing_segments(const DrawingPart *part);

/* Reads the pictures. NULL after a refusal, which is in the file's list. */
Drawing *drawing_create(const SplineScene *scene, YamlFile *file);
void drawing_destroy(Drawing *drawing);

/* The strokes that a part starts from (NULL: not wanted), and what they relax to: the caller's, to clear and destroy.
 * Both at the same time where there are threads; no bit depends on how many. */
void drawing_begin(const Drawing *drawing, int part, int threads, Strokes *strokes, SplineTarget **target);
