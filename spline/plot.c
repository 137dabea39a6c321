#include "spline/plot.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "base/plain.h"
#include <stdbool.h>
#include <stdlib.h>

enum { CUTS = 14 }; /* both ends, and three at each of the four sides */

/* A layer that grows, in units of the page until it is whole. */
typedef struct Builder {
    PlotLayer layer;
    size_t points, curves, point_room, curve_room;
} Builder;

static void reserve_points(Builder *builder, size_t more)
{
    if (builder->points + more <= builder->point_room) return;
    size_t room = 2 * (builder->points + more);
    builder->layer.points = mem_resize(builder->layer.points, builder->points, room, sizeof(Vec2));
    builder->point_room = room;
}

static void begin_curve(Builder *builder, Vec2 at)
{
    PlotLayer *layer = &builder->layer;
    if (builder->curves + 2 > builder->curve_room) {
        size_t room = 2 * (builder->curves + 2);
        layer->start = mem_resize(layer->start, builder->curves + 1, room, sizeof(int));
        builder->curve_room = room;
    }
    reserve_points(builder, 1);
    layer->points[builder->points++] = at;
    builder->curves++;
}

static void add_piece(Builder *builder, const Vec2 c[4])
{
    reserve_points(builder, 3);
    for (int k = 1; k < 4; k++) builder->layer.points[builder->points++] = c[k];
    builder->layer.start[builder->curves] = (int)builder->points;
}

static bool inside(const SplinePage *page, Vec2 p)
{
    return p.x >= 0 && p.x <= page->width && p.y >= 0 && p.y <= page->height;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Where the segment crosses the lines of the four sides, with 0 and 1, ascending. */
static int find_cuts(const SplinePage *page, const Vec2 c[4], double cuts[CUTS])
{
    double sides[2] = {page->width, page->height};
    int count = 0;
    cuts[count++] = 0;
    for (int axis = 0; axis < 2; axis++) {
        for (int far = 0; far < 2; far++) {
            double b[4];
            for (int k = 0; k < 4; k++) b[k] = (axis ? c[k].y : c[k].x) - (far ? sides[axis] : 0);
            count += cubic_roots(b, cuts + count);
        }
    }
    cuts[count++] = 1;
    qsort(cuts, (size_t)count, sizeof *cuts, ascending);
    return count;
}

static Vec2 on_page(const SplinePage *page, Vec2 p)
{
    return (Vec2){fmin(fmax(p.x, 0), page->width), fmin(fmax(p.y, 0), page->height)};
}

/* Adds what is inside of a segment; drawing: the curve goes on from the segment before, and into the next. */
static bool add_inside(Builder *builder, const SplinePage *page, const Vec2 c[4], bool drawing)
{
    double cuts[CUTS];
    int count = find_cuts(page, c, cuts);
    for (int k = 0; k + 1 < count; k++) {
        Vec2 part[4];
        bool in = cuts[k + 1] > cuts[k] && inside(page, cubic_at(c, 0.5 * (cuts[k] + cuts[k + 1])));
        if (in) {
            cubic_part(c, cuts[k], cuts[k + 1], part);
            part[0] = on_page(page, part[0]);
            part[3] = on_page(page, part[3]);
            if (!drawing) begin_curve(builder, part[0]);
            add_piece(builder, part);
        }
        if (cuts[k + 1] > cuts[k]) drawing = in;
    }
    return drawing;
}

/* A segment lies within its control polygon: most need no look at the sides. */
static void add_stroke(Builder *builder, const SplinePage *page, const Strokes *strokes, int stroke)
{
    bool drawing = false;
    for (int node = strokes->start[stroke]; node < strokes->start[stroke + 1] - 1; node++) {
        Vec2 c[4];
        strokes_bezier(strokes, node, c);
        if (inside(page, c[0]) && inside(page, c[1]) && inside(page, c[2]) && inside(page, c[3])) {
            if (!drawing) begin_curve(builder, c[0]);
            add_piece(builder, c);
            drawing = true;
        } else {
            drawing = add_inside(builder, page, c, drawing);
        }
    }
}

Plot spline_plot(const Strokes *strokes, const SplinePage *page, const SplinePen *pens, int pen_count,
                 Color paper)
{
    Plot plot = {.paper = {1e3 * page->paper[0], 1e3 * page->paper[1]},
                 .color = paper,
                 .layer_count = pen_count,
                 .layers = mem_alloc((size_t)pen_count, sizeof *plot.layers)};
    double scale = 1e3 * page->unit;
    for (int layer = 0; layer < pen_count; layer++) {
        Builder builder = {.layer = {.name = mem_text(pens[layer].name),
                                     .start = mem_alloc(1, sizeof(int)),
                                     .color = pens[layer].color,
                                     .opaque = pens[layer].opaque,
                                     .pen = scale * pens[layer].width}};
        for (int k = 0; k < strokes->count; k++)
            if (strokes->layer[k] == layer) add_stroke(&builder, page, strokes, k);
        for (size_t k = 0; k < builder.points; k++) {
            Vec2 *p = &builder.layer.points[k];
            *p = (Vec2){1e3 * page->left + scale * p->x, 1e3 * page->top + scale * p->y};
        }
        builder.layer.count = (int)builder.curves;
        plot.layers[layer] = builder.layer;
    }
    return plot;
}

void spline_plot_clear(Plot *plot)
{
    for (int k = 0; k < plot->layer_count; k++) {
        mem_free((char *)plot->layers[k].name);
        mem_free(plot->layers[k].start);
        mem_free(plot->layers[k].points);
    }
    mem_free(plot->layers);
    *plot = (Plot){0};
}

bool spline_pen_is_name(const char *name)
{
    return *name && plain_is(name);
}
