/* Trajectory design: the adjoint beside its motion, and whole jobs until F/F0 reaches a mark (bench/README.md). */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "io/result.h"
#include "model/model.h"
#include "optim/trajectory_adjoint.h"
#include <stdio.h>
#include <stdlib.h>

enum { PRODUCTS = 20 };

#define NOISE "design.unknowns.flux_density.noise=5 mT"

static TrajectoryProblem problem_of(const Model *model, const Scene *scene)
{
    const Case *c = &model->cases[0];
    return (TrajectoryProblem){.sys = c->sys,
                               .design = &model->design,
                               .params = model->params,
                               .controls = &model->control,
                               .objectives = c->objectives,
                               .control_count = 1,
                               .objective_count = c->objective_count,
                               .start = &c->state,
                               .step = scene->time.step,
                               .steps = scene->time.steps,
                               .p = c->stages[0].p};
}

/* A march in a field of noise, its backward sweep and the products of Gauss-Newton. */
static void sweeps(Model *model, const Scene *scene, const char *name)
{
    TrajectoryProblem problem = problem_of(model, scene);
    TrajectoryDef def = trajectory_default();
    Trajectory *t = trajectory_create(&problem, &def);
    TrajectoryInfo info;
    size_t n = (size_t)model->design.size;
    double *u = mem_alloc(3 * n, sizeof *u), *gradient = u + n, *product = gradient + n;
    char text[80];
    design_read(&model->design, 0, problem.p, u);
    trajectory_evaluate(t, u, gradient, &info);
    trajectory_accept(t);
    snprintf(text, sizeof text, "%s_forward_ms_per_step", name);
    bench_print(text, 1e3 * info.forward / scene->time.steps, "ms");
    snprintf(text, sizeof text, "%s_backward_over_forward", name);
    bench_print(text, info.backward / info.forward, "ratio");
    double start = clock_seconds();
    for (int k = 0; k < PRODUCTS; k++) trajectory_product(t, gradient, product);
    snprintf(text, sizeof text, "%s_product_over_forward", name);
    bench_print(text, (clock_seconds() - start) / PRODUCTS / info.forward, "ratio");
    trajectory_destroy(t);
    mem_free(u);
}

void bench_sweeps(const char *name, const char *const assignments[2])
{
    char path[512];
    Scene scene;
    snprintf(path, sizeof path, "%s/scenes/%s.yaml", SOURCE_DIR, name);
    YamlFile *file = yaml_read(path);
    for (int k = 0; k < 2; k++) yaml_override(file, assignments[k]);
    Model *model = yaml_load(file, scene_table(), &scene) ? model_create(&scene, file) : NULL;
    if (!model) bench_fail("%s is refused: %s check says why", path, PROGRAM);
    sweeps(model, &scene, name);
    model_destroy(model);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
}

/* Seconds and evaluations of the program until F/F0 <= mark, and the job's whole time. */
static void job(const char *name, double mark)
{
    char command[1024], text[80];
    Error err;
    Array objective, seconds;
    snprintf(command, sizeof command, "'%s' run '%s/scenes/%s.yaml' --force --quiet --no-picture -o bench_%s",
             PROGRAM, SOURCE_DIR, name, name);
    if (system(command)) bench_fail("the job of %s fails", name);
    snprintf(command, sizeof command, "bench_%s.vtkhdf", name);
    Result *result = result_open(command, &err);
    if (!result || !result_read(result, "slender/history/objective", &objective, &err) ||
        !result_read(result, "slender/history/seconds", &seconds, &err))
        bench_fail("%s", err.text);
    const double *F = objective.data, *s = seconds.data;
    int count = (int)array_count(&objective), k = 0;
    while (k < count - 1 && !(F[k] <= mark * F[0])) k++;
    if (!(F[k] <= mark * F[0]))
        bench_fail("%s ends at F/F0 = %.3g, above its mark, %.3g", name, F[count - 1] / F[0], mark);
    snprintf(text, sizeof text, "%s_seconds_until_mark", name);
    bench_print(text, s[k], "s");
    snprintf(text, sizeof text, "%s_evaluations_until_mark", name);
    bench_print(text, k + 1, "");
    snprintf(text, sizeof text, "%s_seconds", name);
    bench_print(text, s[count - 1], "s");
    array_clear(&objective);
    array_clear(&seconds);
    result_close(result);
}

void bench_trajectory(void)
{
    bench_sweeps("track_line", (const char *const[]){"shell.bending=midedge", NOISE});
    bench_sweeps("track_circle", (const char *const[]){"shell.bending=hinge", NOISE});
    bench_sweeps("kirigami_reach", (const char *const[]){"shell.bending=midedge", NOISE});
    job("track_line", 3.8e-5);
    job("track_circle", 2.3e-5);
    job("kirigami_reach", 4.9e-4);
}
