/* The row of drawings: a body without cases, which has its own job. */
#include "base/memory.h"
#include "io/scan.h"
#include "spline/drawn.h"
#include "spline/front/front.h"
#include "spline/front/plot_time.h"

/* What says how a pen is lifted needs a file that says so. */
static bool check_plotter(const Scene *scene, YamlFile *file)
{
    const PlotterScene *plotter = &spline_scene(scene)->plotter;
    const OutputScene *output = &scene->output;
    if (plotter->profile && !output->plotter)
        return yaml_refuse(file, "spline.plotter.profile",
                           "this is for the file `output.plotter`, which has no name");
    if (output->plotter && !plotter->profile)
        return yaml_refuse(file, "output.plotter", "in whose words? Say `spline.plotter.profile`");
    if (plotter->z && !output->gcode && !output->plotter)
        return yaml_refuse(file, "spline.plotter.z",
                           "this is for the file `output.gcode`, which has no name");
    return !plotter->servo || output->gcode_servo || output->plotter ||
           yaml_refuse(file, "spline.plotter.servo",
                       "this is for the file `output.gcode_servo`, which has no name");
}

/* All of the drawable page must be within the machine's reach: strokes may be anywhere on it. */
static bool check_reach(const SplinePage *page, const PlotProfile *profile, Error *err)
{
    double paper[2] = {1e3 * page->paper[0], 1e3 * page->paper[1]}, left = 1e3 * page->left,
           top = 1e3 * page->top;
    return plot_profile_reaches(profile, paper, (Vec2){left, top}, err) &&
           plot_profile_reaches(profile, paper, (Vec2){paper[0] - left, paper[1] - top}, err);
}

/* Keeps its text; says whether its lifts are a z axis's. */
static bool read_profile(Drawing *d, const char *path, YamlFile *file, bool *by_z)
{
    PlotProfile profile = {0};
    Error err;
    size_t length;
    bool ok = scan_file(path, &d->profile, &length, &err) &&
              plot_profile_parse(path, d->profile, length, &profile, &err);
    *by_z = ok && plot_profile_lifts_by_z(&profile);
    if (ok && !check_reach(&d->page, &profile, &err)) ok = error_prefix(&err, "%s", path);
    plot_profile_clear(&profile);
    return ok || yaml_refuse(file, "spline.plotter.profile", "%s", err.text);
}

static bool create(Model *model, const Scene *scene, YamlFile *file)
{
    if (!check_plotter(scene, file)) return false;
    Drawing *d = model->self = drawing_create(spline_scene(scene), file);
    const char *profile = spline_scene(scene)->plotter.profile;
    bool by_z = false;
    if (d && profile && !read_profile(d, profile, file, &by_z)) return false;
    if (d && (scene->output.gcode || by_z)) d->timed.lift = plotter_z_lift(&d->plotter);
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
