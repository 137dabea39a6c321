/* page.h - the page of a drawing, in units in which its drawable part has area 1: everything but files speaks
 * them.
 *
 * x goes right from 0 to width = sqrt(a), y down from 0 to height = 1/sqrt(a), a the ratio of the sides: what
 * is inside the margins, and of a picture that is shown whole no more than what it covers. A length of 1 is `unit` metres. Weights of energies, iterations and pixels of
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

/* A paper of paper[0] x paper[1] m with the same margin left and right, and above and below (less than half of
 * each side), and a pen, m. */
static inline SplinePage spline_page_margins(const double paper[2], double left, double top, double pen)
{
    double w = paper[0] - 2 * left, h = paper[1] - 2 * top, unit = sqrt(w * h);
    return (SplinePage){.width = w / unit,
                        .height = h / unit,
                        .unit = unit,
                        .left = left,
                        .top = top,
                        .paper = {paper[0], paper[1]},
                        .pen = pen / unit};
}

/* The same margin all around. */
static inline SplinePage spline_page(double paper_width, double paper_height, double margin, double pen)
{
    return spline_page_margins((const double[2]){paper_width, paper_height}, margin, margin, pen);
}

/* The largest page of that shape (height over width) in the middle of another one's drawable part. */
static inline SplinePage spline_page_shaped(const SplinePage *page, double shape)
{
    double w = page->width, h = page->height, less_w = fmin(w, h / shape), less_h = fmin(h, w * shape);
    if (fmax(w - less_w, h - less_h) < 1e-9) return *page;
    return spline_page_margins(page->paper, page->left + page->unit * (w - less_w) / 2,
                               page->top + page->unit * (h - less_h) / 2, page->pen * page->unit);
}
