/* Sums of levels in boxes, and upright pictures (image_reader.h). */
#include "base/memory.h"
#include "io/image.h"
#include "io/image_reader.h"
#include <math.h>

enum { FACTOR_MAX = 100 }; /* of a box: sums of 65535 fit its 32 bits */

/* How many pixels a box is wide and high. */
static int factor_of(const ImageBytes *file, const Levels *levels)
{
    bool lies = levels->orientation >= 5;
    double across = levels->width / file->useful[lies], down = levels->height / file->useful[!lies];
    return (int)fmin(fmax(fmin(across, down), 1), FACTOR_MAX);
}

bool levels_create(const ImageBytes *file, Levels *levels, size_t least_bytes, Error *err)
{
    size_t pixels = (size_t)levels->width * (size_t)levels->height;
    if (pixels > IMAGE_MAX_PIXELS)
        return error_set(err, "%s: an image of %d x %d pixels; at most %d million are read: make it smaller",
                         file->path, levels->width, levels->height, IMAGE_MAX_PIXELS / 1000000);
    if (file->length < least_bytes)
        return error_set(err, "%s: the file ends before the last of %d x %d pixels", file->path,
                         levels->width, levels->height);
    int factor = factor_of(file, levels);
    levels->columns = levels->width / factor;
    levels->rows = levels->height / factor;
    levels->sum = mem_alloc((size_t)levels->columns * (size_t)levels->rows * (size_t)levels->channels,
                            sizeof *levels->sum);
    return true;
}

/* The first of `size` pixels in box k of `count`. */
static int first_pixel(int k, int size, int count)
{
    return (int)((int64_t)k * size / count);
}

static int box_of(int pixel, int size, int count)
{
    return (int)((((int64_t)pixel + 1) * count - 1) / size);
}

void levels_add_row(Levels *levels, int row, const unsigned char *bytes, int size)
{
    int channels = levels->channels;
    size_t box = (size_t)box_of(row, levels->height, levels->rows);
    uint32_t *sum = levels->sum + box * (size_t)levels->columns * (size_t)channels;
    for (int j = 0, x = 0; j < levels->columns; j++, sum += channels)
        for (int end = first_pixel(j + 1, levels->width, levels->columns); x < end; x++)
            for (int c = 0; c < channels; c++, bytes += size)
                sum[c] += size == 1 ? bytes[0] : (uint32_t)(bytes[0] << 8 | bytes[1]);
}

double levels_box(const Levels *levels, int row, int column)
{
    if (levels->columns == levels->width && levels->rows == levels->height) return 1;
    int wide = first_pixel(column + 1, levels->width, levels->columns) -
               first_pixel(column, levels->width, levels->columns);
    int high =
        first_pixel(row + 1, levels->height, levels->rows) - first_pixel(row, levels->height, levels->rows);
    return (double)wide * high;
}

/* Tags 5 to 8 exchange rows and columns, then 2, 3, 6, 7 turn left and right around and 3, 4, 7, 8 top and
 * bottom. */
void levels_upright(const Levels *levels, int row, int column, int *y, int *x)
{
    int tag = levels->orientation;
    bool lies = tag >= 5, mirror = tag == 2 || tag == 3 || tag == 6 || tag == 7;
    bool flip = tag == 3 || tag == 4 || tag == 7 || tag == 8;
    *x = lies ? row : column;
    *y = lies ? column : row;
    if (mirror) *x = (lies ? levels->rows : levels->columns) - 1 - *x;
    if (flip) *y = (lies ? levels->columns : levels->rows) - 1 - *y;
}

static unsigned read_word(const unsigned char *bytes, bool little, int size)
{
    unsigned word = 0;
    for (int k = 0; k < size; k++) word = word << 8 | bytes[little ? size - 1 - k : k];
    return word;
}

int levels_exif_orientation(const unsigned char *tiff, size_t length)
{
    if (length < 8) return 1;
    bool little = tiff[0] == 'I';
    size_t at = read_word(tiff + 4, little, 4);
    if (at + 2 > length) return 1;
    unsigned entries = read_word(tiff + at, little, 2);
    for (at += 2; entries > 0 && at + 12 <= length; entries--, at += 12)
        if (read_word(tiff + at, little, 2) == 0x0112) {
            unsigned value = read_word(tiff + at + 8, little, 2);
            return value >= 1 && value <= 8 ? (int)value : 1;
        }
    return 1;
}
