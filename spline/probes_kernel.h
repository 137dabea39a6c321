/* probes_kernel.h - the sums between points and the probes around them: the innermost loops of tone.
 *
 * Rows of cells are read in packs that may reach beyond the window: what is there is farther than every
 * radius, or no probe, and counts nothing. */
#pragma once
#include "spline/probes.h"
#include <math.h>

/* Rows [from, to) of each level: a part of the page, so that threads can share out what is written to probes;
 * and between which y the points are that its probes may see. */
typedef struct ProbeRows {
    int from[PROBES_MAX_LEVELS], to[PROBES_MAX_LEVELS];
    double low[PROBES_MAX_LEVELS], high[PROBES_MAX_LEVELS];
} ProbeRows;

/* Rows whose probes are at y in [from, to). */
static inline ProbeRows probe_rows(const Probes *probes, double from, double to)
{
    ProbeRows rows = {0};
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeLevel *level = &probes->levels[l];
        rows.from[l] = (int)fmin(fmax(ceil(from / level->dy - 0.5), 0), level->rows);
        rows.to[l] = (int)fmin(fmax(ceil(to / level->dy - 0.5), 0), level->rows);
        rows.low[l] = from - level->reach;
        rows.high[l] = to + level->reach;
    }
    return rows;
}

/* Cells of a level around a point. */
typedef struct ProbeWindow {
    int left, right, top, bottom; /* inclusive */
} ProbeWindow;

/* a within [low, high], cut to a whole number; low for NaN. The C library's fmin and fmax are calls. */
static inline int probe_index(double a, int low, int high)
{
    return a > low ? a < high ? (int)a : high : low;
}

/* Empty for a point that is nowhere. */
static inline ProbeWindow probe_window(const ProbeLevel *level, double x, double y)
{
    double left = ceil((x - level->reach) / level->dx - 0.5),
           right = floor((x + level->reach) / level->dx - 0.5);
    double top = ceil((y - level->reach) / level->dy - 0.5),
           bottom = floor((y + level->reach) / level->dy - 0.5);
    return (ProbeWindow){probe_index(left, 0, level->columns), probe_index(right, -1, level->columns - 1),
                         probe_index(top, 0, level->rows), probe_index(bottom, -1, level->rows - 1)};
}

/* Levels with a probe that sees the point, as bits; none for a point that is nowhere. */
static inline unsigned probe_levels(const Probes *probes, double x, double y)
{
    int i = probe_index(x / probes->tile_dx, 0, probes->tile_columns - 1);
    int j = probe_index(y / probes->tile_dy, 0, probes->tile_rows - 1);
    return probes->tiles[j * probes->tile_columns + i];
}

/* Distances x - x_c of a point to eight cells from column i on. */
static inline Pack probe_dx(const ProbeLevel *level, double x, int i)
{
    static const Pack lane = {0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5};
    return x - (lane + i) * level->dx;
}

/* 1 - d^2/R^2, 0 beyond R */
static inline Pack probe_closeness(Pack dx, double dy, Pack inverse)
{
    Pack z = 1 - (dx * dx + dy * dy) * inverse, zero = {0};
    return pack_select(z > zero, z, zero);
}

/* to += amount pi/4 W at each probe in the rows; seen: the point's probe_levels. */
static inline void probes_spread(const Probes *probes, const ProbeRows *rows, unsigned seen, double x,
                                 double y, double amount, double *to)
{
    for (int l = 0; seen >> l; l++) {
        if (!(seen >> l & 1) || y < rows->low[l] || y > rows->high[l]) continue;
        const ProbeLevel *level = &probes->levels[l];
        ProbeWindow w = probe_window(level, x, y);
        int top = w.top > rows->from[l] ? w.top : rows->from[l];
        int bottom = w.bottom < rows->to[l] ? w.bottom : rows->to[l] - 1;
        for (int j = top; j <= bottom; j++) {
            long row = level->first + (long)j * level->stride;
            double dy = y - (j + 0.5) * level->dy;
            for (int i = w.left; i <= w.right; i += PACK_LANES) {
                Pack inverse = pack_load(probes->inverse + row + i);
                Pack z = probe_closeness(probe_dx(level, x, i), dy, inverse);
                pack_store(to + row + i, pack_load(to + row + i) + amount * inverse * z * z * z);
            }
        }
    }
}

/* Sums over probes of force times pi/4 W at the point, and its derivatives there. */
typedef struct ProbeSums {
    double value, x, y, xx, xy, yy;
} ProbeSums;

/* Of one level; order 1 or 2. */
static inline void probes_gather_level(const Probes *probes, const ProbeLevel *level, double x, double y,
                                       const double *force, int order, Pack sum[6])
{
    ProbeWindow w = probe_window(level, x, y);
    for (int j = w.top; j <= w.bottom; j++) {
        long row = level->first + (long)j * level->stride;
        double dy = y - (j + 0.5) * level->dy;
        for (int i = w.left; i <= w.right; i += PACK_LANES) {
            Pack inverse = pack_load(probes->inverse + row + i), dx = probe_dx(level, x, i);
            Pack z = probe_closeness(dx, dy, inverse);
            Pack f = pack_load(force + row + i) * inverse, slope = f * inverse * z * z;
            sum[0] += f * z * z * z;
            sum[1] += slope * dx;
            sum[2] += slope * dy;
            if (order < 2) continue;
            Pack second = 4 * f * inverse * inverse * z;
            sum[3] += second * dx * dx - slope;
            sum[4] += second * dx * dy;
            sum[5] += second * dy * dy - slope;
        }
    }
}

static inline ProbeSums probes_gather(const Probes *probes, unsigned seen, double x, double y,
                                      const double *force, int order)
{
    Pack sum[6] = {{0}};
    for (int l = 0; seen >> l; l++)
        if (seen >> l & 1) probes_gather_level(probes, &probes->levels[l], x, y, force, order, sum);
    ProbeSums sums = {pack_sum(sum[0], PACK_LANES),
                      -6 * pack_sum(sum[1], PACK_LANES),
                      -6 * pack_sum(sum[2], PACK_LANES),
                      0,
                      0,
                      0};
    if (order < 2) return sums;
    sums.xx = 6 * pack_sum(sum[3], PACK_LANES);
    sums.xy = 6 * pack_sum(sum[4], PACK_LANES);
    sums.yy = 6 * pack_sum(sum[5], PACK_LANES);
    return sums;
}
