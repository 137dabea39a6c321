/* image.h - grey images from files: PNG, and PGM (P2 and P5, 8 and 16 bits). */
#pragma once
#include "base/error.h"
#include <stddef.h>

typedef struct Image {
    int width, height;
    double *grey; /* [height][width], 0 black .. 1 white, row 0 on top; owned */
} Image;

enum { IMAGE_MAX_PIXELS = 100000000 };

/* Reads a file; what it is follows from its first bytes, not from its name. Colours become luma 0.2126 R' +
 * 0.7152 G' + 0.0722 B' [Rec. 709], as stored (no gamma is undone); what is transparent shows white. Levels
 * are bytes/255 or, PGM, level/maxval. On false *image is empty; an unreadable, broken, empty or too large
 * file gets a sentence. */
bool image_read(const char *path, Image *image, Error *err);

/* A PGM in memory (tests and fuzzing); path only names it in sentences. */
bool image_parse_pgm(const char *path, const unsigned char *bytes, size_t length, Image *image, Error *err);

/* The grey level at (u, v), bilinear. u runs to the right and v downwards over 0..1 from edge to edge, so
 * that the centre of pixel (row i, column j) is at u = (j + 0.5)/width, v = (i + 0.5)/height. Within half a
 * pixel of an edge, and beyond it, the nearest pixels' value continues. */
double image_sample(const Image *image, double u, double v);

/* Frees what the image owns and empties it. */
void image_clear(Image *image);
