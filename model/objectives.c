/* The scene's objectives. */
#include "base/memory.h"
#include "model/probe.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Shapes ---- */

static bool height_objective(const Model *model, const Build *b, Key at, const ObjectiveScene *from,
                             double weight, Objective *objective)
{
    Indices chosen = {0};
    if (!model->body->ops->select(model, b, at.text, from->of, &chosen)) return false;
    *objective = isnan(from->at) ? objective_height(chosen.count, chosen.items, weight)
                                 : objective_height_at(chosen.count, chosen.items, from->at, weight);
    mem_free(chosen.items);
    return true;
}

/* ---- Points ---- */

static bool center_of_mass(const Model *model, const Build *b, Key at, Probe *probe)
{
    if (!model->body->ops->masses)
        return yaml_refuse(b->file, at.text, "the centre of mass of %s is not known", model->body->noun);
    *probe = probe_center(model->body->ops->masses(model));
    return true;
}

bool model_point_number(const char *text, int count, int *point)
{
    char *end;
    long number = strtol(text, &end, 10);
    if (!*text || *end || number < 0 || number >= count) return false;
    *point = (int)number;
    return true;
}

/* A vertex of the mesh's file, or a group's only one. */
static bool mesh_point(const Model *model, const Build *b, Key at, const char *vertex, int *point)
{
    const Mesh *mesh = model->mesh;
    const MeshGroup *group = mesh_group(mesh, vertex, 0);
    Error err;
    int number;
    if (group && group->count == 1) {
        *point = group->members[0];
        return true;
    }
    return (model_point_number(vertex, mesh->file_vertex_count, &number) &&
            mesh_vertex(mesh, number, point, &err)) ||
           yaml_refuse(
               b->file, at.text,
               "vertex is '%s'; it must be a number from 0 to %d or the name of a group of one vertex",
               vertex, mesh->file_vertex_count - 1);
}

/* Of a body without a mesh. */
static bool only_point(const Model *model, const Build *b, Key at, const char *vertex, int *point)
{
    Indices found = {0};
    if (!model->body->ops->select(model, b, at.text, vertex, &found)) return false;
    bool one = found.count == 1;
    *point = found.items[0];
    mem_free(found.items);
    return one || yaml_refuse(b->file, at.text, "vertex is '%s', which is %d points; it must be one", vertex,
                              found.count);
}

bool model_find_point(const Model *model, const Build *b, Key at, const char *vertex, Probe *probe)
{
    if (!vertex) return center_of_mass(model, b, at, probe);
    double one = 1;
    int point;
    if (!(model->mesh ? mesh_point : only_point)(model, b, at, vertex, &point)) return false;
    *probe = (Probe){mem_copy(&point, 1, sizeof point), masses_fixed(1, &one)};
    return true;
}

static bool is_straight(double (*points)[3])
{
    double a[3], c[3], cross = 0, size = 0;
    for (int i = 0; i < 3; i++) a[i] = points[1][i] - points[0][i], c[i] = points[2][i] - points[0][i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        cross += pow(a[j] * c[k] - a[k] * c[j], 2);
        size += c[i] * c[i];
    }
    return sqrt(cross) <= 1e-9 * size;
}

static bool curve_objective(const Build *b, Key at, const CurveScene *curve, const Probe *probe,
                            double weight, Objective *objective)
{
    if (curve->arc && is_straight(curve->arc))
        return yaml_refuse(b->file, key("%s.curve.arc", at.text).text,
                           "the three points of an arc are on one line");
    if (curve->arc)
        *objective = objective_arc(probe, (const double(*)[3])curve->arc, weight);
    else
        *objective = objective_polyline(probe, curve->points_count, (const double(*)[3])curve->points,
                                        curve->blend, weight);
    return true;
}

/* Frames that a row counts at: one, a range, or the last. */
static bool put_frames(const Build *b, Key at, int frame, const int *frames, int steps, Objective *objective)
{
    objective->first = frames ? frames[0] : frame == YAML_ABSENT ? steps : frame;
    objective->last = frames ? frames[1] : objective->first;
    if (objective->first <= objective->last && objective->last <= steps) return true;
    return yaml_refuse(b->file, at.text,
                       "frames %d to %d; they must ascend, and the last one is %d (time.steps)",
                       objective->first, objective->last, steps);
}

/* A waypoint for each target, over the frames from the delay after its switch until the next one. */
static bool reach_objectives(Model *model, const Build *b, Key at, const Scene *scene,
                             const ReachScene *reach, const Probe *probe, double weight)
{
    double step = scene->time.step;
    for (int k = 0; k < reach->targets_count; k++) {
        double due = ceil((k * reach->every + reach->delay) / step - 1e-6),
               gone = fmin(floor((k + 1) * reach->every / step + 1e-6), scene->time.steps);
        if (due > gone)
            return yaml_refuse(
                b->file, at.text,
                "no frame counts for target %d: it is due from %g s to %g s, the motion takes %g s", k + 1,
                k * reach->every + reach->delay, (k + 1) * reach->every, step * scene->time.steps);
        Objective *objective = case_add_objective(&model->cases[0]);
        *objective = objective_waypoint(probe, reach->targets[k], weight);
        objective->first = (int)due, objective->last = (int)gone;
    }
    return true;
}

