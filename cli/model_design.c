/* The scene's unknowns and objectives. */
#include "base/memory.h"
#include "base/random.h"
#include "cli/build.h"
#include "cli/model.h"
#include "optim/objectives.h"
#include "shell/smoothness.h"
#include <math.h>
#include <string.h>

/* ---- Unknowns ---- */

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
    Start start = {.name = name, .block = params_find(&model->shell->params, name), .noise = noise};
    size_t size = (size_t)(start.block->count * start.block->width);
    start.values = mem_copy(p + start.block->offset, size, sizeof(double));
    /* Each block has a sequence of its own, so that another unknown beside it changes nothing. */
    start.random = random_seed((uint64_t)seed * PARAMS_MAX_BLOCKS +
                               (uint64_t)(start.block - model->shell->params.blocks));
    return start;
}

/* Face groups of the mesh: group[face] from 0, -1 in none; a face in several belongs to the last. */
static int *face_groups(const Mesh *mesh, int *count)
{
    int *group = mem_alloc((size_t)mesh->face_count, sizeof *group);
    *count = 0;
    for (int f = 0; f < mesh->face_count; f++) group[f] = -1;
    for (int g = 0; g < mesh->group_count; g++) {
        if (mesh->groups[g].dim != 2) continue;
        for (int k = 0; k < mesh->groups[g].count; k++) group[mesh->groups[g].members[k]] = *count;
        (*count)++;
    }
    return group;
}

/* Noise, then the start goes into all cases and the unknown into the design. Rows of one group get the same
 * noise. */
