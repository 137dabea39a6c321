/* export_drawing.h - drawings out of results, as files for plotters. */
#pragma once
#include "io/result.h"
#include "job/run.h"

/* How a drawing is shared out among files, NAME_1.gcode, NAME_2.gcode, ..; zeroed: it is one, NAME.gcode. */
typedef struct DrawingSplit {
    bool pens;
    double ink; /* mm in a file, at most; 0: no matter */
} DrawingSplit;

/* `take` of --split: "pen", or a length. */
bool drawing_split_take(void *split, const char *text);
#define DRAWING_SPLIT_ALLOWED "pen, or the ink in a file, as \"5 m\""

/* In that plotter's language (drawn.h), or as the name's ending says. Of several files each is said with what is in it;
 * `check` says no, with a sentence, to a file that may not be written. */
RunStatus export_drawing(Result *result, const char *language, DrawingSplit split, const char *path,
                         bool (*check)(void *self, const char *path, Error *err), void *self, Error *err);
