/* The scene's unknowns. */
#include "base/memory.h"
#include "base/random.h"
#include "model/model.h"
#include "optim/objectives.h"
#include <math.h>
#include <string.h>

/* ---- Unknowns ---- */

/* Each block has a sequence of its own, so that another unknown beside it changes nothing: of any seed there is one for
 * each of so many blocks, the first ones. What became a block after others has one of the last, so that these keep theirs. */
enum { SEQUENCES = 16 };

static bool came_later(const ParamBlock *block)
{
    return !strcmp(block->name, "thickness") || !strcmp(block->name, "density");
}

static Random random_of(const Model *model, const ParamBlock *block, int seed)
{
    bool later = came_later(block);
    int number = later ? SEQUENCES : 0;
    for (const ParamBlock *before = model->params->blocks; before < block; before++)
        if (came_later(before) == later) number += later ? -1 : 1;
    return random_seed((uint64_t)seed * SEQUENCES + (uint64_t)(later ? number - 1 : number));
}

/* One unknown being made: its block, where it stands in the scene, and its start. */
typedef struct Start {
    const char *name;
    const ParamBlock *block;
    double *values; /* [count*width] */
    double noise;
    Random random;
} Start;

static Start start_of(Model *model, const char *name, const double *p, double noise, int seed)
{
    Start start = {.name = name, .block = params_find(model->params, name), .noise = noise};
    size_t size = (size_t)(start.block->count * start.block->width);
    start.values = mem_copy(p + start.block->offset, size, sizeof(double));
    start.random = random_of(model, start.block, seed);
    return start;
}

/* A row of its own for each row of the block. */
static int *each_its_own(int count)
{
    int *group = mem_alloc((size_t)count, sizeof *group);
    for (int r = 0; r < count; r++) group[r] = r;
    return group;
}

/* Rows of the block that act on nothing are left out (`on` NULL: none), and groups that have no others. */
static void leave_out(Unknown *unknown, const bool *on)
{
    int *number = mem_alloc((size_t)unknown->group_count, sizeof *number), count = 0;
    for (int g = 0; g < unknown->group_count; g++) number[g] = -1;
    for (int r = 0; r < unknown->block->count; r++) {
        int *group = &unknown->group[r];
        if (on && !on[r]) *group = -1;
        if (*group < 0) continue;
        if (number[*group] < 0) number[*group] = count++;
        *group = number[*group];
    }
    unknown->group_count = count;
    mem_free(number);
}

/* Which of a block's rows are unknown, and which are one. */
typedef struct Rows {
    int per; /* UnknownPer */
    char *const *groups;
    int groups_count;
} Rows;

#define ROWS_OF(from)                                                                                        \
    (Rows)                                                                                                   \
    {                                                                                                        \
        (from)->per, (from)->groups, (from)->groups_count                                                    \
    }

static bool mark_group(const Build *b, Key at, const MeshGroup *group, int number, int *mark)
{
    for (int m = 0; m < group->count; m++) {
        int element = build_element(b, at, group, m);
        if (element < 0) return false;
        mark[element] = number;
    }
    return true;
}

/* The number of each row's group among those that are meant, from 0, -1: it is in none; what is in several belongs to the
 * last. False after a refusal. */
static bool mark_rows(const Model *model, const Build *b, const Start *start, Rows rows, int *mark,
                      int *count)
{
    Key at = key("design.unknowns.%s.%s", start->name, rows.groups ? "groups" : "per");
    if (!model->mesh) return yaml_refuse(b->file, at.text, "%s has no groups", model->body->noun);
    int dim = model->body->ops->row_dim(model, start->block);
    for (int r = 0; r < start->block->count; r++) mark[r] = -1;
    bool ok = true;
    for (int k = 0; ok && k < rows.groups_count; k++) {
        Key here = key("%s[%d]", at.text, k);
        const MeshGroup *group = build_group(b, here, rows.groups[k], dim);
        ok = group && mark_group(b, here, group, (*count)++, mark);
    }
    for (int g = 0; ok && !rows.groups && g < model->mesh->group_count; g++)
        if (model->mesh->groups[g].dim == dim)
            ok = mark_group(b, at, &model->mesh->groups[g], (*count)++, mark);
    return ok &&
           (*count > 0 || yaml_refuse(b->file, at.text, "the mesh has no groups of %s", build_elements[dim]));
}

