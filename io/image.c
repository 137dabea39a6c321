#include "io/image.h"
#include "base/memory.h"
#include "io/image_reader.h"
#include "io/scan.h"
#include <math.h>
#include <string.h>

static bool parse(const ImageBytes *file, Levels *levels, Error *err)
{
    const unsigned char *b = file->bytes;
    bool ok = false;
    *levels = (Levels){0};
    if (file->length == 0)
        error_set(err, "%s: the file is empty", file->path);
    else if (file->length >= 4 && !memcmp(b, "\x89PNG", 4))
        ok = levels_read_png(file, levels, err);
    else if (file->length >= 2 && b[0] == 'P' && b[1] && strchr("2356", b[1]))
        ok = levels_read_pnm(file, levels, err);
    else if (file->length >= 3 && !memcmp(b, "\xff\xd8\xff", 3))
        ok = levels_read_jpeg(file, levels, err);
    else
        error_set(err, "%s: not a PNG, JPEG, PGM or PPM image; convert it to PNG", file->path);
    return ok;
}

static bool read_file(const char *path, const double useful[2], Levels *levels, Error *err)
{
    char *bytes;
    size_t length;
    *levels = (Levels){0};
    if (!scan_file(path, &bytes, &length, err)) return false;
    bool ok = parse(&(ImageBytes){path, (unsigned char *)bytes, length, {useful[0], useful[1]}}, levels, err);
    mem_free(bytes);
    return ok;
}

/* The weighted sum of the channels, upright; weights are 1/10000. */
static Image levels_image(const Levels *levels, const int weights[3])
{
    bool lies = levels->orientation >= 5;
    int width = lies ? levels->rows : levels->columns, height = lies ? levels->columns : levels->rows;
    Image image = {width, height, mem_alloc((size_t)width * (size_t)height, sizeof *image.grey)};
    const uint32_t *sum = levels->sum;
    for (int i = 0; i < levels->rows; i++)
        for (int j = 0; j < levels->columns; j++, sum += levels->channels) {
            int x, y;
            levels_upright(levels, i, j, &y, &x);
            double white = levels->maximum * levels_box(levels, i, j);
            double *grey = image.grey + (size_t)y * (size_t)width + x;
            if (levels->channels == 1)
                *grey = sum[0] / white;
            else
                *grey = (weights[0] * (double)sum[0] + weights[1] * (double)sum[1] +
                         weights[2] * (double)sum[2]) /
                        (10000.0 * white);
        }
    return image;
}

static const int luma[3] = {2126, 7152, 722}, one[3][3] = {{10000, 0, 0}, {0, 10000, 0}, {0, 0, 10000}};
static const double all[2] = {INFINITY, INFINITY};

bool image_read_useful(const char *path, const double useful[2], Image *grey, Image rgb[3], Error *err)
{
    Levels levels;
    bool ok = read_file(path, useful, &levels, err);
    *grey = ok ? levels_image(&levels, luma) : (Image){0};
    for (int c = 0; rgb && c < 3; c++) rgb[c] = ok ? levels_image(&levels, one[c]) : (Image){0};
    mem_free(levels.sum);
    return ok;
}

bool image_read(const char *path, Image *image, Error *err)
{
    return image_read_useful(path, all, image, NULL, err);
}

bool image_read_rgb(const char *path, Image rgb[3], Error *err)
{
    Levels levels;
    bool ok = read_file(path, all, &levels, err);
    for (int c = 0; c < 3; c++) rgb[c] = ok ? levels_image(&levels, one[c]) : (Image){0};
    mem_free(levels.sum);
    return ok;
}

bool image_parse(const char *path, const unsigned char *bytes, size_t length, Image *image, Error *err)
{
    Levels levels;
    bool ok = parse(&(ImageBytes){path, bytes, length, {INFINITY, INFINITY}}, &levels, err);
    *image = ok ? levels_image(&levels, luma) : (Image){0};
    mem_free(levels.sum);
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
