/* show_holds.h - where a result's rods are held, and how: in a frame, or as it began. */
#pragma once
#include "view/curves_picture.h"
#include "view/show_data.h"

enum { HOLDS_MOST = 4 }; /* of more strands squares are shown only */

/* In a frame (-1: the last one). None: the result does not say it, or there are too many. */
Holds show_holds(ShowData *data, int frame);

/* Into a scene that has its sets: the name of what holds the strands, strands[strand_count + 1] their first points; and squares,
 * unless the sets say how they are held: where they begin, and where the other end is. */
void show_clamps(ShowData *data, int strand_count, const int *strands, CurvesScene *scene);
