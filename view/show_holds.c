#include "view/show_holds.h"
#include <math.h>
#include <string.h>

/* Rows of 3x4 matrices: the columns tangent, n1, n2 and place. */
static Hold hold_of(const double row[12])
{
    Hold hold;
    for (int i = 0; i < 3; i++) {
        hold.n1[i] = row[4 * i + 1], hold.n2[i] = row[4 * i + 2];
        hold.at[i] = row[4 * i + 3];
    }
    return hold;
}

/* Of a frame where they move, else as they stand; NULL: not known. */
static const double *read_rows(ShowData *data, int frame, int *count)
{
    static const char MOVED[] = "slender/frames/support_pose", STANDS[] = "slender/rod/support_pose";
    Array rows;
    if (frame < 0) frame = result_step_count(data->result) - 1;
    bool moved = frame >= 0 && result_has(data->result, MOVED);
    if (!moved && !result_has(data->result, STANDS)) return NULL;
    if (!(moved ? result_read_rows(data->result, MOVED, frame, 1, &rows, NULL)
                : result_read(data->result, STANDS, &rows, NULL)))
        return NULL;
    *count = rows.type == ARRAY_FLOAT64 ? (int)(array_count(&rows) / 12) : 0;
    return show_keep(data, rows);
}

static void read_outline(ShowData *data, Holds *holds)
{
    static const char OUTLINE[] = "slender/rod/section_outline";
    Array outline;
    if (!result_has(data->result, OUTLINE) || !result_read(data->result, OUTLINE, &outline, NULL)) return;
    bool fits = outline.type == ARRAY_FLOAT64 && outline.rank == 2 && outline.dims[1] == 2;
    holds->outline_count = fits ? outline.dims[0] : 0;
    holds->outline = show_keep(data, outline);
}

Holds show_holds(ShowData *data, int frame)
{
    Holds holds = {0};
    int count = 0;
    const double *rows = read_rows(data, frame, &count);
    if (!rows || count > HOLDS_MOST) return holds;
    Hold *items = show_block(data, (size_t)count, sizeof *items);
    for (int k = 0; k < count; k++) items[k] = hold_of(rows + 12 * k);
    holds.count = count, holds.items = items;
    read_outline(data, &holds);
    return holds;
}

static void add_squares(ShowData *data, int strand_count, const int *strands, CurvesScene *scene)
{
    static const char HELD[] = "slender/rod/held";
    int from = 0;
    while (from + 1 < scene->set_count && isnan(scene->sets[from].points[0][0]))
        from++; /* a target of some points */
    const double(*points)[3] = scene->sets[from].points;
    double(*held)[3] = show_block(data, (size_t)strand_count + 1, sizeof *held);
    Array array;
    int count = strand_count;
    for (int k = 0; k < count; k++) memcpy(held[k], points[strands[k]], sizeof *held);
    if (result_has(data->result, HELD) && result_read(data->result, HELD, &array, NULL)) {
        if (array_is(&array, ARRAY_FLOAT64, 1, 3)) memcpy(held[count++], array.data, sizeof *held);
        array_clear(&array);
    }
    scene->clamps = (const double(*)[3])held, scene->clamp_count = count;
}

void show_clamps(ShowData *data, int strand_count, const int *strands, CurvesScene *scene)
{
    static const char SUPPORTS[] = "slender/rod/supports";
    Array array;
    if (!curves_holds(scene, -1)) add_squares(data, strand_count, strands, scene);
    if (!result_has(data->result, SUPPORTS) || !result_read(data->result, SUPPORTS, &array, NULL)) return;
    if (array.type == ARRAY_TEXT && strstr(array.data, "pinned")) scene->clamps_name = "held";
    array_clear(&array);
}
