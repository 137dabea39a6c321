#include "model/coercivity.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>

static const double PART = 0.5; /* of the coercivity */

static Vec3 middle(MagnetPart part, const double *place, int element)
{
    Vec3 sum = {0};
    for (int i = 0; i < part.corners; i++)
        sum = vec3_add(sum, vec3_load(place + 3 * part.points[part.each * element + i]));
    return vec3_scale(1.0 / part.corners, sum);
}

/* T, with all fields. */
static double flux_at_place(const Model *model, const double *p, Vec3 place, double time)
{
    double x[3], flux[3];
    vec3_store(x, place);
    flux_value((FluxSum){model->fields, model->flux_blocks, p, time}, x, flux);
    return vec3_length(vec3_load(flux));
}

/* Of the magnetised element in the largest field. */
static char *judge(const Model *model, MagnetPart part, const double *p, const State *at)
{
    if (isnan(part.coercivity)) return NULL;
    double *place = mem_alloc(3 * (size_t)model->point_count, sizeof *place), most = 0;
    int where = -1;
    model->body->ops->places(model, at->x, place);
    for (int e = 0; e < part.count; e++) {
        if (vec3_length(vec3_load(p + part.magnetization + 3 * e)) == 0) continue;
        double flux = flux_at_place(model, p, middle(part, place, e), at->time);
        if (flux > most) most = flux, where = e;
    }
    Vec3 x = where < 0 ? (Vec3){0} : middle(part, place, where);
    mem_free(place);
    if (!(most > PART * FLUX_MU_0 * part.coercivity)) return NULL;
    return mem_format(
        "%s %d, at (%.3g, %.3g, %.3g) m, is in a field of %.3g T, which is %.3g of its coercivity: from "
        "%g of that on a magnetisation may be lost or turn over, which the model leaves out",
        part.noun, where, x.x, x.y, x.z, most, most / (FLUX_MU_0 * part.coercivity), PART);
}

char *coercivity_doubt(const Model *model, MagnetPart part, const Snapshot *shot)
{
    bool is_known = model->fields->count == 0 && model->design.size == 0;
    return is_known ? NULL : judge(model, part, shot->p, &shot->at);
}

void coercivity_advise(Model *model, const Scene *scene, MagnetPart part)
{
    for (int c = 0; c < model->case_count; c++)
        for (int s = 0; s < model->cases[c].stage_count; s++) {
            double *p = mem_copy(model->cases[c].stages[s].p, (size_t)model->params->size, sizeof *p);
            timed_largest(&model->flux_of_time, model->time, scene->time.step, scene->time.steps,
                          p + model->flux_blocks.uniform);
            char *doubt = judge(model, part, p, &model->cases[c].state);
            if (doubt) mesh_warn(&model->report, "%s: %s", model->cases[c].name, doubt);
            mem_free(doubt);
            mem_free(p);
        }
}
