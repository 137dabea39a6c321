#include "spline/front/drawing.h"
#include "base/memory.h"
#include "io/paper.h"
#include "spline/direction.h"
#include "spline/front/drawing_contours.h"
#include "spline/front/drawing_fields.h"
#include "spline/front/drawing_pens.h"
#include "spline/front/drawing_start.h"
#include "spline/front/plot_time.h"
#include "spline/tone_field.h"
#include <math.h>
#include <string.h>

enum { SEGMENTS_MAX = 3000000, DRAFT_LEAST = 10 };

static const double DRAFT_TIME = 2; /* s */

static const double REST_LEAST = 0.05; /* mean distances of lines */

/* ---- Page and parts ---- */

static bool read_page(const SplineScene *scene, YamlFile *file, SplinePage *page)
{
    const PageScene *from = &scene->page;
    double size[2];
    Error err;
    if (from->size.sides)
        memcpy(size, from->size.sides, sizeof size);
    else if (!paper_size(from->size.name, size, &err))
        return yaml_refuse(file, "spline.page.size", "%s", err.text);
    if (2 * from->margin > 0.95 * fmin(size[0], size[1]))
        return yaml_refuse(file, "spline.page.margin", "margins of %g m leave nothing of a page of %g x %g m",
                           from->margin, size[0], size[1]);
    *page = spline_page(size[0], size[1], from->margin, pens_finest(scene));
    return true;
}

/* The parts of a pen in a region, NULL: the page. Sets that cross share its tone. */
static void add_parts(Drawing *d, const SplineScene *scene, int pen, const DrawingRegion *region)
{
    const CrossScene *cross = scene->cross;
    int sets = cross ? cross->from_count : 1;
    SplineField *share = mem_alloc((size_t)sets, sizeof *share);
    SplineField tone = spline_field_copy(&d->tones[pen]);
    if (region) spline_field_multiply(&tone, &region->cover);
    if (cross)
        spline_tone_cross(&tone, sets, cross->from, share);
    else
        share[0] = spline_field_copy(&tone);
    d->parts = mem_resize(d->parts, (size_t)d->part_count, (size_t)(d->part_count + sets), sizeof *d->parts);
    for (int k = 0; k < sets; k++) {
        DrawingPart *part = &d->parts[d->part_count++];
        *part = (DrawingPart){.pen = pen,
                              .page = d->page,
                              .tone = share[k],
                              .direction =
                                  region && region->direction.columns ? &region->direction : &d->direction,
                              .outline = region ? &region->outline : NULL};
        part->page.pen = d->pens[pen].width;
        if (d->contours.count) part->counts = drawing_contours_counted(d, scene, pen, region, sets);
        part->turn = pens_turn(scene, d->pens, pen) + k * (cross ? cross->angle : 0);
    }
    spline_field_clear(&tone);
    mem_free(share);
}

/* All parts, and of each pen's tone what it draws. */
static void make_parts(Drawing *d, const SplineScene *scene)
{
    for (int pen = 0; pen < d->pen_count; pen++) {
        SplineField drawn = spline_field_like(&d->tones[pen], 1);
        for (int k = 0; k < d->region_count; k++) {
            if (d->regions[k].pen >= 0 && d->regions[k].pen != pen) continue;
            add_parts(d, scene, pen, &d->regions[k]);
            spline_field_add(&drawn, &d->regions[k].cover);
        }
        if (d->region_count == 0)
            add_parts(d, scene, pen, NULL);
        else
            spline_field_multiply(&d->tones[pen], &drawn);
        spline_field_clear(&drawn);
    }
}

static bool check_cross(const CrossScene *cross, YamlFile *file)
{
    for (int k = 1; cross && k < cross->from_count; k++)
        if (cross->from[k] < cross->from[k - 1])
            return yaml_refuse(file, "spline.cross.from",
                               "%g is below %g: the densities from which sets draw must grow", cross->from[k],
                               cross->from[k - 1]);
    return true;
}

double drawing_segments(const DrawingPart *part)
{
    SplineGrid tone = spline_grid(&part->tone);
    double distance = spline_line_distance(&tone, &part->page);
    return spline_grid_mean(&tone, 0) /
           (part->page.pen * spline_segment_length(relax_default().rest, distance));
}

/* What would take days, and more memory than there is, is refused. */
static bool check_size(const Drawing *d, YamlFile *file)
{
    double segments = 0;
    for (int k = 0; k < d->part_count; k++) segments += drawing_segments(&d->parts[k]);
    return segments <= SEGMENTS_MAX ||
           yaml_refuse(file, "spline.pen",
                       "so fine a pen takes about %.0f segments on this page, and %d are the most", segments,
                       SEGMENTS_MAX);
}

/* ---- Settings ---- */

/* Segments far shorter than the lines are apart take long, and say no more. */
static bool check_rest(double rest, YamlFile *file)
{
    return rest == 0 || rest >= REST_LEAST ||
           yaml_refuse(file, "spline.rest", "a rest length of %g is too short; say 0, or %g to 10", rest,
                       REST_LEAST);
}

