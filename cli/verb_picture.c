/* slender picture: a result as PNG, SVG or PDF, or in motion as animated WebP. */
#include "base/memory.h"
#include "cli/outputs.h"
#include "cli/show.h"
#include "cli/verb.h"
#include "io/result.h"
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "picture RESULT [-o FILE.png|.svg|.pdf|.webp] [--animation | --stills N | --frame N | --case NAME] "
    "[--field NAME]\n"
    "               [--target beside|over|both] [--view X,Y,Z] [--width PIXELS] [--seconds S] [--no-arrows] "
    "[--no-history]\n"
    "  -o FILE        default: the result's name with .png, of an animation .webp\n"
    "  --animation    all frames one after the other, 25 a second; so does a FILE.webp\n"
    "  --seconds S    how long that takes; default: 6\n"
    "  --stills N     N moments side by side, of rods over each other; default for a motion: 6\n"
    "  --frame N      a frame of the run, from 0\n"
    "                 without any of these: the final state of every load case\n"
    "  --case NAME    one load case\n"
    "  --field NAME   colours: magnetization, young, energy_membrane, .., or none\n"
    "  --target WHERE the target beside the body, over it as wires, or both\n"
    "  --view X,Y,Z   direction to the eye; default: three quarters from above; of rods: front, side and top";

static bool parse_target(const char *word, PictureTarget *target)
{
    static const char *const names[] = {"beside", "over", "both"};
    for (int k = 0; k < 3; k++)
        if (!strcmp(word, names[k])) return *target = (PictureTarget)k, true;
    return false;
}

/* A direction, however long: but its square must be a number, and not 0. */
static bool is_direction(const double view[3])
{
    double length = sqrt(view[0] * view[0] + view[1] * view[1] + view[2] * view[2]);
    return length >= 1e-6 && length <= 1e6;
}

/* FILE, or NAME.png, of an animation .webp. The caller frees. */
static char *picture_name(const Scene *scene, const char *path, const char *output, bool animation)
{
    if (output) return mem_text(output);
    if (!animation) return outputs_picture(scene, path);
    char *base = verb_without_ending(path, ".vtkhdf"), *name = mem_format("%s.webp", base);
    mem_free(base);
    return name;
}

/* *name: where the picture goes; the caller frees. A sentence where there is no result, and where the name is that of
 * the result or of a file that its scene was made of. */
static RunStatus prepare(const char *path, const char *output, bool animation, char **name, Error *err)
{
    Scene scene;
    YamlFile *file;
    Result *result = result_open(path, err);
    if (!result) return RUN_REFUSED;
    verb_result_scene(result, &file, &scene);
    result_close(result);
    *name = picture_name(&scene, path, output, animation);
    bool ok = outputs_check_source(&scene, path, *name, err);
    if (!ok) mem_free(*name);
    yaml_clear(&scene_table, &scene);
    yaml_destroy(file);
    return ok ? RUN_DONE : RUN_CANNOT_WRITE;
}

int verb_picture(int argc, char **argv)
{
    enum {
        FRAME = 256,
        ANIMATION,
        SECONDS,
        STILLS,
        CASE,
        FIELD,
        TARGET,
        VIEW,
        WIDTH,
        NO_ARROWS,
        NO_HISTORY,
        HELP
    };
    static const struct option table[] = {
        {"output", required_argument, NULL, 'o'},    {"frame", required_argument, NULL, FRAME},
        {"animation", no_argument, NULL, ANIMATION}, {"seconds", required_argument, NULL, SECONDS},
        {"stills", required_argument, NULL, STILLS}, {"case", required_argument, NULL, CASE},
        {"field", required_argument, NULL, FIELD},   {"target", required_argument, NULL, TARGET},
        {"view", required_argument, NULL, VIEW},     {"width", required_argument, NULL, WIDTH},
        {"no-arrows", no_argument, NULL, NO_ARROWS}, {"no-history", no_argument, NULL, NO_HISTORY},
        {"help", no_argument, NULL, HELP},           {0}};
    ShowDef def = show_default();
    const char *output = NULL;
    double seconds = 6;
    bool ok = true, animation = false, wide = false, aimed = false;
    for (int c; ok && (c = getopt_long(argc, argv, "o:", table, NULL)) >= 0;) {
        char end;
        if (c == 'o')
            output = optarg;
        else if (c == FRAME)
            ok = sscanf(optarg, "%d%c", &def.frame, &end) == 1 && def.frame >= 0;
        else if (c == ANIMATION)
            animation = true;
        else if (c == SECONDS)
            ok = sscanf(optarg, "%lf%c", &seconds, &end) == 1 && seconds > 0 && seconds <= 600;
        else if (c == STILLS)
            ok = sscanf(optarg, "%d%c", &def.stills, &end) == 1 && def.stills >= 1 && def.stills <= 100;
        else if (c == CASE)
            def.only = optarg;
        else if (c == FIELD)
            def.field = optarg;
        else if (c == TARGET)
            ok = parse_target(optarg, &def.target);
        else if (c == VIEW)
            aimed = ok = sscanf(optarg, "%lf,%lf,%lf%c", &def.view[0], &def.view[1], &def.view[2], &end) == 3;
        else if (c == WIDTH)
            wide = ok =
                sscanf(optarg, "%d%c", &def.width, &end) == 1 && def.width >= 400 && def.width <= 4000;
        else if (c == NO_ARROWS)
            def.arrows = false;
        else if (c == NO_HISTORY)
            def.history = false;
        else
            ok = false;
    }
    if (!ok || optind != argc - 1) return verb_usage(usage);
    if (aimed && !is_direction(def.view))
        return verb_fail(RUN_USAGE, "--view X,Y,Z must be finite numbers up to 1e6, and not all 0");
    Error err;
    char *picture;
    RunStatus status = prepare(argv[optind], output, animation, &picture, &err);
    if (status != RUN_DONE) return verb_fail(status, err.text);
    const char *ending = strrchr(picture, '.');
    if (animation || (ending && !strcmp(ending, ".webp"))) {
        def.seconds = seconds;
        if (!wide) def.width = 800; /* pixels; a page of paper's worth is too much for a moving one */
    }
    int code =
        show_result(argv[optind], picture, &def, &err) ? RUN_DONE : verb_fail(RUN_CANNOT_WRITE, err.text);
    mem_free(picture);
    return code;
}
