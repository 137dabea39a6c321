/* What all bodies with a mesh do alike: what is held, and where it is moved; loads, targets, values, parts; cases made ready. */
#include "base/memory.h"
#include "model/forces.h"
#include "solve/ramp.h"
#include "surface/rigid.h"
#include <math.h>
#include <string.h>

/* Do two motions lead a vertex to one place, as far as both move it? At up to 64 times, or in statics at one. */
static bool agree(const Build *b, const Motion *motion, const Motion *other, int v)
{
    const double little = 1e-9;
    int times = b->duration > 0 ? 64 : 0;
    bool same = true;
    for (int k = 0; same && k <= times; k++) {
        double variables[BUILD_VARIABLES], place[3], there[3];
        build_position(variables, b->mesh->rest[v], b->time + (times ? b->duration * k / times : 0));
        if (!formula_eval(motion->formula, variables, place, NULL) ||
            !formula_eval(other->formula, variables, there, NULL))
            return true; /* what has no value is told where it is needed */
        for (int i = 0; i < 3; i++)
            same &= !motion->axis[i] || !other->axis[i] || fabs(place[i] - there[i]) <= little * b->size;
    }
    return same;
}

/* A vertex that two entries move goes to one place. */
static bool check_motion(const Model *model, const Build *b, const Motion *motion)
{
    int disagree = -1, entry = 0;
    bool *moved = mem_alloc((size_t)b->mesh->vertex_count, sizeof *moved);
    for (int k = 0; k < motion->vertices.count; k++) moved[motion->vertices.items[k]] = true;
    for (int m = 0; disagree < 0 && m < model->motion_count; m++) {
        const Motion *other = &model->motions[m];
        for (int k = 0; disagree < 0 && k < other->vertices.count; k++) {
            int v = other->vertices.items[k];
            if (moved[v] && !agree(b, motion, other, v)) disagree = v, entry = other->entry;
        }
    }
    mem_free(moved);
    return disagree < 0 || yaml_refuse(b->file, key("fix[%d].move", motion->entry).text,
                                       "vertex %d is moved here to another place than by fix[%d]",
                                       b->mesh->file_vertex[disagree], entry);
}

static bool add_motion(Model *model, const Build *b, int entry, const FixScene *fix, const bool *axis,
                       Indices vertices)
{
    Key at = key("fix[%d].move", entry);
    for (int i = 0; i < 3; i++) {
        const char *own = (const char *[]){"x", "y", "z"}[i];
        if (!axis[i] && strcmp(fix->move[i], "0") && strcmp(fix->move[i], own))
            return yaml_refuse(b->file, key("%s[%d]", at.text, i).text,
                               "axes is '%s', so nothing is moved along %s: its expression must be 0 or %s, "
                               "not \"%s\"",
                               fix->axes, own, own, fix->move[i]);
    }
    Motion motion = {.vertices = vertices, .axis = {axis[0], axis[1], axis[2]}, .entry = entry};
    motion.formula = build_formula(b, at, fix->move, 3, NULL, 0, build_variables_time);
    if (!motion.formula) return false;
    if (!check_motion(model, b, &motion)) {
        formula_destroy(motion.formula);
        return false;
    }
    size_t count = (size_t)model->motion_count++;
    model->moves = true;
    model->motions = mem_resize(model->motions, count, count + 1, sizeof *model->motions);
    motion.vertices.items = mem_copy(vertices.items, (size_t)vertices.count, sizeof(int));
    model->motions[count] = motion;
    return true;
}

/* Into which a fix entry goes. */
typedef struct Held {
    bool *fixed, *clamped;
} Held;

static bool fix_entry(Model *model, const Build *b, int entry, const FixScene *fix, Held held)
{
    Key at = key("fix[%d]", entry);
    bool axis[3];
    if (!build_axes(b, at, fix->axes, axis)) return false;
    Indices found = {0};
    SelectionScene selection = SELECTION_OF(fix);
    bool ok = build_selection(b, at, &selection, &found);
    for (int i = 0; i < 3 * found.count; i++)
        if (axis[i % 3]) held.fixed[3 * found.items[i / 3] + i % 3] = true;
    if (ok && fix->clamp && !held.clamped)
        ok = yaml_refuse(b->file, key("%s.clamp", at.text).text,
                         "%s has no slopes of edges: what its fixed points span is held", model->body->noun);
    if (ok && fix->clamp) {
        Indices edges = select_edges(b->mesh, &found);
        for (int k = 0; k < edges.count; k++) held.clamped[edges.items[k]] = true;
        mem_free(edges.items);
    }
    if (ok && fix->move_count) ok = add_motion(model, b, entry, fix, axis, found);
    model_add_support(model, found, axis);
    return ok;
}