static bool add_unknown(Model *model, YamlFile *file, Design *design, Start *start, Unknown unknown, int per)
{
    bool ok = true;
    const ParamBlock *block = unknown.block = start->block;
    unknown.group_count = block->count;
    if (per == PER_GROUP) unknown.group = face_groups(model->shell->mesh, &unknown.group_count);
    if (unknown.group_count == 0)
        ok = yaml_refuse(file, key("design.unknowns.%s.per", start->name).text,
                         "the mesh has no groups of faces");
    double *noise = mem_alloc((size_t)(unknown.group_count * block->width), sizeof *noise);
    for (int i = 0; i < unknown.group_count * block->width; i++)
        noise[i] = start->noise * random_signed(&start->random);
    for (int i = 0; i < block->count * block->width; i++) {
        int row = unknown.group ? unknown.group[i / block->width] : i / block->width;
        if (row >= 0) start->values[i] += noise[row * block->width + i % block->width];
    }
    mem_free(noise);
    for (int c = 0; c < model->case_count; c++)
        memcpy(model->cases[c].stages[0].p + block->offset, start->values,
               (size_t)(block->count * block->width) * sizeof(double));
    design_add(design, unknown);
    return ok;
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

static bool number_unknown(Model *model, const Build *b, Design *design, const char *name,
                           const NumberUnknown *from, int seed)
{
    Start start = start_of(model, name, model->cases[0].stages[0].p, from->noise, seed);
    Key at = key("design.unknowns.%s", name), at_start = key("%s.start", at.text);
    bool edges = start.block->offset == model->shell->fold, ok = check_bounds(b->file, name, from->bounds);
    if (from->start)
        ok = (edges ? build_edge_numbers(b, at_start, from->start, start.values)
                    : build_face_numbers(b, at_start, from->start, start.values)) &&
             ok;
    double mean = 0;
    for (int i = 0; i < start.block->count; i++) mean += start.values[i] / start.block->count;
    Unknown unknown = {.map = from->scale == SCALE_LOG ? UNKNOWN_LOG : UNKNOWN_LINEAR,
                       .scale = mean > 0 ? mean : 1};
    put_bounds(&unknown, from->bounds);
    ok = ok && add_unknown(model, b->file, design, &start, unknown, from->per);
    for (int i = 0; ok && i < start.block->count; i++)
        if (!(start.values[i] > 0))
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
    if (from->start) ok = build_face_vectors(b, key("%s.start", at.text), from->start, start.values) && ok;
    Unknown unknown = {.map = fixed    ? UNKNOWN_FIXED_LENGTH
                              : capped ? UNKNOWN_CAPPED_LENGTH
                                       : UNKNOWN_LINEAR,
                       .scale = from->scale,
                       .limit = fixed ? from->magnitude : from->max_magnitude};
    put_bounds(&unknown, from->bounds);
    ok = ok && add_unknown(model, b->file, design, &start, unknown, from->per);
    for (int i = 0; ok && i < start.block->count; i++) {
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

/* One value per case, each from its own start. */
static bool flux_unknown(Model *model, const Build *b, Design *design, const FluxUnknown *from, int seed)
{
    bool ok = check_bounds(b->file, "flux_density", from->bounds);
    const ParamBlock *block = params_find(&model->shell->params, "flux_density");
    Random random =
        random_seed((uint64_t)seed * PARAMS_MAX_BLOCKS + (uint64_t)(block - model->shell->params.blocks));
    for (int c = 0; c < model->case_count; c++)
        for (int i = 0; i < 3; i++)
            model->cases[c].stages[0].p[block->offset + i] += from->noise * random_signed(&random);
    Unknown unknown = {.block = block, .group_count = block->count, .scale = from->scale, .per_case = true};
    put_bounds(&unknown, from->bounds);
    design_add(design, unknown);
    return ok;
}

static bool add_unknowns(Model *model, const Scene *scene, const Build *b)
{
    Design *design = &model->design;
    const UnknownsScene *unknowns = &scene->design->unknowns;
    int seed = scene->design->seed;
    design->case_count = model->case_count;
    bool ok = true;
    if (unknowns->magnetization)
        ok = magnetization_unknown(model, b, design, unknowns->magnetization, seed) && ok;
    if (unknowns->young) ok = number_unknown(model, b, design, "young", unknowns->young, seed) && ok;
    if (unknowns->fold) ok = number_unknown(model, b, design, "fold", unknowns->fold, seed) && ok;
    if (unknowns->flux_density) ok = flux_unknown(model, b, design, unknowns->flux_density, seed) && ok;
    if (ok && !design->unknown_count)
        ok = yaml_refuse(b->file, "design.unknowns",
                         "a design needs an unknown: magnetization, young, fold or flux_density");
    return ok;
}

/* ---- Objectives ---- */

static bool target_objective(const ModelCase *c, int vertex_count, YamlFile *file, Key at, double weight,
                             Objective *objective)
{
    if (!c->target) return yaml_refuse(file, at.text, "the case '%s' has no target", c->name);
    int *vertices = mem_alloc((size_t)vertex_count, sizeof *vertices), count = 0;
    double(*target)[3] = mem_alloc((size_t)vertex_count, sizeof *target);
    for (int v = 0; v < vertex_count; v++) {
        if (isnan(c->target[v][0])) continue;
        vertices[count] = v;
        memcpy(target[count++], c->target[v], sizeof *target);
    }
    *objective = objective_target(count, vertices, (const double(*)[3])target, weight);
    mem_free(vertices);
    mem_free(target);
    return true;
}

static bool height_objective(const Build *b, Key at, const ObjectiveScene *from, Objective *objective)
{
    SelectionScene group = {.group = from->of};
    Indices chosen = {0};
    if (!build_selection(b, at, strcmp(from->of, "all") ? &group : NULL, &chosen)) return false;
    *objective = objective_height(chosen.count, chosen.items, from->height);
    mem_free(chosen.items);
    return true;
}

/* What depends on parameters only counts once, in the first case. */
static bool add_objective(Model *model, const Build *b, Key at, const ObjectiveScene *from, int case_index)
{
    ModelCase *c = &model->cases[case_index];
    Objective *objective = &c->objectives[c->objective_count];
    if (!isnan(from->magnetization_smoothness)) {
        if (case_index > 0) return true;
        *objective = shell_magnetization_smoothness(model->shell, from->magnetization_smoothness / c->weight);
    } else if (!isnan(from->target)
                   ? !target_objective(c, b->mesh->vertex_count, b->file, at, from->target, objective)
                   : !height_objective(b, at, from, objective))
        return false;
    c->objective_count++;
    return true;
}

static bool add_objectives(Model *model, const Scene *scene, const Build *b)
{
    int count = scene->design->objectives_count;
    bool ok = true;
    for (int c = 0; c < model->case_count; c++) {
        model->cases[c].objectives = mem_alloc((size_t)count, sizeof(Objective));
        for (int k = 0; k < count; k++)
            ok = add_objective(model, b, key("design.objectives[%d]", k), &scene->design->objectives[k], c) &&
                 ok;
    }
    return ok;
}

bool model_design(Model *model, const Scene *scene, YamlFile *file)
{
    Build b = {.file = file, .mesh = model->shell->mesh, .time = scene->time.at};
    if (!scene->design) return yaml_refuse(file, "job", "a design job needs the key `design`");
    if (scene->sequence_count) return yaml_refuse(file, "sequence", "a design has cases, not a sequence");
    bool ok = add_unknowns(model, scene, &b);
    return add_objectives(model, scene, &b) && ok;
}