/* Its rows; false after a refusal. */
static bool take_rows(const Model *model, const Build *b, const Start *start, Rows rows, Unknown *unknown)
{
    const BodyOps *ops = model->body->ops;
    const ParamBlock *block = unknown->block = start->block;
    int *group = unknown->group = each_its_own(block->count), groups = 0;
    bool marked = rows.groups || rows.per == PER_GROUP;
    int *mark = mem_alloc((size_t)block->count, sizeof *mark); /* all in the one group 0 */
    bool ok = !marked || mark_rows(model, b, start, rows, mark, &groups);
    for (int r = 0; r < block->count; r++)
        group[r] = mark[r] < 0 ? -1 : rows.per == PER_FACE ? r : rows.per == PER_GROUP ? mark[r] : 0;
    mem_free(mark);
    unknown->group_count = rows.per == PER_FACE ? block->count : rows.per == PER_GROUP ? groups : 1;
    const bool *on = ops->rows_on ? ops->rows_on(model, block) : NULL;
    if (ok && (on || rows.groups)) leave_out(unknown, on);
    return ok;
}

/* Noise, then the start goes into all cases and the unknown into the design. Rows of one group get the same
 * noise. */
static void add_unknown(Model *model, Design *design, Start *start, Unknown unknown)
{
    const ParamBlock *block = unknown.block;
    double *noise = mem_alloc((size_t)(unknown.group_count * block->width), sizeof *noise);
    for (int i = 0; i < unknown.group_count * block->width; i++)
        noise[i] = start->noise * random_signed(&start->random);
    for (int i = 0; i < block->count * block->width; i++) {
        int row = unknown.group[i / block->width];
        if (row >= 0) start->values[i] += noise[row * block->width + i % block->width];
    }
    mem_free(noise);
    for (int c = 0; c < model->case_count; c++)
        memcpy(model->cases[c].stages[0].p + block->offset, start->values,
               (size_t)(block->count * block->width) * sizeof(double));
    design_add(design, unknown);
}

static bool check_bounds(YamlFile *file, const char *name, const double *bounds)
{
    if (isnan(bounds[0]) || bounds[0] < bounds[1]) return true;
    return yaml_refuse(file, key("design.unknowns.%s.bounds", name).text,
                       "the lower bound %g is not below the upper one, %g", bounds[0], bounds[1]);
}

static void put_bounds(Unknown *unknown, const double *bounds)
{
    unknown->lower = isnan(bounds[0]) ? -INFINITY : bounds[0];
    unknown->upper = isnan(bounds[0]) ? INFINITY : bounds[1];
}

/* Of the logarithm of a fold's factor f: bending goes with f^2, and three folds bound a face. With 1 the folds go ahead
 * of the moduli, a part of the sheet snaps, and letters end later than without folds (docs/optimisers.md). */
static const double FOLD_UNIT = 0.2;

