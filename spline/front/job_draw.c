/* Line art: each part's strokes start, relax and are refined; together they are put in the order in which a
 * plotter draws them, and judged.
 *
 * The journal keeps every part's strokes as they are after each round (kind "state"): a run that goes on does
 * so from there, and ends with the same bits. What readers of results see (kind "final") is put at the same
 * times. */
#include "base/clock.h"
#include "base/memory.h"
#include "job/run.h"
#include "spline/film.h"
#include "spline/front/final.h"
#include "spline/front/front.h"
#include "spline/metrics.h"
#include "spline/revise.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* How far a part has come; kept as the numbers it is. */
typedef struct Part {
    double rounds;           /* done after the first relaxation; -1: not even that */
    double better;           /* did the last one lower the energy?                 */
    double iteration, clock; /* of the whole job, when it was done; s              */
    double status, iterations, evaluations, factorizations, seconds, energy, gradient_max, kinetic,
        temperature, acceptance, energies[SPLINE_WEIGHT_COUNT]; /* RelaxInfo */
} Part;

enum { PART_NUMBERS = sizeof(Part) / sizeof(double) };

typedef struct DrawJob {
    Run *run;
    const Drawing *d;
    RelaxDef relax;
    Strokes *strokes; /* [parts] */
    Part *parts;      /* [parts] */
    int part, iteration;
    SplineTarget *target;
    SplineJudge *judge; /* of the part, where progress is shown */
    double started, judged, cost, tone;
    bool failed, refused;
    Error *err;
} DrawJob;

/* ---- State ---- */

static RelaxInfo info_of(const Part *part)
{
    RelaxInfo info = {(RelaxStatus)part->status,
                      (int)part->iterations,
                      (int)part->evaluations,
                      (int)part->factorizations,
                      part->seconds,
                      part->energy,
                      .gradient_max = part->gradient_max,
                      .kinetic = part->kinetic,
                      .temperature = part->temperature,
                      .acceptance = part->acceptance};
    memcpy(info.energies, part->energies, sizeof info.energies);
    return info;
}

static void take_info(Part *part, const RelaxInfo *info)
{
    part->status = info->status, part->iterations = info->iterations, part->evaluations = info->evaluations;
    part->factorizations = info->factorizations, part->seconds = info->seconds, part->energy = info->energy;
    part->gradient_max = info->gradient_max, part->kinetic = info->kinetic;
    part->temperature = info->temperature, part->acceptance = info->acceptance;
    memcpy(part->energies, info->energies, sizeof part->energies);
}

static bool put_part(DrawJob *job)
{
    static const int none[] = {0};
    const Strokes *strokes = &job->strokes[job->part];
    int nodes = strokes_node_count(strokes);
    Arrays list = {0};
    char *names[3];
    for (int k = 0; k < 3; k++) {
        static const char *const what[] = {"part", "nodes", "strokes"};
        names[k] = arrays_keep(&list, mem_format("%s/%d", what[k], job->part));
    }
    arrays_add(&list, array_float(names[0], "", &job->parts[job->part].rounds, 1, PART_NUMBERS, 0));
    arrays_add(&list, array_float(names[1], "", strokes->q, 2, nodes, 4));
    arrays_add(&list, array_int(names[2], strokes->count ? strokes->start : none, 1, strokes->count + 1, 0));
    return arrays_put(&list, job->run->journal, "state", 0, job->err);
}

/* One array of the part's state; its data is NULL where there is none. */
static bool get_array(const DrawJob *job, const char *what, ArrayType type, Array *array)
{
    char name[32];
    snprintf(name, sizeof name, "%s/%d", what, job->part);
    if (!journal_find(job->run->journal, "state", 0, name, array, job->err)) return false;
    if (array->data && array->type != type) array_clear(array);
    return true;
}

static void take_part(DrawJob *job, const Array *part, const Array *nodes, const Array *start)
{
    const int *first = start->data;
    const double(*q)[4] = (const double(*)[4])nodes->data;
    memcpy(&job->parts[job->part], part->data, sizeof(Part));
    for (int k = 0; k + 1 < start->dims[0]; k++)
        strokes_add(&job->strokes[job->part], first[k + 1] - first[k], q + first[k],
                    job->d->parts[job->part].pen);
    job->started = clock_seconds() - job->parts[job->part].clock;
}

/* *has: the part is known from an earlier run. False where the journal cannot be read. */
static bool get_part(DrawJob *job, bool *has)
{
    Array part = {0}, nodes = {0}, start = {0};
    bool ok = get_array(job, "part", ARRAY_FLOAT64, &part) &&
              get_array(job, "nodes", ARRAY_FLOAT64, &nodes) &&
              get_array(job, "strokes", ARRAY_INT32, &start);
    *has = ok && part.data && array_count(&part) == PART_NUMBERS && nodes.data && start.data;
    if (*has) take_part(job, &part, &nodes, &start);
    array_clear(&part);
    array_clear(&nodes);
    array_clear(&start);
    return ok;
}

