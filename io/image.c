#include "io/image.h"
#include "base/memory.h"
#include "io/canvas.h"
#include "io/image_reader.h"
#include "io/scan.h"
#include <math.h>
#include <string.h>

bool levels_create(const ImageBytes *file, Levels *levels, size_t least_bytes, Error *err)
{
    size_t pixels = (size_t)levels->width * (size_t)levels->height;
    if (pixels > IMAGE_MAX_PIXELS)
        return error_set(err, "%s: an image of %d x %d pixels; at most 100 million are read", file->path,
                         levels->width, levels->height);
    if (file->length < least_bytes)
        return error_set(err, "%s: the file ends before the last of %d x %d pixels", file->path,
                         levels->width, levels->height);
    levels->level = mem_alloc(pixels * (size_t)levels->channels, sizeof *levels->level);
    return true;
}

static bool levels_read_png(const ImageBytes *file, Levels *levels, Error *err)
{
    unsigned char *rgb;
    *levels = (Levels){.channels = 3, .maximum = 255};
    if (!canvas_read_png(file->path, &rgb, &levels->width, &levels->height, err)) return false;
    bool ok = levels_create(file, levels, 0, err);
    size_t count = 3 * (size_t)levels->width * (size_t)levels->height;
    for (size_t i = 0; ok && i < count; i++) levels->level[i] = rgb[i];
    mem_free(rgb);
    return ok;
}

/* PGM, PPM, JPEG. */
static bool parse(const ImageBytes *file, Levels *levels, Error *err)
{
    const unsigned char *b = file->bytes;
    *levels = (Levels){0};
    if (file->length == 0) return error_set(err, "%s: the file is empty", file->path);
    if (file->length >= 2 && b[0] == 'P' && b[1] && strchr("2356", b[1]))
        return levels_read_pnm(file, levels, err);
    if (file->length >= 3 && memcmp(b, "\xff\xd8\xff", 3) == 0) return levels_read_jpeg(file, levels, err);
    return error_set(err, "%s: not a PNG, JPEG, PGM or PPM image; convert it to PNG", file->path);
}

static bool read_file(const char *path, Levels *levels, Error *err)
{
    char *bytes;
    size_t length;
    *levels = (Levels){0};
    if (!scan_file(path, &bytes, &length, err)) return false;
    ImageBytes file = {path, (unsigned char *)bytes, length};
    bool png = length >= 4 && memcmp(bytes, "\x89PNG", 4) == 0;
    bool ok = (png ? levels_read_png : parse)(&file, levels, err);
    mem_free(bytes);
    return ok;
}

/* The weighted sum of the channels; weights are 1/10000. */
static Image levels_image(const Levels *levels, const int weights[3])
{
    size_t count = (size_t)levels->width * (size_t)levels->height, channels = (size_t)levels->channels;
    Image image = {levels->width, levels->height, mem_alloc(count, sizeof *image.grey)};
    for (size_t i = 0; i < count; i++) {
        const uint16_t *level = levels->level + channels * i;
        if (channels == 1)
            image.grey[i] = (double)level[0] / levels->maximum;
        else
            image.grey[i] = (weights[0] * level[0] + weights[1] * level[1] + weights[2] * level[2]) /
                            (10000.0 * levels->maximum);
    }
    return image;
}

static const int luma[3] = {2126, 7152, 722};

bool image_read(const char *path, Image *image, Error *err)
{
    Levels levels;
    *image = (Image){0};
    if (!read_file(path, &levels, err)) return false;
    *image = levels_image(&levels, luma);
    mem_free(levels.level);
    return true;
}

bool image_read_rgb(const char *path, Image rgb[3], Error *err)
{
    static const int one[3][3] = {{10000, 0, 0}, {0, 10000, 0}, {0, 0, 10000}};
    Levels levels;
    bool ok = read_file(path, &levels, err);
    for (int c = 0; c < 3; c++) rgb[c] = ok ? levels_image(&levels, one[c]) : (Image){0};
    mem_free(levels.level);
    return ok;
}

bool image_parse(const char *path, const unsigned char *bytes, size_t length, Image *image, Error *err)
{
    Levels levels;
    *image = (Image){0};
    if (!parse(&(ImageBytes){path, bytes, length}, &levels, err)) return false;
    *image = levels_image(&levels, luma);
    mem_free(levels.level);
    return true;
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
