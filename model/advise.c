#include "model/advise.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "model/within.h"
#include "solve/newton.h"
#include <math.h>
#include <string.h>

enum { POINTS = 300, MOMENTS = 30 }; /* at most, of which fields are asked */

static const double STRONG = 1; /* T: about what magnets reach at their surface; most likely it is in mT   */
static const double LARGE = 10; /* of the body's size: no slender body stretches so far                    */

/* ---- Fields ---- */

/* Of the moments of a motion, and of some of the points. */
static double largest_at(const Model *model, const Scene *scene, const double *p, const double *place)
{
    bool varies = model->fields->count > 0, moves = varies && model->job->motion;
    int points = varies ? model->point_count : 1, stride = 1 + (points - 1) / POINTS,
        moments = moves ? (scene->time.steps < MOMENTS ? scene->time.steps : MOMENTS) : 0;
    double largest = 0;
    for (int t = 0; t <= moments; t++) {
        double part = moments ? scene->time.steps * (double)t / moments : 0,
               time = model->time + (moves ? part * scene->time.step : 0);
        for (int k = 0; k < points; k += stride) {
            double flux[3];
            flux_value((FluxSum){model->fields, model->flux_blocks, p, time}, place + 3 * k, flux);
            largest = fmax(largest, vec3_length(vec3_load(flux)));
        }
    }
    return largest;
}

double advise_largest_flux(const Model *model, const Scene *scene, const Case *c, const double *p)
{
    if (model->flux_blocks.uniform < 0) return 0;
    const FluxUnknown *unknown = scene->design ? scene->design->unknowns.flux_density : NULL;
    double *q = mem_copy(p, (size_t)model->params->size, sizeof *p),
           *place = mem_alloc(3 * (size_t)model->point_count, sizeof *place);
    model->body->ops->places(model, c->state.x, place);
    timed_largest(&model->flux_of_time, model->time, scene->time.step, scene->time.steps,
                  q + model->flux_blocks.uniform);
    double largest = largest_at(model, scene, q, place);
    if (unknown && !isnan(unknown->bounds[0]))
        largest = fmax(largest, fmax(fabs(unknown->bounds[0]), fabs(unknown->bounds[1])));
    mem_free(place);
    mem_free(q);
    return largest;
}

static void warn(void *report, const char *sentence)
{
    mesh_warn(report, "%s", sentence);
}

/* Of a magnet or coil that the body is in at the start: true if there is one. */
static bool advise_within(Model *model, const Case *c, const double *p)
{
    char *where = mem_format("%s: the body starts in", c->name);
    int before = model->report.warning_count;
    model_tell_within(model, p, model->time, c->state.x, where, warn, &model->report);
    mem_free(where);
    return model->report.warning_count > before;
}

/* Of a field without a value where the body is at the start: true if there is one. */
static bool advise_unknown(Model *model, const Case *c)
{
    Error err;
    bool known = model_knows_fields(model, c->stages[0].p, model->time, c->state.x, &err);
    if (!known) mesh_warn(&model->report, "%s: at the start %s", c->name, err.text);
    return !known;
}

static void advise_field(Model *model, const Scene *scene, const Case *c)
{
    double largest = 0;
    if (advise_unknown(model, c) || advise_within(model, c, c->stages[0].p)) return;
    for (int s = 0; s < c->stage_count; s++)
        largest = fmax(largest, advise_largest_flux(model, scene, c, c->stages[s].p));
    if (largest > STRONG)
        mesh_warn(
            &model->report,
            "%s: a flux density of %.3g T, and few magnets give more than %g: a number without a unit is "
            "in T, `20 mT` is 0.02",
            c->name, largest, STRONG);
}

static bool is_magnetization(const ParamBlock *block)
{
    return !strcmp(block->unit, "A/m");
}

/* Has a block numbers that are not 0, in any stage of any case? */
static bool is_used(const Model *model, const ParamBlock *block)
{
    for (int c = 0; c < model->case_count; c++)
        for (int s = 0; s < model->cases[c].stage_count; s++)
            for (int i = 0; i < block->count * block->width; i++)
                if (model->cases[c].stages[s].p[block->offset + i] != 0) return true;
    return false;
}

static bool is_magnetised(const Model *model)
{
    bool is = false;
    for (int b = 0; !is && b < model->params->block_count; b++)
        is = is_magnetization(&model->params->blocks[b]) && is_used(model, &model->params->blocks[b]);
    return is;
}

static const Unknown *unknown_magnetization(const Model *model)
{
    for (int k = 0; k < model->design.unknown_count; k++)
        if (is_magnetization(model->design.unknowns[k].block)) return &model->design.unknowns[k];
    return NULL;
}

/* A field and what is magnetised act on each other; one without the other is idle. */
static void advise_idle(Model *model, const Scene *scene)
{
    const Unknown *unknown = unknown_magnetization(model);
    double largest = 0;
    for (int k = 0; k < model->case_count; k++)
        for (int s = 0; s < model->cases[k].stage_count; s++)
            largest = fmax(largest,
                           advise_largest_flux(model, scene, &model->cases[k], model->cases[k].stages[s].p));
    bool field = largest > 0 || (scene->design && scene->design->unknowns.flux_density);
    if (unknown && !field)
        mesh_warn(&model->report, "the unknown %s moves nothing: there is no `flux_density`",
                  unknown->block->name);
    if (!unknown && field && !is_magnetised(model))
        mesh_warn(&model->report, "the flux density moves nothing: nothing is magnetised");
}

