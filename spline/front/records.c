/* Drawings in the journal, as spline/drawn.h reads them. */
#include "base/memory.h"
#include "spline/front/front.h"
#include <math.h>
#include <string.h>

static void add_pens(const Drawing *d, Arrays *list)
{
    double *width = arrays_numbers(list, (size_t)d->layer_count),
           *color = arrays_numbers(list, 3 * (size_t)d->layer_count), *paper = arrays_numbers(list, 3);
    int *opaque = arrays_keep(list, mem_alloc((size_t)d->layer_count, sizeof *opaque));
    char *names = mem_text("");
    for (int k = 0; k < d->layer_count; k++) {
        const SplinePen *pen = &d->pens[k];
        names = mem_join(names, pen->name, "\n");
        width[k] = pen->width * d->page.unit;
        opaque[k] = pen->opaque;
        memcpy(color + 3 * k, (double[]){pen->color.r, pen->color.g, pen->color.b}, 3 * sizeof *color);
    }
    arrays_add(list, array_text("spline/names", arrays_keep(list, names)));
    arrays_add(list, array_float("spline/width", "m", width, 1, d->layer_count, 0));
    memcpy(paper, (double[]){d->paper.r, d->paper.g, d->paper.b}, 3 * sizeof *paper);
    arrays_add(list, array_float("spline/color", "", color, 2, d->layer_count, 3));
    arrays_add(list, array_int("spline/opaque", opaque, 1, d->layer_count, 0));
    arrays_add(list, array_float("spline/paper_color", "", paper, 1, 3, 0));
}

static void add_picture(const SplineField *picture, Arrays *list)
{
    size_t count = (size_t)picture->columns * (size_t)picture->rows * (size_t)picture->width;
    int *level = arrays_keep(list, mem_alloc(count, sizeof *level));
    for (size_t i = 0; i < count; i++) level[i] = (int)lround(255 * picture->values[i]);
    Array array = array_int("spline/picture", level, 2, picture->rows, picture->columns);
    if (picture->width > 1) array.rank = 3, array.dims[2] = picture->width;
    arrays_add(list, array);
}

static void add_plotter(const Drawing *d, Arrays *list)
{
    const Plotter *plotter = &d->plotter;
    double *speed = arrays_numbers(list, 2), *z = arrays_numbers(list, 3);
    char *servo = arrays_keep(list, mem_format("%s\n%s\n", plotter->servo_up, plotter->servo_down));
    speed[0] = 1e-3 * plotter->down, speed[1] = 1e-3 * plotter->up;
    z[0] = 1e-3 * plotter->z_up, z[1] = 1e-3 * plotter->z_down, z[2] = 1e-3 * plotter->z_speed;
    arrays_add(list, array_float("spline/speed", "m/s", speed, 1, 2, 0));
    arrays_add(list, array_float("spline/lift", "s", &plotter->lift, 0, 0, 0));
    arrays_add(list, array_float("spline/z", "m, m, m/s", z, 1, 3, 0));
    arrays_add(list, array_text("spline/servo", servo));
    if (d->profile) arrays_add(list, array_text("spline/profile", d->profile));
    arrays_add(list, array_float("spline/pause", "s", &plotter->pause, 0, 0, 0));
}

void drawing_add_static(const Drawing *d, Arrays *list)
{
    add_pens(d, list);
    add_picture(&d->picture, list);
    arrays_add(list, array_float("spline/paper", "m", d->page.paper, 1, 2, 0));
    double *margin = arrays_numbers(list, 2);
    margin[0] = d->page.left, margin[1] = d->page.top;
    arrays_add(list, array_float("spline/margins", "m", margin, 1, 2, 0));
    double *least =
        arrays_numbers(list, 1); /* the scene's: of a picture that is shown whole one of them is wider */
    *least = fmin(margin[0], margin[1]);
    arrays_add(list, array_float("spline/margin", "m", least, 0, 0, 0));
    add_plotter(d, list);
}

void drawing_add_strokes(const Drawing *d, const Strokes *strokes, Arrays *list)
{
    static const int none[] = {0};
    const SplinePage *page = &d->page;
    int nodes = strokes_node_count(strokes);
    double *q = arrays_numbers(list, 4 * (size_t)nodes);
    for (int i = 0; i < nodes; i++) {
        const double *from = strokes->q + 4 * i;
        double to[] = {page->left + page->unit * from[0], page->top + page->unit * from[1],
                       page->unit * from[2], page->unit * from[3]};
        memcpy(q + 4 * i, to, sizeof to);
    }
    arrays_add(list, array_float("spline/nodes", "m", q, 2, nodes, 4));
    arrays_add(list,
               array_int("spline/strokes", strokes->count ? strokes->start : none, 1, strokes->count + 1, 0));
    arrays_add(list, array_int("spline/pen", strokes->layer, 1, strokes->count, 0));
}
