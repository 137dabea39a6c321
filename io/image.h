/* image.h - grey and colour images from files: PNG, JPEG, PGM and PPM (P2, P3, P5 and P6, 8 and 16 bits). */
#pragma once
#include "base/error.h"
#include <stddef.h>

/* One value a pixel: grey, or one of red, green and blue. */
typedef struct Image {
    int width, height;
    double *grey; /* [height][width], 0 black .. 1 white, row 0 on top; owned */
} Image;

enum { IMAGE_MAX_PIXELS = 400000000 };

/* Reads a file; what it is follows from its first bytes, not from its name. Colours become luma 0.2126 R' +
 * 0.7152 G' + 0.0722 B' [Rec. 709], as stored (no gamma is undone); what is transparent shows white. Levels
 * are bytes/255 (of a PNG of 16 bits, which Cairo reads as one of 8, too) or, PGM and PPM, level/maximum. A
 * JPEG or PNG is turned upright as its Exif tag says. What comes after the last pixel may be missing, or be
 * anything. On false *image is empty; an unreadable, broken, empty or too large file gets a sentence. */
bool image_read(const char *path, Image *image, Error *err);

/* The same, as red, green and blue, which are equal for a grey file. */
bool image_read_rgb(const char *path, Image rgb[3], Error *err);

/* Both at once, and no larger than needed: where the picture has several times as many pixels across and down
 * as are useful, boxes of so many become one, their mean. rgb: NULL: grey alone. */
bool image_read_useful(const char *path, const double useful[2], Image *grey, Image rgb[3], Error *err);

/* An image in memory (tests and fuzzing); path only names it in sentences. */
bool image_parse(const char *path, const unsigned char *bytes, size_t length, Image *image, Error *err);

/* The grey level at (u, v), bilinear. u runs to the right and v downwards over 0..1 from edge to edge, so
 * that the centre of pixel (row i, column j) is at u = (j + 0.5)/width, v = (i + 0.5)/height. Within half a
 * pixel of an edge, and beyond it, the nearest pixels' value continues. */
double image_sample(const Image *image, double u, double v);

/* Frees what the image owns and empties it. */
void image_clear(Image *image);
