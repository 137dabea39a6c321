/* From a picture to a drawing: how long until its tone is that near to the picture's, by each method. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "spline/front/drawing.h"
#include "spline/metrics.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double goals[] = {0.05, 0.03, 0.02}; /* tone_rmse */
enum { GOALS = 3 };

typedef struct Race {
    SplineJudge *judge;
    double started, judging, limit; /* s */
    double reached[GOALS];          /* s; infinite: not reached */
    int iterations, every;          /* between judgements       */
} Race;

/* Time that goes into judging does not count. */
static bool judge(Race *race, const Strokes *strokes)
{
    double before = clock_seconds(), now = before - race->started - race->judging,
           error = spline_judge_tone(race->judge, strokes);
    for (int k = 0; k < GOALS; k++)
        if (error <= goals[k]) race->reached[k] = fmin(race->reached[k], now);
    race->judging += clock_seconds() - before;
    return isinf(race->reached[GOALS - 1]) && now < race->limit;
}

static bool watch(void *self, const RelaxInfo *info, const Strokes *strokes)
{
    (void)info;
    Race *race = self;
    return ++race->iterations % race->every != 0 || judge(race, strokes);
}

static Drawing *drawing_of(double pen, const char *start, const char *method)
{
    char text[500];
    Scene scene;
    snprintf(
        text, sizeof text,
        "slender: 1\njob: draw\nspline: {image: %s/scenes/images/sphere.png, page: {size: [100 mm, 100 mm], "
        "margin: 0}, pen: %.4g mm, start: %s, method: %s, rounds: 0}\n",
        SOURCE_DIR, 100 * pen, start, method);
    YamlFile *file = yaml_parse("bench_draw.yaml", text, strlen(text));
    Drawing *drawing =
        yaml_load(file, scene_table(), &scene) ? drawing_create(spline_scene(&scene), file) : NULL;
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return drawing;
}

static void run(double pen, const char *start, const char *method, int threads, double limit)
{
    Race race = {.started = clock_seconds(), .limit = limit, .every = 1};
    for (int k = 0; k < GOALS; k++) race.reached[k] = INFINITY;
    Drawing *d = drawing_of(pen, start, method);
    Strokes strokes = {0};
    SplineTarget *target;
    drawing_begin(d, 0, threads, &strokes, &target);
    double before = clock_seconds(), start_seconds = before - race.started;
    SplineGrid tone = spline_grid(&d->parts[0].tone);
    race.judge = spline_judge_create(&d->page, &tone);
    race.judging = clock_seconds() - before;
    int segments = strokes_segment_count(&strokes);
    char name[120];
    if (judge(&race, &strokes)) {
        double judging = race.judging;
        d->relax.threads = threads;
        RelaxInfo info = spline_relax(target, &d->relax, &strokes, &(RelaxObserver){watch, &race});
        snprintf(name, sizeof name, "draw_%d_segments_%s_%s_%d_threads_iteration", segments, start, method,
                 threads);
        bench_print(name, 1e3 * (info.seconds - (race.judging - judging)) / info.iterations, "ms");
    }
    snprintf(name, sizeof name, "draw_%d_segments_%s_%s_%d_threads_start", segments, start, method, threads);
    bench_print(name, start_seconds, "s");
    for (int k = 0; k < GOALS; k++) {
        snprintf(name, sizeof name, "draw_%d_segments_%s_%s_%d_threads_to_%g", segments, start, method,
                 threads, goals[k]);
        bench_print(name, race.reached[k], "s");
    }
    spline_judge_destroy(race.judge);
    spline_target_destroy(target);
    strokes_clear(&strokes);
    drawing_destroy(d);
}

void bench_draw(void)
{
    static const double pens[] = {0.006, 0.0021, 0.0007};
    for (int p = 0; p < 3; p++)
        for (int threads = 1; threads <= 2; threads++) {
            run(pens[p], "streamlines", "auto", threads, 100);
            run(pens[p], "random", "auto", threads, 100);
        }
    for (int p = 0; p < 2; p++) run(pens[p], "random", "monte_carlo", 1, 60);
    for (int p = 0; p < 2; p++) run(pens[p], "random", "gradient", 1, 60);
    run(pens[0], "random", "newton", 1, 60);
    run(pens[0], "random", "dynamics", 1, 60);
}