bool model_hold(Model *model, const Build *b, const Scene *scene, bool *fixed, bool *clamped)
{
    bool ok = true;
    for (int k = 0; k < scene->fix_count; k++)
        ok = fix_entry(model, b, k, &scene->fix[k], (Held){fixed, clamped}) && ok;
    return ok;
}

bool model_move_held(const Model *model, HeldWay way, double *x, Error *err)
{
    double part = ramp_part(way.from, way.to);
    for (int m = 0; m < model->motion_count; m++) {
        const Motion *motion = &model->motions[m];
        for (int k = 0; k < motion->vertices.count; k++) {
            int v = motion->vertices.items[k];
            double variables[BUILD_VARIABLES], place[3];
            build_position(variables, model->mesh->rest[v], way.time);
            if (!formula_eval(motion->formula, variables, place, err))
                return model_unknown(model, key("fix[%d].move", motion->entry).text, err);
            for (int i = 0; i < 3; i++)
                if (motion->axis[i]) x[3 * v + i] += part * (place[i] - x[3 * v + i]);
        }
    }
    return true;
}

/* ---- Loads, targets, values, parts ---- */

bool model_put_loads(Model *model, const Build *b, const char *at, const LoadScene *loads, int count,
                     double *p)
{
    return build_loads(b, key("%s", at), loads, count, p + params_find(model->params, "load")->offset);
}

bool model_put_target(Model *model, const Build *b, const char *at, const TargetScene *scene,
                      double (*target)[3])
{
    (void)model;
    return build_target(b, key("%s", at), scene, target);
}

bool model_put_numbers(Model *model, const Build *b, const char *at, const NumberScene *scene,
                       const ParamBlock *block, double *values)
{
    return build_numbers(b, key("%s", at), model->body->ops->row_dim(model, block), block->unit, scene,
                         values);
}

bool model_put_vectors(Model *model, const Build *b, const char *at, const VectorScene *scene,
                       const ParamBlock *block, double *values)
{
    return build_vectors(b, key("%s", at), model->body->ops->row_dim(model, block), scene, values);
}

bool model_select(const Model *model, const Build *b, const char *at, const char *name, Indices *found)
{
    (void)model;
    SelectionScene group = {.group = (char *)name};
    return build_selection(b, key("%s", at), strcmp(name, "all") ? &group : NULL, found);
}

void model_places(const Model *model, const double *x, double *place)
{
    memcpy(place, x, 3 * (size_t)model->point_count * sizeof *place);
}

void model_masses(const Model *model, const double *p, double *mass)
{
    Masses masses = model->body->ops->masses(model);
    masses_all(&masses, p, mass);
    masses_clear(&masses);
}

void model_supports(const Model *model, const Snapshot *shot, double *force)
{
    model_held_forces(model, shot, 0, force);
}

/* ---- Cases ---- */

bool model_start_cases(Model *model, const Build *b, const bool *fixed)
{
    const BodyOps *ops = model->body->ops;
    const World *world = model->world;
    int load = params_find(model->params, "load")->offset;
    double *mass = mem_alloc((size_t)model->point_count, sizeof *mass);
    model_masses(model, model->cases[0].stages[0].p, mass);
    bool ok = true, borne = world && (world->obstacle_count || world->self);
    for (int k = 0; ok && k < model->case_count; k++) {
        Case *c = &model->cases[k];
        Error err;
        case_start(c, model_take_system(model, ops->system(model, model->job->motion)), model->x);
        system_accept(c->sys, c->state.x, c->state.memory);
        for (int s = 0; ok && model->job->rest && !borne && s < c->stage_count; s++)
            ok = rigid_check_force(b->mesh, fixed, mass, c->stages[s].p + model->gravity,
                                   c->stages[s].p + load, &err) ||
                 yaml_refuse(b->file, "", "%s", err.text);
    }
    mem_free(mass);
    return ok;
}
