#include "rod/samples.h"
#include "base/memory.h"
#include "rod/spline.h"
#include <math.h>

enum { LEAST = 2, FEW = 8, INTERVALS_MOST = 2000 };

static const double weight_least = -15; /* decimal logarithm: nothing is smoothed */

RodSamplesDef rod_samples_default(void)
{
    return (RodSamplesDef){.noise = NAN};
}

/* Copies the samples that differ from the one before, from the first one on, and the middle of two; 0 where
 * they are refused. */
static int differing(const Vec3 *x, int count, Vec3 *kept, Error *err)
{
    const double same = 1e-12;
    double size = 0;
    int n = 0;
    for (int i = 0; i < count; i++) {
        size = fmax(size, vec3_length(vec3_sub(x[i], x[0])));
        if (!isfinite(x[i].x + x[i].y + x[i].z) || !isfinite(size))
            return error_set(err, "sample %d of the rod is not finite", i + 1);
    }
    for (int i = 0; i < count; i++)
        if (n == 0 || vec3_length(vec3_sub(x[i], kept[n - 1])) > same * size) kept[n++] = x[i];
    if (n < LEAST)
        return error_set(err, "a rod's curve needs %d different samples at least, not %d", LEAST, n);
    if (n == LEAST) { /* a straight line; the spline needs three */
        kept[2] = kept[1];
        kept[n++ - 1] = vec3_scale(0.5, vec3_add(kept[0], kept[1]));
    }
    return n;
}

static double chords(const Vec3 *x, int count)
{
    double sum = 0;
    for (int i = 1; i < count; i++) sum += vec3_length(vec3_sub(x[i], x[i - 1]));
    return sum;
}

/* Steps are the means of the chords up to `reach` samples away on either side. */
static void parameters(const Vec3 *x, int count, int reach, double *u)
{
    double *length = mem_alloc((size_t)count, sizeof *length);
    for (int i = 1; i < count; i++) length[i] = length[i - 1] + vec3_length(vec3_sub(x[i], x[i - 1]));
    u[0] = 0;
    for (int i = 1; i < count; i++) {
        int first = i - 1 > reach ? i - 1 - reach : 0, last = i < count - reach ? i + reach : count - 1;
        u[i] = u[i - 1] + (length[last] - length[first]) / (last - first);
    }
    mem_free(length);
}

/* What the weight's logarithm is judged by: cross-validation, or the expected square error for a known noise
 * in three coordinates. */
static double judge(RodSpline *spline, double log_weight, double noise)
{
    double n = spline->points;
    rod_spline_fit(spline, pow(10, log_weight));
    if (!isnan(noise)) return spline->squares + 6 * noise * noise * spline->freedom;
    return spline->squares / pow(n - spline->freedom, 2);
}

/* The weight with the best judgement, between two decimal logarithms and up to a step beyond: in steps of two
 * decades, then by golden sections around the best one. */
static void choose_weight(RodSpline *spline, double low, double high, double noise)
{
    const double golden = 0.6180339887498949, step = 2, enough = 0.25;
    double best = low, least = INFINITY;
    for (double at = low; at <= high; at += step) {
        double value = judge(spline, at, noise);
        if (value < least) least = value, best = at;
    }
    low = best - step, high = best + step;
    double p = high - golden * (high - low), q = low + high - p;
    double at_p = judge(spline, p, noise), at_q = judge(spline, q, noise);
    while (high - low > enough) {
        if (at_p < at_q) {
            high = q, q = p, at_q = at_p, p = low + high - q;
            at_p = judge(spline, p, noise);
        } else {
            low = p, p = q, at_p = at_q, q = low + high - p;
            at_q = judge(spline, q, noise);
        }
    }
    judge(spline, at_p < at_q ? p : q, noise);
}

/* Half as many knots as samples leave enough of them to tell a curve from noise. */
static int half_intervals(int count)
{
    int half = count / 2 - 3;
    return half < 1 ? 1 : half > INTERVALS_MOST ? INTERVALS_MOST : half;
}

/* As many unknowns as samples: the spline may pass through each. */
static int all_intervals(int count)
{
    return count > ROD_SPLINE_ORDER ? count - ROD_SPLINE_ORDER + 1 : 1;
}

/* Fits on so many intervals with the parameter that suits the samples best: the smoother one where the two
 * are equal but for chance, unless it leaves more along the curve than noise would (half of what it leaves
 * across, or as much in a plane): then it is the parameter that is wrong. What roughness of the chords adds
 * to the curve's makes the first weight smaller than the next ones. */
static RodSpline fit_on(const Vec3 *x, int count, int intervals, double noise)
{
    const int reaches[] = {0, count / 20, count};
    const double tie = 1.003, along = 3;
    double *u = mem_alloc((size_t)count, sizeof *u), least = INFINITY;
    RodSpline best = {0};
    for (int k = 0; k < (noise == 0 ? 1 : 3); k++) {
        parameters(x, count, reaches[k], u);
        RodSpline next = rod_spline_create(u, x, count, intervals);
        double parabola = 6 * log10(next.intervals) + 2, before = k == 0 ? 0 : log10(best.weight);
        if (noise == 0)
            rod_spline_fit(&next, pow(10, weight_least));
        else if (k == 0)
            choose_weight(&next, weight_least, parabola, noise);
        else
            choose_weight(&next, fmax(before - 4, weight_least), fmin(before + 8, parabola), noise);
        double across = rod_spline_squares_across(&next), value = across / pow(count - next.freedom, 2);
        bool better = k == 0 || (value <= tie * least && next.squares <= along * across);
        RodSpline worse = better ? best : next;
        if (better) least = value, best = next;
        rod_spline_clear(&worse);
    }
    mem_free(u);
    return best;
}