static RelaxDef relax_def(const SplineScene *scene)
{
    RelaxDef def = relax_default();
    def.method = (RelaxMethod)scene->method;
    def.weights = scene->energies;
    if (!scene->regions_count) def.weights.outline = 0;
    def.model.pair_kernel = (PairKernel)scene->pair.kernel;
    def.model.pair_radius = scene->pair.radius;
    def.rest = scene->rest;
    def.max_iterations = scene->iterations;
    def.energy_tol = scene->tolerance;
    def.temperature_first = scene->monte_carlo.first;
    def.temperature_last = scene->monte_carlo.last;
    def.temperatures = scene->monte_carlo.temperatures;
    def.sweeps = scene->monte_carlo.sweeps;
    def.seed = (uint64_t)scene->seed;
    def.time_step = scene->dynamics.step;
    def.time_steps = scene->dynamics.steps;
    def.damping = scene->dynamics.damping;
    return def;
}

static SplineStartDef start_def(const SplineScene *scene, const SplinePage *page)
{
    SplineStartDef def = spline_start_default();
    const StrokesScene *from = &scene->start;
    if (!isnan(from->separation)) def.separation = from->separation;
    if (!isnan(from->longest)) def.longest = from->longest / page->unit;
    def.ink = from->ink;
    def.segments = from->segments;
    def.seed = (uint64_t)scene->seed;
    return def;
}

/* ---- The plotter ---- */

static bool read_command(const char *from, const char *at, YamlFile *file, char *to)
{
    if (plotter_is_command(from)) return strcpy(to, from), true;
    return yaml_refuse(file, at,
                       "a plotter's command is a letter and up to %d more letters, digits, spaces and . - + "
                       "_ =",
                       PLOTTER_COMMAND_MAX - 1);
}

static bool read_z_axis(const ZAxisScene *from, YamlFile *file, Plotter *to)
{
    to->z_up = 1e3 * from->up, to->z_down = 1e3 * from->down, to->z_speed = 1e3 * from->speed;
    return from->up != from->down ||
           yaml_refuse(file, "spline.plotter.z", "the pen is at %g mm when it is up and when it is down",
                       to->z_up);
}

static bool read_plotter(const PlotterScene *from, YamlFile *file, Plotter *to)
{
    const ServoScene *servo = from->servo;
    *to = plotter_default();
    to->down = 1e3 * from->down, to->up = 1e3 * from->up, to->lift = from->lift;
    if (servo) to->pause = servo->pause == PAUSE_MILLISECONDS ? 1e-3 : 1;
    return (!from->z || read_z_axis(from->z, file, to)) &&
           (!servo || (read_command(servo->up, "spline.plotter.servo.up", file, to->servo_up) &&
                       read_command(servo->down, "spline.plotter.servo.down", file, to->servo_down)));
}

/* ---- The whole ---- */

/* As many iterations as are foretold to fit, so that it is the same on every machine; a few there must be. */
static void make_draft(Drawing *d)
{
    d->draft = true;
    d->rounds = 0;
    int most = d->relax.max_iterations;
    for (d->relax.max_iterations = 0; d->relax.max_iterations < most; d->relax.max_iterations++)
        if (d->relax.max_iterations >= DRAFT_LEAST && drawing_work_time(d) > DRAFT_TIME) break;
}

static bool fill(Drawing *d, const SplineScene *scene, YamlFile *file)
{
    if (!check_cross(scene->cross, file) || !check_rest(scene->rest, file) ||
        !read_page(scene, file, &d->page) || !drawing_read_fields(d, scene, file))
        return false;
    make_parts(d, scene);
    d->relax = relax_def(scene);
    d->start = start_def(scene, &d->page);
    d->start_kind = (StrokesStart)scene->start.kind;
    if (scene->start.file && !drawing_read_start(d, scene, file)) return false;
    d->rounds = scene->rounds;
    d->order = (DrawOrder)scene->order;
    d->thinned = 1;
    d->at_most = isnan(scene->plotter.at_most) ? 0 : scene->plotter.at_most;
    if (!read_plotter(&scene->plotter, file, &d->plotter) || !check_size(d, file)) return false;
    d->timed = d->plotter;
    if (scene->draft) make_draft(d);
    return true;
}

Drawing *drawing_create(const SplineScene *scene, YamlFile *file)
{
    Drawing *d = mem_alloc(1, sizeof *d);
    if (fill(d, scene, file)) return d;
    drawing_destroy(d);
    return NULL;
}

