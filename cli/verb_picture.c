/* slender picture: a result as PNG, SVG or PDF, or in motion as animated WebP. */
#include "base/memory.h"
#include "cli/verb.h"
#include "io/mark.h"
#include "io/path.h"
#include "io/result.h"
#include "job/outputs.h"
#include "model/stored.h"
#include "view/animation.h"
#include "view/show.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "picture RESULT [-o FILE.png|.svg|.pdf|.webp] [--animation | --stills N | --frame N | --case NAME] "
    "[--field NAME]\n"
    "               [--target beside|over|both] [--view X,Y,Z] [--clip PLANE] [--width PIXELS] [--seconds S] "
    "[--no-arrows] [--no-history] [--force]\n"
    "  -o FILE        default: the result's name with .png, of an animation .webp\n"
    "  --animation    all frames one after the other, 25 a second (of a drawing with output.film: how it "
    "relaxed); so does a\n"
    "                 FILE.webp\n"
    "  --seconds S    how long that takes; default: 6\n"
    "  --stills N     N moments side by side, of rods over each other; default for a motion: 6\n"
    "  --frame N      a frame of the run, from 0\n"
    "                 without any of these: the final state of every load case\n"
    "  --case NAME    one load case\n"
    "  --field NAME   colours: magnetization, young, thickness, von_mises, contact_force, .., or none\n"
    "  --target KIND  the target beside the body, over it as wires (default for a motion), or both; of a "
    "motion's places and\n"
    "                 curves: over\n"
    "  --view X,Y,Z   direction to the eye; default: three quarters from above; of rods: front, side and "
    "top\n"
    "  --clip PLANE   cuts a shell or solid open: x=0.01 (or y, z; m), or a point and a normal, "
    "PX,PY,PZ,NX,NY,NZ; of the\n"
    "                 body at rest, whose cut moves with it; what is on the eye's side is left out\n"
    "  --force        replaces a file of that name that slender has not made";

static const char *const target_words[] = {[PICTURE_TARGET_BESIDE - 1] = "beside",
                                           [PICTURE_TARGET_OVER - 1] = "over",
                                           [PICTURE_TARGET_BOTH - 1] = "both",
                                           NULL};

/* A direction, however long: but its square must be a number, and not 0. */
static bool take_view(void *view, const char *text)
{
    double *v = view, length;
    char end;
    if (sscanf(text, "%lf,%lf,%lf%c", &v[0], &v[1], &v[2], &end) != 3) return false;
    length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return length >= 1e-6 && length <= 1e6;
}

/* One coordinate, or a point and a direction as that of a view. */
static bool take_clip(void *clip, const char *text)
{
    ClipPlane plane = {.normal = {0}};
    double *p = plane.point, *n = plane.normal, at;
    char axis, end;
    if (sscanf(text, "%c=%lf%c", &axis, &at, &end) == 2 && axis >= 'x' && axis <= 'z')
        p[axis - 'x'] = at, n[axis - 'x'] = 1;
    else if (sscanf(text, "%lf,%lf,%lf,%lf,%lf,%lf%c", &p[0], &p[1], &p[2], &n[0], &n[1], &n[2], &end) != 6)
        return false;
    *(ClipPlane *)clip = plane;
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return isfinite(p[0] + p[1] + p[2]) && length >= 1e-6 && length <= 1e6;
}

/* FILE, or NAME.png, of an animation .webp. The caller frees. */
static char *picture_name(const Scene *scene, const char *path, const char *output, bool animation)
{
    if (output) return mem_text(output);
    if (!animation) return outputs_picture(scene, path);
    char *base = path_without_ending(path, ".vtkhdf"), *name = mem_format("%s.webp", base);
    mem_free(base);
    return name;
}

/* *name: where the picture goes; the caller frees. A sentence where there is no result, and where the name is that of
 * the result or of a file that its scene was made of. */
static RunStatus prepare(const char *path, const char *output, bool animation, bool force, char **name,
                         Error *err)
{
    Scene scene;
    YamlFile *file;
    Result *result = result_open(path, err);
    if (!result) return RUN_REFUSED;
    stored_result_scene(result, &file, &scene);
    result_close(result);
    *name = picture_name(&scene, path, output, animation);
    bool ok = outputs_check_source(&scene, path, *name, err) && mark_check(*name, force, err);
    if (!ok) mem_free(*name);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ok ? RUN_DONE : RUN_CANNOT_WRITE;
}

int verb_picture(int argc, char **argv)
{
    ShowDef def = show_default();
    const char *output = NULL, *path;
    double seconds = 6;
    bool animation = false, no_arrows = false, no_history = false, force = false;
    int width = 0, code; /* 0: as usual */
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &output,
         .words = OPTION_WORDS(".png", ".svg", ".pdf", ".webp")},
        {"frame", .kind = OPTION_INT, .value = &def.frame, .least = 0, .most = INT_MAX},
        {"animation", .value = &animation},
        {"seconds", .kind = OPTION_DOUBLE, .value = &seconds, .least = 0.04, .most = 600},
        {"stills", .kind = OPTION_INT, .value = &def.stills, .least = 1, .most = 100},
        {"case", .kind = OPTION_TEXT, .value = &def.only, .words = OPTION_WORDS("CASE")},
        {"field", .kind = OPTION_TEXT, .value = &def.field, .words = OPTION_WORDS("FIELD", "none")},
        {"target", .kind = OPTION_CHOICE, .value = &def.target, .words = target_words},
        {"view", .kind = OPTION_OTHER, .value = def.view, .take = take_view,
         .allowed = "X,Y,Z, finite numbers up to 1e6, and not all 0"},
        {"clip", .kind = OPTION_OTHER, .value = &def.clip, .take = take_clip,
         .allowed = "x=.., y=.., z=.. or PX,PY,PZ,NX,NY,NZ, finite numbers, and a normal that is not 0"},
        {"width", .kind = OPTION_INT, .value = &width, .least = 400, .most = 4000},
        {"no-arrows", .value = &no_arrows},
        {"no-history", .value = &no_history},
        {"force", .value = &force},
    };
    if (!options_parse(argc, argv, usage, options, sizeof options / sizeof *options, &path, &code))
        return code;
    if (animation + (def.stills > 0) + (def.frame >= 0) > 1)
        return verb_fail(
            RUN_USAGE,
            "--animation, --stills and --frame are three ways to show it: one of them can be given");
    if (no_arrows) def.arrows = false;
    if (no_history) def.history = false;
    if (width) def.width = width;
    Error err;
    char *picture;
    animation = animation || (output && animation_check_path(output, NULL));
    if (output && !(animation ? animation_check_path : canvas_check_path)(output, &err))
        return verb_fail(RUN_USAGE, err.text);
    RunStatus status = prepare(path, output, animation, force, &picture, &err);
    if (status != RUN_DONE) return verb_fail(status, err.text);
    if (animation) {
        def.seconds = seconds;
        if (!width) def.width = 800; /* pixels; a page of paper's worth is too much for a moving one */
    }
    ShowStatus shown = show_result(path, picture, &def, &err);
    mem_free(picture);
    return shown == SHOW_DONE ? RUN_DONE
                              : verb_fail(shown == SHOW_HAS_NOT ? RUN_REFUSED : RUN_CANNOT_WRITE, err.text);
}