/* waypoint, curve and reach. */
static bool point_objectives(Model *model, const Build *b, Key at, const Scene *scene,
                             const ObjectiveScene *from)
{
    const WaypointScene *waypoint = from->waypoint;
    const CurveScene *curve = from->curve;
    const char *vertex = waypoint ? waypoint->vertex : curve ? curve->vertex : from->reach->vertex;
    Probe probe;
    if (!model_find_point(model, b, at, vertex, &probe)) return false;
    bool ok;
    if (from->reach) {
        ok = reach_objectives(model, b, at, scene, from->reach, &probe, from->weight);
    } else {
        Objective objective;
        if ((ok = !curve || curve_objective(b, at, curve, &probe, from->weight, &objective))) {
            if (waypoint) objective = objective_waypoint(&probe, waypoint->at, from->weight);
            ok = put_frames(b, at, waypoint ? waypoint->frame : curve->frame,
                            waypoint ? waypoint->frames : curve->frames, scene->time.steps, &objective);
            *case_add_objective(&model->cases[0]) = objective;
        }
    }
    probe_clear(&probe);
    return ok;
}

/* ---- Fields over time ---- */

static bool field_objective(Model *model, const Build *b, Key at, const ObjectiveScene *from)
{
    const Params *params = model->params;
    const Control *control = &model->control;
    if (!control->rows)
        return yaml_refuse(b->file, at.text, "this objective needs the unknown flux_density of a trajectory");
    const ParamBlock *omega = params_find(params, "dmp_omega");
    if (!isnan(from->dmp) && !omega) return false; /* refused before */
    Objective *objective = case_add_objective(&model->cases[0]);
    if (!isnan(from->field_magnitude))
        *objective = objective_field_magnitude(control, from->weight * from->field_magnitude);
    else if (!isnan(from->field_smoothness))
        *objective = objective_field_smoothness(control, from->weight * from->field_smoothness);
    else
        *objective =
            objective_dmp(control, from->pairs, omega->offset, params_find(params, "dmp_alpha")->offset,
                          params_find(params, "dmp_beta")->offset, from->weight * from->dmp);
    return true;
}

/* ---- Rows ---- */

typedef struct Smoothed {
    const char *block; /* whose jumps are to be small; NULL: none */
    double weight;
} Smoothed;

static Smoothed smoothed_of(const ObjectiveScene *from)
{
    const Smoothed rows[] = {{"magnetization", from->magnetization_smoothness},
                             {"young", from->young_smoothness},
                             {"thickness", from->thickness_smoothness},
                             {"fold", from->fold_smoothness}};
    for (int k = 0; k < 4; k++)
        if (!isnan(rows[k].weight)) return rows[k];
    return (Smoothed){0};
}

/* What depends on parameters only counts once, in the first case. */
static bool smoothness_objective(Model *model, const Build *b, Key at, Smoothed smoothed, double weight,
                                 int case_index)
{
    Case *c = &model->cases[case_index];
    if (!model->body->ops->smoothness)
        return yaml_refuse(b->file, at.text, "%s_smoothness is not for %s", smoothed.block,
                           model->body->nouns);
    if (case_index > 0) return true;
    *case_add_objective(c) = model->body->ops->smoothness(model, params_find(model->params, smoothed.block),
                                                          weight * smoothed.weight / c->weight);
    return true;
}

/* A target or height, which in a motion has frames. */
static bool add_shape(Model *model, const Build *b, Key at, const Scene *scene, const ObjectiveScene *from,
                      Case *c, Objective objective)
{
    bool ok =
        !model->job->motion || put_frames(b, at, from->frame, from->frames, scene->time.steps, &objective);
    if (ok)
        *case_add_objective(c) = objective;
    else
        objective_destroy(objective);
    return ok;
}

static bool shape_objectives(Model *model, const Build *b, Key at, const Scene *scene,
                             const ObjectiveScene *from, Case *c)
{
    Objective objective;
    if (isnan(from->target))
        return height_objective(model, b, at, from, from->weight * from->height, &objective) &&
               add_shape(model, b, at, scene, from, c, objective);
    if (!c->target_count) return yaml_refuse(b->file, at.text, "the case '%s' has no target", c->name);
    bool ok = true;
    for (int k = 0; ok && k < c->target_count; k++) {
        objective = model_target_objective(&c->targets[k], model->point_count, from->weight * from->target);
        ok = add_shape(model, b, at, scene, from, c, objective);
    }
    return ok;
}

static bool add_objective(Model *model, const Build *b, Key at, const Scene *scene,
                          const ObjectiveScene *from, int case_index)
{
    bool trajectory = model->job->motion, point = from->waypoint || from->curve || from->reach;
    bool field = !isnan(from->field_magnitude) || !isnan(from->field_smoothness) || !isnan(from->dmp);
    if (point && !trajectory)
        return yaml_refuse(b->file, at.text,
                           "objectives of a point are for trajectories; a design has `target` and `height`");
    if (point) return point_objectives(model, b, at, scene, from);
    if (field) return field_objective(model, b, at, from);
    Smoothed smoothed = smoothed_of(from);
    if (smoothed.block) return smoothness_objective(model, b, at, smoothed, from->weight, case_index);
    return shape_objectives(model, b, at, scene, from, &model->cases[case_index]);
}

bool model_objectives(Model *model, const Scene *scene, YamlFile *file)
{
    Build b = build_start(scene, model->mesh, model->time, file);
    bool ok = true;
    for (int c = 0; c < model->case_count; c++)
        for (int k = 0; k < scene->design->objectives_count; k++)
            ok = add_objective(model, &b, key("design.objectives[%d]", k), scene,
                               &scene->design->objectives[k], c) &&
                 ok;
    return ok;
}
