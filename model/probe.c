#include "model/probe.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "model/forces.h"
#include <math.h>
#include <string.h>

/* A state, and where the points are in it. */
typedef struct Moment {
    const Model *model;
    const Snapshot *shot;
    const double *place;
} Moment;

struct ProbeKind {
    const char *unit;
    int width;
    void (*measure)(const ModelProbe *probe, const Moment *now, double *values);
};

/* ---- What is measured ---- */

static Vec3 point_at(const ModelProbe *probe, int k, const Moment *now)
{
    return probe_at(&probe->points[k], now->place, now->shot->p);
}

static void measure_place(const ModelProbe *probe, const Moment *now, double *values)
{
    vec3_store(values, point_at(probe, 0, now));
}

static void measure_height(const ModelProbe *probe, const Moment *now, double *values)
{
    *values = point_at(probe, 0, now).z;
}

static void measure_distance(const ModelProbe *probe, const Moment *now, double *values)
{
    *values = vec3_length(vec3_sub(point_at(probe, 1, now), point_at(probe, 0, now)));
}

/* At the second of three points, or of the line from the first to the second with the axis. Exact also where it is small. */
static void measure_angle(const ModelProbe *probe, const Moment *now, double *values)
{
    Vec3 a = point_at(probe, 0, now), b = point_at(probe, 1, now), u, v;
    if (probe->point_count == 3)
        u = vec3_sub(a, b), v = vec3_sub(point_at(probe, 2, now), b);
    else
        u = vec3_sub(b, a), v = vec3_load(probe->axis);
    *values = atan2(vec3_length(vec3_cross(u, v)), vec3_dot(u, v));
}

static void measure_obstacle(const ModelProbe *probe, const Moment *now, double *values)
{
    Arrays list = {0};
    ContactSums sums = model_contacts(now->model, now->shot, &list);
    memcpy(values, sums.force[probe->number], sizeof *sums.force);
    arrays_clear(&list);
}

static void measure_support(const ModelProbe *probe, const Moment *now, double *values)
{
    double(*force)[3] = mem_alloc((size_t)now->model->support_count, sizeof *force);
    model_support_forces(now->model, now->shot, force);
    memcpy(values, force[probe->number], sizeof *force);
    mem_free(force);
}

static void measure_couple(const ModelProbe *probe, const Moment *now, double *values)
{
    double(*couple)[3] = mem_alloc((size_t)now->model->support_count, sizeof *couple);
    model_support_couples(now->model, now->shot, couple);
    memcpy(values, couple[probe->number], sizeof *couple);
    mem_free(couple);
}

static void measure_held(const ModelProbe *probe, const Moment *now, double *values)
{
    model_force_on(now->model, now->shot, &probe->held, values);
}

static const ProbeKind place_kind = {"m", 3, measure_place}, height_kind = {"m", 1, measure_height},
                       distance_kind = {"m", 1, measure_distance}, angle_kind = {"rad", 1, measure_angle},
                       obstacle_kind = {"N", 3, measure_obstacle}, support_kind = {"N", 3, measure_support},
                       held_kind = {"N", 3, measure_held}, couple_kind = {"N m", 3, measure_couple};

/* ---- Points ---- */

static bool group_mean(const Model *model, const Build *b, Key at, const char *name, Probe *probe)
{
    Indices found = {0};
    if (!model->body->ops->select(model, b, at.text, name, &found)) return false;
    double *alike = mem_alloc((size_t)found.count, sizeof *alike);
    for (int i = 0; i < found.count; i++) alike[i] = 1;
    *probe = (Probe){found.items, masses_fixed(found.count, alike)};
    mem_free(alike);
    return true;
}

/* The centre of mass, a vertex's number, or a group's mean. */
static bool any_point(const Model *model, const Build *b, Key at, const char *name, Probe *probe)
{
    bool center = !strcmp(name, "mass_center"), number = name[strspn(name, "0123456789")] == 0;
    if (center || number) return model_find_point(model, b, at, center ? NULL : name, probe);
    return group_mean(model, b, at, name, probe);
}

static bool add_points(const Model *model, const Build *b, Key at, char *const *names, int count,
                       ModelProbe *probe)
{
    bool ok = true;
    for (int k = 0; k < count; k++)
        if (any_point(model, b, at, names[k], &probe->points[probe->point_count]))
            probe->point_count++;
        else
            ok = false;
    return ok;
}

