/* marks.h - thin lines and dots that a page draws over a body, whatever is in front of them: where a motion was to go, and
 * where it went. Plain data that borrows everything. */
#pragma once
#include "io/canvas.h"
#include "view/raster.h"

typedef struct MarkLine {
    const char *name; /* in the legend; NULL: not there */
    int count;
    const double (*points)[3]; /* m */
    Color color;
    double width; /* pt */
} MarkLine;

typedef struct MarkDot {
    const char *name;
    const double *at; /* [3] m */
    Color color;
    double radius; /* pt */
    bool hollow;
} MarkDot;

typedef struct Marks {
    int line_count, dot_count;
    const MarkLine *lines; /* later ones lie over earlier ones, dots over all */
    const MarkDot *dots;
} Marks;

/* What the camera sees of them, whose pixels are `resolution` a point from `origin` on the page. */
void marks_draw(Canvas *canvas, const Marks *marks, const Camera *camera, double resolution, Vec2 origin);

/* One of them in a legend: a piece of a line as wide as MARKS_SAMPLE, or a full dot in its middle, from the left end `at` on. */
extern const double MARKS_SAMPLE;
void marks_draw_line(Canvas *canvas, const MarkLine *line, Vec2 at);
void marks_draw_dot(Canvas *canvas, const MarkDot *dot, Vec2 at);
