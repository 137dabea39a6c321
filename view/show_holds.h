/* show_holds.h - where a result's rods are held, and how: in a frame, or as it began. */
#pragma once
#include "view/holds.h"
#include "view/show_data.h"

enum { HOLDS_MOST = 4 }; /* of more strands squares are shown only */

/* In a frame (-1: the last one). None: the result does not say it, or there are too many. */
Holds show_holds(ShowData *data, int frame);
