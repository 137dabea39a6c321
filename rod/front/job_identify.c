/* What a rod is made of, from poses that it was seen in. */
#include "base/memory.h"
#include "job/run.h"
#include "rod/front/curves.h"
#include "rod/front/front.h"
#include <math.h>
#include <string.h>

typedef struct Identification {
    Run *run;
    int count;
    RodCurve *curves; /* [count] */
    RodPose *poses;   /* [count] */
    RodIdentifyDef def;
    RodMaterial found;
} Identification;

/* RodSought */
static const struct {
    const char *name, *unit;
} names[] = {{"young", "Pa"}, {"radius", "m"}, {"density", "kg/m^3"}};

/* Natural shapes and strains of all poses, natural[n][3] and strain[n][3], with what was found; where the poses do not tell,
 * nu = 1/2, and the poses themselves. The strains are those in frames that do not twist in the natural shape. */
static void natural_shapes(const Identification *o, double *natural, double *strain)
{
    double poisson = o->found.poisson_known ? o->found.poisson : 0.5;
    size_t nodes = (size_t)o->run->model->point_count, stations = 2 * nodes - 1;
    Vec3 *moment = mem_alloc(2 * stations, sizeof *moment), *k = moment + stations;
    RodFrame *frames = mem_alloc(stations, sizeof *frames);
    RodSection section = rod_identify_section(&o->def, o->found.value, poisson);
    for (int p = 0; p < o->count; p++) {
        const RodCurve *curve = &o->curves[p];
        if (o->found.known) rod_moments(curve, rod_identify_loads(&o->def, p, o->found.value), moment);
        if (!o->found.known) section = rod_circle(1, INFINITY, 0.5, 1);
        rod_invert(curve, rod_alike(&section), moment, NULL, (Vec3 *)(natural + 3 * (size_t)p * nodes));
        rod_bishop(curve, o->poses[p].clamp.n1, frames);
        rod_natural_strains(curve, rod_alike(&section), moment, frames, k);
        rod_untwist(curve, k);
        for (size_t i = 0; i < nodes; i++) vec3_store(strain + 3 * ((size_t)p * nodes + i), k[2 * i]);
    }
    mem_free(frames);
    mem_free(moment);
}

static void add_poses(const Identification *o, Arrays *list)
{
    int nodes = o->run->model->point_count, all = o->count * nodes;
    double *input = arrays_numbers(list, 3 * (size_t)all), *natural = arrays_numbers(list, 3 * (size_t)all),
           *strain = arrays_numbers(list, 3 * (size_t)all), *s = arrays_numbers(list, (size_t)all);
    int *starts = arrays_keep(list, mem_alloc((size_t)o->count + 1, sizeof *starts));
    for (int k = 0; k <= o->count; k++) starts[k] = k * nodes;
    for (int k = 0; k < o->count; k++)
        for (int i = 0; i < nodes; i++) {
            s[k * nodes + i] = o->curves[k].length * i / (nodes - 1);
            vec3_store(input + 3 * (k * nodes + i), o->curves[k].x[2 * i]);
        }
    natural_shapes(o, natural, strain);
    rod_add_mean_strains(strain, o->count, nodes, list);
    arrays_add(list, array_float("rod/s", "m", s, 1, all, 0));
    arrays_add(list, array_float("rod/input", "m", input, 2, all, 3));
    arrays_add(list, array_float("rod/natural", "m", natural, 2, all, 3));
    arrays_add(list, array_float("rod/natural_strain", "1/m", strain, 2, all, 3));
    arrays_add(list, array_int("rod/strands", starts, 1, o->count + 1, 0));
}

/* A number that was found, and its standard error. */
static void add_found(Arrays *list, const char *name, const char *unit, const double *value,
                      const double *error)
{
    const char *path = arrays_keep(list, mem_format("rod/identified/%s", name)),
               *error_path = arrays_keep(list, mem_format("rod/identified/%s_error", name));
    arrays_add(list, array_float(path, unit, value, 0, 0, 0));
    arrays_add(list, array_float(error_path, unit, error, 0, 0, 0));
}

static bool put_results(const Identification *o, Error *err)
{
    const RodMaterial *found = &o->found;
    Arrays list = {0};
    arrays_add(&list, array_text("status", !found->known      ? "undetermined"
                                           : found->converged ? "converged"
                                                              : "max_iterations"));
    add_found(&list, names[o->def.sought].name, names[o->def.sought].unit, &found->value, &found->error);
    if (isnan(o->def.poisson)) add_found(&list, "poisson", "", &found->poisson, &found->poisson_error);
    arrays_add(&list, array_float("metrics/condition", "", &found->condition, 0, 0, 0));
    arrays_add(&list, array_float("metrics/pose_distance", "m", &found->distance, 0, 0, 0));
    arrays_add(&list, array_float("rod/gravity", "m/s^2", rod_scene(o->run->scene)->gravity, 1, 3, 0));
    add_poses(o, &list);
    return arrays_replace(&list, o->run->journal, "final", err);
}

/* "young 7.03e+06 +- 3e+04 Pa; poisson 0.4215 +- 0.0017 (condition 5)" */
static void say(const Identification *o)
{
    const RodMaterial *found = &o->found;
    const char *name = names[o->def.sought].name;
    if (!found->converged)
        host_say(o->run->host, "not converged: all iterations were done before the best match was found");
    char *value =
        found->known
            ? mem_format("%s %.4g +- %.2g %s", name, found->value, found->error, names[o->def.sought].unit)
            : mem_format("%s is not determined: the poses differ too little for their noise", name);
    char *poisson = !isnan(o->def.poisson) ? mem_text("")
                    : found->poisson_known
                        ? mem_format("; poisson %.4g +- %.2g%s", found->poisson, found->poisson_error,
                                     found->poisson_at_limit ? ", at the limit of what is sought" : "")
                        : mem_text("; poisson is not determined: too little twist in the poses");
    host_say(o->run->host, "%s%s (condition %.3g)", value, poisson, found->condition);
    mem_free(value);
    mem_free(poisson);
}

static RunStatus run_identify(Run *run, Error *err)
{
    const RodScene *scene = rod_scene(run->scene);
    size_t count = (size_t)scene->poses_count;
    Identification o = {.run = run,
                        .count = scene->poses_count,
                        .curves = ((const RodModel *)run->model->self)->curves,
                        .poses = mem_alloc(count, sizeof *o.poses)};
    o.def = rod_model_poses(((const RodModel *)run->model->self), scene, o.poses);
    o.found = rod_identify(&o.def);
    bool ok = put_results(&o, err);
    if (ok) say(&o);
    mem_free(o.poses);
    return !ok ? RUN_CANNOT_WRITE : o.found.known && o.found.converged ? RUN_DONE : RUN_NOT_CONVERGED;
}

static const char *const free_keys[] = {NULL};

const JobRow rod_job_identify = {
    .name = "identify",
    .noun = "an identification",
    .run = run_identify,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
};