void drawing_destroy(Drawing *d)
{
    if (!d) return;
    for (int k = 0; k < d->layer_count; k++) mem_free((char *)d->pens[k].name);
    for (int k = 0; d->tones && k < d->pen_count; k++) spline_field_clear(&d->tones[k]);
    for (int k = 0; k < d->part_count; k++) {
        spline_field_clear(&d->parts[k].tone);
        spline_field_clear(&d->parts[k].counts);
        strokes_clear(&d->parts[k].given);
    }
    for (int k = 0; k < d->region_count; k++) {
        spline_field_clear(&d->regions[k].cover);
        spline_field_clear(&d->regions[k].outline);
        spline_field_clear(&d->regions[k].direction);
    }
    SplineField *fields[] = {&d->direction, &d->potential, &d->flow, &d->picture,
                             &d->outline,   &d->contoured, &d->light};
    for (int k = 0; k < 7; k++) spline_field_clear(fields[k]);
    strokes_clear(&d->contours);
    mem_free(d->profile);
    mem_free(d->regions);
    mem_free(d->pens);
    mem_free(d->tones);
    mem_free(d->parts);
    mem_free(d);
}

/* ---- Contours ---- */

void drawing_add_contours(const Drawing *d, Strokes *strokes)
{
    strokes_append(strokes, &d->contours, d->pen_count);
}

static void take_contours(const Drawing *d, const SplineField *counts, SplineField *tone)
{
    for (int i = 0; d->contoured.columns && i < tone->columns * tone->rows; i++)
        tone->values[i] -= d->contoured.values[i] * (counts->columns ? counts->values[i] : 1);
}

SplineField drawing_part_left(const Drawing *d, int part)
{
    SplineField left = spline_field_copy(&d->parts[part].tone);
    take_contours(d, &d->parts[part].counts, &left);
    return left;
}

SplineField drawing_pen_left(const Drawing *d, int pen)
{
    SplineField left = spline_field_copy(&d->tones[pen]);
    for (int k = 0; k < d->part_count; k++)
        if (d->parts[k].pen == pen) take_contours(d, &d->parts[k].counts, &left);
    return left;
}

static SplineFixed fixed_of(const Drawing *d, int part)
{
    if (!d->contours.count) return (SplineFixed){0};
    return (SplineFixed){&d->contours, d->pens[d->pen_count].width, spline_grid(&d->parts[part].counts)};
}

/* ---- Parts at work ---- */

static SplineField direction_of(const Drawing *d, int part)
{
    SplineField direction = spline_field_copy(d->parts[part].direction);
    spline_direction_turn(&direction, d->parts[part].turn);
    return direction;
}

Strokes drawing_first_strokes(const Drawing *d, int part)
{
    const DrawingPart *from = &d->parts[part];
    if (d->start_given) return strokes_copy(&from->given);
    SplineField direction = direction_of(d, part);
    SplineGrid tone = spline_grid(&from->tone), along = spline_grid(&direction);
    Strokes strokes = {0};
    SplineStartDef def = d->start;
    def.seed += (uint64_t)part;
    def.fixed = fixed_of(d, part);
    if (from->outline) def.outline = spline_grid(from->outline);
    (d->start_kind == START_RANDOM ? spline_random_strokes : spline_streamlines)(&tone, &along, &from->page,
                                                                                 &def, from->pen, &strokes);
    spline_field_clear(&direction);
    return strokes;
}

/* Where the tone is light the potential is high. */
static SplineField brightness(const SplineField *tone)
{
    SplineField light = spline_field_copy(tone);
    for (int i = 0; i < light.columns * light.rows; i++) light.values[i] = 1 - light.values[i];
    return light;
}

static SplineTarget *target_of(const Drawing *d, int part, Workers *workers)
{
    const DrawingPart *from = &d->parts[part];
    SplineField direction = direction_of(d, part), light = brightness(&from->tone);
    SplineFields fields = {.density = spline_grid(&from->tone), .align = spline_grid(&direction)};
    ProbesDef probes = probes_default();
    probes.workers = workers;
    if (d->relax.weights.potential > 0)
        fields.potential = spline_grid(d->potential.columns ? &d->potential : &light);
    if (d->flow.columns) fields.flow = spline_grid(&d->flow);
    if (from->outline) fields.outline = spline_grid(from->outline);
    SplineTarget *target = spline_target_create(&from->page, &fields, &probes);
    SplineFixed fixed = fixed_of(d, part);
    spline_fixed_take_ink(&fixed, target);
    spline_field_clear(&direction);
    spline_field_clear(&light);
    return target;
}

typedef struct Begin {
    const Drawing *d;
    int part;
    Workers *workers; /* the target's */
    Strokes *strokes;
    SplineTarget **target;
} Begin;

static void begin_task(void *self, int k)
{
    const Begin *b = self;
    if (k == 0)
        *b->target = target_of(b->d, b->part, b->workers);
    else
        *b->strokes = drawing_first_strokes(b->d, b->part);
}

/* Strokes take one thread as long as the target takes it, more or less: with threads of its own beside that, the target
 * has what is left of them. */
void drawing_begin(const Drawing *d, int part, int threads, Strokes *strokes, SplineTarget **target)
{
    Workers *two = threads > 1 && strokes ? workers_create(2) : NULL;
    Workers *own = threads > 1 ? workers_create(threads) : NULL;
    Begin begin = {d, part, own, strokes, target};
    workers_run(two, strokes ? 2 : 1, begin_task, &begin);
    workers_destroy(two);
    workers_destroy(own);
}
