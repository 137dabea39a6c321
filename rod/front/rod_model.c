#include "rod/front/rod_model.h"
#include "base/memory.h"
#include "rod/front/curves.h"
#include "rod/front/front.h"
#include <math.h>
#include <string.h>

enum { DRAWS = 32 }; /* of poses' noise: standard errors are good to 12 % */

/* ---- What a rod is made of ---- */

/* All that a rod is made of must be there. */
static bool check_known(const RodScene *scene, const Build *b)
{
    bool ok = true;
    if (!scene->radius && !scene->ellipse && !scene->section)
        ok = yaml_refuse(b->file, "rod", "`radius`, `ellipse` or `section` is missing");
    if (!scene->young) ok = yaml_refuse(b->file, "rod", "`young`, Young's modulus, is missing");
    if (isnan(scene->poisson)) ok = yaml_refuse(b->file, "rod", "`poisson`, Poisson's ratio, is missing");
    if (isnan(scene->density)) ok = yaml_refuse(b->file, "rod", "`density` is missing");
    return ok;
}

/* One number must not. */
static bool check_sought(const RodScene *scene, const Build *b)
{
    int missing = !scene->young + !scene->radius + isnan(scene->density);
    if (missing == 1) return true;
    return yaml_refuse(
        b->file, "rod", "%s",
        missing ? "of `young`, `radius` and `density` two must be given: what the poses tell is the "
                  "rod's bending stiffness over its loads, and Poisson's ratio"
                : "`young`, `radius` and `density` are all given: the one that is looked for must be "
                  "left out");
}

/* sought: a part of what it is made of is looked for. */
static bool read_properties(RodModel *model, const RodScene *scene, const Build *b, bool sought)
{
    bool ok = (sought ? check_sought : check_known)(scene, b);
    const RodProperties *properties = &model->properties;
    ok = rod_properties_read(scene, b, &model->properties) && ok;
    if (sought && properties->varies)
        return yaml_refuse(b->file, properties->varies,
                           "an identification is of a rod that is the same all along: a number");
    return ok;
}

static bool is_of_curve(const JobRow *job)
{
    return job == &rod_job_invert || job == &rod_job_identify;
}

/* Once its curves are there. */
static bool read_loads(RodModel *model, const Scene *scene, const Build *b)
{
    const RodScene *from = rod_scene(scene);
    double size = model->strand_count ? rod_model_longest(model) : from->length;
    if (!rod_loads_read(from, b, size, is_of_curve(scene_job(scene)), &model->list)) return false;
    Error err;
    int count = model->list.count, curves = model->strand_count ? model->strand_count : 1;
    model->points = mem_alloc((size_t)curves * (size_t)count, sizeof *model->points);
    for (int k = 0; k < curves; k++)
        if (!rod_loads_at(&model->list, rod_model_time(model, k, b->time), model->points + k * count,
                          &model->loads, &err))
            return yaml_refuse(b->file, "rod.loads", "%s", err.text);
    model->line = model->loads.line;
    double mass = model->varied ? 0 : model->unit.mass; /* find_along has what varies */
    model->loads.line = vec3_axpy(mass, vec3_load(from->gravity), model->line);
    return true;
}

/* What varies along the curves of a strand: its own, and draws of its noise. */
static bool find_along(RodModel *model, Vec3 gravity, const Build *b, int k)
{
    int drawn = model->draws ? model->draws[k].count : 0, stations = 2 * model->curves[k].elements + 1;
    Vec3 *along = mem_alloc((size_t)(1 + drawn) * (size_t)stations, sizeof *along);
    double time = rod_model_time(model, k, b->time);
    model->along[k] = along;
    for (int i = 0; i <= drawn; i++, along += stations) {
        const RodCurve *curve = i ? &model->draws[k].curves[i - 1] : &model->curves[k];
        Error err;
        if (!rod_loads_along(&model->list, curve->elements, curve->length, curve, time, along, &err))
            return yaml_refuse(b->file, "rod.loads", "%s", err.text);
        for (int j = 0; model->inertia && j < stations; j++)
            along[j] = vec3_add(along[j], model->inertia[k][j]);
        for (int j = 0; model->varied && j < stations; j++)
            along[j] = vec3_axpy(model->varied[k].unit[j].mass, gravity, along[j]);
    }
    return true;
}

