/* What of a scene counts before its parameters are laid out: flux densities, and the blocks of a trajectory. */
#include "base/memory.h"
#include "model/model.h"
#include "model/sequence.h"
#include "model/within.h"
#include <math.h>
#include <string.h>

/* ---- Flux densities ---- */

/* What an entry says; what it does not say is as in `flux` already. */
static bool read_flux(const Build *b, Key at, const FluxScene *list, int count, CaseFlux *flux,
                      FluxFields *fields)
{
    if (!list) return true;
    flux->first = fields->count;
    bool ok = build_flux(b, at, list, count, flux->uniform, fields);
    flux->count = fields->count - flux->first;
    return ok;
}

/* What stays as it was is that of another time: the uniform part, for fields of space know the time themselves. */
static bool follow_time(const Build *now, Key at, const FluxScene *list, int count, CaseFlux *flux)
{
    FluxFields there = {0};
    bool ok = build_flux(now, at, list, count, flux->uniform, &there);
    flux_fields_clear(&there);
    return ok;
}

/* Stages, each from the one before. */
static bool read_stages(Model *model, const Build *b, const Scene *scene, FluxFields *fields)
{
    Build now = *b;
    bool ok = true;
    const FluxScene *said = scene->flux_density; /* last */
    int count = scene->flux_density_count;
    Key at = key("flux_density");
    now.time = model->time;
    for (int k = 0; k < sequence_said(scene); k++) {
        StageScene stage = sequence_stage(scene, k);
        CaseFlux *flux = &model->flux[1 + k];
        if (!isnan(stage.time)) now.time = stage.time;
        *flux = model->flux[k];
        if (stage.flux_density) {
            said = stage.flux_density, count = stage.flux_density_count;
            at = sequence_key(scene, k, "flux_density");
            ok = read_flux(&now, at, said, count, flux, fields) && ok;
        } else if (!isnan(stage.time)) {
            ok = follow_time(&now, at, said, count, flux) && ok;
        }
    }
    return ok;
}

bool model_read_flux(Model *model, const Build *b, const Scene *scene, FluxFields *fields)
{
    *fields = (FluxFields){0};
    size_t count = 1 + (size_t)(scene->sequence ? sequence_said(scene) : scene->cases_count);
    model->flux = mem_alloc(count, sizeof *model->flux);
    bool ok = read_flux(b, key("flux_density"), scene->flux_density, scene->flux_density_count,
                        &model->flux[0], fields);
    if (scene->sequence) return read_stages(model, b, scene, fields) && ok;
    for (int k = 0; k < scene->cases_count; k++) {
        model->flux[1 + k] = model->flux[0];
        ok = read_flux(b, key("cases[%d].flux_density", k), scene->cases[k].flux_density,
                       scene->cases[k].flux_density_count, &model->flux[1 + k], fields) &&
             ok;
    }
    return ok;
}

void model_put_flux(const Model *model, int number, double *p)
{
    if (model->flux_blocks.uniform < 0) return;
    const CaseFlux *flux = &model->flux[number];
    memcpy(p + model->flux_blocks.uniform, flux->uniform, sizeof flux->uniform);
    for (int k = 0; k < model->fields->count; k++)
        p[model->flux_blocks.scale + k] = k >= flux->first && k < flux->first + flux->count;
}

void model_flux(const Model *model, const double *p, double time, double flux[3])
{
    double middle[3] = {0}, *place = NULL;
    const double *at = model->mesh ? model->mesh->rest[0] : NULL;
    if (!at) {
        at = place = mem_alloc(3 * (size_t)model->point_count, sizeof *place);
        model->body->ops->places(model, model->x, place);
    }
    for (int v = 0; v < model->point_count; v++)
        for (int i = 0; i < 3; i++) middle[i] += at[3 * v + i] / model->point_count;
    flux_value((FluxSum){model->fields, model->flux_blocks, p, time}, middle, flux);
    mem_free(place);
}

static bool knows_field(const FluxField *field, FluxPlace where, const double *place, int count, Error *err)
{
    for (int k = 0; k < count; k++)
        if (!flux_field_is_known(field, place + 3 * k, where, err)) return false;
    return true;
}

