#include "view/show_film.h"
#include "spline/film.h"
#include "spline/preview.h"
#include "view/animation.h"
#include "view/chart.h"
#include "view/page.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double HEADING = 18, FOOTER = 118, HIGHEST = 640, THUMB = 180; /* pt */
static const Color edge = {0.6, 0.6, 0.6, 1};

typedef struct FilmPage {
    ShowData *data;
    const Drawn *drawn;
    Film film;
    const char *title;
    Box paper, thumb, chart; /* on the page */
    double scale, height;    /* pt per mm of the paper; pt */
    Chart energy;
} FilmPage;

/* Energy of each iteration, which count from 1. */
static void read_energy(FilmPage *page)
{
    Array energy;
    ShowData *data = page->data;
    ChartSeries *series = show_block(data, 1, sizeof *series);
    if (result_has(data->result, "slender/history/energy") &&
        result_read_as(data->result, "slender/history/energy", ARRAY_FLOAT64, 1, 0, &energy, NULL)) {
        int count = (int)array_count(&energy);
        double *x = show_block(data, (size_t)count, sizeof *x);
        for (int k = 0; k < count; k++) x[k] = k + 1;
        *series = (ChartSeries){.name = "energy", .count = count, .x = x, .y = show_keep(data, energy)};
    }
    page->energy = (Chart){.x_label = "iteration",
                           .x_counts = true,
                           .x_high = series->count,
                           .y_label = "energy",
                           .series_count = 1,
                           .series = series};
}

static void lay_out(FilmPage *page)
{
    const double *paper = page->drawn->plot.paper; /* mm */
    double width = PAGE_WIDTH - 2 * PAGE_MARGIN,
           top = page_head_end((PageHead){.title = page->title}) + HEADING;
    page->scale = fmin(width / paper[0], HIGHEST / paper[1]);
    page->paper = (Box){PAGE_MARGIN, top, page->scale * paper[0], page->scale * paper[1]};
    double small = fmin(FOOTER / paper[1], THUMB / paper[0]);
    top += page->paper.height + PAGE_GAP;
    page->thumb = (Box){PAGE_MARGIN, top, small * paper[0], small * paper[1]};
    double left = PAGE_MARGIN + page->thumb.width + PAGE_GAP;
    page->chart = (Box){left, top, PAGE_WIDTH - PAGE_MARGIN - left, FOOTER};
    page->height = top + FOOTER + PAGE_MARGIN;
}

/* The frames of the film, and the drawing itself. */
static int frame_count(const FilmPage *page)
{
    return page->film.count + 1;
}

static void draw_page(Canvas *canvas, const FilmPage *page, int frame)
{
    bool end = frame == page->film.count;
    const Drawn *drawn = page->drawn;
    double iteration = end ? page->energy.x_high : film_iteration(&page->film, frame);
    char heading[64];
    snprintf(heading, sizeof heading, end ? "as drawn, after %.0f iterations" : "iteration %.0f", iteration);
    page_draw_head(canvas, (PageHead){.title = page->title});
    canvas_text(canvas, (Vec2){page->paper.x, page->paper.y - 6}, heading,
                (TextStyle){.color = page_ink, .size = 10, .bold = true});
    Plot plot = end ? drawn->plot : film_plot(&page->film, drawn, frame);
    preview_draw(canvas, &plot, (Vec2){page->paper.x, page->paper.y}, page->scale);
    if (!end) spline_plot_clear(&plot);
    canvas_frame(canvas, page->paper, (Pen){edge, 0.5, 0});
    SplineGrid target = spline_grid(&drawn->picture);
    preview_draw_target(canvas, &drawn->page, &target, (Vec2){page->thumb.x, page->thumb.y},
                        page->thumb.width / drawn->plot.paper[0]);
    canvas_frame(canvas, page->thumb, (Pen){edge, 0.5, 0});
    Chart energy = page->energy;
    energy.marks = &iteration, energy.mark_count = 1;
    chart_draw(canvas, &energy, page->chart);
}

static Canvas *make_page(const FilmPage *page, const char *path, int frame, Error *err)
{
    double resolution = page->data->def->width / page->paper.width;
    Canvas *canvas = canvas_create(path, PAGE_WIDTH, page->height, resolution, err);
    if (canvas) draw_page(canvas, page, frame);
    return canvas;
}

static bool write_frame(const FilmPage *page, const char *picture, int frame, Error *err)
{
    Canvas *canvas = make_page(page, picture, frame, err);
    bool ok = canvas && canvas_save(canvas, err);
    canvas_destroy(canvas);
    return ok;
}

static bool animate(const FilmPage *page, const char *picture, double seconds, Error *err)
{
    int frames = frame_count(page), count = show_moment_count(frames, seconds);
    Animation *animation = animation_create(picture, err);
    bool ok = animation;
    for (int k = 0; ok && k < count; k++) {
        Canvas *canvas = make_page(page, "page.png", show_moment(frames, count, k), err);
        ok = canvas && animation_add(animation, canvas, seconds / count, err);
        canvas_destroy(canvas);
    }
    ok = ok && animation_save(animation, err);
    animation_destroy(animation);
    return ok;
}

static bool write_film(FilmPage *page, const char *picture, Error *err)
{
    const ShowDef *def = page->data->def;
    if (!film_read(page->data->result, page->drawn, &page->film, err)) return false;
    if (page->film.count == 0)
        return error_set(err, "the drawing has no frames; `output: {film: N}` keeps those of a run");
    if (def->frame >= frame_count(page))
        return error_set(err, "the drawing's film has %d frames, from 0", frame_count(page));
    read_energy(page);
    lay_out(page);
    page->data->drawn = true;
    if (def->frame >= 0) return write_frame(page, picture, def->frame, err);
    return animate(page, picture, def->seconds, err);
}

bool show_film(ShowData *data, const Drawn *drawn, const char *result, const char *picture, Error *err)
{
    const char *slash = strrchr(result, '/');
    FilmPage page = {.data = data, .drawn = drawn, .title = slash ? slash + 1 : result};
    bool ok = write_film(&page, picture, err);
    film_clear(&page.film);
    return ok;
}
