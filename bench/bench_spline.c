/* Strokes at random on a shaded ball: energy and gradient, preconditioner, and a relaxation. */
#include "base/clock.h"
#include "base/memory.h"
#include "base/random.h"
#include "bench/bench.h"
#include "solve/system.h"
#include "spline/relax.h"
#include "spline/terms.h"
#include <math.h>
#include <stdio.h>

enum { PIXELS = 320, SEGMENTS = 5, REPEATS = 10 };

typedef struct Drawing {
    SplinePage page;
    double *density, *align;
    SplineTarget *target;
    Strokes strokes;
} Drawing;

/* A ball lit from above on a light ground; directions around its middle. */
static void set_pixel(Drawing *d, int i, int j)
{
    double x = (i + 0.5) / PIXELS - 0.5, y = (j + 0.5) / PIXELS - 0.5, r = hypot(x, y),
           *M = d->align + 3 * (j * PIXELS + i);
    double height = sqrt(fmax(0.16 - r * r, 0));
    d->density[j * PIXELS + i] = r < 0.4 ? 0.8 - 0.7 * fmax((height - x - y) / 0.7, 0) : 0.06;
    M[0] = x * x / (r * r), M[1] = x * y / (r * r), M[2] = y * y / (r * r);
}

static void add_strokes(Drawing *d)
{
    Random random = random_seed(1);
    double rest = 1.2 * d->target->spacing;
    int count = spline_stroke_budget(d->target, SEGMENTS, rest);
    while (d->strokes.count < count) {
        double x = random_uniform(&random), y = random_uniform(&random),
               angle = M_PI * random_signed(&random);
        double q[SEGMENTS + 1][4], c = rest * cos(angle), s = rest * sin(angle);
        int pixel = (int)(y * PIXELS) * PIXELS + (int)(x * PIXELS);
        if (random_uniform(&random) > d->density[pixel]) continue;
        for (int k = 0; k <= SEGMENTS; k++)
            q[k][0] = x + k * c, q[k][1] = y + k * s, q[k][2] = c / 3, q[k][3] = s / 3;
        double end_x = q[SEGMENTS][0], end_y = q[SEGMENTS][1];
        if (fmin(fmin(end_x, 1 - end_x), fmin(end_y, 1 - end_y)) > 0)
            strokes_add(&d->strokes, SEGMENTS + 1, (const double(*)[4])q, 0);
    }
}

static Drawing drawing_create(double pen)
{
    Drawing d = {.page = {.width = 1, .height = 1, .pen = pen}};
    d.density = mem_alloc(PIXELS * PIXELS, sizeof *d.density);
    d.align = mem_alloc(3 * PIXELS * PIXELS, sizeof *d.align);
    for (int j = 0; j < PIXELS; j++)
        for (int i = 0; i < PIXELS; i++) set_pixel(&d, i, j);
    SplineFields fields = {.density = {PIXELS, PIXELS, 1, d.density}, .align = {PIXELS, PIXELS, 3, d.align}};
    ProbesDef probes = probes_default();
    d.target = spline_target_create(&d.page, &fields, &probes);
    add_strokes(&d);
    return d;
}

static void drawing_clear(Drawing *d)
{
    strokes_clear(&d->strokes);
    spline_target_destroy(d->target);
    mem_free(d->density);
    mem_free(d->align);
}

static void print_for(const char *what, int segments, int threads, double value, const char *unit)
{
    char name[80];
    snprintf(name, sizeof name, "spline_%s_%d_segments_%d_threads", what, segments, threads);
    bench_print(name, value, unit);
}

static void time_tone(Drawing *d, int threads)
{
    SplineModelDef def = spline_model_default();
    def.workers = threads > 1 ? workers_create(threads) : NULL;
    int segments = strokes_segment_count(&d->strokes), dofs = 4 * strokes_node_count(&d->strokes);
    double *rest = mem_alloc((size_t)segments, sizeof *rest), *g = mem_alloc((size_t)dofs, sizeof *g),
           best = INFINITY;
    for (int k = 0; k < segments; k++) rest[k] = 1.2 * d->target->spacing;
    SplineModel *model = spline_model_create(d->target, &d->strokes, rest, &def);
    SplineWeights weights = spline_weights_scaled(spline_weights_default(), d->page.pen, d->target->spacing);
    Bulk tone = spline_tone_bulk(model, SPLINE_OWN);
    Point at = {.x = d->strokes.q, .p = (const double *)&weights};
    for (int k = 0; k < REPEATS; k++) {
        double start = clock_seconds();
        tone.ops->eval(tone.self, &at, g, NULL);
        best = fmin(best, clock_seconds() - start);
    }
    print_for("tone", segments, threads, 1e3 * best, "ms");
    tone.ops->destroy(tone.self);
    spline_model_destroy(model);
    workers_destroy(def.workers);
    mem_free(rest);
    mem_free(g);
}

void bench_spline(void)
{
    static const double pens[] = {0.006, 0.002, 0.0007};
    for (int p = 0; p < 3; p++) {
        Drawing d = drawing_create(pens[p]);
        for (int threads = 1; threads <= 2; threads++) time_tone(&d, threads);
        for (int threads = 1; p < 2 && threads <= 2; threads++) {
            Strokes strokes = strokes_copy(&d.strokes);
            RelaxDef def = relax_default();
            def.threads = threads;
            def.max_iterations = 200;
            RelaxInfo info = spline_relax(d.target, &def, &strokes, NULL);
            print_for("relax", strokes_segment_count(&strokes), threads, 1e3 * info.seconds / info.iterations,
                      "ms_per_iteration");
            strokes_clear(&strokes);
        }
        drawing_clear(&d);
    }
}