static bool number_unknown(Model *model, const Build *b, Design *design, const char *name,
                           const NumberUnknown *from, int seed)
{
    Start start = start_of(model, name, model->cases[0].stages[0].p, from->noise, seed);
    Key at = key("design.unknowns.%s", name), at_start = key("%s.start", at.text);
    bool ok = check_bounds(b->file, name, from->bounds);
    if (from->start)
        ok = model->body->ops->put_numbers(model, b, at_start.text, from->start, start.block, start.values) &&
             ok;
    double mean = 0;
    for (int i = 0; i < start.block->count; i++) mean += start.values[i] / start.block->count;
    Unknown unknown = {.map = UNKNOWN_LINEAR, .scale = mean > 0 ? mean : 1};
    if (from->scale == SCALE_LOG)
        unknown.map = UNKNOWN_LOG, unknown.scale = !strcmp(name, "fold") ? FOLD_UNIT : 1;
    put_bounds(&unknown, from->bounds);
    ok = take_rows(model, b, &start, ROWS_OF(from), &unknown) && ok;
    add_unknown(model, design, &start, unknown);
    for (int i = 0; ok && i < start.block->count; i++)
        if (unknown.group[i] >= 0 && !(start.values[i] > 0))
            ok = yaml_refuse(b->file, at.text,
                             "its start, noise included, is %g somewhere; it must be positive",
                             start.values[i]);
    if (ok && from->scale == SCALE_LOG && unknown.lower == 0)
        ok = yaml_refuse(b->file, at.text, "scale: log needs a lower bound above 0");
    mem_free(start.values);
    return ok;
}

static bool magnetization_unknown(Model *model, const Build *b, Design *design, const VectorUnknown *from,
                                  int seed)
{
    const char *name = "magnetization";
    Start start = start_of(model, name, model->cases[0].stages[0].p, from->noise, seed);
    Key at = key("design.unknowns.%s", name);
    bool ok = check_bounds(b->file, name, from->bounds), capped = !isnan(from->max_magnitude),
         fixed = !isnan(from->magnitude);
    if ((capped || fixed) && !isnan(from->bounds[0]))
        ok =
            yaml_refuse(b->file, key("%s.bounds", at.text).text, "bounds and a magnitude exclude each other");
    if (from->start) {
        Key at_start = key("%s.start", at.text);
        ok = model->body->ops->put_vectors(model, b, at_start.text, from->start, start.block, start.values) &&
             ok;
    }
    Unknown unknown = {.map = fixed    ? UNKNOWN_FIXED_LENGTH
                              : capped ? UNKNOWN_CAPPED_LENGTH
                                       : UNKNOWN_LINEAR,
                       .scale = from->scale,
                       .limit = fixed ? from->magnitude : from->max_magnitude};
    put_bounds(&unknown, from->bounds);
    ok = take_rows(model, b, &start, ROWS_OF(from), &unknown) && ok;
    add_unknown(model, design, &start, unknown);
    for (int i = 0; ok && i < start.block->count; i++) {
        if (unknown.group[i] < 0) continue;
        const double *M = start.values + 3 * i;
        double length = sqrt(M[0] * M[0] + M[1] * M[1] + M[2] * M[2]);
        if (fixed && !(length > 0))
            ok = yaml_refuse(b->file, at.text,
                             "a fixed magnitude needs a start that is not zero: give start or noise");
        if (capped && !(length < from->max_magnitude))
            ok =
                yaml_refuse(b->file, at.text, "the start's |M| of %g A/m is not below max_magnitude", length);
    }
    mem_free(start.values);
    return ok;
}

static bool strain_unknown(Model *model, const Build *b, Design *design, const StrainUnknown *from, int seed)
{
    const char *name = "natural_strain";
    Start start = start_of(model, name, model->cases[0].stages[0].p, from->noise, seed);
    Unknown unknown = {.map = UNKNOWN_LINEAR, .scale = from->scale};
    put_bounds(&unknown, from->bounds);
    bool ok = check_bounds(b->file, name, from->bounds);
    ok = take_rows(model, b, &start, (Rows){PER_FACE, NULL, 0}, &unknown) && ok;
    add_unknown(model, design, &start, unknown);
    mem_free(start.values);
    return ok;
}

