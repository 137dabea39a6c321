#include "spline/sheet.h"
#include "base/memory.h"

double (*sheet_add(Sheet *sheet, int nodes))[4]
{
    int before = sheet_node_count(sheet), after = before + nodes;
    if (sheet->count + 1 >= sheet->stroke_room) {
        int room = 2 * sheet->stroke_room + 64;
        sheet->start =
            mem_resize(sheet->start, (size_t)sheet->stroke_room, (size_t)room, sizeof *sheet->start);
        sheet->stroke_room = room;
    }
    if (after > sheet->node_room) {
        int room = 2 * after + 256;
        sheet->q = mem_resize(sheet->q, (size_t)sheet->node_room, (size_t)room, sizeof *sheet->q);
        sheet->node_room = room;
    }
    sheet->start[++sheet->count] = after;
    return sheet->q + before;
}

void sheet_hand_over(Sheet *sheet, int layer, Strokes *strokes)
{
    for (int k = 0; k < sheet->count; k++)
        strokes_add(strokes, sheet->start[k + 1] - sheet->start[k],
                    (const double(*)[4])(sheet->q + sheet->start[k]), layer);
    sheet_clear(sheet);
}

void sheet_clear(Sheet *sheet)
{
    mem_free(sheet->start);
    mem_free(sheet->q);
    *sheet = (Sheet){0};
}
