/* What is around a body: obstacles, magnets and coils, the field and gravity; and the curves and places of a motion. */
#include "report/report_private.h"
#include "view/show_motion.h"
#include "view/show_obstacles.h"
#include <math.h>
#include <string.h>

static const MotionInk motion_ink = {{0.835, 0.369, 0, 1}, {0.25, 0.25, 0.27, 1}, 2.6};

/* ---- Obstacles ---- */

/* [frame][12]; false where it stands still. */
static bool read_poses(const ReportPart *part, const char *path, int count, int index, double *poses)
{
    for (int k = 0; k < part->frame_count; k++) {
        Array rows;
        if (!result_has(part->data->result, path) ||
            !result_read_rows(part->data->result, path, part->frames[k], 1, &rows, NULL))
            return false;
        bool fits = rows.type == ARRAY_FLOAT64 && array_count(&rows) == 12 * (size_t)count;
        if (fits) memcpy(poses + 12 * k, (const double *)rows.data + 12 * index, 12 * sizeof *poses);
        array_clear(&rows);
        if (!fits) return false;
    }
    return true;
}

static void add_obstacle(const ReportPart *part, const ShowObstacles *all, int index, const Color *colors)
{
    const ShowObstacle *one = &all->list[index];
    Document *document = part->document;
    size_t points = (size_t)one->point_count, faces = (size_t)one->face_count;
    bool source = index >= all->obstacles;
    document_open(document, NULL, '{');
    document_text(document, "kind", source ? one->kind : "obstacle");
    document_packed(document, "points", one->points[0], (Packed){1, 3 * points, 3, 16, false});
    document_indices(document, "faces", one->faces[0], 3 * faces, 3);
    double *rgb = show_block(part->data, 3 * faces, sizeof *rgb);
    for (size_t f = 0; f < faces; f++)
        rgb[3 * f] = colors[f].r, rgb[3 * f + 1] = colors[f].g, rgb[3 * f + 2] = colors[f].b;
    document_packed(document, "colors", rgb, (Packed){1, 3 * faces, 3, 8, false});
    double *poses = show_block(part->data, 12 * (size_t)part->frame_count, sizeof *poses);
    const char *path = source ? "slender/frames/source_pose" : "slender/frames/obstacle_pose";
    int of = source ? index - all->obstacles : index;
    if (read_poses(part, path, source ? all->count - all->obstacles : all->obstacles, of, poses))
        document_numbers(document, "poses", poses, 12 * (size_t)part->frame_count);
    document_close(document);
}

static bool add_obstacles(const ReportPart *part, Error *err)
{
    ShowObstacles all;
    if (!show_obstacles_read(&all, part->data, err)) return false;
    if (all.count == 0) return true;
    document_open(part->document, "obstacles", '[');
    const Color *colors = all.colors;
    for (int k = 0; k < all.count; colors += all.list[k++].face_count) add_obstacle(part, &all, k, colors);
    document_close(part->document);
    return true;
}

/* ---- Field and gravity ---- */

static void add_field(const ReportPart *part)
{
    static const char path[] = "slender/frames/flux_density";
    double *B = show_block(part->data, 3 * (size_t)part->frame_count, sizeof *B);
    for (int k = 0; k < part->frame_count; k++) {
        Array row;
        if (!result_has(part->data->result, path) ||
            !result_read_rows(part->data->result, path, part->frames[k], 1, &row, NULL))
            return;
        bool fits = array_is(&row, ARRAY_FLOAT64, 2, 3);
        if (fits) memcpy(B + 3 * k, row.data, 3 * sizeof *B);
        array_clear(&row);
        if (!fits) return;
    }
    document_numbers(part->document, "flux", B, 3 * (size_t)part->frame_count);
}

static void add_gravity(const ReportPart *part)
{
    static const char *const paths[] = {"slender/design/gravity", "slender/rod/gravity"};
    for (int k = 0; k < 2; k++) {
        const double *gravity = show_dataset(part->data, paths[k], ARRAY_FLOAT64, 3);
        if (!gravity) continue;
        document_numbers(part->document, "gravity", gravity, 3);
        return;
    }
}

bool report_surroundings(const ReportPart *part, Error *err)
{
    if (part->frame_count == 0) return true;
    add_field(part);
    add_gravity(part);
    return add_obstacles(part, err);
}

/* ---- Curves ---- */

