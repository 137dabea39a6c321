#include "model/within.h"
#include "base/memory.h"
#include <string.h>

/* A point of the body that is in the field's source; -1: none. */
static int point_within(const Model *model, int field, const double *p, double time, const double *place)
{
    const FluxBlocks *blocks = &model->flux_blocks;
    FluxPlace where = {time, p + blocks->move + 3 * field, p + blocks->turn + 3 * field};
    return flux_field_find_within(model->fields->items[field], place, model->point_count, where);
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
            ? "its field there is not known and grows towards the wire, so that solves take long"
            : "its field there is that within it");
}

void model_tell_within(Model *model, const double *p, double time, const double *place, const char *where,
                       void (*tell)(void *self, const char *sentence), void *self)
{
    int count = model->flux_blocks.uniform < 0 ? 0 : model->fields->count;
    if (count && !model->told_within)
        model->told_within = mem_alloc((size_t)count, sizeof *model->told_within);
    for (int k = 0; k < count; k++) {
        bool acts = p[model->flux_blocks.scale + k] != 0 && !model->told_within[k];
        int v = acts ? point_within(model, k, p, time, place) : -1;
        if (v < 0) continue;
        char *text = sentence(model->fields->items[k], place + 3 * v, where);
        mark_told(model, flux_field_name(model->fields->items[k]));
        tell(self, text);
        mem_free(text);
    }
}
