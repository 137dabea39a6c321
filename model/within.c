#include "model/within.h"
#include "base/memory.h"
#include <string.h>

double *model_field_places(const Model *model, const double *x, int *count)
{
    int points = model->point_count, faces = model->mesh ? model->mesh->face_count : 0;
    double *place = mem_alloc(3 * ((size_t)points + (size_t)faces), sizeof *place);
    model->body->ops->places(model, x, place);
    for (int f = 0; f < faces; f++) {
        const int *v = model->mesh->faces[f];
        for (int i = 0; i < 3; i++)
            place[3 * (points + f) + i] =
                (place[3 * v[0] + i] + place[3 * v[1] + i] + place[3 * v[2] + i]) / 3;
    }
    *count = points + faces;
    return place;
}

/* The first of the places that is in the field's source; -1: none. */
static int first_within(const Model *model, int field, const double *p, double time, const double *place,
                        int count)
{
    const FluxBlocks *blocks = &model->flux_blocks;
    FluxPlace where = {time, p + blocks->move + 3 * field, p + blocks->turn + 3 * field};
    return flux_field_find_within(model->fields->items[field], place, count, where);
}

/* Stages have fields of their own for what is one thing. */
static void mark_told(Model *model, const char *name)
{
    for (int k = 0; k < model->fields->count; k++)
        if (!strcmp(flux_field_name(model->fields->items[k]), name)) model->told_within[k] = true;
}

static char *sentence(const FluxField *field, const double x[3], const char *where)
{
    return mem_format(
        "%s the %s '%s', at (%.4g, %.4g, %.4g) m: %s, and nothing keeps the two apart but an "
        "obstacle",
        where, flux_field_kind(field), flux_field_name(field), x[0], x[1], x[2],
        flux_field_has_winding(field)
            ? "its field there is that of a winding without thickness, which jumps or grows without "
              "bounds, so that solves take long"
            : "its field there is that within it");
}

void model_tell_within(Model *model, const double *p, double time, const double *x, const char *where,
                       void (*tell)(void *self, const char *sentence), void *self)
{
    int fields = model->flux_blocks.uniform < 0 ? 0 : model->fields->count, places;
    if (!fields) return;
    if (!model->told_within) model->told_within = mem_alloc((size_t)fields, sizeof *model->told_within);
    double *place = model_field_places(model, x, &places);
    for (int k = 0; k < fields; k++) {
        bool acts = p[model->flux_blocks.scale + k] != 0 && !model->told_within[k];
        int v = acts ? first_within(model, k, p, time, place, places) : -1;
        if (v < 0) continue;
        char *text = sentence(model->fields->items[k], place + 3 * v, where);
        mark_told(model, flux_field_name(model->fields->items[k]));
        tell(self, text);
        mem_free(text);
    }
    mem_free(place);
}