/* From one line of points on; `grows`: as the motion goes on. */
static void add_line(Document *document, const MarkLine *line, bool grows)
{
    int ends[2] = {0, line->count};
    document_open(document, NULL, '{');
    document_text(document, "name", line->name);
    report_color(document, "color", line->color);
    document_number(document, "width", line->width);
    document_flag(document, "grows", grows);
    document_indices(document, "offsets", ends, 2, 1);
    document_packed(document, "points", line->points[0], (Packed){1, 3 * (size_t)line->count, 3, 16, false});
    document_close(document);
}

static void add_places(Document *document, const ShowMotion *motion, const Marks *marks)
{
    document_open(document, "places", '[');
    for (int k = 0; k < marks->dot_count - motion->followed_count; k++) {
        document_open(document, NULL, '{');
        report_color(document, "color", marks->dots[k].color);
        document_numbers(document, "at", marks->dots[k].at, 3);
        document_close(document);
    }
    document_close(document);
}

/* Names a strand's curves of one kind, which are lines first .. first + count - 1 of the frames. */
typedef struct Strands {
    const char *name;
    Color color;
    double width;
    int first, count;
    bool moves;
} Strands;

static bool add_strands(const ReportPart *part, const int (*lines)[2], Strands strands, Error *err)
{
    int points = 0, rows = strands.moves ? part->frame_count : 1,
        *offsets = show_block(part->data, (size_t)strands.count + 1, sizeof *offsets);
    for (int k = 0; k < strands.count; k++) offsets[k + 1] = points += lines[strands.first + k][1];
    size_t width = 3 * (size_t)points;
    double *x = show_block(part->data, (size_t)rows * width, sizeof *x);
    for (int k = 0; k < rows; k++) {
        Array frame;
        if (!result_read_step(part->data->result, "Points", part->frames[k], &frame, err)) return false;
        for (int s = 0; s < strands.count; s++) {
            const int *line = lines[strands.first + s];
            if (line[0] < 0 || line[1] < 0 || line[0] + line[1] > frame.dims[0])
                return array_clear(&frame), error_set(err, "slender/lines is not as slender writes it");
            memcpy(x + (size_t)k * width + 3 * (size_t)offsets[s],
                   (const double *)frame.data + 3 * (size_t)line[0], 3 * (size_t)line[1] * sizeof *x);
        }
        array_clear(&frame);
    }
    Document *document = part->document;
    document_open(document, NULL, '{');
    document_text(document, "name", strands.name);
    report_color(document, "color", strands.color);
    document_number(document, "width", strands.width);
    document_flag(document, "body", strands.moves);
    document_indices(document, "offsets", offsets, (size_t)strands.count + 1, 1);
    document_packed(document, "points", x, (Packed){(size_t)rows, width, 3, 16, false});
    document_close(document);
    return true;
}

/* The strands of the input, over them those of the natural shape and the simulated ones, as far as there are. */
static bool add_rods(const ReportPart *part, Error *err)
{
    Array array;
    Result *result = part->data->result;
    if (result_has(result, "slender/faces") || !result_has(result, "slender/lines")) return true;
    if (!result_read_as(result, "slender/lines", ARRAY_INT32, 2, 2, &array, err)) return false;
    const int(*lines)[2] = show_keep(part->data, array);
    int count = array.dims[0], strands = 1;
    if (result_has(result, "slender/rod/strands") &&
        result_read_as(result, "slender/rod/strands", ARRAY_INT32, 1, 0, &array, NULL))
        strands = array.dims[0] - 1, array_clear(&array);
    const Strands sets[] = {{"input", {0.62, 0.62, 0.64, 1}, 5, strands, strands, false},
                            {"natural", colormap_series(0), 2, 2 * strands, strands, false},
                            {"rod", colormap_series(1), 3, 0, strands, true}};
    for (int k = 0; k < 3; k++)
        if (sets[k].first + strands <= count && !add_strands(part, lines, sets[k], err)) return false;
    return true;
}

bool report_curves(const ReportPart *part, Error *err)
{
    ShowMotion motion;
    Document *document = part->document;
    if (part->frame_count == 0) return true;
    if (!show_motion_read(&motion, part->data, err)) return false;
    Marks marks = show_motion_marks(&motion, NAN, motion_ink);
    document_open(document, "curves", '[');
    for (int k = 0; k < marks.line_count; k++)
        add_line(document, &marks.lines[k], k >= marks.line_count - motion.followed_count);
    bool ok = add_rods(part, err);
    document_close(document);
    add_places(document, &motion, &marks);
    return ok;
}