/* Are all forces in balance where a case begins, in each of its stages? */
static bool is_at_rest(const Case *c)
{
    double *gradient = mem_alloc((size_t)c->state.dofs, sizeof *gradient);
    bool rests = true;
    for (int s = 0; rests && s < c->stage_count; s++) {
        Point at = state_point(&c->state, c->stages[s].p);
        Evaluation now = system_hessian(c->sys, &at, gradient);
        rests = now.finite && now.gradient_max <= newton_round_off(c->sys, c->state.x);
    }
    mem_free(gradient);
    return rests;
}

/* How stiff a body is moves it only where something else would. */
static void advise_stiffness(Model *model, const Scene *scene)
{
    const UnknownsScene *unknowns = &scene->design->unknowns;
    const char *name = unknowns->thickness ? "thickness" : "young";
    bool only = model->design.unknown_count == (unknowns->thickness != NULL) + (unknowns->young != NULL);
    if (!only || model->job->motion || model->moves || model->world) return;
    for (int k = 0; k < model->case_count; k++)
        if (!is_at_rest(&model->cases[k])) return;
    mesh_warn(&model->report,
              "the unknown %s moves nothing: no load, gravity or field acts on the body where it starts",
              name);
}

/* ---- Targets ---- */

/* Of the box around the coordinates that are numbers, m. */
static double diagonal(const double (*place)[3], int count)
{
    Vec3 low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_scale(-1, low);
    for (int k = 0; k < count; k++) {
        const double *at = place[k];
        low = vec3(fmin(low.x, at[0]), fmin(low.y, at[1]), fmin(low.z, at[2])); /* NaN aside */
        high = vec3(fmax(high.x, at[0]), fmax(high.y, at[1]), fmax(high.z, at[2]));
    }
    Vec3 size = vec3_sub(high, low);
    return vec3_length(vec3(fmax(size.x, 0), fmax(size.y, 0), fmax(size.z, 0)));
}

/* Of the places of a case's targets, clouds of points among them. */
static double targets_size(const Model *model, const Case *c)
{
    double size = 0;
    for (int k = 0; k < c->target_count; k++) {
        const Target *target = &c->targets[k];
        size = fmax(size, target->place ? diagonal((const double(*)[3])target->place, model->point_count)
                                        : diagonal((const double(*)[3])target->cloud.points,
                                                   target->cloud.point_count));
    }
    return size;
}

static void advise_target(Model *model, const Case *c)
{
    if (!c->target_count) return;
    double(*place)[3] = mem_alloc((size_t)model->point_count, sizeof *place);
    model->body->ops->places(model, c->state.x, place[0]);
    double size = diagonal((const double(*)[3])place, model->point_count), target = targets_size(model, c);
    if (target > LARGE * size)
        mesh_warn(
            &model->report,
            "%s: the target is %.3g m across, and the body %.3g m at the start: expressions and numbers "
            "without a unit are in metres, a file's `scale` is a factor to metres",
            c->name, target, size);
    mem_free(place);
}

/* ---- Values ---- */

/* Of any slender body; what is outside was most likely meant in another unit. */
typedef struct Usual {
    const char *unit;
    double least, most;
    const char *hint;
} Usual;

static const Usual usuals[] = {
    {"Pa", 100, 1e13, "a number without a unit is in Pa, `m` is milli and `M` mega: `1 MPa` is 1e6"},
    {"A/m", 0, 3e6, "a number without a unit is in A/m, and `remanence` takes mT"},
    {"m/s^2", 0, 1000, "a number without a unit is in m/s^2: the Earth's gravity is 9.81"},
    {"kg/m^3", 10, 3e4, "a number without a unit is in kg/m^3: water has 1000, and `1.1 g/cm^3` is 1100"},
};

/* NULL: any value is one, of that unit too. */
static const Usual *unusual(const char *unit, double value)
{
    for (size_t k = 0; k < sizeof usuals / sizeof *usuals; k++)
        if (!strcmp(usuals[k].unit, unit))
            return fabs(value) < usuals[k].least || fabs(value) > usuals[k].most ? &usuals[k] : NULL;
    return NULL;
}

void advise_value(Model *model, const char *name, const char *unit, double value)
{
    const Usual *usual = unusual(unit, value);
    if (usual)
        mesh_warn(&model->report, "%s is %.3g %s, and usual is %g to %g: %s", name, value, unit, usual->least,
                  usual->most, usual->hint);
}

/* The first unusual one of a block in any stage of any case; NAN: there is none. */
static double unusual_in(const Model *model, const ParamBlock *block)
{
    for (int c = 0; c < model->case_count; c++)
        for (int s = 0; s < model->cases[c].stage_count; s++)
            for (int i = 0; i < block->count * block->width; i++) {
                double value = model->cases[c].stages[s].p[block->offset + i];
                if (unusual(block->unit, value)) return value;
            }
    return NAN;
}

static void advise_values(Model *model, const Scene *scene)
{
    for (int b = 0; b < model->params->block_count; b++) {
        const ParamBlock *block = &model->params->blocks[b];
        advise_value(model, block->name, block->unit, unusual_in(model, block));
    }
    const NumberUnknown *young = scene->design ? scene->design->unknowns.young : NULL;
    for (int k = 0; young && !isnan(young->bounds[0]) && k < 2; k++) /* NAN: none are written */
        advise_value(model, "a bound of the unknown young", "Pa", young->bounds[k]);
}

/* ---- The whole ---- */

void model_advise(Model *model, const Scene *scene)
{
    if (model->params) advise_values(model, scene);
    for (int k = 0; k < model->case_count; k++) {
        advise_field(model, scene, &model->cases[k]);
        advise_target(model, &model->cases[k]);
    }
    if (model->flux_blocks.uniform >= 0) advise_idle(model, scene);
    if (model->design.unknown_count) advise_stiffness(model, scene);
}