/* Through one point goes no line that would have an angle. */
static bool check_distinct(const Build *b, Key at, char *const *names, const ModelProbe *probe)
{
    for (int k = 0; k < probe->point_count; k++)
        for (int j = 0; j < k; j++)
            if (probe_is_same(&probe->points[j], &probe->points[k]))
                return yaml_refuse(b->file, at.text, "'%s' and '%s' are one point; they must be different",
                                   names[j], names[k]);
    return true;
}

static bool angle_probe(const Model *model, const Build *b, Key at, const ProbeScene *from, ModelProbe *probe)
{
    bool axis = !isnan(from->axis[0]);
    if (from->angle_count != (axis ? 2 : 3))
        return yaml_refuse(b->file, key("%s.angle", at.text).text,
                           "an angle is that of three points, at the second one, or that of two points' line "
                           "with an `axis`");
    if (axis && vec3_length(vec3_load(from->axis)) == 0)
        return yaml_refuse(b->file, key("%s.axis", at.text).text, "an axis has a direction; it is 0");
    if (axis) memcpy(probe->axis, from->axis, sizeof probe->axis);
    at = key("%s.angle", at.text);
    return add_points(model, b, at, from->angle, from->angle_count, probe) &&
           check_distinct(b, at, from->angle, probe);
}

/* ---- Forces ---- */

static bool obstacle_probe(const Model *model, const Build *b, Key at, const char *name, ModelProbe *probe)
{
    const World *world = model->world;
    char *names = mem_text("");
    int count = world ? world->obstacle_count : 0;
    for (probe->number = 0; probe->number < count; probe->number++) {
        if (!strcmp(world->obstacles[probe->number].name, name)) break;
        names = mem_join(names, probe->number ? ", " : "; there are ", world->obstacles[probe->number].name);
    }
    bool found = probe->number < count;
    if (!found)
        yaml_refuse(b->file, key("%s.obstacle", at.text).text, "there is no obstacle '%s'%s", name,
                    count ? names : ": the scene has none");
    mem_free(names);
    return found;
}

/* What the key `name` below `at` says. */
static bool support_probe(const Model *model, const Build *b, Key at, const char *name, int number,
                          ModelProbe *probe)
{
    probe->number = number;
    if (number < model->support_count) return true;
    at = key("%s.%s", at.text, name);
    return model->support_count == 0
               ? yaml_refuse(b->file, at.text, "nothing holds the body")
               : yaml_refuse(b->file, at.text, "%s is %d; what holds the body has the numbers 0 to %d", name,
                             number, model->support_count - 1);
}

static bool is_held(const Model *model, int point)
{
    for (int k = 0; k < model->support_count; k++)
        for (int i = 0; i < model->supports[k].points.count; i++)
            if (model->supports[k].points.items[i] == point) return true;
    return false;
}

/* On what is held of a group: of one that nothing holds there is no force to tell. */
static bool held_probe(const Model *model, const Build *b, Key at, const char *name, ModelProbe *probe)
{
    at = key("%s.group", at.text);
    if (!model->body->ops->select(model, b, at.text, name, &probe->held)) return false;
    for (int i = 0; i < probe->held.count; i++)
        if (is_held(model, probe->held.items[i])) return true;
    return yaml_refuse(b->file, at.text,
                       "nothing holds '%s': a force is that of what holds, or of an obstacle", name);
}

static bool force_probe(const Model *model, const Build *b, Key at, const ForceScene *from, ModelProbe *probe)
{
    at = key("%s.force", at.text);
    probe->kind = from->obstacle ? &obstacle_kind : from->group ? &held_kind : &support_kind;
    if (from->obstacle) return obstacle_probe(model, b, at, from->obstacle, probe);
    if (!from->group) return support_probe(model, b, at, "fix", from->fix, probe);
    return held_probe(model, b, at, from->group, probe);
}

/* ---- Probes ---- */

/* A column's name, too. */
static bool check_name(const Build *b, Key at, const char *name, bool stages)
{
    static const char *const counts[] = {"stage", "time", "evaluation", "case"}, *const staged[] = {
                                                                                     "t", "load_part", "B",
                                                                                     "gravity"};
    bool count = false, stage = false;
    for (int k = 0; k < 4; k++) count |= !strcmp(name, counts[k]);
    for (int k = 0; stages && k < 4; k++) stage |= !strcmp(name, staged[k]);
    if (count)
        return yaml_refuse(b->file, at.text, "'%s' is the name of the column that counts the rows", name);
    if (stage)
        return yaml_refuse(b->file, at.text,
                           "'%s' is the name of a column that stages have: t, load_part, B, gravity", name);
    return (*name && !strpbrk(name, " .,;\"'#") && build_check_name(b, at, "a probe", name)) ||
           yaml_refuse(b->file, "probes", "'%s' names a column: no blanks, quotes, '.', ',', ';' or '#'",
                       name);
}

