#include "view/show_holds.h"
#include <math.h>

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