/* Iterations count on from the last that any part has kept: a run with more rounds writes over none of them. */
static bool find_iteration(DrawJob *job)
{
    bool ok = true;
    for (job->part = 0; ok && job->part < job->d->part_count; job->part++) {
        Array part = {0};
        ok = get_array(job, "part", ARRAY_FLOAT64, &part);
        if (ok && part.data && array_count(&part) == PART_NUMBERS) {
            double last = ((const Part *)part.data)->iteration;
            if (last > job->iteration) job->iteration = (int)last;
        }
        array_clear(&part);
    }
    return ok;
}

/* A run that goes on has the tones that it began with: with `at_most` they follow from the plotter's speeds. */
static bool keeps_tones(DrawJob *job)
{
    static const char *const kind = "state", *const name = "thinned";
    Array kept = {0}, own = array_float(name, "", &job->d->thinned, 0, 0, 0);
    if (!journal_find(job->run->journal, kind, 0, name, &kept, job->err)) return false;
    if (!kept.data) return journal_put(job->run->journal, kind, 0, &own, 1, job->err);
    bool same = kept.type == ARRAY_FLOAT64 && *(const double *)kept.data == job->d->thinned;
    array_clear(&kept);
    job->refused = !same;
    return same ||
           error_set(job->err,
                     "with --resume the plotter's speeds may not change where its `at_most` counts on them");
}

/* ---- Progress ---- */

/* The tone's error now and then: no more than a twentieth of the time goes into it, by one thread. */
static void judge(DrawJob *job, const Strokes *strokes)
{
    double now = clock_seconds();
    if (!job->judge || now - job->judged < fmax(0.5, 20 * job->cost)) return;
    job->tone = spline_judge_tone(job->judge, strokes);
    job->judged = clock_seconds();
    job->cost = job->judged - now;
}

/* Strokes of the parts that are done and of the one at work, for their pens. */
static Strokes all_so_far(const DrawJob *job, const Strokes *strokes)
{
    Strokes all = {0};
    for (int k = 0; k <= job->part; k++)
        strokes_append(&all, k < job->part ? &job->strokes[k] : strokes, job->d->parts[k].pen);
    drawing_add_contours(job->d, &all);
    return all;
}

/* Does a cadence fall on this iteration? */
static bool is_due(const DrawJob *job, int every)
{
    return every > 0 && job->iteration % every == 0;
}

static bool put_film(DrawJob *job, const Strokes *strokes)
{
    if (!is_due(job, job->run->scene->output.film)) return true;
    Strokes all = all_so_far(job, strokes);
    bool ok = film_put(job->run->journal, &job->d->page, &all, job->iteration, job->err);
    strokes_clear(&all);
    return ok;
}

static bool write_svg(DrawJob *job, const Strokes *strokes)
{
    if (!is_due(job, job->run->scene->output.every)) return true;
    char *name = mem_format("%.*s-%06d.svg", (int)(strlen(job->run->result) - strlen(".vtkhdf")),
                            job->run->result, job->iteration);
    Strokes all = all_so_far(job, strokes);
    Plot plot = spline_plot(&all, &job->d->page, job->d->pens, job->d->layer_count, job->d->paper);
    bool ok = plot_write_svg(name, &plot, job->err);
    spline_plot_clear(&plot);
    strokes_clear(&all);
    mem_free(name);
    return ok;
}

static bool put_evaluation(DrawJob *job, const RelaxInfo *info, const Strokes *strokes)
{
    double now = clock_seconds() - job->started, count = strokes->count;
    Array row[] = {array_float("energy", "", &info->energy, 0, 0, 0),
                   array_float("strokes", "", &count, 0, 0, 0), array_float("seconds", "s", &now, 0, 0, 0)};
    return journal_put(job->run->journal, "evaluation", job->iteration, row, 3, job->err);
}

/* Of each iteration of a relaxation. */
static bool watch(void *self, const RelaxInfo *info, const Strokes *strokes)
{
    DrawJob *job = self;
    const Drawing *d = job->d;
    int done = (int)fmax(job->parts[job->part].rounds + 1, 0);
    job->iteration++;
    job->failed = !put_evaluation(job, info, strokes) || !write_svg(job, strokes) || !put_film(job, strokes);
    judge(job, strokes);
    double ink = job->judge ? strokes_length(strokes) / fmax(spline_ink_budget(job->target), 1e-30) : 0;
    host_step(job->run->host, job->part * (d->rounds + 1) + done, d->part_count * (d->rounds + 1),
              "iteration %d, energy %.5g, tone error %.4f, ink %.3f", job->iteration, info->energy, job->tone,
              ink);
    return !job->failed && !host_stops(job->run->host);
}

/* ---- A part ---- */

/* After a round: false where it was stopped. */
static bool keep(DrawJob *job, const RelaxInfo *info, bool better)
{
    Part *part = &job->parts[job->part];
    take_info(part, info);
    if (info->status == RELAX_STOPPED) return false;
    part->rounds++;
    part->better = better;
    part->iteration = job->iteration;
    part->clock = clock_seconds() - job->started;
    job->failed =
        !put_part(job) || !draw_put_strokes(job->run, job->d, job->strokes, job->part + 1, job->err);
    return !job->failed;
}

