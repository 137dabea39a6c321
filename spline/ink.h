/* ink.h - the colours that inks make on paper, and how much of each ink makes a colour.
 *
 * Each ink covers a part of every place, wherever the others lie: two that cover a and b meet on a*b of it [Demichel
 * 1924]. Seen from afar a place has the mean of what lies side by side, each with its part of the area [Neugebauer
 * 1937], in linear light (reflectances; no light spreads in the paper). Where inks meet, a transparent one multiplies
 * what is below it by its own colour, an opaque one hides it. As both are affine in the colour below, the sum over all
 * 2^n meetings is a chain: R <- (1 - a) R + a f(R) for one ink after the other, from the paper up.
 *
 * Colours are linear red, green and blue of sRGB, 0 to 1 (color_linear); their distance is CIELAB's Delta E*ab [CIE
 * 1976], white being sRGB's. */
#pragma once
#include "base/vec3.h"
#include <stdbool.h>

typedef struct Ink {
    Vec3 color; /* of a whole coat on white paper */
    bool opaque;
} Ink;

enum { INK_MAX = 32 };

typedef struct InkSet {
    Vec3 paper;
    int count;       /* at most INK_MAX                            */
    const Ink *inks; /* in the order in which they are laid; borrowed */
    double most;     /* that each may cover, in (0, 1]             */
} InkSet;

/* What is seen where the inks cover so much: cover[count]. */
Vec3 ink_mix(const InkSet *set, const double *cover);

double ink_difference(Vec3 a, Vec3 b);

/* What the inks should cover, 0 to `most`: the minimum of (Delta E/100)^2 and 1e-4 of all amounts and their squares,
 * which takes least ink where several mixtures make the colour, and costs less than one Delta E as a rule.
 * Non-negative least squares of a model that is not linear: projected Gauss-Newton steps [Bertsekas 1982]; from no ink
 * and from half of it, the better end. */
void ink_match(const InkSet *set, Vec3 color, double *cover);
