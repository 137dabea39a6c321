/* Where a case's body should be: points of it at places of their own, or a cloud of points on its line. */
#include "base/memory.h"
#include "io/table.h"
#include "model/model.h"
#include "optim/objectives.h"
#include <math.h>
#include <string.h>

/* ---- Which points ---- */

/* Of a body without a mesh: numbers of points, and parts that have names. */
static bool mark_parts(const Model *model, const Build *b, Key at, const SelectionScene *on, bool *marked)
{
    Indices part = {0};
    int count = model->point_count;
    if (on->boundary || on->ball || on->box_count || (!on->group && !on->vertices_count))
        return yaml_refuse(b->file, at.text, "the points of %s are chosen by `group` or `vertices`",
                           model->body->noun);
    for (int k = 0; k < on->vertices_count; k++)
        if (on->vertices[k] < 0 || on->vertices[k] >= count)
            return yaml_refuse(b->file, at.text, "there is no point %d; there are 0 to %d", on->vertices[k],
                               count - 1);
        else
            marked[on->vertices[k]] = true;
    if (!on->group) return true;
    if (!model->body->ops->select(model, b, at.text, on->group, &part)) return false;
    for (int v = 0, k = 0; v < count; v++) { /* both conditions hold */
        bool within = k < part.count && part.items[k] == v;
        k += within;
        marked[v] = within && (marked[v] || !on->vertices_count);
    }
    mem_free(part.items);
    return true;
}

/* marked[point_count], all of them where nothing is said. */
static bool mark_points(const Model *model, const Build *b, Key at, const SelectionScene *on, bool *marked)
{
    Indices chosen = {0};
    if (on && !model->mesh) return mark_parts(model, b, at, on, marked);
    if (on && !build_selection(b, at, on, &chosen)) return false;
    for (int v = 0; v < model->point_count; v++) marked[v] = !on;
    for (int k = 0; k < chosen.count; k++) marked[chosen.items[k]] = true;
    mem_free(chosen.items);
    return true;
}

/* ---- Clouds ---- */

/* The edges of the mesh both of whose ends are chosen; of a body without one what joins its points in turn. */
static bool take_segments(const Model *model, const Build *b, Key at, const bool *chosen, PointCloud *cloud)
{
    const Mesh *mesh = model->mesh;
    int most = mesh ? mesh->edge_count : model->point_count - 1;
    cloud->segments = mem_alloc((size_t)most, sizeof *cloud->segments);
    for (int e = 0; e < most; e++) {
        int ends[2] = {e, e + 1};
        if (mesh) memcpy(ends, mesh->edges[e], sizeof ends);
        if (chosen[ends[0]] && chosen[ends[1]])
            memcpy(cloud->segments[cloud->segment_count++], ends, sizeof ends);
    }
    return cloud->segment_count > 0 ||
           yaml_refuse(b->file, at.text, "no edge has both ends among these vertices");
}

/* "x [m], z [m]", of the coordinates that count. */
static const char *cloud_columns(const bool *axes)
{
    static const char *const names[] = {"y [m], z [m]", "x [m], z [m]", "x [m], y [m]",
                                        "x [m], y [m], z [m]"};
    for (int i = 0; i < 3; i++)
        if (!axes[i]) return names[i];
    return names[3];
}

