/* tone.h - ink and the tone that it makes: what `tone` as an energy, Monte Carlo's moves and the insertion of
 * strokes share.
 *
 *     E = K/2 sum_c gain_c (rho_c - D_c)^2,   rho_c = pen sum over points of their ink times W_c
 *
 * over the probes c (probes.h): the ink around each, less what the picture asks for there. */
#pragma once
#include "spline/points.h"
#include "spline/probes_kernel.h"

/* Which levels see a point (probe_levels), and in which band across the page it is. */
typedef struct ToneSight {
    uint16_t levels, band;
} ToneSight;

typedef struct Tone {
    const Probes *probes;
    double pen;
    Workers *workers; /* borrowed */
    double *ink;      /* [probes->size] rho_c  */
    double *force;    /* [probes->size] dE/drho_c at K = 1 */
    double *rows;     /* [row_count] energy of each row of cells, over K */
    int row_count;
    ToneSight *sights; /* [sight_room] of the points of the last update */
    int sight_room;
} Tone;

Tone tone_create(const SplineTarget *target, Workers *workers);
void tone_clear(Tone *tone);

/* That of strokes drawn by a pen of that width. */
Tone tone_of_strokes(const SplineTarget *target, const Strokes *strokes, double pen);

/* Ink of all points, and then energy and forces of it. Returns E/K. */
double tone_update(Tone *tone, const SplinePoints *points);

/* What the probes do to point p of the last update: E/K per length of ink there, and its derivatives in the place. */
static inline ProbeSums tone_sums(const Tone *tone, const SplinePoints *points, int p, int order)
{
    ProbeSums sums =
        probes_gather(tone->probes, tone->sights[p].levels, points->x[p], points->y[p], tone->force, order);
    double c = 4 * tone->pen / M_PI;
    return (ProbeSums){c * sums.value, c * sums.x, c * sums.y, c * sums.xx, c * sums.xy, c * sums.yy};
}