/* False where it was stopped. */
static bool relax_part(DrawJob *job)
{
    const Drawing *d = job->d;
    Strokes *strokes = &job->strokes[job->part];
    Part *part = &job->parts[job->part];
    RelaxObserver observer = {watch, job};
    *part = (Part){.rounds = -1};
    bool going;
    job->failed = !get_part(job, &going);
    if (job->failed) return false;
    drawing_begin(d, job->part, job->run->threads, going ? NULL : strokes, &job->target);
    if (!going) {
        job->failed = job->part == 0 && !put_film(job, strokes); /* as it starts */
        if (job->failed) return false;
        RelaxInfo info = spline_relax(job->target, &job->relax, strokes, &observer);
        going = keep(job, &info, true);
    }
    while (going && part->better != 0 && part->rounds < d->rounds) {
        RelaxInfo info = info_of(part);
        bool better =
            spline_refine_once(job->target, &job->relax, d->start.segments, strokes, &info, &observer);
        going = keep(job, &info, better);
    }
    return going;
}

static bool run_part(DrawJob *job, int part)
{
    const DrawingPart *from = &job->d->parts[part];
    SplineField left = drawing_part_left(job->d, part);
    SplineGrid tone = spline_grid(&left);
    job->part = part;
    job->target = NULL;
    if (job->run->host->step) job->judge = spline_judge_create(&from->page, &tone);
    job->judged = 0;
    spline_field_clear(&left);
    bool going = relax_part(job);
    spline_judge_destroy(job->judge);
    job->judge = NULL;
    spline_target_destroy(job->target);
    return going;
}

/* ---- The job ---- */

/* All energies, and the worst status: the first in the order of this list that any part ended with. */
static RelaxInfo sum_up(const DrawJob *job)
{
    static const RelaxStatus order[] = {RELAX_STOPPED,        RELAX_NOT_FINITE, RELAX_STALLED,
                                        RELAX_MAX_ITERATIONS, RELAX_SETTLED,    RELAX_CONVERGED};
    RelaxInfo sum = {.status = RELAX_CONVERGED};
    int worst = 5;
    for (int k = 0; k < job->d->part_count; k++) {
        RelaxInfo info = info_of(&job->parts[k]);
        sum.energy += info.energy;
        sum.iterations += info.iterations;
        for (int t = 0; t < SPLINE_WEIGHT_COUNT; t++) sum.energies[t] += info.energies[t];
        for (int i = 0; i < worst; i++)
            if (info.status == order[i]) worst = i;
    }
    sum.status = order[worst];
    return sum;
}

/* Monte Carlo, dynamics and drafts end when they have done what they were told. */
static bool has_ended_well(const RelaxInfo *info, const Drawing *d)
{
    bool counted = d->relax.method == RELAX_MONTE_CARLO || d->relax.method == RELAX_DYNAMICS || d->draft;
    return info->status == RELAX_CONVERGED || info->status == RELAX_SETTLED ||
           (counted && info->status == RELAX_MAX_ITERATIONS);
}

static RunStatus run_draw(Run *run, Error *err)
{
    const Drawing *d = run->model->self;
    DrawJob job = {.run = run, .d = d, .relax = d->relax, .started = clock_seconds(), .err = err};
    job.relax.threads = run->threads;
    job.strokes = mem_alloc((size_t)d->part_count, sizeof *job.strokes);
    job.parts = mem_alloc((size_t)d->part_count, sizeof *job.parts);
    bool going = keeps_tones(&job) && find_iteration(&job);
    job.failed = !going;
    for (int k = 0; going && k < d->part_count; k++) going = run_part(&job, k);
    RelaxInfo info = sum_up(&job);
    bool interrupted = !going && !job.failed;
    bool ok = !job.failed && draw_finish(run, d, job.strokes, &info,
                                         interrupted ? "interrupted" : relax_status_name(info.status), err);
    if (ok && !interrupted && !has_ended_well(&info, d))
        host_say(run->host, "%s", relax_status_text(info.status));
    for (int k = 0; k < d->part_count; k++) strokes_clear(&job.strokes[k]);
    mem_free(job.strokes);
    mem_free(job.parts);
    if (!ok) return job.refused ? RUN_REFUSED : RUN_CANNOT_WRITE;
    return interrupted ? RUN_INTERRUPTED : has_ended_well(&info, d) ? RUN_DONE : RUN_NOT_CONVERGED;
}

static const char *const free_keys[] = {"output",
                                        "spline.rounds",
                                        "spline.order",
                                        "spline.plotter.down",
                                        "spline.plotter.up",
                                        "spline.plotter.lift",
                                        "spline.plotter.z",
                                        "spline.plotter.servo",
                                        NULL};

const JobRow spline_job_draw = {
    .name = "draw",
    .noun = "a drawing",
    .run = run_draw,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
};