/* Exact samples that half as many knots miss are passed through. */
static RodSpline fit(const Vec3 *x, int count, double noise)
{
    const double passes = 3e-7; /* of the length */
    RodSpline half = fit_on(x, count, half_intervals(count), noise);
    if (noise != 0 || rod_spline_worst(&half) <= passes * chords(x, count)) return half;
    rod_spline_clear(&half);
    return fit_on(x, count, all_intervals(count), noise);
}

/* What a fit of n samples takes their noise for. */
static double fit_noise(const RodSamplesDef *def, int n)
{
    return isnan(def->noise) && n < FEW ? 0 : def->noise;
}

static RodSamplesInfo report(const RodSpline *spline)
{
    double free = spline->points - spline->freedom;
    return (RodSamplesInfo){
        .noise = free > 0.5 ? sqrt(rod_spline_squares_across(spline) / (2 * free)) : 0,
        .weight = spline->weight,
        .freedom = spline->freedom,
        .coefficients = spline->coefficients,
    };
}

/* Where the curve through these samples is refused: a sample from which they go back the way they came says more of
 * it. */
static void name_turn(const Vec3 *x, int count, Error *err)
{
    const double exactly = 1e-12;
    for (int i = 1; i + 1 < count; i++) {
        Vec3 before = vec3_unit(vec3_sub(x[i], x[i - 1])), after = vec3_unit(vec3_sub(x[i + 1], x[i]));
        if (1 + vec3_dot(before, after) > exactly) continue;
        rod_curve_refuse_turn(x[i], chords(x, count), err);
        return;
    }
}

bool rod_samples_curve(const Vec3 *x, int count, const RodSamplesDef *def, int elements, RodCurve *curve,
                       RodSamplesInfo *info, Error *err)
{
    const double longest = 3; /* times the chords: half a turn between samples is 1.6 */
    *curve = (RodCurve){0};
    if (def->noise < 0 || isinf(def->noise))
        return error_set(err, "the noise of a rod's samples is %g m; it must be finite and not negative",
                         def->noise);
    Vec3 *kept = mem_alloc((size_t)count + 1, sizeof *kept);
    int n = differing(x, count, kept, err);
    bool ok = n > 0;
    if (ok) {
        RodSpline spline = fit(kept, n, fit_noise(def, n));
        ok = rod_curve_create_pieces(rod_spline_jet, &spline, spline.intervals, elements, curve, err);
        if (!ok) name_turn(kept, n, err);
        double longer = ok ? curve->length / chords(kept, n) : 0;
        if (longer > longest) {
            ok = error_set(
                err,
                "the smooth curve through these samples is %.3g times as long as their chords: it needs more "
                "samples where long chords meet short ones",
                longer);
            rod_curve_clear(curve);
        }
        if (info) *info = report(&spline);
        rod_spline_clear(&spline);
    }
    mem_free(kept);
    return ok;
}

/* Each coordinate off by as much, by even chances. */
static bool draw(const RodSpline *spline, double noise, int elements, Random *random, RodCurve *curve,
                 Error *err)
{
    size_t points = (size_t)spline->points;
    Vec3 *y = mem_alloc(points, sizeof *y);
    for (size_t i = 0; i < points; i++) {
        Vec3 jet[3];
        double a = random_signed(random), b = random_signed(random), c = random_signed(random);
        rod_spline_jet((void *)spline, spline->u[i], jet);
        y[i] = vec3_axpy(sqrt(3) * noise, vec3(a, b, c), jet[0]);
    }
    RodSpline other = rod_spline_create(spline->u, y, spline->points, spline->intervals);
    rod_spline_fit(&other, spline->weight);
    bool ok = rod_curve_create_pieces(rod_spline_jet, &other, other.intervals, elements, curve, err);
    rod_spline_clear(&other);
    mem_free(y);
    return ok;
}

bool rod_samples_draw(const Vec3 *x, int count, const RodSamplesDef *def, int elements, RodDraws *draws,
                      Error *err)
{
    Vec3 *kept = mem_alloc((size_t)count + 1, sizeof *kept);
    int n = differing(x, count, kept, err);
    bool ok = n > 0;
    if (ok) {
        RodSpline spline = fit(kept, n, fit_noise(def, n));
        double noise = isnan(def->noise) ? report(&spline).noise : def->noise;
        if (noise > 0) draws->curves = mem_alloc((size_t)draws->wanted, sizeof *draws->curves);
        for (; noise > 0 && ok && draws->count < draws->wanted; draws->count += ok)
            ok = draw(&spline, noise, elements, &draws->random, &draws->curves[draws->count], err);
        rod_spline_clear(&spline);
    }
    mem_free(kept);
    return ok;
}

void rod_draws_clear(RodDraws *draws)
{
    for (int k = 0; k < draws->count; k++) rod_curve_clear(&draws->curves[k]);
    mem_free(draws->curves);
    *draws = (RodDraws){0};
}
