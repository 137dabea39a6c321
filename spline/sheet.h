/* sheet.h - many strokes that are collected one by one and handed over at once. */
#pragma once
#include "spline/strokes.h"

typedef struct Sheet {
    int count, stroke_room, node_room;
    int *start; /* [count + 1] once there is one */
    double (*q)[4];
} Sheet;

/* The nodes of a new stroke, to be filled before the next one is added. */
double (*sheet_add(Sheet *sheet, int nodes))[4];

static inline int sheet_node_count(const Sheet *sheet)
{
    return sheet->count ? sheet->start[sheet->count] : 0;
}

/* Appends all to `strokes` on a layer and empties the sheet. */
void sheet_hand_over(Sheet *sheet, int layer, Strokes *strokes);

void sheet_clear(Sheet *sheet);
