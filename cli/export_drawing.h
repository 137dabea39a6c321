/* export_drawing.h - drawings out of results, as files for plotters. */
#pragma once
#include "cli/export_files.h"

/* How a drawing is shared out among files, NAME_1.gcode, NAME_2.gcode, ..; zeroed: it is one, NAME.gcode. */
typedef struct DrawingSplit {
    bool pens;
    double ink; /* mm in a file, at most; 0: no matter */
} DrawingSplit;

/* `take` of --split: "pen", or a length. */
bool drawing_split_take(void *split, const char *text);
#define DRAWING_SPLIT_ALLOWED "pen, or the ink in a file, as \"5 m\""

/* In that plotter's language (drawn.h; NULL: as the name's ending says). Of several files each is said with what is in it. */
RunStatus export_drawing(Result *result, const char *language, DrawingSplit split, const char *path,
                         FurtherFiles further, Error *err);
