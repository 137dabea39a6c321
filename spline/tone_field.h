/* tone_field.h - from pictures to densities: how much of the paper ink shall cover, at every place of the
 * page.
 *
 * A density is D = density * (1 - brightness) in 0..1, brightness the grey level after inversion and tone
 * curve. Lines of width w drawn w/D apart have it. */
#pragma once
#include "io/image.h"
#include "spline/grid.h"

typedef struct SplineToneDef {
    double crop[4]; /* left, top, right, bottom of what is drawn, parts of the picture; default 0, 0, 1, 1 */
    bool cover;     /* fills the page and loses what is beyond; default: all is shown, centred */
    bool extend;    /* beside the picture its edges go on; default: the paper is blank there */
    bool invert;    /* default false */
    double black, white;      /* grey levels that become brightness 0 and 1; default 0, 1 */
    double gamma;             /* brightness^(1/gamma): above 1 lightens the middle tones; default 1 */
    const double (*curve)[2]; /* instead of these three: brightness at grey levels, linear between   */
    int curve_points;         /* [curve_points], levels growing; 0: none; borrowed                   */
    double density;           /* of black; default 0.85, above which neighbouring lines run together */
} SplineToneDef;

SplineToneDef spline_tone_default(void);

/* Is every number of it allowed? */
bool spline_tone_check(const SplineToneDef *def, Error *err);

/* The density in pixels of about that size, each the mean of the picture over it. def has been checked. */
SplineField spline_tone(const Image *image, const SplinePage *page, const SplineToneDef *def, double pixel);

/* How many pixels of the whole picture, across and down, are of use for pixels of that size on the page: two
 * in each. */
void spline_tone_useful(const SplinePage *page, const SplineToneDef *def, double pixel, double useful[2]);

/* The size of pixels that shows all a pen can draw: half its width. */
static inline double spline_tone_pixel(const SplinePage *page)
{
    return fmax(page->pen / 2, 1.0 / 2000);
}

/* Cyan, magenta, yellow and black as pictures in which black is full ink, from red, green and blue. Their
 * common part K0 = min(1 - R, 1 - G, 1 - B) becomes black ink K = black*K0, and what is left for the others,
 * C = (1 - R - K)/(1 - K), gives the colour back where inks lie on each other by chance [Demichel 1924;
 * grey-component replacement]. black = 0: three inks; 1: as little of them as there can be. Owned. */
void spline_separate(const Image rgb[3], double black, Image ink[4]);

/* Shares a density among layers by its tone: layer k gets it where limits[k - 1] <= D < limits[k] (limits
 * growing, [layers - 1]), and nothing elsewhere. Owned. */
void spline_tone_layers(const SplineField *tone, int layers, const double *limits, SplineField *layer);

/* Shares a density among sets of strokes that cross: set k draws where D exceeds from[k] (growing, from[0] =
 * 0 as a rule). Crossing lines cover 1 - (1 - D1)(1 - D2) of the paper, so that depths -ln(1 - D) add up;
 * depth is shared equally among the sets that draw at it. Owned. */
void spline_tone_cross(const SplineField *tone, int sets, const double *from, SplineField *set);
