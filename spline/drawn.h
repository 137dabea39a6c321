/* drawn.h - the drawing of a result, and the files that are made of it: the run itself, `slender export` and
 * `slender picture` all go this way.
 *
 * In a result, under /slender/spline: nodes [K,4] m (p and v on the paper, from its top left corner, y down),
 * strokes [S+1] first node of each stroke in the order in which they are plotted, pen [S]; and names (of the
 * pens, a line each), width [pens] m, color [pens,3], opaque [pens] 0 or 1, paper [2] m, paper_color [3], margin [2] m (left and right,
 * above and below), speed [2] m/s (pen down, up),
 * profile (text of the scene's machine, where it names one), lift s, z [3] (up, down m; m/s), servo (two commands, a line each: up, down), pause s (what G4 P1 waits),
 * picture [rows,columns] or [rows,columns,3]: what was to be drawn, 0 white .. 255 black or, of a
 * coloured one, what takes away red, green and blue. */
#pragma once
#include "io/result.h"
#include "spline/grid.h"
#include "spline/plot.h"
#include "spline/strokes.h"

typedef struct Drawn {
    SplinePage page;
    int pen_count;
    SplinePen *pens; /* names owned */
    Color paper;
    Strokes strokes; /* in units of the page */
    Plot plot;
    SplineField picture; /* as in Drawing */
    Plotter plotter;
    char *profile; /* text of the scene's machine; NULL: none */
} Drawn;

bool drawn_has(Result *result);

/* False and a sentence where the result has no drawing, or it is not as slender writes it. Clear it in any
 * case. */
bool drawn_read(Result *result, Drawn *drawn, Error *err);
void drawn_clear(Drawn *drawn);

/* Writes it as "svg", or in the words of a profile (plot_file.h): its name, the path of its file, or "profile": the
 * result's own. */
bool drawn_write(const Drawn *drawn, const char *language, const char *path, Error *err);

/* The same of a plot that is a part of its own (plot_split.h). */
bool drawn_write_plot(const Drawn *drawn, const Plot *plot, const char *language, const char *path,
                      Error *err);

/* False and a sentence where there is no such language, or none of the result's own. */
bool drawn_check_language(const Drawn *drawn, const char *language, Error *err);
