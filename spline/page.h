/* page.h - the page of a drawing, in units in which its drawable part has area 1: everything but files speaks
 * them.
 *
 * x goes right from 0 to width = sqrt(a), y down from 0 to height = 1/sqrt(a), a the ratio of the sides: what
 * is inside the margins. A length of 1 is `unit` metres. Weights of energies, iterations and pixels of
 * pictures then mean the same on every page [Linewise]. */
#pragma once
#include <math.h>

typedef struct SplinePage {
    double width, height; /* of the drawable part, product 1                              */
    double unit;          /* m                                                            */
    double left, top;     /* margins, m                                                   */
    double paper[2];      /* the whole page, m                                            */
    double pen;           /* width of the line, in units of the page                      */
} SplinePage;

/* The pen is round: beyond each end of a line it covers half a disc, as much as this further length does. */
static inline double spline_pen_cap(const SplinePage *page)
{
    return M_PI / 8 * page->pen;
}

/* A paper of paper[0] x paper[1] m with the same margin all around (less than half of the shorter side), and
 * a pen, m. */
static inline SplinePage spline_page(double paper_width, double paper_height, double margin, double pen)
{
    double w = paper_width - 2 * margin, h = paper_height - 2 * margin, unit = sqrt(w * h);
    return (SplinePage){.width = w / unit,
                        .height = h / unit,
                        .unit = unit,
                        .left = margin,
                        .top = margin,
                        .paper = {paper_width, paper_height},
                        .pen = pen / unit};
}
