/* Curves of a result, for its report: rods, and of a motion what was to be followed and how it went. */
#include "base/memory.h"
#include "report/report_private.h"
#include "view/show_curves.h"
#include "view/show_motion.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- A motion ---- */

/* As in pictures. */
static const MotionInk ink_of_bodies = {{0.835, 0.369, 0, 1}, {0.25, 0.25, 0.27, 1}, 2.6};
static const MotionInk ink_of_rods = {{0.62, 0.62, 0.64, 1}, {0, 0.62, 0.451, 1}, 3};

/* From one line of points on; `grows`: as the motion goes on. */
static void add_line(const ReportPart *part, const MarkLine *line, bool grows)
{
    Document *document = part->document;
    int ends[2] = {0, line->count};
    document_open(document, NULL, '{');
    document_text(document, "name", line->name);
    report_color(document, "color", line->color);
    document_number(document, "width", line->width);
    document_flag(document, "grows", grows);
    document_indices(document, "offsets", ends, 2, 1);
    report_places(part, "points", line->points[0], (Packed){1, 3 * (size_t)line->count, 3, 16, false});
    document_close(document);
}

static void add_places(const ReportPart *part, const ShowMotion *motion, const Marks *marks)
{
    Document *document = part->document;
    document_open(document, "places", '[');
    for (int k = 0; k < marks->dot_count - motion->followed_count; k++) {
        double at[3];
        for (int i = 0; i < 3; i++) at[i] = marks->dots[k].at[i] - part->origin[i];
        document_open(document, NULL, '{');
        report_color(document, "color", marks->dots[k].color);
        document_numbers(document, "at", at, 3);
        document_close(document);
    }
    document_close(document);
}

/* ---- Rods ---- */

enum { FEW = 20, UNIT_MAX = 32 };

/* Curves of one kind, and where their points begin. */
typedef struct Strands {
    const char *name;
    Color color;
    double width;
    int count;
    const int *offsets;   /* [count + 1] */
    const int *row;       /* [case] 0 of those whose frames show it, -1 of others; NULL: all do */
    bool measured;        /* frames have numbers at its nodes */
    const double *radius; /* [node] m; NULL: it is a line */
} Strands;

/* What rods are coloured by: the size of some columns of an array that frames have at their nodes. */
typedef struct NodeField {
    const char *name, *array;
    int first, count;
} NodeField;

static const NodeField node_fields[] = {{"curvature", "strain", 1, 2},
                                        {"twist", "strain", 0, 1},
                                        {"stretch", "stretch", 0, 1},
                                        {"shear", "stretch", 1, 2},
                                        {"moment", "moment", 0, 3},
                                        {"force", "force", 0, 3},
                                        {"contact_force", "contact_force", 0, 3}};

/* A single column with its sign. */
static void take_columns(const double *rows, int count, const NodeField *field, double *values)
{
    for (int v = 0; v < count; v++) {
        const double *row = rows + 3 * v + field->first;
        double square = 0;
        for (int i = 0; i < field->count; i++) square += row[i] * row[i];
        values[v] = field->count == 1 ? *row : sqrt(square);
    }
}

/* Its numbers in all frames; false where they do not have it. */
static bool read_field(const ReportPart *part, const NodeField *field, int nodes, double *values, char *unit)
{
    const char *path = show_text(part->data, "PointData/%s", field->array);
    if (!result_has(part->data->result, show_text(part->data, "VTKHDF/%s", path))) return false;
    for (int k = 0; k < part->frame_count; k++) {
        Array array;
        if (!result_read_step(part->data->result, path, part->frames[k], &array, NULL)) return false;
        bool fits =
            array.type == ARRAY_FLOAT64 && array.rank == 2 && array.dims[0] >= nodes && array.dims[1] == 3;
        if (fits) take_columns(array.data, nodes, field, values + (size_t)k * (size_t)nodes);
        snprintf(unit, UNIT_MAX, "%s", array.unit ? array.unit : "");
        array_clear(&array);
        if (!fits) return false;
    }
    return true;
}

static void add_fields(const ReportPart *part, int nodes)
{
    Document *document = part->document;
    size_t count = (size_t)part->frame_count, width = (size_t)nodes;
    double *values = mem_alloc(count * width, sizeof *values);
    char unit[UNIT_MAX];
    document_open(document, "fields", '[');
    for (size_t f = 0; f < sizeof node_fields / sizeof *node_fields; f++) {
        if (!read_field(part, &node_fields[f], nodes, values, unit)) continue;
        bool still = report_is_static(values, count, width);
        document_open(document, NULL, '{');
        document_text(document, "name", node_fields[f].name);
        document_text(document, "unit", unit);
        document_packed(document, "values", values,
                        (Packed){still ? 1 : count, width, 1, still ? 16 : 8, false});
        document_close(document);
    }
    document_close(document);
    mem_free(values);
}

