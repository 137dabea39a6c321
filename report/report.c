#include "report/report.h"
#include "base/memory.h"
#include "base/plain.h"
#include "base/vec3.h"
#include "io/mark.h"
#include "io/safe_file.h"
#include "io/text.h"
#include "report/page.h"
#include "report/report_private.h"
#include "spline/drawn.h"
#include "view/show_curves.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double BYTES_MAX = 1e7; /* of the frames of a result, before they are compressed */

void report_color(Document *document, const char *key, Color color)
{
    char text[8];
    const double rgb[3] = {color.r, color.g, color.b};
    int byte[3];
    for (int i = 0; i < 3; i++) byte[i] = (int)lround(255 * fmin(fmax(rgb[i], 0), 1));
    snprintf(text, sizeof text, "#%02x%02x%02x", byte[0] & 255, byte[1] & 255, byte[2] & 255);
    document_text(document, key, text);
}

/* Of the k-th frame that is shown: the last frames of all are one of each case; of a motion, and of what is before them in
 * a design, it is the last case's. */
static int case_of(const ReportPart *part, int k)
{
    int cases = part->cases.count, from_end = result_step_count(part->data->result) - part->frames[k];
    return from_end > cases ? cases - 1 : cases - from_end;
}

void report_rows(const ReportPart *part, const int *row)
{
    document_open(part->document, "of", '[');
    for (int k = 0; k < part->frame_count; k++) document_number(part->document, NULL, row[case_of(part, k)]);
    document_close(part->document);
}

void report_places(const ReportPart *part, const char *key, const double *places, Packed shape)
{
    size_t count = shape.rows * shape.width;
    double *from_origin = mem_copy(places, count, sizeof *places);
    for (size_t i = 0; i < count; i++) from_origin[i] -= part->origin[i % 3];
    document_packed(part->document, key, from_origin, shape);
    mem_free(from_origin);
}

bool report_is_static(const double *rows, size_t count, size_t width)
{
    for (size_t k = 1; k < count; k++)
        if (memcmp(rows, rows + k * width, width * sizeof *rows) != 0) return false;
    return true;
}

/* ---- Frames ---- */

/* As many as there is room for, of what takes two bytes for a coordinate and, say, six for the numbers of a face. */
static int most_frames(const ReportPart *part)
{
    Array points;
    if (part->most) return part->most;
    if (!result_read_step(part->data->result, "Points", 0, &points, NULL)) return 1;
    double bytes = 18. * points.dims[0];
    array_clear(&points);
    return (int)fmax(2, BYTES_MAX / fmax(bytes, 1));
}

static void choose_frames(ReportPart *part)
{
    int steps = result_step_count(part->data->result), most = steps ? most_frames(part) : 0;
    part->frame_count = steps < most ? steps : most;
    int *frames = show_block(part->data, (size_t)part->frame_count, sizeof *frames);
    for (int k = 0; k < part->frame_count; k++) frames[k] = show_moment(steps, part->frame_count, k);
    part->frames = frames;
    part->timed = part->data->motion;
}

/* Where the points of all frames are. */
static void find_origin(ReportPart *part)
{
    part->way = show_way();
    for (int k = 0; k < part->frame_count; k++) {
        Array points;
        if (!result_read_step(part->data->result, "Points", part->frames[k], &points, NULL)) continue;
        if (array_is(&points, ARRAY_FLOAT64, 2, 3))
            show_way_add(&part->way, (const double(*)[3])points.data, points.dims[0]);
        array_clear(&points);
    }
    Vec3 middle = vec3_scale(0.5, vec3_add(part->way.low, part->way.high));
    if (isfinite(vec3_length(middle))) vec3_store(part->origin, middle);
    document_numbers(part->document, "origin", part->origin, 3);
}

/* "t = 0.2 s"; the last ones are those of the load cases, if there are several. */
static void add_frames(const ReportPart *part)
{
    Document *document = part->document;
    document_open(document, "frames", '{');
    bool staged = result_has(part->data->result, "slender/stages/status");
    const char *const *stages = staged ? report_stages(part) : NULL;
    document_open(document, "labels", '[');
    for (int k = 0; k < part->frame_count; k++)
        document_text(document, NULL,
                      staged ? stages[k] : show_cases_frame(part->data, &part->cases, part->frames[k]));
    document_close(document);
    document_open(document, part->timed ? "times" : "stages", '[');
    for (int k = 0; k < part->frame_count; k++)
        document_number(document, NULL,
                        part->timed ? show_frame_time(part->data, part->frames[k]) : part->frames[k]);
    document_close(document);
    report_evaluations(part);
    document_close(document);
}

