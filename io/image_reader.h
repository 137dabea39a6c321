/* image_reader.h - the levels of an image as its file stores them. Private to the image readers.
 *
 * Rows come one by one and are added up in boxes of about equally many pixels, so that a photograph of a
 * hundred million pixels takes no more memory than its reader can use. */
#pragma once
#include "base/error.h"
#include <stddef.h>
#include <stdint.h>

typedef struct ImageBytes {
    const char *path; /* names the file in sentences */
    const unsigned char *bytes;
    size_t length;
    double useful[2]; /* pixels across and down, upright, that the reader can use; more are averaged */
} ImageBytes;

typedef struct Levels {
    int width, height; /* in the file, in which it may lie on its side            */
    int channels;      /* 1: grey; 3: red, green, blue                            */
    int maximum;       /* the level of white, at most 65535                       */
    int orientation;   /* [Exif 2.3] 1 upright .. 8; 0: 1                         */
    int columns, rows; /* of boxes                                                */
    uint32_t *sum;     /* [rows][columns][channels] of levels in each, row 0 on top; owned */
} Levels;

/* Reserves the sums for a width, height, channels, maximum and orientation; refuses more than
 * IMAGE_MAX_PIXELS pixels, and more than so many bytes can hold. */
bool levels_create(const ImageBytes *file, Levels *levels, size_t least_bytes, Error *err);

/* Adds a row of the file, channels of a pixel side by side, each of 1 byte or 2, the greater first. */
void levels_add_row(Levels *levels, int row, const unsigned char *bytes, int size);

/* Pixels in the box of a column and row. */
double levels_box(const Levels *levels, int row, int column);

/* Where it is in the upright picture, which is rows x columns where the image lies on its side. */
void levels_upright(const Levels *levels, int row, int column, int *y, int *x);

/* The tag 0x0112 of the first directory of a TIFF, as Exif data are one; 1 where it has none. */
int levels_exif_orientation(const unsigned char *tiff, size_t length);

/* The formats. On false levels->sum is NULL. */
bool levels_read_pnm(const ImageBytes *file, Levels *levels, Error *err);
bool levels_read_jpeg(const ImageBytes *file, Levels *levels, Error *err);
bool levels_read_png(const ImageBytes *file, Levels *levels, Error *err);