/* Of an inversion or an identification. */
static bool find_all_along(RodModel *model, const RodScene *scene, const Build *b)
{
    bool ok = true;
    if (!model->list.along && !model->list.potentials.count && !model->inertia && !model->varied) return true;
    model->along = mem_alloc((size_t)model->strand_count, sizeof *model->along);
    for (int k = 0; ok && k < model->strand_count; k++)
        ok = find_along(model, vec3_load(scene->gravity), b, k);
    return ok;
}

double rod_model_time(const RodModel *model, int strand, double time)
{
    return model->times ? model->times[strand] : time;
}

RodLoads rod_model_on_curve(const RodModel *model, int strand)
{
    RodLoads loads = model->loads;
    loads.points = model->points + strand * model->list.count;
    if (model->along) loads.along = model->along[strand];
    return loads;
}

RodActs rod_model_acts(const RodModel *model)
{
    return (RodActs){.potentials = model->list.potentials, .couples = model->list.couples};
}

/* What is known of a field in an inversion is one for all frames of a motion. */
static bool check_flux_stays(const RodModel *model, const Scene *scene, const Build *b)
{
    bool stays = true;
    for (int k = 0; stays && model->times && k < model->strand_count; k++) {
        Build then = *b;
        double flux[3];
        FluxFields fields = {0};
        then.time = model->times[k];
        bool known = build_flux(&then, key("flux_density"), scene->flux_density, scene->flux_density_count,
                                flux, &fields);
        flux_fields_clear(&fields);
        if (!known) return false;
        stays = !memcmp(flux, model->flux, sizeof flux);
    }
    return stays ||
           yaml_refuse(b->file, "flux_density",
                       "an inversion knows a field on a rod in `motion` that stays: no formulas of t");
}

/* Of a curve: what the magnetisation does is known along the tangent, the same all along. */
static bool read_magnetic(RodModel *model, const Scene *scene, const Build *b)
{
    const VectorScene *M = &rod_scene(scene)->magnetization;
    FluxFields fields = {0};
    double *flux = model->flux;
    bool ok = build_flux(b, key("flux_density"), scene->flux_density, scene->flux_density_count, flux,
                         &fields),
         varies = fields.count > 0;
    flux_fields_clear(&fields);
    if (!ok) return false;
    if (varies)
        return yaml_refuse(
            b->file, "flux_density",
            "an inversion knows a field that is uniform: three numbers, formulas of t, or a file");
    if (!check_flux_stays(model, scene, b)) return false;
    double value[3];
    build_magnetization(M->value, M->remanence, value);
    bool none = flux[0] == 0 && flux[1] == 0 && flux[2] == 0,
         along = !isnan(value[0]) && value[1] == 0 && value[2] == 0;
    if (!along)
        return yaml_refuse(b->file, "rod.magnetization",
                           "of a curve it must be along the tangent and the same all along: [m, 0, 0]");
    if (!none && value[0] != 0 && model->properties.section_varies)
        return yaml_refuse(b->file, model->properties.section_varies,
                           "in a field an inversion knows a magnetised rod of one section: a number");
    if (!none) model->magnetic = vec3_scale(model->unit.area * value[0], vec3_load(flux));
    model->loads.end = model->magnetic;
    return true;
}

/* Of a curve that is inverted: what holds its last end, as far as it is known. */
static bool read_end(RodModel *model, const EndScene *end, const Build *b)
{
    if (end->choose < 0 && isnan(end->force[0]))
        return yaml_refuse(
            b->file, "rod.end",
            "of an inversion it needs `force` (and `couple`), what holds the end, or `choose`");
    if (end->choose >= 0) return true;
    model->loads.end = vec3_add(model->loads.end, vec3_load(end->force));
    if (end->hold == HOLD_CLAMPED) model->loads.end_couple = vec3_load(end->couple);
    return true;
}

