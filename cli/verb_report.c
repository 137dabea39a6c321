/* slender report: results as a page of HTML. */
#include "base/memory.h"
#include "cli/verb.h"
#include "io/mark.h"
#include "io/path.h"
#include "job/outputs.h"
#include "model/stored.h"
#include "report/report.h"

static const char usage[] =
    "report RESULT.. [-o FILE.html] [--frames N] [--force]\n"
    "  -o FILE     .html or .htm; default: the first result's name with .html\n"
    "  --frames N  how many of each result's frames are in it, evenly spread, at most; default: as many as\n"
    "              10 MB hold\n"
    "  --force     replaces a file of that name that slender has not made\n"
    "  One file that any browser shows, without a net: frames to play, to turn and to zoom, colours, "
    "targets,\n"
    "  charts, facts and the scene. Several results are beside each other, at one time and seen from one "
    "side.\n"
    "  In the page: space plays, arrows step, f colours, t target, m magnetisation, b flux density, e "
    "edges,\n"
    "  d dark, 0 as at first;\n"
    "  FILE.html#at=0.5&field=young&target=beside&view=top&theme=dark begins so (docs/report.md).";

/* The page is neither a result that it is made of nor a file of its scene. */
static RunStatus check_output(const char *result, const char *page, Error *err)
{
    Scene scene;
    YamlFile *file;
    Result *opened = result_open(result, err);
    if (!opened) return RUN_REFUSED;
    stored_result_scene(opened, &file, &scene);
    result_close(opened);
    bool ok = outputs_check_source(&scene, result, page, err);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ok ? RUN_DONE : RUN_CANNOT_WRITE;
}

static RunStatus write_report(char **results, int count, const char *page, const ReportDef *def, bool force,
                              Error *err)
{
    for (int k = 0; k < count; k++) {
        RunStatus status = check_output(results[k], page, err);
        if (status != RUN_DONE) return status;
    }
    if (!mark_check(page, force, err)) return RUN_CANNOT_WRITE;
    ShowStatus shown = report_write((const char *const *)results, count, page, def, err);
    return shown == SHOW_DONE ? RUN_DONE : shown == SHOW_HAS_NOT ? RUN_REFUSED : RUN_CANNOT_WRITE;
}

int verb_report(int argc, char **argv)
{
    ReportDef def = {0};
    const char *output = NULL;
    bool force = false;
    char **results;
    int count, code;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &output,
         .words = OPTION_WORDS(".html", ".htm")},
        {"frames", .kind = OPTION_INT, .value = &def.frames, .least = 1, .most = 100000},
        {"force", .value = &force},
    };
    if (!options_parse_all(argc, argv, usage, options, sizeof options / sizeof *options, &results, &count,
                           &code))
        return code;
    if (output && !path_has_ending(output, ".html") && !path_has_ending(output, ".htm"))
        return verb_fail(RUN_USAGE, "-o FILE must end in .html or .htm: a report is a page of HTML");
    Error err;
    char *base = path_without_ending(results[0], ".vtkhdf"),
         *page = output ? mem_text(output) : mem_format("%s.html", base);
    RunStatus status = write_report(results, count, page, &def, force, &err);
    mem_free(base);
    mem_free(page);
    return status == RUN_DONE ? RUN_DONE : verb_fail(status, err.text);
}