/* ---- Results ---- */

static bool ends_with(const char *path, const char *name)
{
    size_t length = strlen(path), end = strlen(name);
    return length > end && path[length - end - 1] == '/' && !strcmp(path + length - end, name);
}

/* The end of a path from as late a folder on as no other one has, but for the same path. */
static const char *name_of(const char *const *results, int count, int which)
{
    const char *path = results[which], *name = path + strlen(path);
    bool shared = true;
    while (shared && name > path) {
        for (name--; name > path && name[-1] != '/';) name--;
        shared = false;
        for (int k = 0; k < count; k++)
            shared |=
                strcmp(results[k], path) != 0 && (!strcmp(results[k], name) || ends_with(results[k], name));
    }
    return name;
}

static bool is_shown(const ShowData *data)
{
    return drawn_has(data->result) || result_has(data->result, "slender/faces") || show_curves_has(data);
}

static bool add_result(Document *document, ShowData *data, ShowDef *show, const char *name,
                       const ReportDef *def, Error *err)
{
    ReportPart part = {.document = document, .data = data, .show = show, .most = def->frames};
    Array status;
    document_open(document, NULL, '{');
    document_text(document, "name", name);
    if (result_read(data->result, "slender/status", &status, NULL)) {
        document_text(document, "status", status.data);
        array_clear(&status);
    }
    if (!show_cases(data, &part.cases, err)) return false;
    choose_frames(&part);
    find_origin(&part);
    add_frames(&part);
    if (!is_shown(data)) return error_set(err, "there is no body and no drawing in it: nothing to show");
    bool ok = drawn_has(data->result) ? report_drawing(&part, err)
                                      : result_check_state(data->result, err) && report_body(&part, err) &&
                                            report_curves(&part, err) && report_surroundings(&part, err);
    if (ok) report_flux(&part);
    ok = ok && report_charts(&part, err) && report_facts(&part, err);
    if (ok) document_close(document);
    return ok;
}

static bool read_result(Document *document, const char *path, const char *name, const ReportDef *def,
                        Error *err)
{
    ShowDef show = show_default();
    ShowData data;
    bool ok = show_data_open(&data, path, &show, err) && add_result(document, &data, &show, name, def, err);
    show_data_clear(&data);
    return ok || (error_prefix(err, "%s", path), false);
}

/* The two colormaps, 33 colours each. */
static void add_colormaps(Document *document)
{
    static const char *const names[] = {"sequential", "diverging"};
    static const Colormap maps[] = {COLORMAP_VIRIDIS, COLORMAP_DIVERGING};
    document_open(document, "colormaps", '{');
    for (int m = 0; m < 2; m++) {
        document_open(document, names[m], '[');
        for (int k = 0; k <= 32; k++) report_color(document, NULL, colormap_color(maps[m], k / 32.));
        document_close(document);
    }
    document_close(document);
}

/* ---- The page ---- */

static bool write_page(const Document *document, const char *title, const char *path, Error *err)
{
    Text page = {0};
    char *block = document_block(document);
    text_add(&page, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" MARK_HTML(
                        SLENDER_VERSION) "\n<title>");
    text_add_xml(&page, title);
    text_add(&page,
             "</title>\n<style>\n%s</style>\n</head>\n%s\n<script id=\"document\" type=\"application/json\">",
             report_page_style, report_page_body);
    text_add(&page, "%s</script>\n<script id=\"block\" type=\"text/plain\">%s</script>\n",
             document_json(document), block);
    text_add(&page, "<script>\n\"use strict\";\n%s</script>\n</html>\n", report_page_script);
    mem_free(block);
    bool ok = safe_file_write(path, page.text, page.length, false, err);
    mem_free(page.text);
    return ok;
}

ShowStatus report_write(const char *const *results, int count, const char *path, const ReportDef *def,
                        Error *err)
{
    Document *document = document_create();
    document_open(document, NULL, '{');
    document_text(document, "version", SLENDER_VERSION);
    add_colormaps(document);
    document_open(document, "results", '[');
    bool ok = true, read;
    for (int k = 0; ok && k < count; k++)
        ok = read_result(document, results[k], name_of(results, count, k), def, err);
    document_close(document);
    document_close(document);
    read = ok;
    const char *slash = strrchr(results[0], '/');
    if (ok) ok = write_page(document, slash ? slash + 1 : results[0], path, err);
    document_destroy(document);
    return ok ? SHOW_DONE : read ? SHOW_CANNOT_WRITE : SHOW_HAS_NOT;
}