bool rod_model_check_points(const RodModel *model, const Build *b, double length)
{
    for (int k = 0; k < model->loads.point_count; k++)
        if (isfinite(model->points[k].s) && model->points[k].s > length * (1 + 1e-9))
            return yaml_refuse(b->file, "rod.loads", "a load is at s = %g m, beyond the rod's length of %g m",
                               model->points[k].s, length);
    return true;
}

static bool read_poses(RodModel *model, const RodScene *scene, const Build *b)
{
    bool ok = true;
    model->curves = mem_alloc((size_t)scene->poses_count, sizeof *model->curves);
    model->clamps = mem_alloc((size_t)scene->poses_count, sizeof *model->clamps);
    model->draws = mem_alloc((size_t)scene->poses_count, sizeof *model->draws);
    model->strand_count = scene->poses_count;
    Random random = random_seed(1);
    for (int k = 0; k < scene->poses_count; k++) {
        const RodPoseScene *pose = &scene->poses[k];
        Key at = key("rod.poses[%d].file", k);
        model->draws[k] = (RodDraws){.wanted = DRAWS, .random = random};
        ok = rod_curve_read(b, (Sampled){at.text, pose->file, 1, pose->noise, scene->elements},
                            &model->curves[k], &model->draws[k]) &&
             ok;
        random = model->draws[k].random;
        ok = rod_model_frame(b, key("rod.poses[%d].frame", k).text, (const double(*)[3])pose->frame,
                             &model->clamps[k]) &&
             ok;
    }
    return ok;
}

RodIdentifyDef rod_model_poses(const RodModel *model, const RodScene *scene, RodPose *poses)
{
    for (int k = 0; k < model->strand_count; k++)
        poses[k] = (RodPose){&model->curves[k], model->clamps[k], model->draws[k].curves,
                             model->along ? model->along[k] : NULL};
    return (RodIdentifyDef){
        .poses = poses,
        .pose_count = model->strand_count,
        .draw_count = DRAWS,
        .sought = !scene->young    ? ROD_SOUGHT_YOUNG
                  : !scene->radius ? ROD_SOUGHT_RADIUS
                                   : ROD_SOUGHT_DENSITY,
        .young = model->young,
        .radius = scene->radius ? scene->radius->value : NAN,
        .density = scene->density,
        .poisson = scene->poisson,
        .gravity = vec3_load(scene->gravity),
        .loads = {.line = model->line, .point_count = model->loads.point_count, .points = model->points},
        .magnetization = scene->magnetization.value[0],
        .flux_density = vec3_load(model->flux),
    };
}

/* What can be said of poses before they are compared: their lengths may differ by 2 %. */
static bool check_poses(const RodModel *model, const RodScene *scene, const Build *b)
{
    if (scene->poses_count < 2)
        return yaml_refuse(b->file, "rod", "an identification needs two or more `poses` of the rod");
    RodPose *poses = mem_alloc((size_t)scene->poses_count, sizeof *poses);
    RodIdentifyDef def = rod_model_poses(model, scene, poses);
    Error err;
    bool ok = rod_identify_check(&def, &err) || yaml_refuse(b->file, "rod.poses", "%s", err.text);
    mem_free(poses);
    return ok && rod_model_check_points(model, b, 1.02 * model->curves[0].length);
}

RodModel *rod_model_create(const Scene *scene, const Build *b)
{
    RodModel *model = mem_alloc(1, sizeof *model);
    const RodScene *from = rod_scene(scene);
    const JobRow *job = scene_job(scene);
    bool identify = job == &rod_job_identify;
    model->preview = from->solver == ROD_SOLVER_PBD;
    model->coercivity = from->coercivity;
    bool ok = read_properties(model, from, b, identify);
    if (from->curve) {
        RodStrands strands;
        ok = rod_strands_read(b, from, &strands) && ok;
        model->strand_count = strands.count, model->curves = strands.curves, model->frames = strands.frames;
    }
    if (from->motion) ok = ok && rod_read_motion(model, from, b);
    if (identify) ok = read_poses(model, from, b) && ok;
    if (!from->motion) ok = ok && rod_model_take_properties(model, from, b);
    double length = model->strand_count ? rod_model_longest(model) : from->length;
    if (ok) rod_properties_outline(&model->properties, b, length, model->unit.reach, model->outline);
    ok = read_loads(model, scene, b) && ok;
    for (int k = 0; ok && !identify && k < model->strand_count; k++)
        ok = rod_model_check_points(model, b, model->curves[k].length);
    if (ok && is_of_curve(job)) ok = read_magnetic(model, scene, b) && find_all_along(model, from, b);
    if (ok && job == &rod_job_invert && from->end) ok = read_end(model, from->end, b);
    if (ok && identify) ok = check_poses(model, from, b);
    if (ok) return model;
    rod_model_destroy(model);
    return NULL;
}

