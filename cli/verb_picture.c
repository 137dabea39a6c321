/* slender picture: a result as PNG, SVG or PDF. */
#include "base/memory.h"
#include "cli/show.h"
#include "cli/verb.h"
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "picture RESULT [-o FILE.png|.svg|.pdf] [--frame N | --case NAME] [--field NAME] [--target "
    "beside|over|both]\n"
    "               [--view X,Y,Z] [--width PIXELS] [--no-arrows] [--no-history]\n"
    "  -o FILE        default: the result's name with .png\n"
    "  --frame N      a frame of the run, from 0; default: the final state of every load case\n"
    "  --case NAME    one load case\n"
    "  --field NAME   colours: magnetization, young, energy_membrane, .., or none\n"
    "  --target WHERE the target beside the body, over it as wires, or both\n"
    "  --view X,Y,Z   direction to the eye; default: three quarters from above";

static bool parse_target(const char *word, PictureTarget *target)
{
    static const char *const names[] = {"beside", "over", "both"};
    for (int k = 0; k < 3; k++)
        if (!strcmp(word, names[k])) return *target = (PictureTarget)k, true;
    return false;
}

int verb_picture(int argc, char **argv)
{
    enum { FRAME = 256, CASE, FIELD, TARGET, VIEW, WIDTH, NO_ARROWS, NO_HISTORY, HELP };
    static const struct option table[] = {{"output", required_argument, NULL, 'o'},
                                          {"frame", required_argument, NULL, FRAME},
                                          {"case", required_argument, NULL, CASE},
                                          {"field", required_argument, NULL, FIELD},
                                          {"target", required_argument, NULL, TARGET},
                                          {"view", required_argument, NULL, VIEW},
                                          {"width", required_argument, NULL, WIDTH},
                                          {"no-arrows", no_argument, NULL, NO_ARROWS},
                                          {"no-history", no_argument, NULL, NO_HISTORY},
                                          {"help", no_argument, NULL, HELP},
                                          {0}};
    ShowDef def = show_default();
    const char *output = NULL;
    bool ok = true;
    for (int c; ok && (c = getopt_long(argc, argv, "o:", table, NULL)) >= 0;) {
        char end;
        if (c == 'o')
            output = optarg;
        else if (c == FRAME)
            ok = sscanf(optarg, "%d%c", &def.frame, &end) == 1 && def.frame >= 0;
        else if (c == CASE)
            def.only = optarg;
        else if (c == FIELD)
            def.field = optarg;
        else if (c == TARGET)
            ok = parse_target(optarg, &def.target);
        else if (c == VIEW)
            ok = sscanf(optarg, "%lf,%lf,%lf%c", &def.view[0], &def.view[1], &def.view[2], &end) == 3;
        else if (c == WIDTH)
            ok = sscanf(optarg, "%d%c", &def.width, &end) == 1 && def.width >= 400 && def.width <= 4000;
        else if (c == NO_ARROWS)
            def.arrows = false;
        else if (c == NO_HISTORY)
            def.history = false;
        else
            ok = false;
    }
    if (!ok || optind != argc - 1) return verb_usage(usage);
    Error err;
    char *name = verb_without_ending(argv[optind], ".vtkhdf"),
         *picture = output ? mem_text(output) : mem_format("%s.png", name);
    int code =
        show_result(argv[optind], picture, &def, &err) ? RUN_DONE : verb_fail(RUN_CANNOT_WRITE, err.text);
    mem_free(name);
    mem_free(picture);
    return code;
}
