/* PNG through Cairo (canvas.h), upright as its eXIf chunk says [PNG 3rd edition, 11.3.4.5]. */
#include "io/canvas.h"
#include "io/image_reader.h"
#include <string.h>

static uint32_t word_at(const unsigned char *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

/* The end of the last whole chunk; what follows may be the beginning of an IEND. Takes the orientation on the
 * way. */
static size_t read_chunks(const ImageBytes *file, Levels *levels)
{
    size_t at = 8;
    while (file->length - at >= 12) {
        const unsigned char *chunk = file->bytes + at;
        size_t size = word_at(chunk);
        if (size > file->length - at - 12) break;
        if (!memcmp(chunk + 4, "eXIf", 4)) levels->orientation = levels_exif_orientation(chunk + 8, size);
        at += 12 + size;
    }
    return at;
}

static void add_row(void *self, int row, const unsigned char *rgb)
{
    levels_add_row(self, row, rgb, 1);
}

bool levels_read_png(const ImageBytes *file, Levels *levels, Error *err)
{
    const unsigned char *b = file->bytes;
    if (file->length < 24 || memcmp(b, "\x89PNG\r\n\x1a\n", 8) != 0 || memcmp(b + 12, "IHDR", 4) != 0)
        return error_set(err, "%s: not a PNG file", file->path);
    uint32_t width = word_at(b + 16), height = word_at(b + 20);
    if (width == 0 || height == 0) return error_set(err, "%s: the image has no pixels", file->path);
    if (width > CANVAS_MAX_SIDE || height > CANVAS_MAX_SIDE)
        return error_set(err, "%s: an image of %u x %u pixels; at most %d a side are read", file->path, width,
                         height, CANVAS_MAX_SIDE);
    *levels = (Levels){.width = (int)width, .height = (int)height, .channels = 3, .maximum = 255};

    /* A file that ends in its IEND, or before it, has all of its pixels. */
    size_t whole = read_chunks(file, levels), rest = file->length - whole;
    bool ends = rest < 12 && !memcmp(b + whole, "\0\0\0\0IEND\xae\x42\x60\x82", rest);
    size_t least = (size_t)width * height / 8 / 1032; /* a bit a pixel, as short as zlib makes it */
    if (!levels_create(file, levels, least, err)) return false;
    return canvas_read_png(file->path, b, ends ? whole : file->length, add_row, levels, err);
}
