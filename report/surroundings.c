/* What is around a body: obstacles, magnets and coils, the field and gravity. */
#include "report/report_private.h"
#include "view/show_holds.h"
#include <math.h>
#include <string.h>

/* ---- Obstacles ---- */

/* [frame][12], to places from the origin; false where it stands still. */
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
        for (int i = 0; i < 3; i++) poses[12 * k + 4 * i + 3] -= part->origin[i];
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
    document_indices(document, "faces", one->faces[0], 3 * faces, 3);
    double *rgb = show_block(part->data, 3 * faces, sizeof *rgb);
    for (size_t f = 0; f < faces; f++)
        rgb[3 * f] = colors[f].r, rgb[3 * f + 1] = colors[f].g, rgb[3 * f + 2] = colors[f].b;
    document_packed(document, "colors", rgb, (Packed){1, 3 * faces, 3, 8, false});
    double *poses = show_block(part->data, 12 * (size_t)part->frame_count, sizeof *poses);
    const char *path = source ? "slender/frames/source_pose" : "slender/frames/obstacle_pose";
    int of = source ? index - all->obstacles : index;
    Packed shape = {1, 3 * points, 3, 16, false};
    bool moves = read_poses(part, path, source ? all->count - all->obstacles : all->obstacles, of, poses);
    if (moves) document_packed(document, "points", one->points[0], shape);
    if (moves) document_numbers(document, "poses", poses, 12 * (size_t)part->frame_count);
    if (!moves) report_places(part, "points", one->points[0], shape);
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

/* Places that hold rods, of each frame; one row where they stand still. */
static void add_holds(const ReportPart *part)
{
    size_t frames = (size_t)part->frame_count, count = (size_t)show_holds(part->data, part->frames[0]).count;
    double *places = show_block(part->data, 3 * frames * count, sizeof *places);
    for (size_t k = 0; k < frames; k++) {
        Holds holds = show_holds(part->data, part->frames[k]);
        if ((size_t)holds.count != count) return;
        for (size_t h = 0; h < count; h++)
            memcpy(places + 3 * (k * count + h), holds.items[h].at, 3 * sizeof *places);
    }
    if (count == 0) return;
    size_t rows = report_is_static(places, frames, 3 * count) ? 1 : frames;
    report_places(part, "holds", places, (Packed){rows, 3 * count, 3, 16, false});
}

bool report_surroundings(const ReportPart *part, Error *err)
{
    if (part->frame_count == 0) return true;
    add_holds(part);
    add_field(part);
    add_gravity(part);
    return add_obstacles(part, err);
}
