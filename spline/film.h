/* film.h - how a drawing relaxed: its strokes after every so many iterations, from a journal into a result and from there to
 * what a plotter would draw.
 *
 * In the journal kind `film`, the index is the iteration. In a result, under /slender/spline/film: iteration [T]; frames [T+1]
 * first stroke of each and their number; strokes [S+1] first node of each stroke, and K; pen [S]; nodes [K,4] as in spline/nodes,
 * in whole micrometres. */
#pragma once
#include "io/arrays.h"
#include "spline/drawn.h"

/* Strokes of the page, after that iteration. */
bool film_put(Journal *journal, const SplinePage *page, const Strokes *strokes, int iteration, Error *err);

/* All that has been put, into the arrays of a result; none where there is nothing. */
bool film_add(Journal *journal, Arrays *list, Error *err);

typedef struct Film {
    int count; /* 0: there is none */
    Array iteration, frames, strokes, pen, nodes;
} Film;

/* Of a drawing's result; drawn as read from it. False and a sentence where it is not as slender writes it. Clear it in any case. */
bool film_read(Result *result, const Drawn *drawn, Film *film, Error *err);
void film_clear(Film *film);

int film_iteration(const Film *film, int frame);

/* Frame 0 .. count - 1 as its pens draw it; the caller frees (spline_plot_clear). */
Plot film_plot(const Film *film, const Drawn *drawn, int frame);