void rod_model_destroy(RodModel *model)
{
    if (!model) return;
    for (int k = 0; model->inertia && k < model->strand_count; k++) mem_free(model->inertia[k]);
    mem_free(model->inertia);
    for (int k = 0; model->along && k < model->strand_count; k++) mem_free(model->along[k]);
    mem_free(model->along);
    mem_free(model->times);
    rod_model_clear_varied(model);
    RodStrands strands = {model->strand_count, model->curves, model->frames};
    for (int k = 0; model->draws && k < model->strand_count; k++) rod_draws_clear(&model->draws[k]);
    rod_strands_clear(&strands);
    rod_destroy(model->rod);
    mem_free(model->clamps);
    mem_free(model->draws);
    mem_free(model->points);
    rod_loads_clear(&model->list);
    rigid_move_clear(&model->first_moves);
    rigid_move_clear(&model->last_moves);
    mem_free(model->base);
    mem_free(model->natural);
    mem_free(model->moving);
    mem_free(model);
}

bool rod_model_frame(const Build *b, const char *at, const double (*rows)[3], RodFrame *frame)
{
    Vec3 t = vec3_load(rows[0]), n1 = vec3_load(rows[1]), n2 = vec3_load(rows[2]);
    double off = fmax(fabs(vec3_length(t) - 1), fmax(fabs(vec3_length(n1) - 1), fabs(vec3_length(n2) - 1)));
    off = fmax(off, fmax(fabs(vec3_dot(t, n1)), fmax(fabs(vec3_dot(n1, n2)), fabs(vec3_dot(t, n2)))));
    if (!(off <= 1e-3) || vec3_dot(vec3_cross(t, n1), n2) < 0)
        return yaml_refuse(b->file, at,
                           "its rows, tangent, n1, n2, are not orthonormal and right-handed to 1e-3");
    t = vec3_unit(t);
    n1 = vec3_unit(vec3_axpy(-vec3_dot(n1, t), t, n1));
    *frame = (RodFrame){t, n1, vec3_cross(t, n1)};
    return true;
}

/* ---- Numbers along a discrete rod ---- */

/* Arclength of its strand in the middle of an element. */
static double middle(const Rod *rod, int e)
{
    return (e % rod_each(rod) + 0.5) * rod_element_length(rod, e);
}

/* Three formulas of s and L at the elements' middles. */
static bool from_formula(const Build *b, const char *at, char *const *formula, const WhereScene *where,
                         int where_count, const Rod *rod, double *values)
{
    static const char *const variables[] = {"s", "L", NULL};
    Error err;
    Formula *made = build_formula(b, key("%s.formula", at), formula, 3, where, where_count, variables);
    bool ok = made != NULL;
    for (int e = 0; ok && e < rod->elements; e++) {
        double place[] = {middle(rod, e), rod->strand[e / rod_each(rod)].length};
        ok = formula_eval(made, place, values + 3 * e, &err) || yaml_refuse(b->file, at, "%s", err.text);
    }
    formula_destroy(made);
    return ok;
}

/* Has the table a row for the middle of each element of a strand? */
static bool is_at_middles(const Table *table, const Rod *rod)
{
    const double little = 1e-2;
    double h = rod_element_length(rod, 0);
    bool own = table->rows == rod_each(rod);
    for (int e = 0; own && e < table->rows; e++)
        own = fabs(table->values[4 * e] - (e + 0.5) * h) <= little * h;
    return own;
}