/* Which rows of a block of sources are meant; false after a refusal. */
static bool mark_sources(const Model *model, const Build *b, const char *name, const SourceUnknown *from,
                         bool *on)
{
    Key at = key("design.unknowns.%s", name);
    const FluxFields *fields = model->fields;
    if (!fields->count)
        return yaml_refuse(b->file, at.text,
                           "the flux density has no source that has a place: a magnet, coil, ..");
    for (int k = 0; k < fields->count; k++) on[k] = !from->sources;
    for (int s = 0; s < from->sources_count; s++) {
        bool known = false;
        for (int k = 0; k < fields->count; k++)
            if (!strcmp(flux_field_name(fields->items[k]), from->sources[s])) on[k] = known = true;
        if (!known)
            return yaml_refuse(b->file, key("%s.sources[%d]", at.text, s).text,
                               "the flux density has no source with a place that is named '%s'",
                               from->sources[s]);
    }
    return true;
}

/* Strengths over time begin with those of the scene: 1. */
static bool strengths_over_time(Model *model, const Build *b, const SourceUnknown *from, int seed)
{
    const Control *control = &model->strengths;
    const ParamBlock *block = params_find(model->params, "strengths");
    Key at = key("design.unknowns.source_strength");
    bool *on = mem_alloc((size_t)model->fields->count, sizeof *on);
    bool known = mark_sources(model, b, "source_strength", from, on);
    mem_free(on);
    if (!known) return false;
    for (int s = 0; control->rows && s < from->sources_count; s++) {
        int field = control->to - model->flux_blocks.strength + s;
        if (strcmp(flux_field_name(model->fields->items[field]), from->sources[s]) != 0)
            return yaml_refuse(b->file, key("%s.sources[%d]", at.text, s).text,
                               "with `per` the sources are named in the scene's order, without gaps");
    }
    if (!control->rows)
        return yaml_refuse(b->file, key("%s.per", at.text).text,
                           "over time there may be %d sources, which stand one after the other",
                           CONTROL_MAX_WIDTH);
    double *rows = model->cases[0].stages[0].p + control->from;
    int ones = control->kind == CONTROL_HARMONIC ? 1 : control->rows;
    Random random = random_of(model, block, seed);
    for (int i = 0; i < control->rows * control->width; i++)
        rows[i] = (i < ones * control->width) + from->noise * random_signed(&random);
    Unknown unknown = {.block = block, .group_count = control->rows, .scale = from->scale};
    put_bounds(&unknown, from->bounds);
    design_add(&model->design, unknown);
    return check_bounds(b->file, "source_strength", from->bounds);
}

static bool source_unknown(Model *model, const Build *b, Design *design, const char *name,
                           const SourceUnknown *from, int seed)
{
    Unknown unknown = {.map = UNKNOWN_LINEAR, .scale = from->scale};
    put_bounds(&unknown, from->bounds);
    bool *on = mem_alloc((size_t)model->fields->count, sizeof *on),
         ok = check_bounds(b->file, name, from->bounds);
    if (mark_sources(model, b, name, from, on)) {
        Start start = start_of(model, name, model->cases[0].stages[0].p, from->noise, seed);
        unknown.block = start.block, unknown.group_count = start.block->count;
        unknown.group = each_its_own(start.block->count);
        leave_out(&unknown, on);
        add_unknown(model, design, &start, unknown);
        mem_free(start.values);
    } else {
        ok = false;
    }
    mem_free(on);
    return ok;
}

/* One value per case, each from its own start. */
static void flux_per_case(Model *model, const FluxUnknown *from, const ParamBlock *block, Random *random,
                          Unknown unknown)
{
    for (int c = 0; c < model->case_count; c++)
        for (int i = 0; i < 3; i++)
            model->cases[c].stages[0].p[block->offset + i] += from->noise * random_signed(random);
    unknown.block = block, unknown.group_count = block->count, unknown.per_case = true;
    design_add(&model->design, unknown);
}

