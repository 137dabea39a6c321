/* paper.h - sizes of paper by name. */
#pragma once
#include "base/error.h"

/* Width and height, m, of "a4", "A3", "letter", "a5 landscape", "210x297mm", "8.5x11in", "21x29.7cm". Names:
 * a0 to a6, letter, legal, tabloid, upright; "landscape" behind a size lays its long side flat, "portrait"
 * sets it up. A side is 1 mm to 10 m. Anything else gets a sentence. */
bool paper_size(const char *text, double size[2], Error *err);
