/* animation.h - pages one after the other as an animated WebP, which browsers show.
 *
 * All pages have the size of the first. The file appears at path when it is complete; a file that was there stays until
 * then. */
#pragma once
#include "io/canvas.h"

typedef struct Animation Animation;

/* False and a sentence where path does not end in .webp, any case. */
bool animation_check_path(const char *path, Error *err);

/* NULL and a sentence where path does not. */
Animation *animation_create(const char *path, Error *err);
void animation_destroy(Animation *animation);

/* A page drawn on a .png canvas, to be shown for so long. */
bool animation_add(Animation *animation, Canvas *page, double seconds, Error *err);

/* Writes the file; it is shown again and again. */
bool animation_save(Animation *animation, Error *err);