/* The scene's field at the times of a control's rows: of harmonics its Fourier sums over the steps. */
static bool sample_flux(Model *model, const Build *b, const Control *control, double *rows)
{
    double *p = model->cases[0].stages[0].p;
    const Timed *timed = &model->flux_of_time;
    int count = control->kind == CONTROL_KNOT ? control->rows : control->steps;
    Error err;
    for (int k = 0; k < count; k++) {
        double part = control->kind == CONTROL_KNOT ? (double)k / (count - 1) : (double)(k + 1) / count;
        double time = control->start + part * control->duration;
        if (timed_is_given(timed) && !timed_eval(timed, time, p + control->to, &err))
            return yaml_refuse(b->file, "flux_density", "%s", err.text);
        const double *B = p + control->to;
        if (control->kind != CONTROL_HARMONIC) memcpy(rows + 3 * k, B, 3 * sizeof *B);
        for (int r = 0; control->kind == CONTROL_HARMONIC && r < control->rows; r++) {
            double angle = 2 * M_PI * ((r + 1) / 2) * part;
            double w = r == 0 ? 1.0 / count : 2.0 / count * (r % 2 ? cos(angle) : sin(angle));
            for (int i = 0; i < 3; i++) rows[3 * r + i] += w * B[i];
        }
    }
    return true;
}

static bool start_control(Model *model, const Build *b, const FluxStart *start, double *rows)
{
    const Control *control = &model->control;
    const char *at = "design.unknowns.flux_density.start.file";
    if (!start) return sample_flux(model, b, control, rows);
    if (!start->file) {
        int copies = control->kind == CONTROL_HARMONIC ? 1 : control->rows;
        for (int k = 0; k < copies; k++) memcpy(rows + 3 * k, start->value, sizeof start->value);
        return true;
    }
    Table table;
    Error err;
    if (!table_read(start->file, "Bx [T], By [T], Bz [T]", &table, &err))
        return yaml_refuse(b->file, at, "%s", err.text);
    bool ok = table.rows == control->rows ||
              yaml_refuse(b->file, at, "%s has %d rows; the unknown flux density has %d", start->file,
                          table.rows, control->rows);
    if (ok) memcpy(rows, table.values, 3 * (size_t)table.rows * sizeof *rows);
    table_clear(&table);
    return ok;
}

/* A row for each step, knot or coefficient. */
static bool flux_over_time(Model *model, const Build *b, const Scene *scene, Random *random, Unknown unknown)
{
    const FluxUnknown *from = scene->design->unknowns.flux_density;
    const Control *control = &model->control;
    double *rows = model->cases[0].stages[0].p + control->from;
    if (!start_control(model, b, from->start, rows)) return false;
    for (int i = 0; i < 3 * control->rows; i++) rows[i] += from->noise * random_signed(random);
    unknown.block = params_find(model->params, "control");
    unknown.group_count = control->rows;
    design_add(&model->design, unknown);
    return true;
}

static bool flux_unknown(Model *model, const Build *b, const Scene *scene)
{
    const FluxUnknown *from = scene->design->unknowns.flux_density;
    bool ok = check_bounds(b->file, "flux_density", from->bounds);
    const ParamBlock *block = params_find(model->params, "flux_density");
    Random random = random_of(model, block, scene->design->seed);
    Unknown unknown = {.block = block, .scale = from->scale};
    put_bounds(&unknown, from->bounds);
    if (model->job->motion) return flux_over_time(model, b, scene, &random, unknown) && ok;
    flux_per_case(model, from, block, &random, unknown);
    return ok;
}

/* Is it asked of a body that has no such block? */
static bool lacks(const Model *model, const Build *b, const char *name, const void *asked)
{
    return asked && !params_find(model->params, name) &&
           !yaml_refuse(b->file, key("design.unknowns.%s", name).text, "%s has no %s", model->body->noun,
                        name);
}

