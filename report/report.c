#include "report/report.h"
#include "base/memory.h"
#include "base/plain.h"
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

/* ---- Frames ---- */

/* As many as there is room for, of what takes two bytes for a coordinate and, say, six for the numbers of a face. */
static int most_frames(ShowData *data, const ReportDef *def)
{
    Array points;
    if (def->frames) return def->frames;
    if (!result_read_step(data->result, "Points", 0, &points, NULL)) return 1;
    double bytes = 18. * points.dims[0];
    array_clear(&points);
    return (int)fmax(2, BYTES_MAX / fmax(bytes, 1));
}

static void choose_frames(ReportPart *part, const ReportDef *def)
{
    int steps = result_step_count(part->data->result), most = steps ? most_frames(part->data, def) : 0;
    part->frame_count = steps < most ? steps : most;
    int *frames = show_block(part->data, (size_t)part->frame_count, sizeof *frames);
    for (int k = 0; k < part->frame_count; k++) frames[k] = show_moment(steps, part->frame_count, k);
    part->frames = frames;
    part->timed = part->data->motion;
}

/* Of a frame's rows at a path the size of the one, a number or a vector; NAN: there is none. */
static double size_of_row(const ReportPart *part, const char *path, int frame)
{
    Array row;
    double square = 0;
    if (!result_has(part->data->result, path) ||
        !result_read_rows(part->data->result, path, frame, 1, &row, NULL))
        return NAN;
    for (size_t i = 0; row.type == ARRAY_FLOAT64 && i < array_count(&row); i++)
        square += ((double *)row.data)[i] * ((double *)row.data)[i];
    array_clear(&row);
    return sqrt(square);
}

/* What a sequence changes first: its field, or the time of its formulas; NULL: neither. */
static const char *quantity_of(const ReportPart *part)
{
    static const char *const paths[] = {"slender/frames/flux_density", "slender/stages/time"};
    for (int p = 0; p < 2; p++)
        for (int k = 1; k < part->frame_count; k++) {
            double first = size_of_row(part, paths[p], part->frames[0]);
            if (fabs(size_of_row(part, paths[p], part->frames[k]) - first) > 1e-9 * first) return paths[p];
        }
    return NULL;
}

/* "stage 3: 20 mT" */
static const char *stage_name(const ReportPart *part, const char *quantity, int frame)
{
    char number[64];
    if (!quantity) return show_text(part->data, "stage %d", frame);
    unit_format(size_of_row(part, quantity, frame), strstr(quantity, "time") ? "s" : "T", number,
                sizeof number);
    return show_text(part->data, "stage %d: %s", frame, number);
}

/* "t = 0.2 s"; the last ones are those of the load cases, if there are several. */
static void add_frames(const ReportPart *part)
{
    Document *document = part->document;
    document_open(document, "frames", '{');
    bool staged = result_has(part->data->result, "slender/stages/status");
    const char *quantity = staged ? quantity_of(part) : NULL;
    document_open(document, "labels", '[');
    for (int k = 0; k < part->frame_count; k++)
        document_text(document, NULL,
                      staged ? stage_name(part, quantity, part->frames[k])
                             : show_cases_frame(part->data, &part->cases, part->frames[k]));
    document_close(document);
    document_open(document, part->timed ? "times" : "stages", '[');
    for (int k = 0; k < part->frame_count; k++)
        document_number(document, NULL,
                        part->timed ? show_frame_time(part->data, part->frames[k]) : part->frames[k]);
    document_close(document);
    document_close(document);
}

/* ---- Results ---- */

static bool is_shown(const ShowData *data)
{
    return drawn_has(data->result) || result_has(data->result, "slender/faces") || show_curves_has(data);
}

static bool add_result(Document *document, ShowData *data, ShowDef *show, const char *path,
                       const ReportDef *def, Error *err)
{
    ReportPart part = {.document = document, .data = data, .show = show};
    Array status;
    const char *slash = strrchr(path, '/');
    document_open(document, NULL, '{');
    document_text(document, "name", slash ? slash + 1 : path);
    if (result_read(data->result, "slender/status", &status, NULL)) {
        document_text(document, "status", status.data);
        array_clear(&status);
    }
    if (!show_cases(data, &part.cases, err)) return false;
    choose_frames(&part, def);
    add_frames(&part);
    if (!is_shown(data)) return error_set(err, "there is no body and no drawing in it: nothing to show");
    bool ok = drawn_has(data->result) ? report_drawing(&part, err)
                                      : result_check_state(data->result, err) && report_body(&part, err) &&
                                            report_curves(&part, err) && report_surroundings(&part, err);
    ok = ok && report_charts(&part, err) && report_facts(&part, err);
    if (ok) document_close(document);
    return ok;
}

static bool read_result(Document *document, const char *path, const ReportDef *def, Error *err)
{
    ShowDef show = show_default();
    ShowData data;
    bool ok = show_data_open(&data, path, &show, err) && add_result(document, &data, &show, path, def, err);
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
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta "
                    "name=\"generator\" content=\"" MARK_TEXT "\">\n<title>");
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
    for (int k = 0; ok && k < count; k++) ok = read_result(document, results[k], def, err);
    document_close(document);
    document_close(document);
    read = ok;
    const char *slash = strrchr(results[0], '/');
    if (ok) ok = write_page(document, slash ? slash + 1 : results[0], path, err);
    document_destroy(document);
    return ok ? SHOW_DONE : read ? SHOW_CANNOT_WRITE : SHOW_HAS_NOT;
}
