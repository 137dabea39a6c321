/* PGM (P2, P5) and PPM (P3, P6): the text ones hold decimal numbers, the binary ones a byte a level, or two
 * with the greater first where the greatest level exceeds 255. */
#include "base/memory.h"
#include "io/image.h"
#include "io/image_reader.h"
#include <ctype.h>

/* A file's text, read number by number. */
typedef struct Reader {
    const ImageBytes *file;
    size_t place;
} Reader;

static int reader_line(const Reader *reader)
{
    int line = 1;
    for (size_t i = 0; i < reader->place; i++) line += reader->file->bytes[i] == '\n';
    return line;
}

static void skip_blanks(Reader *reader)
{
    const ImageBytes *file = reader->file;
    while (reader->place < file->length) {
        unsigned char c = file->bytes[reader->place];
        if (c == '#')
            while (reader->place < file->length && file->bytes[reader->place] != '\n') reader->place++;
        else if (!isspace(c))
            return;
        else
            reader->place++;
    }
}

/* A whole number in low..high; what names it in the sentence. */
static bool read_number(Reader *reader, const char *what, int low, int high, int *number, Error *err)
{
    const ImageBytes *file = reader->file;
    skip_blanks(reader);
    long value = 0;
    size_t start = reader->place;
    while (reader->place < file->length && isdigit(file->bytes[reader->place]) && value <= high)
        value = 10 * value + file->bytes[reader->place++] - '0';
    if (reader->place == file->length && start == reader->place)
        return error_set(err, "%s:%d: the file ends where the %s should be", file->path, reader_line(reader),
                         what);
    if (start == reader->place || value < low || value > high)
        return error_set(err, "%s:%d: the %s must be a whole number from %d to %d", file->path,
                         reader_line(reader), what, low, high);
    *number = (int)value;
    return true;
}

/* A row of numbers, as two bytes each. */
static bool read_text_row(Reader *reader, const Levels *levels, unsigned char *row, Error *err)
{
    for (int i = 0; i < levels->width * levels->channels; i++) {
        int level;
        if (!read_number(reader, "level", 0, levels->maximum, &level, err)) return false;
        row[2 * i] = (unsigned char)(level >> 8), row[2 * i + 1] = (unsigned char)level;
    }
    return true;
}

static bool read_text_levels(Reader *reader, Levels *levels, Error *err)
{
    unsigned char *row = mem_alloc((size_t)levels->width * (size_t)levels->channels, 2);
    bool ok = true;
    for (int i = 0; ok && i < levels->height; i++) {
        ok = read_text_row(reader, levels, row, err);
        if (ok) levels_add_row(levels, i, row, 2);
    }
    mem_free(row);
    return ok;
}

static bool read_binary_levels(Reader *reader, Levels *levels, Error *err)
{
    int size = levels->maximum > 255 ? 2 : 1;
    size_t count = (size_t)levels->width * (size_t)levels->channels;
    const unsigned char *b = reader->file->bytes + reader->place;
    for (int i = 0; i < levels->height; i++, b += count * (size_t)size) {
        for (size_t k = 0; k < count; k++) {
            int level = size == 2 ? b[2 * k] << 8 | b[2 * k + 1] : b[k];
            if (level > levels->maximum)
                return error_set(
                    err, "%s: level %d of pixel %zu exceeds the file's maximum %d", reader->file->path, level,
                    (size_t)i * (size_t)levels->width + k / (size_t)levels->channels, levels->maximum);
        }
        levels_add_row(levels, i, b, size);
    }
    return true;
}

bool levels_read_pnm(const ImageBytes *file, Levels *levels, Error *err)
{
    bool binary = file->bytes[1] >= '5', color = file->bytes[1] == '3' || file->bytes[1] == '6';
    Reader reader = {file, 2};
    *levels = (Levels){.channels = color ? 3 : 1};
    if (!read_number(&reader, "width", 1, IMAGE_MAX_PIXELS, &levels->width, err) ||
        !read_number(&reader, "height", 1, IMAGE_MAX_PIXELS, &levels->height, err) ||
        !read_number(&reader, "greatest level", 1, 65535, &levels->maximum, err))
        return false;
    if (reader.place < file->length && isspace(file->bytes[reader.place]))
        reader.place++; /* exactly one: pixels follow */

    /* In text each level takes a digit and all but one a blank. */
    size_t count = (size_t)levels->width * (size_t)levels->height * (size_t)levels->channels;
    size_t least = !binary ? 2 * count - 1 : levels->maximum > 255 ? 2 * count : count;
    if (!levels_create(file, levels, reader.place + least, err)) return false;
    if ((binary ? read_binary_levels : read_text_levels)(&reader, levels, err)) return true;
    mem_free(levels->sum);
    *levels = (Levels){0};
    return false;
}