static bool add_unknowns(Model *model, const Scene *scene, const Build *b)
{
    Design *design = &model->design;
    const UnknownsScene *unknowns = &scene->design->unknowns;
    int seed = scene->design->seed;
    design->case_count = model->case_count;
    const NumberUnknown *numbers[] = {unknowns->young, unknowns->skin_young, unknowns->thickness,
                                      unknowns->fold};
    static const char *const number_names[] = {"young", "skin_young", "thickness", "fold"};
    const SourceUnknown *sources[] = {unknowns->source_strength, unknowns->source_move,
                                      unknowns->source_turn};
    static const char *const source_names[] = {"source_strength", "source_move", "source_turn"};
    bool ok = !lacks(model, b, "magnetization", unknowns->magnetization) &&
              !lacks(model, b, "natural_strain", unknowns->natural_strain) &&
              !lacks(model, b, "flux_density", unknowns->flux_density);
    for (int k = 0; k < 4; k++) ok = ok && !lacks(model, b, number_names[k], numbers[k]);
    if (!ok) return false;
    if (unknowns->magnetization)
        ok = magnetization_unknown(model, b, design, unknowns->magnetization, seed) && ok;
    for (int k = 0; k < 4; k++)
        if (numbers[k]) ok = number_unknown(model, b, design, number_names[k], numbers[k], seed) && ok;
    if (unknowns->natural_strain) ok = strain_unknown(model, b, design, unknowns->natural_strain, seed) && ok;
    if (unknowns->flux_density) ok = flux_unknown(model, b, scene) && ok;
    for (int k = 0; k < 3; k++) {
        bool over_time = k == 0 && sources[k] && sources[k]->per >= 0;
        if (over_time)
            ok = strengths_over_time(model, b, sources[k], seed) && ok;
        else if (sources[k])
            ok = source_unknown(model, b, design, source_names[k], sources[k], seed) && ok;
    }
    if (ok && !design->unknown_count)
        ok = yaml_refuse(b->file, "design.unknowns",
                         "a design needs an unknown: magnetization, young, skin_young, thickness, fold, "
                         "natural_strain, flux_density, source_strength, source_move or source_turn");
    return ok;
}

/* Frequencies and amplitudes of a DMP row. */
static bool add_dmp(Model *model, const Scene *scene, const Build *b)
{
    const ObjectiveScene *row = NULL;
    for (int k = 0; k < scene->design->objectives_count; k++) {
        if (isnan(scene->design->objectives[k].dmp)) continue;
        Key at = key("design.objectives[%d]", k);
        if (row) return yaml_refuse(b->file, at.text, "there is a dmp already; one is enough");
        if (!model->control.rows)
            return yaml_refuse(b->file, at.text, "dmp needs the unknown flux_density of a trajectory");
        row = &scene->design->objectives[k];
    }
    if (!row) return true;
    static const char *const names[] = {"dmp_omega", "dmp_alpha", "dmp_beta"};
    int first[3];
    for (int k = 0; k < 3; k++) {
        const ParamBlock *block = params_find(model->params, names[k]);
        first[k] = block->offset;
        Unknown unknown = {.block = block,
                           .group_count = row->pairs,
                           .scale = k == 0 ? 2 * M_PI / model->control.duration
                                           : scene->design->unknowns.flux_density->scale,
                           .lower = k == 0 ? 0 : -INFINITY,
                           .upper = INFINITY,
                           .auxiliary = true};
        design_add(&model->design, unknown);
    }
    objective_dmp_start(&model->control, row->pairs, first[0], first[1], first[2],
                        model->cases[0].stages[0].p);
    return true;
}

bool model_design(Model *model, const Scene *scene, YamlFile *file)
{
    Build b = build_start(scene, model->mesh, model->time, file);
    if (!scene->design) return yaml_refuse(file, "job", "a %s job needs the key `design`", model->job->name);
    bool ok = add_unknowns(model, scene, &b) && add_dmp(model, scene, &b);
    return model_objectives(model, scene, file) && ok;
}