static bool read_strains(const Build *b, const StrainScene *scene, const Rod *rod, double *strain)
{
    const char *at = "rod.natural_strain";
    if (scene->formula)
        return from_formula(b, at, scene->formula, scene->where, scene->where_count, rod, strain);
    for (int i = 0; !scene->file && i < 3 * rod->elements; i++) strain[i] = scene->value[i % 3];
    if (!scene->file) return true;
    Table table;
    bool ok = rod_table_read(b, "rod.natural_strain.file", scene->file,
                             "s [m], twist [1/m], k1 [1/m], k2 [1/m]", rod_length(rod), &table),
         own = ok && is_at_middles(&table, rod);
    for (int e = 0; ok && e < rod->elements; e++)
        if (own)
            memcpy(strain + 3 * e, table.values + 4 * (e % rod_each(rod)) + 1, 3 * sizeof *strain);
        else
            rod_table_at(&table, middle(rod, e), strain + 3 * e);
    table_clear(&table);
    return ok;
}

bool rod_model_vectors(const Build *b, const char *at, const VectorScene *scene, const Rod *rod,
                       double *values)
{
    if (scene->groups)
        return yaml_refuse(b->file, at, "a rod has no groups: give three numbers, formulas of s, or a file");
    if (scene->formula)
        return from_formula(b, at, scene->formula, scene->where, scene->where_count, rod, values);
    for (int e = 0; !scene->file && e < rod->elements; e++)
        build_magnetization(scene->value, scene->remanence, values + 3 * e);
    if (!scene->file) return true;
    Table table;
    Error err;
    if (!table_read(scene->file, "tangent [A/m], n1 [A/m], n2 [A/m]", &table, &err))
        return yaml_refuse(b->file, at, "%s", err.text);
    bool ok = table.rows == rod->elements ||
              yaml_refuse(b->file, at, "%s has %d rows, and the rod %d elements: one row for each is needed",
                          scene->file, table.rows, rod->elements);
    if (ok) memcpy(values, table.values, 3 * (size_t)table.rows * sizeof *values);
    table_clear(&table);
    return ok;
}

bool rod_model_loads(const RodModel *model, int strand, const Rod *rod, const RodScene *scene,
                     const RodCurve *curves, double time, double *p, Error *err)
{
    rod_default_params(rod, model->young, p);
    rod_model_put_young(model, strand, rod, p);
    memcpy(p + rod->gravity, scene->gravity, sizeof scene->gravity);
    p[rod->damping] = scene->damping;
    return rod_loads_put(&model->list, rod, curves, time, p, err);
}

bool rod_model_params(const RodModel *model, const Scene *scene, const Build *b, double *p)
{
    const Rod *rod = model->rod;
    const RodScene *from = rod_scene(scene);
    Error err;
    bool ok = rod_model_loads(model, 0, rod, from, NULL, b->time, p, &err) ||
              yaml_refuse(b->file, "rod.loads", "%s", err.text);
    ok = rod_model_vectors(b, "rod.magnetization", &from->magnetization, rod, p + rod->magnetization) && ok;
    return (!from->natural_strain || read_strains(b, from->natural_strain, rod, p + rod->natural_strain)) &&
           ok;
}

double rod_model_longest(const RodModel *model)
{
    double longest = model->rod ? rod_length(model->rod) : 0;
    for (int k = 0; k < model->strand_count; k++) longest = fmax(longest, model->curves[k].length);
    return longest;
}

bool rod_model_check_preview(const RodModel *model, const Scene *scene, YamlFile *file)
{
    if (model->rod->fields.count)
        return yaml_refuse(
            file, "flux_density",
            "a preview (solver: pbd) knows a uniform field: three numbers, formulas of t, or a file");
    if (model->varied)
        return yaml_refuse(file, model->properties.varies,
                           "a preview (solver: pbd) knows a rod that is the same all along: a number");
    return !scene->output.stress ||
           yaml_refuse(file, "output.stress", "a preview (solver: pbd) knows no moments and forces");
}
