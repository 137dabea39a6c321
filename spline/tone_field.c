#include "spline/tone_field.h"
#include "base/memory.h"

SplineToneDef spline_tone_default(void)
{
    return (SplineToneDef){.crop = {0, 0, 1, 1}, .white = 1, .gamma = 1, .density = 0.85};
}

static bool curve_check(const SplineToneDef *def, Error *err)
{
    for (int k = 0; k < def->curve_points; k++) {
        const double *point = def->curve[k];
        if (!(point[0] >= 0 && point[0] <= 1 && point[1] >= 0 && point[1] <= 1))
            return error_set(
                err, "point %d of the tone curve is (%g, %g); grey levels and brightnesses are 0 to 1", k + 1,
                point[0], point[1]);
        if (k > 0 && !(point[0] > def->curve[k - 1][0]))
            return error_set(err, "the grey levels of the tone curve must grow; %g follows %g", point[0],
                             def->curve[k - 1][0]);
    }
    return true;
}

bool spline_tone_check(const SplineToneDef *def, Error *err)
{
    const double *c = def->crop;
    if (!(c[0] >= 0 && c[1] >= 0 && c[2] <= 1 && c[3] <= 1 && c[0] < c[2] && c[1] < c[3]))
        return error_set(
            err, "the crop %g, %g, %g, %g must be left, top, right and bottom as fractions of the picture",
            c[0], c[1], c[2], c[3]);
    if (!(def->black >= 0 && def->white <= 1 && def->black < def->white))
        return error_set(err,
                         "the black point %g and the white point %g must be grey levels 0 to 1 that grow",
                         def->black, def->white);
    if (!(def->gamma >= 0.05 && def->gamma <= 20))
        return error_set(err, "the gamma is %g; 0.05 to 20 is allowed", def->gamma);
    if (!(def->density > 0 && def->density <= 1))
        return error_set(err, "the density of black is %g; it must be above 0 and at most 1", def->density);
    return curve_check(def, err);
}

static double curve_at(const SplineToneDef *def, double grey)
{
    const double(*point)[2] = def->curve;
    int k = 0;
    while (k < def->curve_points && point[k][0] < grey) k++;
    if (k == 0) return point[0][1];
    if (k == def->curve_points) return point[k - 1][1];
    double s = (grey - point[k - 1][0]) / (point[k][0] - point[k - 1][0]);
    return (1 - s) * point[k - 1][1] + s * point[k][1];
}

static double brightness_of(const SplineToneDef *def, double grey)
{
    if (def->curve_points > 0) return curve_at(def, grey);
    double level = fmin(fmax((grey - def->black) / (def->white - def->black), 0), 1);
    return def->gamma == 1 ? level : pow(level, 1 / def->gamma);
}

static double density_of(const SplineToneDef *def, double grey)
{
    return def->density * (1 - brightness_of(def, def->invert ? 1 - grey : grey));
}

/* Where the picture lies: u = u0 + x*du, v = v0 + y*dv, fractions of its sides. */
typedef struct Placement {
    double u0, v0, du, dv;
} Placement;

static Placement placement_of(const Image *image, const SplinePage *page, const SplineToneDef *def)
{
    const double *c = def->crop;
    double width = (c[2] - c[0]) * image->width, height = (c[3] - c[1]) * image->height; /* pixels */
    double x = width / page->width, y = height / page->height;
    double scale = def->cover ? fmin(x, y) : fmax(x, y); /* pixels in a unit of the page */
    double du = scale / image->width, dv = scale / image->height;
    return (Placement){(c[0] + c[2] - page->width * du) / 2, (c[1] + c[3] - page->height * dv) / 2, du, dv};
}

/* Sample k of n along a side of a pixel from `start` of that size, held inside low..high. inside tells
 * whether that was needed. */
static double sample_place(double start, double size, int k, int n, const double range[2], bool *inside)
{
    double at = start + size * (k + 0.5) / n;
    *inside = at >= range[0] && at <= range[1];
    return fmin(fmax(at, range[0]), range[1]);
}

