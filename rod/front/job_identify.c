/* Young's modulus and Poisson's ratio of a rod from poses that it was seen in. */
#include "base/memory.h"
#include "job/run.h"
#include "rod/front/curves.h"
#include "rod/front/front.h"
#include "rod/inverse.h"
#include <math.h>

typedef struct Identification {
    Run *run;
    int count;
    RodCurve *curves; /* [count] */
    RodPose *poses;   /* [count] */
    RodMaterial found;
} Identification;

/* With what was found, nu = 1/2 where the poses do not tell. */
static void natural_shapes(const Identification *o, double *natural)
{
    const RodScene *scene = rod_scene(o->run->scene);
    double young = o->found.young_known ? o->found.young : INFINITY,
           poisson = o->found.poisson_known ? o->found.poisson : 0.5;
    RodSection section = rod_circle(scene->radius, young, poisson, scene->density);
    int nodes = o->run->model->point_count;
    Vec3 *moment = mem_alloc(2 * (size_t)nodes - 1, sizeof *moment);
    for (int k = 0; k < o->count; k++) {
        rod_moments(&o->curves[k], rod_model_on_curve(o->run->model->self, k), moment);
        rod_invert(&o->curves[k], section, moment, NULL, (Vec3 *)(natural + 3 * (size_t)k * (size_t)nodes));
    }
    mem_free(moment);
}

static bool put_results(const Identification *o, Error *err)
{
    const RodMaterial *found = &o->found;
    int nodes = o->run->model->point_count;
    size_t size = 3 * (size_t)o->count * (size_t)nodes;
    Arrays list = {0};
    double *input = arrays_numbers(&list, size), *natural = arrays_numbers(&list, size),
           *s = arrays_numbers(&list, (size_t)(o->count * nodes));
    int *starts = arrays_keep(&list, mem_alloc((size_t)o->count + 1, sizeof *starts));
    for (int k = 0; k <= o->count; k++) starts[k] = k * nodes;
    for (int k = 0; k < o->count; k++)
        for (int i = 0; i < nodes; i++) {
            s[k * nodes + i] = o->curves[k].length * i / (nodes - 1);
            vec3_store(input + 3 * (k * nodes + i), o->curves[k].x[2 * i]);
        }
    natural_shapes(o, natural);
    arrays_add(&list, array_text("status", !found->young_known ? "undetermined"
                                           : found->converged  ? "converged"
                                                               : "max_iterations"));
    arrays_add(&list, array_float("rod/identified/young", "Pa", &found->young, 0, 0, 0));
    arrays_add(&list, array_float("rod/identified/poisson", "", &found->poisson, 0, 0, 0));
    arrays_add(&list, array_float("rod/identified/young_error", "Pa", &found->young_error, 0, 0, 0));
    arrays_add(&list, array_float("rod/identified/poisson_error", "", &found->poisson_error, 0, 0, 0));
    arrays_add(&list, array_float("metrics/pose_distance", "m", &found->distance, 0, 0, 0));
    arrays_add(&list, array_float("rod/s", "m", s, 1, o->count * nodes, 0));
    arrays_add(&list, array_float("rod/input", "m", input, 2, o->count * nodes, 3));
    arrays_add(&list, array_float("rod/natural", "m", natural, 2, o->count * nodes, 3));
    arrays_add(&list, array_float("rod/gravity", "m/s^2", rod_scene(o->run->scene)->gravity, 1, 3, 0));
    arrays_add(&list, array_int("rod/strands", starts, 1, o->count + 1, 0));
    return arrays_replace(&list, o->run->journal, "final", err);
}

static void say(const Identification *o)
{
    const RodMaterial *found = &o->found;
    if (!found->converged)
        host_say(o->run->host, "not converged: all iterations were done before the best match was found");
    if (found->young_known)
        host_say(o->run->host, "Young's modulus %.4g Pa (+- %.2g)", found->young, found->young_error);
    else
        host_say(o->run->host,
                 "the poses do not tell Young's modulus: they differ too little for their noise");
    if (found->poisson_known)
        host_say(o->run->host, "Poisson's ratio %.4g (+- %.2g)%s", found->poisson, found->poisson_error,
                 found->poisson_at_limit ? ", at the limit of what is sought" : "");
    else
        host_say(o->run->host, "the poses do not tell Poisson's ratio: too little twist in them");
}

static RunStatus run_identify(Run *run, Error *err)
{
    const RodScene *scene = rod_scene(run->scene);
    size_t count = (size_t)scene->poses_count;
    Identification o = {.run = run,
                        .count = scene->poses_count,
                        .curves = ((const RodModel *)run->model->self)->curves,
                        .poses = mem_alloc(count, sizeof *o.poses)};
    RodIdentifyDef def = rod_model_poses(((const RodModel *)run->model->self), scene, o.poses);
    o.found = rod_identify(&def);
    bool ok = put_results(&o, err);
    if (ok) say(&o);
    mem_free(o.poses);
    return !ok ? RUN_CANNOT_WRITE : o.found.young_known && o.found.converged ? RUN_DONE : RUN_NOT_CONVERGED;
}

static const char *const free_keys[] = {NULL};

const JobRow rod_job_identify = {
    .name = "identify",
    .noun = "an identification",
    .run = run_identify,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
};