/* A row for each point: the coordinates that count, in the order of x, y, z, or all three. */
static bool take_points(const Build *b, Key at, const TargetScene *scene, const bool *axes, PointCloud *cloud)
{
    static const bool all[] = {true, true, true};
    int seen = axes[0] + axes[1] + axes[2];
    Table table = {0};
    Error err;
    if (seen < 2)
        return yaml_refuse(b->file, key("%s.axes", at.text).text,
                           "axes is '%s'; a cloud is seen in two coordinates or three", scene->axes);
    at = key("%s.cloud", at.text);
    bool ok = table_read(scene->cloud, NULL, &table, &err);
    if (ok && table.columns != 3 && table.columns != seen)
        ok = error_set(&err, "%s:%d: %d numbers; a row is %s, or all three coordinates", scene->cloud,
                       table.line[0], table.columns, cloud_columns(axes));
    const bool *given = table.columns == 3 ? all : axes;
    ok = ok && table_take_header(&table, scene->cloud, cloud_columns(given), &err);
    if (!ok) yaml_refuse(b->file, at.text, "%s", err.text);
    cloud->point_count = ok ? table.rows : 0;
    cloud->points = mem_alloc((size_t)cloud->point_count, sizeof *cloud->points);
    const double *value = table.values;
    for (int k = 0; k < 3 * cloud->point_count; k++) {
        double read = given[k % 3] ? *value++ : 0, scale = isnan(scene->scale) ? 1 : scene->scale;
        cloud->points[k / 3][k % 3] = axes[k % 3] ? scale * read : NAN;
    }
    table_clear(&table);
    return ok;
}

/* ---- Targets ---- */

/* Of the chosen points, in the coordinates that count. */
static bool take_places(Model *model, const Build *b, Key at, const TargetScene *scene, const bool *axes,
                        const bool *chosen, Target *target)
{
    target->place = mem_alloc((size_t)model->point_count, sizeof *target->place);
    if (!model->body->ops->put_target(model, b, at.text, scene, target->place)) return false;
    for (int i = 0; i < 3 * model->point_count; i++)
        if (!axes[i % 3] || !chosen[i / 3]) target->place[i / 3][i % 3] = NAN;
    return true;
}

static bool add_target(Model *model, const Build *b, Key at, const TargetScene *scene, Case *c)
{
    size_t count = (size_t)c->target_count++;
    c->targets = mem_resize(c->targets, count, count + 1, sizeof *c->targets);
    Target *target = &c->targets[count];
    *target = (Target){.weight = scene->weight, .cloud.blend = scene->blend};
    Key on = key("%s.on", at.text);
    bool axes[3], *chosen = mem_alloc((size_t)model->point_count, sizeof *chosen);
    bool ok = build_axes(b, at, scene->axes, axes) && mark_points(model, b, on, scene->on, chosen) &&
              (scene->cloud ? take_points(b, at, scene, axes, &target->cloud) &&
                                  take_segments(model, b, on, chosen, &target->cloud)
                            : take_places(model, b, at, scene, axes, chosen, target));
    mem_free(chosen);
    return ok;
}

bool model_targets(Model *model, const Build *b, Key at, const TargetScene *list, int count, Case *c)
{
    bool ok = true;
    for (int k = 0; k < count; k++)
        ok = add_target(model, b, count > 1 ? key("%s[%d]", at.text, k) : at, &list[k], c) && ok;
    return ok;
}

double (*model_target_places(const Case *c, int point_count))[3]
{
    double(*place)[3] = NULL;
    for (int k = 0; k < c->target_count; k++) {
        const double(*own)[3] = (const double(*)[3])c->targets[k].place;
        if (!own) continue;
        if (!place) {
            place = mem_copy(own, (size_t)point_count, sizeof *place);
            continue;
        }
        for (int i = 0; i < 3 * point_count; i++)
            if (!isnan(own[i / 3][i % 3])) place[i / 3][i % 3] = own[i / 3][i % 3];
    }
    return place;
}

/* Of a target with places: those of its points that have any. */
static Objective places_objective(const Target *target, int point_count, double weight)
{
    int *points = mem_alloc((size_t)point_count, sizeof *points), count = 0;
    double(*places)[3] = mem_alloc((size_t)point_count, sizeof *places);
    for (int v = 0; v < point_count; v++) {
        const double *place = target->place[v];
        if (isnan(place[0]) && isnan(place[1]) && isnan(place[2])) continue;
        points[count] = v;
        memcpy(places[count++], place, sizeof *places);
    }
    Objective objective = objective_target(count, points, (const double(*)[3])places, weight);
    mem_free(points);
    mem_free(places);
    return objective;
}

Objective model_target_objective(const Target *target, int point_count, double weight)
{
    weight *= target->weight;
    return target->place ? places_objective(target, point_count, weight)
                         : objective_cloud(&target->cloud, weight);
}
