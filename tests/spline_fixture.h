/* spline_fixture.h - a shaded target and strokes that nobody needed to relax. */
#pragma once
#include "base/memory.h"
#include "base/random.h"
#include "spline/grid.h"
#include "spline/page.h"
#include "spline/strokes.h"
#include <string.h>

enum { FIXTURE_SIDE = 320, FIXTURE_LAYERS = 2 };

/* Density of a soft round spot on light ground, at a distance from the middle of a page of 1 x 1. */
static inline double fixture_density(double r)
{
    return 0.08 + 0.55 * exp(-r * r / 0.08);
}

/* The same as an image file would have it: 256 levels of grey, of which black is a density of 0.85. */
static inline double *fixture_image(void)
{
    double *values = mem_alloc(FIXTURE_SIDE * FIXTURE_SIDE, sizeof *values);
    for (int j = 0; j < FIXTURE_SIDE; j++) {
        for (int i = 0; i < FIXTURE_SIDE; i++) {
            double x = (i + 0.5) / FIXTURE_SIDE - 0.5, y = (j + 0.5) / FIXTURE_SIDE - 0.5;
            double grey = 1 - fixture_density(hypot(x, y)) / 0.85;
            values[j * FIXTURE_SIDE + i] = 0.85 * (1 - round(255 * grey) / 255);
        }
    }
    return values;
}

static inline SplineGrid fixture_grid(const double *values)
{
    return (SplineGrid){.columns = FIXTURE_SIDE, .rows = FIXTURE_SIDE, .width = 1, .values = values};
}

/* Room for so many nodes and strokes, to be filled with fixture_end. */
typedef struct FixtureStrokes {
    Strokes strokes;
    int nodes; /* of the stroke being made */
} FixtureStrokes;

static inline FixtureStrokes fixture_begin(int strokes, int nodes)
{
    return (FixtureStrokes){.strokes = {.start = mem_alloc((size_t)strokes + 1, sizeof(int)),
                                        .layer = mem_alloc((size_t)strokes, sizeof(int)),
                                        .q = mem_alloc(4 * (size_t)nodes, sizeof(double))}};
}

static inline void fixture_node(FixtureStrokes *made, double x, double y, double vx, double vy)
{
    double *q = made->strokes.q + 4 * (made->strokes.start[made->strokes.count] + made->nodes++);
    q[0] = x, q[1] = y, q[2] = vx, q[3] = vy;
}

/* The nodes since the last one are a stroke, if there are two. */
static inline void fixture_end(FixtureStrokes *made, int layer)
{
    Strokes *strokes = &made->strokes;
    if (made->nodes >= 2) {
        strokes->layer[strokes->count] = layer;
        strokes->start[strokes->count + 1] = strokes->start[strokes->count] + made->nodes;
        strokes->count++;
    }
    made->nodes = 0;
}

/* An arc about the middle of the page, in strokes of 4 to 12 segments with gaps of `gap` between them. */
static inline void fixture_arc(FixtureStrokes *made, Random *random, double r, double from, double to,
                               double gap)
{
    int segments = (int)ceil((to - from) * r / 0.02), left = 0;
    double step = (to - from) / segments, speed = 4.0 / 3 * tan(step / 4) * r;
    for (int k = 0; k <= segments; k++, left--) {
        for (int again = left == 0; again >= 0; again--) {
            double angle = from + k * step + (left == 0 && !again ? gap / r : 0);
            if (left == 0 && !again) {
                fixture_end(made, 0);
                left = 4 + (int)(8 * random_uniform(random));
                if (k == segments) return;
            }
            fixture_node(made, 0.5 + r * cos(angle), 0.5 + r * sin(angle), -speed * sin(angle),
                         speed * cos(angle));
        }
    }
    fixture_end(made, 0);
}

/* Rings about the middle of a page of 1 x 1 that have the density as their tone: where the integral of
 * density over r is a half of the pen, one and a half, .. */
static inline Strokes fixture_rings(double pen, double gap, uint64_t seed)
{
    const double step = 1e-5, quarter = acos(-1) / 2;
    Random random = random_seed(seed);
    FixtureStrokes made = fixture_begin((int)(60 / pen), (int)(600 / pen));
    double sum = 0.5 * pen;
    for (double r = step / 2; r < sqrt(0.5); r += step) {
        sum += fixture_density(r) * step;
        if (sum < pen) continue;
        sum -= pen;
        double cut = r > 0.5 ? acos(0.5 / r) : 0;
        for (int k = 0; k < 4; k++)
            fixture_arc(&made, &random, r, k * quarter + cut, (k + 1) * quarter - cut, gap);
    }
    return made.strokes;
}

/* Strokes that wander about within the page, with so many segments of that length each. */
static inline Strokes fixture_walks(const SplinePage *page, int count, int segments, double length,
                                    uint64_t seed)
{
    Random random = random_seed(seed);
    FixtureStrokes made = fixture_begin(count, count * (segments + 1));
    for (int k = 0; k < count; k++) {
        double edge = segments * length, x = edge + (page->width - 2 * edge) * random_uniform(&random);
        double y = edge + (page->height - 2 * edge) * random_uniform(&random);
        double angle = 3.14 * random_signed(&random);
        for (int s = 0; s <= segments; s++) {
            fixture_node(&made, x, y, length / 3 * cos(angle), length / 3 * sin(angle));
            double turned = angle + random_signed(&random);
            x += 0.5 * length * (cos(angle) + cos(turned));
            y += 0.5 * length * (sin(angle) + sin(turned));
            angle = turned;
        }
        fixture_end(&made, k % FIXTURE_LAYERS);
    }
    return made.strokes;
}
