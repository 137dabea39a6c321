/* The drawing of a result, for its report. */
#include "report/report_private.h"
#include "spline/film.h"

/* The curves of a pen in the order in which they are plotted, mm. */
static void add_layer(Document *document, const PlotLayer *layer)
{
    document_open(document, NULL, '{');
    document_text(document, "name", layer->name);
    report_color(document, "color", layer->color);
    document_number(document, "width", layer->pen);
    document_indices(document, "offsets", layer->start, (size_t)layer->count + 1, 1);
    document_packed(document, "points", layer->count ? &layer->points[0].x : NULL,
                    (Packed){1, 2 * (size_t)layer->start[layer->count], 2, 16, false});
    document_close(document);
}

/* What was to be drawn within the margins: 0 white .. 1 black, or what takes away red, green and blue. */
static void add_picture(Document *document, const SplineField *picture)
{
    size_t pixels = (size_t)picture->rows * (size_t)picture->columns;
    document_open(document, "picture", '{');
    document_number(document, "columns", picture->columns);
    document_number(document, "rows", picture->rows);
    document_packed(document, "values", picture->values,
                    (Packed){(size_t)picture->rows, pixels / (size_t)picture->rows * (size_t)picture->width,
                             (size_t)picture->width, 8, false});
    document_close(document);
}

/* How it relaxed: what its pens would have drawn after some iterations. */
static bool add_film(const ReportPart *part, const Drawn *drawn, Error *err)
{
    enum { ROOM = 40 };
    Film film;
    Document *document = part->document;
    bool ok = film_read(part->data->result, drawn, &film, err);
    int most = part->most ? part->most : ROOM, count = !ok ? 0 : film.count < most ? film.count : most;
    if (count) document_open(document, "film", '[');
    for (int k = 0; k < count; k++) {
        int frame = show_moment(film.count, count, k);
        Plot plot = film_plot(&film, drawn, frame);
        document_open(document, NULL, '{');
        document_number(document, "iteration", film_iteration(&film, frame));
        document_open(document, "layers", '[');
        for (int l = 0; l < plot.layer_count; l++) add_layer(document, &plot.layers[l]);
        document_close(document);
        document_close(document);
        spline_plot_clear(&plot);
    }
    if (count) document_close(document);
    film_clear(&film);
    return ok;
}

bool report_drawing(const ReportPart *part, Error *err)
{
    Drawn drawn = {0};
    if (!drawn_has(part->data->result)) return true;
    bool ok = drawn_read(part->data->result, &drawn, err);
    if (ok) {
        Document *document = part->document;
        document_open(document, "drawing", '{');
        document_numbers(document, "paper", drawn.plot.paper, 2);
        const SplinePage *page = &drawn.page;
        const double area[4] = {1e3 * page->left, 1e3 * page->top, 1e3 * page->unit * page->width,
                                1e3 * page->unit * page->height};
        document_numbers(document, "area", area, 4);
        document_open(document, "layers", '[');
        for (int k = 0; k < drawn.plot.layer_count; k++) add_layer(document, &drawn.plot.layers[k]);
        document_close(document);
        add_picture(document, &drawn.picture);
        ok = add_film(part, &drawn, err);
        document_close(document);
    }
    drawn_clear(&drawn);
    return ok;
}