static bool read_probe(const Model *model, const Build *b, Key at, const ProbeScene *from, ModelProbe *probe)
{
    if (from->force) return force_probe(model, b, at, from->force, probe);
    if (from->couple != YAML_ABSENT) {
        probe->kind = &couple_kind;
        return support_probe(model, b, at, "couple", from->couple, probe);
    }
    if (from->angle) return probe->kind = &angle_kind, angle_probe(model, b, at, from, probe);
    if (from->distance) {
        probe->kind = &distance_kind;
        return add_points(model, b, key("%s.distance", at.text), from->distance, from->distance_count, probe);
    }
    probe->kind = from->height ? &height_kind : &place_kind;
    if (from->height) return add_points(model, b, key("%s.height", at.text), &from->height, 1, probe);
    probe->point_count = 1;
    if (from->group) return group_mean(model, b, key("%s.group", at.text), from->group, &probe->points[0]);
    return model_find_point(model, b, at, from->vertex, &probe->points[0]);
}

bool model_probes(Model *model, const Scene *scene, YamlFile *file)
{
    Build b = build_start(scene, model->mesh, model->time, file);
    bool ok = true, stages = scene->sequence || scene->load_steps.frames;
    model->probes = mem_alloc((size_t)scene->probes_count, sizeof *model->probes);
    model->probe_count = scene->probes_count;
    for (int k = 0; k < scene->probes_count; k++) {
        const ProbeScene *from = &scene->probes[k];
        Key at = key("probes.%s", from->name);
        model->probes[k].name = mem_text(from->name);
        ok = check_name(&b, at, from->name, stages) && read_probe(model, &b, at, from, &model->probes[k]) &&
             ok;
    }
    return ok;
}

void model_clear_probes(Model *model)
{
    for (int k = 0; k < model->probe_count; k++) {
        ModelProbe *probe = &model->probes[k];
        for (int i = 0; i < PROBE_POINTS; i++) probe_clear(&probe->points[i]);
        mem_free(probe->held.items);
        mem_free(probe->name);
    }
    mem_free(model->probes);
}

int model_probe_width(const ModelProbe *probe)
{
    return probe->kind->width;
}

int model_probe_count(const Model *model)
{
    int count = 0;
    for (int k = 0; k < model->probe_count; k++) count += model->probes[k].kind->width;
    return count;
}

void model_measure(const Model *model, const Snapshot *shot, double *values)
{
    double *place = mem_alloc(3 * (size_t)model->point_count, sizeof *place);
    model->body->ops->places(model, shot->at.x, place);
    Moment now = {model, shot, place};
    for (int k = 0; k < model->probe_count; k++) {
        const ModelProbe *probe = &model->probes[k];
        probe->kind->measure(probe, &now, values);
        values += probe->kind->width;
    }
    mem_free(place);
}

const char *model_probe_rows(const Model *model)
{
    static const char *const names[] = {
        [PROBED_STAGES] = "stage", [PROBED_TIMES] = "time", [PROBED_EVALUATIONS] = "evaluation"};
    return names[model->job->probed];
}

void model_add_probes(const Model *model, const double *values, int rows, bool frame, double number,
                      Arrays *list)
{
    int all = model_probe_count(model), from = 0;
    bool alone = !frame && rows == 1;
    for (int k = 0; k < model->probe_count; k++) {
        const ModelProbe *probe = &model->probes[k];
        int width = probe->kind->width;
        double *own = arrays_numbers(list, (size_t)(rows * width));
        for (int r = 0; r < rows; r++)
            memcpy(own + r * width, values + r * all + from, (size_t)width * sizeof *own);
        char *name = arrays_keep(list, mem_format("probes/%s", probe->name));
        int rank = (width > 1) + !alone;
        arrays_add(list, array_float(name, probe->kind->unit, own, rank, alone ? width : rows, width));
        from += width;
    }
    double *count = arrays_numbers(list, 1);
    *count = number;
    char *name = arrays_keep(list, mem_format("probes/%s", model_probe_rows(model)));
    const char *unit = model->job->probed == PROBED_TIMES ? "s" : "";
    arrays_add(list, array_float(name, unit, count, frame ? 1 : 0, 1, 0));
}
