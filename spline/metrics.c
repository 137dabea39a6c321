#include "spline/metrics.h"
#include "base/memory.h"
#include "spline/coverage.h"
#include "spline/smooth.h"
#include "spline/spacing.h"
#include <string.h>

/* Blurred pictures are kept on blocks of a sixth of sigma: there is nothing finer in them. */
static const double BLOCKS_PER_SIGMA = 6;

enum { BLOCKS_LEAST = 16, BLOCKS_MOST = 2000 };

struct SplineJudge {
    SplinePage page;
    double target_mean;
    Coverage coverage;
    double sigma[2];       /* of the blur, blocks */
    double *target, *tone; /* [rows][columns] blurred: the target, the last drawing */
    SplineSpacing spacing;
};

static int block_count(double length, double sigma)
{
    return (int)fmin(fmax(ceil(BLOCKS_PER_SIGMA * length / sigma), BLOCKS_LEAST), BLOCKS_MOST);
}

/* Sigma in blocks, less what averaging over a block has blurred already. */
static double block_sigma(double sigma, double length, int blocks)
{
    double wide = sigma * blocks / length;
    return sqrt(fmax(wide * wide - 1.0 / 12, 0));
}

static double grid_mean(const SplineGrid *grid)
{
    double sum = 0;
    size_t pixels = (size_t)grid->columns * (size_t)grid->rows;
    for (size_t k = 0; k < pixels; k++) sum += grid->values[k * (size_t)grid->width];
    return sum / (double)pixels;
}

SplineJudge *spline_judge_create(const SplinePage *page, const SplineGrid *target)
{
    SplineJudge *judge = mem_alloc(1, sizeof *judge);
    judge->page = *page;
    judge->target_mean = grid_mean(target);
    double sigma = 1.5 * page->pen / fmax(judge->target_mean, 1e-3);
    int columns = block_count(page->width, sigma), rows = block_count(page->height, sigma);
    judge->coverage = coverage_create(page, columns, rows);
    judge->sigma[0] = block_sigma(sigma, page->width, columns);
    judge->sigma[1] = block_sigma(sigma, page->height, rows);
    size_t blocks = (size_t)columns * (size_t)rows;
    judge->target = mem_alloc(blocks, sizeof(double));
    judge->tone = mem_alloc(blocks, sizeof(double));
    smooth_resample(target, columns, rows, judge->target);
    smooth_blur(judge->target, columns, rows, judge->sigma, SMOOTH_MIRROR);
    judge->spacing = spacing_create(page, target);
    return judge;
}

void spline_judge_destroy(SplineJudge *judge)
{
    if (!judge) return;
    coverage_clear(&judge->coverage);
    spacing_clear(&judge->spacing);
    mem_free(judge->target);
    mem_free(judge->tone);
    mem_free(judge);
}

static size_t block_total(const SplineJudge *judge)
{
    return (size_t)judge->coverage.columns * (size_t)judge->coverage.rows;
}

static void blur(const SplineJudge *judge, double *values)
{
    smooth_blur(values, judge->coverage.columns, judge->coverage.rows, judge->sigma, SMOOTH_MIRROR);
}

static void find_tone(SplineJudge *judge, const Strokes *strokes)
{
    coverage_draw(&judge->coverage, strokes, judge->page.pen);
    memcpy(judge->tone, judge->coverage.mean, block_total(judge) * sizeof *judge->tone);
    blur(judge, judge->tone);
}

/* Root mean square of scale*tone - target. */
static double tone_difference(const SplineJudge *judge, double scale)
{
    double sum = 0;
    for (size_t k = 0; k < block_total(judge); k++) {
        double d = scale * judge->tone[k] - judge->target[k];
        sum += d * d;
    }
    return sqrt(sum / (double)block_total(judge));
}

static double best_scale(const SplineJudge *judge)
{
    double both = 0, tone = 0;
    for (size_t k = 0; k < block_total(judge); k++) {
        both += judge->tone[k] * judge->target[k];
        tone += judge->tone[k] * judge->tone[k];
    }
    return tone > 0 ? both / tone : 0;
}

/* Of light, not of ink: white is 1. */
static double structural_similarity(const SplineJudge *judge)
{
    enum { TONE, TARGET, TONE_TONE, TARGET_TARGET, BOTH, COUNT };
    double *mean[COUNT], sum = 0;
    size_t total = block_total(judge);
    for (int m = 0; m < COUNT; m++) mean[m] = mem_alloc(total, sizeof(double));
    for (size_t k = 0; k < total; k++) {
        double a = 1 - judge->tone[k], b = 1 - judge->target[k];
        mean[TONE][k] = a;
        mean[TARGET][k] = b;
        mean[TONE_TONE][k] = a * a;
        mean[TARGET_TARGET][k] = b * b;
        mean[BOTH][k] = a * b;
    }
    for (int m = 0; m < COUNT; m++) blur(judge, mean[m]);
    for (size_t k = 0; k < total; k++) {
        double a = mean[TONE][k], b = mean[TARGET][k];
        double spread = mean[TONE_TONE][k] - a * a + mean[TARGET_TARGET][k] - b * b;
        sum += (2 * a * b + 1e-4) * (2 * (mean[BOTH][k] - a * b) + 9e-4) /
               ((a * a + b * b + 1e-4) * (spread + 9e-4));
    }
    for (int m = 0; m < COUNT; m++) mem_free(mean[m]);
    return sum / (double)total;
}

static double block_mean(const SplineJudge *judge)
{
    double sum = 0;
    for (size_t k = 0; k < block_total(judge); k++) sum += judge->coverage.mean[k];
    return sum / (double)block_total(judge);
}

/* From the end of each stroke to the beginning of the next. */
static double travel(const Strokes *strokes)
{
    double sum = 0;
    for (int k = 1; k < strokes->count; k++) {
        const double *from = strokes->q + 4 * (strokes->start[k] - 1), *to = from + 4;
        sum += hypot(to[0] - from[0], to[1] - from[1]);
    }
    return sum;
}

double spline_judge_tone(SplineJudge *judge, const Strokes *strokes)
{
    find_tone(judge, strokes);
    return tone_difference(judge, 1);
}

SplineMetrics spline_judge_measure(SplineJudge *judge, const Strokes *strokes)
{
    SplineMetrics metrics = {.ink_length = strokes_length(strokes),
                             .ink_budget = judge->target_mean / judge->page.pen,
                             .target = judge->target_mean};
    find_tone(judge, strokes);
    metrics.ink = block_mean(judge);
    metrics.tone_rmse = tone_difference(judge, 1);
    metrics.tone_scaled = tone_difference(judge, best_scale(judge));
    metrics.ssim = structural_similarity(judge);
    spacing_measure(&judge->spacing, strokes, &metrics.spacing_mean, &metrics.spacing_cv, &metrics.crowded);
    if (metrics.ink_length > 0) metrics.travel_over_ink = travel(strokes) / metrics.ink_length;
    return metrics;
}
