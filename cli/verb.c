#include "cli/verb.h"
#include "base/memory.h"
#include "cli/say.h"
#include "solve/kernels.h"
#include "solve/ranks.h"
#include "sweep/sweep.h"
#include <stdio.h>
#include <string.h>

int verb_fail(int code, const char *sentence)
{
    say(stderr, "slender: %s", sentence);
    return code;
}

static void print_report(YamlFile *file)
{
    char *report = yaml_report(file);
    say_lines(stderr, report);
    mem_free(report);
}

/* What factors are spread over is started; others of several processes have nothing to do, and no thought of it. */
static void start_ranks(const Scene *scene)
{
    if (direct_is_spread(scene->solver.direct))
        ranks_start();
    else if (ranks_count() > 1)
        say(stderr,
            "warning: of %d processes one works: only `solver: {direct: mumps}` gives work to the others",
            ranks_count());
}

/* A sweep is many runs of a scene, and none itself. */
static bool refuse_sweep(YamlFile *file, const char *path)
{
    if (yaml_says(file, "slender") || !yaml_says(file, sweep_table.version)) return false;
    say(stderr, "%s: it is a sweep, which is many runs of a scene: slender sweep %s", path, path);
    return true;
}

bool verb_load_scene(const char *path, const Settings *settings, YamlFile **file, Scene *scene)
{
    *scene = (Scene){0};
    *file = yaml_read(path);
    if (refuse_sweep(*file, path)) return false;
    for (int k = 0; settings && k < settings->count; k++) yaml_override(*file, settings->text[k]);
    if (!yaml_load(*file, scene_table(), scene)) {
        print_report(*file);
        return false;
    }
    start_ranks(scene);
    return true;
}

Model *verb_build_model(const Scene *scene, YamlFile *file)
{
    if (kernels_reserve(1) < 1) mem_exhausted("OpenBLAS, which works in 128 MB");
    Model *model = model_create(scene, file);
    if (!model) print_report(file);
    for (int k = 0; model && k < model->report.warning_count; k++)
        say(stderr, "warning: %s", model->report.warnings[k]);
    return model;
}
