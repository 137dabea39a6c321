/* samples.h - a rod's curve from sampled points, clean or noisy: what a camera, a scanner or a drawing gives.
 *
 * A quintic spline with half as many knots as samples, 2000 at most, is fitted with a penalty on its third
 * derivative (spline.h); or with as many unknowns as samples, where half as many knots miss exact samples by
 * 3e-7 of the length. Its places, tangents and curvatures at equal arclengths are the curve. How much it
 * smooths is found by generalised cross-validation, or from the noise where that is known, by the unbiased
 * estimate of the risk [Craven & Wahba 1979]. A polyline through noisy samples would not do: it is too long,
 * and turns at every sample.
 *
 * The parameter is the length of the chords between the samples. Noise makes these uneven, so smoothed ones
 * are tried too: means over a tenth of the samples, and over all of them, that is, equal steps. Of the three
 * fits the one with the least cross-validated distance across the curve is kept.
 *
 * The curve begins and ends where the fit does, not at the first and last sample: the clamp is the fit's own
 * start, about the noise away from the first sample. Nothing here knows of weight: where a rod's whole weight
 * is known rather than its mass per metre, divide it by the curve's length. */
#pragma once
#include "base/random.h"
#include "rod/curve.h"

typedef struct RodSamplesDef {
    double noise; /* standard deviation of each coordinate, m; 0: none, the curve goes through the samples;
                     NAN: unknown, found by cross-validation (default) */
} RodSamplesDef;

RodSamplesDef rod_samples_default(void);

typedef struct RodSamplesInfo {
    double noise;     /* m, found from the distances across the curve (0.7 of it where all is in a plane);
                         0 where the fit has as many unknowns as there are samples */
    double weight;    /* of the penalty, a pure number (spline.h) */
    double freedom;   /* effective unknowns per coordinate */
    int coefficients; /* per coordinate */
} RodSamplesInfo;

/* x[count] in the order along the rod, from the clamp. Samples that equal the one before to twelve digits are
 * dropped; two must remain, which are a straight rod. Fewer than eight are taken as clean unless their noise
 * is given. Samples in a plane give a curve in it. info may be NULL. False and a sentence where a sample is
 * not finite, or where there are too few. */
bool rod_samples_curve(const Vec3 *x, int count, const RodSamplesDef *def, int elements, RodCurve *curve,
                       RodSamplesInfo *info, Error *err);

/* Curves that the same samples would have given with other noise of the same size: curves[count], made with the same knots
 * and weight from where the samples' curve is and noise at each of them; none of samples without noise. */
typedef struct RodDraws {
    int wanted, count;
    RodCurve *curves; /* owned; NULL: there is no noise */
    Random random;
} RodDraws;

/* Makes as many as are wanted. False and a sentence as above. To be cleared in any case. */
bool rod_samples_draw(const Vec3 *x, int count, const RodSamplesDef *def, int elements, RodDraws *draws,
                      Error *err);
void rod_draws_clear(RodDraws *draws);
