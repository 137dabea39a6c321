#include "io/image.h"
#include "base/memory.h"
#include "io/canvas.h"
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A PGM's text, read number by number. */
typedef struct Reader {
    const char *path;
    const unsigned char *bytes;
    size_t length, place;
} Reader;

static int reader_line(const Reader *reader)
{
    int line = 1;
    for (size_t i = 0; i < reader->place; i++) line += reader->bytes[i] == '\n';
    return line;
}

static void skip_blanks(Reader *reader)
{
    while (reader->place < reader->length) {
        unsigned char c = reader->bytes[reader->place];
        if (c == '#')
            while (reader->place < reader->length && reader->bytes[reader->place] != '\n') reader->place++;
        else if (!isspace(c))
            return;
        else
            reader->place++;
    }
}

/* A whole number in low..high; what names it in the sentence. */
static bool read_number(Reader *reader, const char *what, int low, int high, int *number, Error *err)
{
    skip_blanks(reader);
    long value = 0;
    size_t start = reader->place;
    while (reader->place < reader->length && isdigit(reader->bytes[reader->place]) && value <= high)
        value = 10 * value + reader->bytes[reader->place++] - '0';
    if (reader->place == reader->length && start == reader->place)
        return error_set(err, "%s:%d: the file ends where the %s should be", reader->path,
                         reader_line(reader), what);
    if (start == reader->place || value < low || value > high)
        return error_set(err, "%s:%d: the %s must be a whole number from %d to %d", reader->path,
                         reader_line(reader), what, low, high);
    *number = (int)value;
    return true;
}

static bool read_text_pixels(Reader *reader, int maxval, size_t count, double *grey, Error *err)
{
    for (size_t i = 0; i < count; i++) {
        int level;
        if (!read_number(reader, "grey level", 0, maxval, &level, err)) return false;
        grey[i] = (double)level / maxval;
    }
    return true;
}

/* One byte a pixel, or two with the greater first where maxval exceeds 255. */
static bool read_binary_pixels(Reader *reader, int maxval, size_t count, double *grey, Error *err)
{
    int wide = maxval > 255;
    const unsigned char *b = reader->bytes + reader->place;
    for (size_t i = 0; i < count; i++, b += 1 + wide) {
        int level = wide ? b[0] << 8 | b[1] : b[0];
        if (level > maxval)
            return error_set(err, "%s: grey level %d of pixel %zu exceeds the file's maximum %d",
                             reader->path, level, i, maxval);
        grey[i] = (double)level / maxval;
    }
    return true;
}

bool image_parse_pgm(const char *path, const unsigned char *bytes, size_t length, Image *image, Error *err)
{
    *image = (Image){0};
    if (length < 2 || bytes[0] != 'P' || (bytes[1] != '2' && bytes[1] != '5'))
        return error_set(err, "%s: not a PGM file (P2 or P5)", path);
    bool binary = bytes[1] == '5';
    Reader reader = {path, bytes, length, 2};
    int width, height, maxval;
    if (!read_number(&reader, "width", 1, IMAGE_MAX_PIXELS, &width, err)) return false;
    if (!read_number(&reader, "height", 1, IMAGE_MAX_PIXELS, &height, err)) return false;
    if ((size_t)width * (size_t)height > IMAGE_MAX_PIXELS)
        return error_set(err, "%s: an image of %d x %d pixels; at most 100 million are read", path, width,
                         height);
    if (!read_number(&reader, "greatest grey level", 1, 65535, &maxval, err)) return false;
    if (reader.place < length && isspace(bytes[reader.place]))
        reader.place++; /* exactly one: pixels follow */

    /* Before memory is reserved: can the pixels be there at all? In text each takes a digit and all but one a
     * blank. */
    size_t count = (size_t)width * (size_t)height;
    size_t least = !binary ? 2 * count - 1 : maxval > 255 ? 2 * count : count;
    if (length - reader.place < least)
        return error_set(err, "%s: the file ends before the last of %d x %d pixels", path, width, height);
    image->width = width;
    image->height = height;
    image->grey = mem_alloc(count, sizeof *image->grey);
    bool ok = (binary ? read_binary_pixels : read_text_pixels)(&reader, maxval, count, image->grey, err);
    if (!ok) image_clear(image);
    return ok;
}

static bool read_png(const char *path, Image *image, Error *err)
{
    unsigned char *rgb;
    if (!canvas_read_png(path, &rgb, &image->width, &image->height, err)) {
        *image = (Image){0};
        return false;
    }
    size_t count = (size_t)image->width * (size_t)image->height;
    image->grey = mem_alloc(count, sizeof *image->grey);
    for (size_t i = 0; i < count; i++)
        image->grey[i] = (2126 * rgb[3 * i] + 7152 * rgb[3 * i + 1] + 722 * rgb[3 * i + 2]) / (10000 * 255.0);
    mem_free(rgb);
    return true;
}

/* All bytes of the open file; NULL with errno set where that fails. */
static unsigned char *file_bytes(FILE *file, size_t *length)
{
    size_t capacity = 1 << 16;
    unsigned char *bytes = mem_alloc(capacity, 1);
    *length = 0;
    for (;;) {
        *length += fread(bytes + *length, 1, capacity - *length, file);
        if (*length < capacity) break;
        bytes = mem_resize(bytes, capacity, 2 * capacity, 1);
        capacity *= 2;
    }
    if (!ferror(file)) return bytes;
    mem_free(bytes);
    return NULL;
}

static bool read_pgm(const char *path, FILE *file, Image *image, Error *err)
{
    size_t length;
    unsigned char *bytes = file_bytes(file, &length);
    if (!bytes) return error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    bool ok = image_parse_pgm(path, bytes, length, image, err);
    mem_free(bytes);
    return ok;
}

bool image_read(const char *path, Image *image, Error *err)
{
    *image = (Image){0};
    FILE *file = fopen(path, "rb");
    if (!file) return error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    unsigned char magic[4] = {0};
    size_t got = fread(magic, 1, sizeof magic, file);
    bool ok;
    if (ferror(file))
        ok = error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    else if (got == 0)
        ok = error_set(err, "%s: the file is empty", path);
    else if (memcmp(magic, "\x89PNG", 4) == 0)
        ok = read_png(path, image, err);
    else if (magic[0] == 'P' && (magic[1] == '2' || magic[1] == '5') && fseek(file, 0, SEEK_SET) == 0)
        ok = read_pgm(path, file, image, err);
    else
        ok = error_set(err, "%s: neither a PNG nor a PGM image (P2, P5); convert it to PNG", path);
    fclose(file);
    return ok;
}

double image_sample(const Image *image, double u, double v)
{
    double x = fmin(fmax(u * image->width - 0.5, 0), image->width - 1);
    double y = fmin(fmax(v * image->height - 0.5, 0), image->height - 1);
    int j = (int)x, i = (int)y;
    int right = j + 1 < image->width, below = i + 1 < image->height;
    const double *row = image->grey + (size_t)i * (size_t)image->width + j;
    const double *next = row + (below ? image->width : 0);
    double s = x - j, t = y - i;
    return (1 - t) * ((1 - s) * row[0] + s * row[right]) + t * ((1 - s) * next[0] + s * next[right]);
}

void image_clear(Image *image)
{
    mem_free(image->grey);
    *image = (Image){0};
}
