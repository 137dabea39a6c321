#include "spline/sheet.h"
#include "base/memory.h"
#include <string.h>

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
    int count = strokes->count, nodes = strokes_node_count(strokes);
    size_t all = (size_t)(count + sheet->count), added = (size_t)sheet_node_count(sheet);
    if (sheet->count == 0) return;
    strokes->start = mem_resize(strokes->start, (size_t)count + 1, all + 1, sizeof *strokes->start);
    strokes->layer = mem_resize(strokes->layer, (size_t)count, all, sizeof *strokes->layer);
    strokes->q = mem_resize(strokes->q, 4 * (size_t)nodes, 4 * ((size_t)nodes + added), sizeof *strokes->q);
    for (int k = 0; k < sheet->count; k++) {
        strokes->start[count + k] = nodes + sheet->start[k];
        strokes->layer[count + k] = layer;
    }
    strokes->start[all] = nodes + sheet->start[sheet->count];
    memcpy(strokes->q + 4 * nodes, sheet->q, added * sizeof *sheet->q);
    strokes->count = (int)all;
    sheet_clear(sheet);
}

void sheet_clear(Sheet *sheet)
{
    mem_free(sheet->start);
    mem_free(sheet->q);
    *sheet = (Sheet){0};
}
