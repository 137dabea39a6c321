/* image_reader.h - the levels of an image as its file stores them. Private to the image readers. */
#pragma once
#include "base/error.h"
#include <stddef.h>
#include <stdint.h>

typedef struct Levels {
    int width, height;
    int channels;    /* 1: grey; 3: red, green, blue                                   */
    int maximum;     /* the level of white                                             */
    uint16_t *level; /* [height][width][channels], 0 .. maximum, row 0 on top; owned */
} Levels;

typedef struct ImageBytes {
    const char *path; /* names the file in sentences */
    const unsigned char *bytes;
    size_t length;
} ImageBytes;

/* Reserves the levels; refuses more than IMAGE_MAX_PIXELS pixels, and more than so many bytes can hold. */
bool levels_create(const ImageBytes *file, Levels *levels, size_t least_bytes, Error *err);

/* The formats. On false levels->level is NULL. */
bool levels_read_pnm(const ImageBytes *file, Levels *levels, Error *err);
bool levels_read_jpeg(const ImageBytes *file, Levels *levels, Error *err);