/* Of many the lines are thinner: so their density is seen. */
static void add_strands(const ReportPart *part, Strands strands, const double *x, int rows)
{
    Document *document = part->document;
    document_open(document, NULL, '{');
    document_text(document, "name", strands.name);
    report_color(document, "color", strands.color);
    document_number(document, "width", fmax(1, strands.width * fmin(1, sqrt(FEW / (double)strands.count))));
    if (strands.row) report_rows(part, strands.row);
    if (strands.radius)
        document_packed(document, "radius", strands.radius,
                        (Packed){1, (size_t)strands.offsets[strands.count], 1, 16, false});
    document_indices(document, "offsets", strands.offsets, (size_t)strands.count + 1, 1);
    report_places(part, "points", x,
                  (Packed){(size_t)rows, 3 * (size_t)strands.offsets[strands.count], 3, 16, false});
    if (strands.measured) add_fields(part, strands.offsets[strands.count]);
    document_close(document);
}

/* Lines of the frames, one after the other: their points in `rows` frames. */
static bool add_lines(const ReportPart *part, const int (*lines)[2], Strands strands, int rows, Error *err)
{
    int *offsets = show_block(part->data, (size_t)strands.count + 1, sizeof *offsets);
    for (int k = 0; k < strands.count; k++) offsets[k + 1] = offsets[k] + lines[k][1];
    strands.offsets = offsets;
    size_t width = 3 * (size_t)offsets[strands.count];
    double *x = show_block(part->data, (size_t)rows * width, sizeof *x);
    for (int k = 0; k < rows; k++) {
        Array frame;
        if (!result_read_step(part->data->result, "Points", part->frames[k], &frame, err)) return false;
        for (int s = 0; s < strands.count; s++) {
            const int *line = lines[s];
            if (line[0] < 0 || line[1] < 0 || line[0] + line[1] > frame.dims[0])
                return array_clear(&frame), error_set(err, "slender/lines is not as slender writes it");
            memcpy(x + (size_t)k * width + 3 * (size_t)offsets[s],
                   (const double *)frame.data + 3 * (size_t)line[0], 3 * (size_t)line[1] * sizeof *x);
        }
        array_clear(&frame);
    }
    add_strands(part, strands, x, rows);
    return true;
}

/* Where each case should be, of those of whose points something is to be somewhere. */
static void add_targets(const ReportPart *part, const ShowCurves *curves, Strands strands)
{
    int cases = part->cases.count;
    for (int s = 0; s < curves->state_count; s++) {
        const ShowCurvesState *state = &curves->states[s];
        if (!state->target) continue;
        int *row = show_block(part->data, (size_t)cases, sizeof *row);
        for (int c = 0; c < cases; c++) row[c] = strcmp(part->cases.names[c], state->load_case) ? -1 : 0;
        strands.row = row;
        add_strands(part, strands, state->target[0], 1);
    }
}

/* The strands of the input or target, over them those of the natural shape and the simulated ones, as far as there are. */
static bool add_rods(const ReportPart *part, Error *err)
{
    ShowCurves curves;
    Array array;
    if (!show_curves_has(part->data) || !result_has(part->data->result, "slender/lines")) return true;
    if (!show_curves_read(&curves, part->data, err) ||
        !result_read_as(part->data->result, "slender/lines", ARRAY_INT32, 2, 2, &array, err))
        return false;
    const int(*lines)[2] = show_keep(part->data, array);
    int strands = curves.strand_count;
    if (array.dims[0] < strands) return error_set(err, "slender/lines is not as slender writes it");
    Strands rod = {.name = "rod", .color = colormap_series(1), .width = 3, .count = strands},
            input = {.name = "input",
                     .color = {0.62, 0.62, 0.64, 1},
                     .width = 5,
                     .count = strands,
                     .offsets = curves.strands},
            natural = {.name = "natural",
                       .color = colormap_series(0),
                       .width = 2,
                       .count = strands,
                       .offsets = curves.strands};
    Strands target = input;
    target.name = "target";
    if (curves.input) add_strands(part, input, curves.input[0], 1);
    add_targets(part, &curves, target);
    if (curves.natural) add_strands(part, natural, curves.natural[0], 1);
    if (!curves.x && !part->data->motion)
        return true; /* nothing is simulated: the frames have the other curves */
    bool own = true; /* all lines are strands, point by point */
    for (int k = 0; k < strands; k++)
        own &= lines[k][0] == curves.strands[k] && lines[k][1] == curves.strands[k + 1] - curves.strands[k];
    rod.measured = own;
    rod.radius = own ? show_curves_radii(part->data, strands, curves.strands) : NULL;
    return add_lines(part, lines, rod, part->frame_count, err);
}

bool report_curves(const ReportPart *part, Error *err)
{
    ShowMotion motion;
    Document *document = part->document;
    if (part->frame_count == 0) return true;
    if (!show_motion_read(&motion, part->data, err)) return false;
    Marks marks = show_motion_marks(&motion, NAN, show_curves_has(part->data) ? ink_of_rods : ink_of_bodies);
    document_open(document, "curves", '[');
    for (int k = 0; k < marks.line_count; k++)
        add_line(part, &marks.lines[k], k >= marks.line_count - motion.followed_count);
    bool ok = add_rods(part, err);
    document_close(document);
    add_places(part, &motion, &marks);
    return ok;
}