static bool knows_all(const Model *model, const double *p, double time, const double *place, int count,
                      Error *err)
{
    const FluxBlocks *blocks = &model->flux_blocks;
    for (int k = 0; model->fields && k < model->fields->count; k++) {
        FluxPlace where = {time, p + blocks->move + 3 * k, p + blocks->turn + 3 * k};
        if (p[blocks->scale + k] != 0 && !knows_field(model->fields->items[k], where, place, count, err))
            return model_unknown(model, "flux_density", err);
    }
    const BodyOps *ops = model->body->ops;
    if (ops->knows && !ops->knows(model, time, place, err)) return false;
    const FluxField *flow = model->world ? model->world->flow : NULL;
    return !flow || knows_field(flow, (FluxPlace){.time = time}, place, model->point_count, err) ||
           model_unknown(model, "water.velocity", err);
}

bool model_knows_fields(const Model *model, const double *p, double time, const double *x, Error *err)
{
    int count;
    double *place = model_field_places(model, x, &count);
    bool known = knows_all(model, p, time, place, count, err);
    mem_free(place);
    return known;
}

/* ---- Trajectories ---- */

/* A row for each step, knot or coefficient of so many numbers. */
static Control make_control(Model *model, const Scene *scene, ControlKind kind, int count, int width)
{
    Control control = {.kind = kind,
                       .width = width,
                       .steps = scene->time.steps,
                       .start = model->time,
                       .duration = scene->time.step * scene->time.steps};
    control.rows = control_rows(control.kind, control.steps, count);
    return control;
}

static void add_flux_control(Model *model, const Scene *scene, const FluxUnknown *from)
{
    ControlKind kind = (ControlKind)from->per;
    Control *control = &model->control;
    *control = make_control(model, scene, kind, kind == CONTROL_KNOT ? from->knots : from->harmonics, 3);
    control->to = model->flux_blocks.uniform;
    control->from = params_add(model->params, "control", "T", control->rows, 3, false);
}

/* Of the sources that are meant, from the first to the last; model_design refuses what is not so. */
static void add_strength_control(Model *model, const Scene *scene, const SourceUnknown *from)
{
    ControlKind kind = (ControlKind)from->per;
    int first = 0, width = model->fields->count;
    for (int k = 0; from->sources && k < model->fields->count; k++) {
        const char *name = flux_field_name(model->fields->items[k]);
        if (!strcmp(name, from->sources[0])) first = k, width = from->sources_count;
    }
    if (width < 1 || width > CONTROL_MAX_WIDTH || first + width > model->fields->count) return;
    Control *control = &model->strengths;
    *control = make_control(model, scene, kind, kind == CONTROL_KNOT ? from->knots : from->harmonics, width);
    control->to = model->flux_blocks.strength + first;
    control->from = params_add(model->params, "strengths", "", control->rows, width, false);
}

int model_controls(const Model *model, Control controls[2])
{
    int count = 0;
    if (model->control.rows) controls[count++] = model->control;
    if (model->strengths.rows) controls[count++] = model->strengths;
    return count;
}

void model_add_blocks(Model *model, const Scene *scene)
{
    if (model->world) world_add_params(model->world, model->params);
    const DesignScene *design = scene->design;
    bool trajectory = model->job->design && model->job->motion;
    if (!trajectory || !design) return;
    const SourceUnknown *strength = design->unknowns.source_strength;
    if (strength && strength->per >= 0) add_strength_control(model, scene, strength);
    if (!design->unknowns.flux_density) return;
    add_flux_control(model, scene, design->unknowns.flux_density);
    for (int k = 0; k < design->objectives_count; k++) {
        const ObjectiveScene *row = &design->objectives[k];
        if (isnan(row->dmp)) continue;
        params_add(model->params, "dmp_omega", "rad/s", row->pairs, 1, false);
        params_add(model->params, "dmp_alpha", "T", row->pairs, 3, false);
        params_add(model->params, "dmp_beta", "T", row->pairs, 3, false);
        return; /* a second one is refused */
    }
}
