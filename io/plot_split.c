#include "io/plot_split.h"
#include "base/memory.h"
#include "io/plot_text.h"
#include <math.h>

static void begin_part(PlotParts *parts, const Plot *whole)
{
    if (parts->count == parts->room) {
        size_t room = 2 * (size_t)parts->room + 8;
        parts->plots = mem_resize(parts->plots, (size_t)parts->room, room, sizeof *parts->plots);
        parts->room = (int)room;
    }
    Plot *part = &parts->plots[parts->count++];
    *part = *whole;
    part->layers = mem_copy(whole->layers, (size_t)whole->layer_count, sizeof *part->layers);
    for (int k = 0; k < part->layer_count; k++) part->layers[k].count = 0;
}

/* Curves of a layer, from one on, to the last part. */
static void put_curves(PlotParts *parts, const Plot *whole, int layer, int first, int count)
{
    PlotLayer *to = &parts->plots[parts->count - 1].layers[layer];
    to->start = whole->layers[layer].start + first;
    to->count = count;
}

PlotParts plot_split_pens(const Plot *plot)
{
    PlotParts parts = {0};
    for (int k = 0; k < plot->layer_count; k++) {
        if (!plot->layers[k].count) continue;
        begin_part(&parts, plot);
        put_curves(&parts, plot, k, 0, plot->layers[k].count);
    }
    return parts;
}

static double curve_ink(const PlotLayer *layer, int curve)
{
    double length = 0;
    plot_add_length(layer->points + layer->start[curve], layer->points + layer->start[curve + 1] - 1,
                    &length);
    return length;
}

PlotParts plot_split_ink(const Plot *plot, double most)
{
    PlotParts parts = {0};
    double ink = INFINITY;
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        for (int i = 0, first = 0; i < layer->count; i++) {
            double length = curve_ink(layer, i);
            if (ink + length > most) begin_part(&parts, plot), first = i, ink = 0;
            ink += length;
            put_curves(&parts, plot, k, first, i + 1 - first);
        }
    }
    return parts;
}

void plot_parts_clear(PlotParts *parts)
{
    for (int k = 0; k < parts->count; k++) mem_free(parts->plots[k].layers);
    mem_free(parts->plots);
    *parts = (PlotParts){0};
}
