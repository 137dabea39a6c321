#include "io/plot_file.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "io/plot_text.h"
#include "io/mark.h"
#include "io/safe_file.h"
#include <math.h>

void plot_add_number(Text *text, double number, int decimals)
{
    long long scale = 1;
    for (int k = 0; k < decimals; k++) scale *= 10;
    long long ticks = llround(number * (double)scale), whole, part;
    const char *sign = ticks < 0 ? "-" : "";
    if (ticks < 0) ticks = -ticks;
    whole = ticks / scale;
    part = ticks % scale;
    if (part == 0) {
        text_add(text, "%s%lld", sign, whole);
        return;
    }
    for (; part % 10 == 0; part /= 10) decimals--;
    text_add(text, "%s%lld.%0*lld", sign, whole, decimals, part);
}

bool plot_check(const char *path, const Plot *plot, Error *err)
{
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        for (int i = 0; i < (layer->count ? layer->start[layer->count] : 0); i++) {
            Vec2 p = layer->points[i];
            if (!(fabs(p.x) <= 2 * plot->paper[0] && fabs(p.y) <= 2 * plot->paper[1]))
                return error_set(err, "%s: layer %d has a point at (%g, %g) mm, on a paper of %g x %g mm",
                                 path, k + 1, p.x, p.y, plot->paper[0], plot->paper[1]);
        }
    }
    return true;
}

static void add_point(Text *text, char before, Vec2 p)
{
    text_add(text, "%c", before);
    plot_add_number(text, p.x, 3);
    text_add(text, " ");
    plot_add_number(text, p.y, 3);
}

static void add_color(Text *text, Color color)
{
    text_add(text, "#%02x%02x%02x", (unsigned)lround(255 * color.r), (unsigned)lround(255 * color.g),
             (unsigned)lround(255 * color.b));
}

static void add_layer(Text *text, const PlotLayer *layer, int number)
{
    text_add(text, "<g id=\"layer%d\" inkscape:groupmode=\"layer\" inkscape:label=\"%d-", number, number);
    text_add_xml(text, layer->name);
    text_add(text, "\" fill=\"none\" stroke=\"");
    add_color(text, layer->color);
    text_add(text, "\" stroke-width=\"");
    plot_add_number(text, layer->pen, 3);
    text_add(text, "\" stroke-linecap=\"round\" stroke-linejoin=\"round\"%s>\n",
             layer->opaque ? "" : " style=\"mix-blend-mode:multiply\"");
    for (int k = 0; k < layer->count; k++) {
        text_add(text, "<path d=\"");
        for (int i = layer->start[k]; i < layer->start[k + 1]; i++)
            add_point(text,
                      i == layer->start[k]       ? 'M'
                      : i == layer->start[k] + 1 ? 'C'
                                                 : ' ',
                      layer->points[i]);
        text_add(text, "\"/>\n");
    }
    text_add(text, "</g>\n");
}

bool plot_write_svg(const char *path, const Plot *plot, Error *err)
{
    Text text = {0}, width = {0}, height = {0};
    if (!plot_check(path, plot, err)) return false;
    plot_add_number(&width, plot->paper[0], 3);
    plot_add_number(&height, plot->paper[1], 3);
    text_add(&text,
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
             "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"%smm\" height=\"%smm\" "
             "viewBox=\"0 0 %s %s\"",
             width.text, height.text, width.text, height.text);
    Color c = plot->color;
    if (c.a > 0 && (c.r < 1 || c.g < 1 || c.b < 1)) {
        text_add(&text, " style=\"background:");
        add_color(&text, c);
        text_add(&text, "\"");
    }
    text_add(&text, ">\n");
    for (int k = 0; k < plot->layer_count; k++)
        if (plot->layers[k].count) add_layer(&text, &plot->layers[k], k + 1);
    text_add(&text, MARK_SVG(SLENDER_VERSION) "</svg>\n");
    bool ok = safe_file_write(path, text.text, text.length, false, err);
    mem_free(width.text);
    mem_free(height.text);
    mem_free(text.text);
    return ok;
}

Plotter plotter_default(void)
{
    return (Plotter){.down = 40,
                     .up = 100,
                     .lift = 0.3,
                     .z_up = 5,
                     .z_speed = 10,
                     .pause = 1,
                     .servo_up = "M5",
                     .servo_down = "M3 S30"};
}

bool plotter_check(const Plotter *p, Error *err)
{
    const double positive[] = {p->down, p->up, p->z_speed, p->pause}, any[] = {p->z_up, p->z_down, p->lift};
    bool ok = p->lift >= 0 && p->z_up != p->z_down;
    for (int k = 0; k < 4; k++) ok = ok && positive[k] >= 1e-6 && positive[k] <= 1e6;
    for (int k = 0; k < 3; k++) ok = ok && fabs(any[k]) <= 1e6;
    return ok || error_set(err, "the plotter's speeds, times or heights are none");
}

double plotter_z_lift(const Plotter *plotter)
{
    return fmax(plotter->lift, 2 * fabs(plotter->z_up - plotter->z_down) / plotter->z_speed);
}

static double distance(Vec2 a, Vec2 b)
{
    return hypot(b.x - a.x, b.y - a.y);
}

void plot_add_length(const Vec2 *c, const Vec2 *end, double *length)
{
    for (; c < end; c += 3) {
        int steps = cubic_steps(c, 0.001);
        Vec2 at = *c;
        for (int i = 1; i <= steps; i++) {
            Vec2 next = cubic_at(c, (double)i / steps);
            *length += distance(at, next);
            at = next;
        }
    }
}

PlotEstimate plot_estimate(const PlotLayer *layer, const Plotter *plotter)
{
    PlotEstimate estimate = {0};
    Vec2 home = {0, 0}, at = home;
    for (int k = 0; k < layer->count; k++) {
        const Vec2 *c = layer->points + layer->start[k], *end = layer->points + layer->start[k + 1] - 1;
        estimate.travel += distance(at, *c);
        plot_add_length(c, end, &estimate.ink);
        at = *end;
    }
    estimate.travel += distance(at, home);
    estimate.seconds =
        estimate.ink / plotter->down + estimate.travel / plotter->up + layer->count * plotter->lift;
    return estimate;
}
