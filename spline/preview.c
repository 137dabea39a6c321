#include "spline/preview.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "io/canvas.h"

static const double TRUE_SCALE = 72 / 25.4;   /* points a millimetre: the paper's own size */
static const Color edge = {0.6, 0.6, 0.6, 1}; /* between the two papers */

void preview_draw_target(Canvas *canvas, const SplinePage *page, const SplineGrid *target, Vec2 origin,
                         double scale)
{
    size_t pixels = (size_t)target->columns * (size_t)target->rows;
    unsigned char *rgba = mem_alloc(pixels, 4);
    for (size_t k = 0; k < pixels; k++) {
        const double *dark = target->values + k * (size_t)target->width;
        for (size_t c = 0; c < 3; c++) {
            double white = 1 - dark[target->width == 3 ? c : 0];
            rgba[4 * k + c] = (unsigned char)lround(255 * fmin(fmax(white, 0), 1));
        }
        rgba[4 * k + 3] = 255;
    }
    double points = 1e3 * scale;
    canvas_image(canvas, rgba, target->columns, target->rows,
                 (Box){origin.x + points * page->left, origin.y + points * page->top,
                       points * page->unit * page->width, points * page->unit * page->height});
    mem_free(rgba);
}

/* Where a paper lies. */
typedef struct Frame {
    Vec2 origin;
    double scale; /* pt per mm */
} Frame;

/* c to end: control points of a curve. Chords stay within a quarter of a pixel. */
static void draw_curve(Canvas *canvas, const Vec2 *c, const Vec2 *end, const Frame *frame, Pen pen)
{
    double tolerance = 0.25 / (frame->scale * canvas_resolution(canvas));
    int count = 1, room = 1;
    for (const Vec2 *k = c; k < end; k += 3) room += cubic_steps(k, tolerance);
    Vec2 *points = mem_alloc((size_t)room, sizeof *points);
    points[0] = *c;
    for (; c < end; c += 3) {
        int steps = cubic_steps(c, tolerance);
        for (int i = 1; i <= steps; i++) points[count++] = cubic_at(c, (double)i / steps);
    }
    for (int k = 0; k < count; k++)
        points[k] = (Vec2){frame->origin.x + frame->scale * points[k].x,
                           frame->origin.y + frame->scale * points[k].y};
    canvas_polyline(canvas, points, count, pen);
    mem_free(points);
}

void preview_draw(Canvas *canvas, const Plot *plot, Vec2 origin, double scale)
{
    const Frame frame = {origin, scale};
    if (plot->color.a > 0)
        canvas_fill(canvas, (Box){origin.x, origin.y, scale * plot->paper[0], scale * plot->paper[1]},
                    plot->color);
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        Pen pen = {.color = layer->color, .width = scale * layer->pen};
        if (!layer->opaque) canvas_begin_ink(canvas);
        for (int i = 0; i < layer->count; i++)
            draw_curve(canvas, layer->points + layer->start[i], layer->points + layer->start[i + 1] - 1,
                       &frame, pen);
        if (!layer->opaque) canvas_end_ink(canvas);
    }
}

bool spline_preview(const char *path, const Plot *plot, const SplinePage *page, const SplineGrid *target,
                    int width, Error *err)
{
    double scale = TRUE_SCALE, paper[2] = {scale * plot->paper[0], scale * plot->paper[1]};
    Canvas *canvas = canvas_create(path, target ? 2 * paper[0] : paper[0], paper[1], width / paper[0], err);
    if (!canvas) return false;
    if (target) {
        double x = paper[0];
        preview_draw_target(canvas, page, target, (Vec2){0, 0}, scale);
        canvas_line(canvas, (Vec2){x, 0}, (Vec2){x, paper[1]}, (Pen){.color = edge, .width = 0.5});
    }
    preview_draw(canvas, plot, (Vec2){target ? paper[0] : 0, 0}, scale);
    bool ok = canvas_save(canvas, err);
    canvas_destroy(canvas);
    return ok;
}
