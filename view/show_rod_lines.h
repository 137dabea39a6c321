/* show_rod_lines.h - the small print of a rod's page: how the run ended, how stable the rod is, and what was measured. */
#pragma once
#include "view/show_curves.h"

enum { ROD_LINES_MAX = 4 };

typedef struct RodLines {
    int count;
    const char *text[ROD_LINES_MAX]; /* kept in the data */
} RodLines;

RodLines show_rod_lines(const ShowCurves *curves);
