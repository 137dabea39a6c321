/* png_fixture.h - what was drawn, read back: (*rgb)[height][width][3] bytes, the caller's. */
#pragma once
#include "base/memory.h"
#include "io/image.h"
#include <math.h>

static inline bool png_read(const char *path, unsigned char **rgb, int *width, int *height, Error *err)
{
    Image planes[3];
    *rgb = NULL, *width = *height = 0;
    if (!image_read_rgb(path, planes, err)) return false;
    size_t count = (size_t)planes[0].width * (size_t)planes[0].height;
    *rgb = mem_alloc(3 * count, 1);
    *width = planes[0].width, *height = planes[0].height;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < count; i++)
            (*rgb)[3 * i + (size_t)c] = (unsigned char)lround(255 * planes[c].grey[i]);
        image_clear(&planes[c]);
    }
    return true;
}