/* The mean density over the pixel with that corner: samples not farther apart than the picture's pixels. */
static double pixel_density(const Image *image, const SplineToneDef *def, const Placement *pixel)
{
    const double across[2] = {def->crop[0], def->crop[2]}, down[2] = {def->crop[1], def->crop[3]};
    int columns = (int)ceil(fmax(pixel->du * image->width, 1)),
        rows = (int)ceil(fmax(pixel->dv * image->height, 1));
    double sum = 0;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            bool in_u, in_v;
            double u = sample_place(pixel->u0, pixel->du, j, columns, across, &in_u);
            double v = sample_place(pixel->v0, pixel->dv, i, rows, down, &in_v);
            if (def->extend || (in_u && in_v)) sum += density_of(def, image_sample(image, u, v));
        }
    return sum / (rows * columns);
}

SplineField spline_tone(const Image *image, const SplinePage *page, const SplineToneDef *def, double pixel)
{
    SplineField tone = spline_field_create(page, pixel, 1);
    Placement place = placement_of(image, page, def);
    Placement at = {.du = place.du * page->width / tone.columns, .dv = place.dv * page->height / tone.rows};
    for (int i = 0; i < tone.rows; i++)
        for (int j = 0; j < tone.columns; j++) {
            at.u0 = place.u0 + j * at.du;
            at.v0 = place.v0 + i * at.dv;
            tone.values[(size_t)i * (size_t)tone.columns + (size_t)j] = pixel_density(image, def, &at);
        }
    return tone;
}

void spline_tone_useful(const SplinePage *page, const SplineToneDef *def, double pixel, double useful[2])
{
    useful[0] = 2 * page->width / (pixel * (def->crop[2] - def->crop[0]));
    useful[1] = 2 * page->height / (pixel * (def->crop[3] - def->crop[1]));
}

void spline_separate(const Image rgb[3], double black, Image ink[4])
{
    size_t count = (size_t)rgb[0].width * (size_t)rgb[0].height;
    for (int c = 0; c < 4; c++)
        ink[c] = (Image){rgb[0].width, rgb[0].height, mem_alloc(count, sizeof *ink[c].grey)};
    for (size_t i = 0; i < count; i++) {
        double common = 1 - fmax(rgb[0].grey[i], fmax(rgb[1].grey[i], rgb[2].grey[i])), k = black * common;
        for (int c = 0; c < 3; c++)
            ink[c].grey[i] = k < 1 ? 1 - fmax(1 - rgb[c].grey[i] - k, 0) / (1 - k) : 1;
        ink[3].grey[i] = 1 - k;
    }
}

void spline_tone_layers(const SplineField *tone, int layers, const double *limits, SplineField *layer)
{
    size_t count = (size_t)tone->columns * (size_t)tone->rows;
    for (int k = 0; k < layers; k++) layer[k] = spline_field_like(tone, 1);
    for (size_t i = 0; i < count; i++) {
        int k = 0;
        while (k < layers - 1 && tone->values[i] >= limits[k]) k++;
        layer[k].values[i] = tone->values[i];
    }
}

void spline_tone_cross(const SplineField *tone, int sets, const double *from, SplineField *set)
{
    size_t count = (size_t)tone->columns * (size_t)tone->rows;
    for (int k = 0; k < sets; k++) set[k] = spline_field_like(tone, 1);
    for (size_t i = 0; i < count; i++) {
        double depth = -log1p(-fmin(tone->values[i], 1 - 1e-9)), share = 0;
        /* from the set that begins last: what lies between its beginning and the next one's is shared by
         * all that have begun */
        double upper = depth;
        for (int k = sets - 1; k >= 0; k--) {
            double lower = -log1p(-fmin(from[k], 1 - 1e-9));
            set[k].values[i] = fmax(upper - lower, 0) / (k + 1);
            upper = fmin(upper, lower);
        }
        for (int k = sets - 1; k >= 0; k--) {
            share += set[k].values[i];
            set[k].values[i] = -expm1(-share);
        }
    }
}
