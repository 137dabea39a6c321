/* The row of drawings: a body without cases, which has its own job. */
#include "base/memory.h"
#include "spline/drawn.h"
#include "spline/front/front.h"
#include "spline/front/plot_time.h"

/* What says how a pen is lifted needs the file that says so. */
static bool check_plotter(const Scene *scene, YamlFile *file)
{
    if (spline_scene(scene)->plotter.z && !scene->output.gcode)
        return yaml_refuse(file, "spline.plotter.z",
                           "this is for the file `output.gcode`, which has no name");
    return !spline_scene(scene)->plotter.servo || scene->output.gcode_servo ||
           yaml_refuse(file, "spline.plotter.servo",
                       "this is for the file `output.gcode_servo`, which has no name");
}

static bool create(Model *model, const Scene *scene, YamlFile *file)
{
    if (!check_plotter(scene, file)) return false;
    Drawing *d = model->self = drawing_create(spline_scene(scene), file);
    if (d && scene->output.gcode) d->timed.lift = plotter_z_lift(&d->plotter);
    return d && (d->at_most == 0 || drawing_fit_time(d, file));
}

static void destroy(void *self)
{
    drawing_destroy(self);
}

static void add_static(const Model *model, Arrays *list)
{
    drawing_add_static(model->self, list);
}

static char *describe_times(const Drawing *d)
{
    PlotTime time = drawing_foretell(d);
    char *text =
        mem_format("to plot: about %.3g min, %.3g m of ink in %d strokes, %.3g m with the pen lifted\n",
                   time.seconds / 60, 1e-3 * time.ink, time.strokes, 1e-3 * time.travel);
    char *thinned = drawing_thinned(d);
    char *work = d->relax.method == RELAX_AUTO
                     ? mem_format("to compute: about %.2g s by one thread\n", drawing_work_time(d))
                     : mem_text("to compute: only method auto is foretold\n");
    text = mem_join(text, thinned, "");
    text = mem_join(text, work, "");
    mem_free(thinned);
    mem_free(work);
    return text;
}

static char *describe(const Model *model, const Scene *scene)
{
    (void)scene;
    const Drawing *d = model->self;
    const SplinePage *page = &d->page;
    char *text = mem_format("%d pen%s; %.4g x %.4g mm within margins of %.4g mm\n", d->pen_count,
                            d->pen_count == 1 ? "" : "s", 1e3 * page->unit * page->width,
                            1e3 * page->unit * page->height, 1e3 * page->left);
    for (int k = 0; k < d->part_count; k++) {
        const DrawingPart *part = &d->parts[k];
        SplineGrid tone = spline_grid(&part->tone);
        double mean = spline_grid_mean(&tone, 0);
        char *line = mem_format("%s, %.3g mm: covers %.3g of the page, %.3g m of ink, about %.0f segments\n",
                                d->pens[part->pen].name, 1e3 * page->unit * part->page.pen, mean,
                                page->unit * mean / part->page.pen, drawing_segments(part));
        text = mem_join(text, line, "");
        mem_free(line);
    }
    if (d->layer_count > d->pen_count) {
        char *line = mem_format("contours, %.3g mm: %.3g m of ink in %d strokes\n",
                                1e3 * page->unit * d->pens[d->pen_count].width,
                                page->unit * strokes_length(&d->contours), d->contours.count);
        text = mem_join(text, line, "");
        mem_free(line);
    }
    char *times = describe_times(d);
    text = mem_join(text, times, "");
    mem_free(times);
    return text;
}

static bool write_drawing(Result *result, const char *language, const char *path, bool *written, Error *err)
{
    Drawn drawn;
    *written = drawn_has(result);
    if (!*written) return true;
    bool ok = drawn_read(result, &drawn, err) && drawn_write(&drawn, language, path, err);
    drawn_clear(&drawn);
    return ok;
}

static const BodyOps ops = {
    .create = create,
    .destroy = destroy,
    .add_static = add_static,
    .describe = describe,
    .write = write_drawing,
};

static const KeyUse uses[] = {
    {"flux_density", "!spline"}, {"fix", "!spline"}, {"loads", "!spline"}, {"modes", "!spline"}, {0},
};

static const JobRow *const jobs[] = {&spline_job_draw, NULL};

const BodyRow spline_body = {
    .key = "spline",
    .noun = "a drawing",
    .nouns = "drawings",
    .doc = "no body, but a drawing",
    .table = &spline_table,
    .uses = uses,
    .jobs = jobs,
    .ops = &ops,
};
