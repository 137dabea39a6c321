#include "io/colormap.h"
#include "base/vec3.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { VIRIDIS_COUNT = 16, DIVERGING_COUNT = 17 };

/* [Smith and van der Walt 2015] */
static const unsigned viridis[VIRIDIS_COUNT] = {0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e,
                                                0x2a788e, 0x23888e, 0x1f988b, 0x22a884, 0x35b779, 0x54c568,
                                                0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725};

/* Lightness linear on both sides, Oklab hues 255 and 26 degrees. */
static const unsigned diverging[DIVERGING_COUNT] = {
    0x1d4d87, 0x2c61a0, 0x3c75ba, 0x5289cf, 0x6d9fdf, 0x8bb4ea, 0xaccaf0, 0xcfdff3, 0xf3f3f3,
    0xf9d3ce, 0xf9b2ab, 0xf3938a, 0xe8756c, 0xd75952, 0xc1413d, 0xa6302d, 0x8b1e1e};

double color_linear(double c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double srgb_from_linear(double c)
{
    c = fmin(fmax(c, 0), 1);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055;
}

static Vec3 rgb_unpack(unsigned hex)
{
    return vec3((hex >> 16) / 255.0, (hex >> 8 & 255) / 255.0, (hex & 255) / 255.0);
}

static Vec3 oklab_from_rgb(Vec3 c)
{
    const Mat3 lms = {{0.4122214708, 0.5363325363, 0.0514459929},
                      {0.2119034982, 0.6806995451, 0.1073969566},
                      {0.0883024619, 0.2817188376, 0.6299787005}};
    const Mat3 lab = {{0.2104542553, 0.7936177850, -0.0040720468},
                      {1.9779984951, -2.4285922050, 0.4505937099},
                      {0.0259040371, 0.7827717662, -0.8086757660}};
    Vec3 v = mat3_times(lms, vec3(color_linear(c.x), color_linear(c.y), color_linear(c.z)));
    return mat3_times(lab, vec3(cbrt(v.x), cbrt(v.y), cbrt(v.z)));
}

static Vec3 rgb_from_oklab(Vec3 c)
{
    const Mat3 lms = {{1, 0.3963377774, 0.2158037573},
                      {1, -0.1055613458, -0.0638541728},
                      {1, -0.0894841775, -1.2914855480}};
    const Mat3 rgb = {{4.0767416621, -3.3077115913, 0.2309699292},
                      {-1.2684380046, 2.6097574011, -0.3413193965},
                      {-0.0041960863, -0.7034186147, 1.7076147010}};
    Vec3 v = mat3_times(lms, c);
    v = mat3_times(rgb, vec3(v.x * v.x * v.x, v.y * v.y * v.y, v.z * v.z * v.z));
    return vec3(srgb_from_linear(v.x), srgb_from_linear(v.y), srgb_from_linear(v.z));
}

Color colormap_color(Colormap map, double t)
{
    if (isnan(t)) return (Color){0.75, 0.75, 0.75, 1};
    const unsigned *anchors = map == COLORMAP_VIRIDIS ? viridis : diverging;
    int last = (map == COLORMAP_VIRIDIS ? VIRIDIS_COUNT : DIVERGING_COUNT) - 1;
    double place = fmin(fmax(t, 0), 1) * last;
    int k = place < last ? (int)place : last - 1;
    Vec3 a = oklab_from_rgb(rgb_unpack(anchors[k])), b = oklab_from_rgb(rgb_unpack(anchors[k + 1]));
    Vec3 c = rgb_from_oklab(vec3_axpy(place - k, vec3_sub(b, a), a));
    return (Color){c.x, c.y, c.z, 1};
}

/* Inks of pens rather than lights of a screen: pure red, green and blue would be too bright on paper. */
static const struct {
    const char *name;
    unsigned rgb;
} named[] = {{"black", 0x000000},  {"white", 0xffffff},  {"grey", 0x808080},  {"red", 0xd62728},
             {"green", 0x2ca02c},  {"blue", 0x1f55b4},   {"cyan", 0x00aeef},  {"magenta", 0xec008c},
             {"yellow", 0xfff200}, {"orange", 0xff7f0e}, {"brown", 0x8c564b}, {"purple", 0x7b3fa0}};

bool color_parse(const char *text, Color *color, Error *err)
{
    unsigned long rgb = 0;
    bool known = text[0] == '#' && strspn(text + 1, "0123456789abcdefABCDEF") == 6 && strlen(text) == 7;
    if (known) rgb = strtoul(text + 1, NULL, 16);
    for (size_t k = 0; !known && k < sizeof named / sizeof *named; k++)
        if ((known = !strcmp(text, named[k].name))) rgb = named[k].rgb;
    if (!known)
        return error_set(err,
                         "'%s' is no colour; write #rrggbb, or black, white, grey, red, green, blue, "
                         "cyan, magenta, yellow, orange, brown or purple",
                         text);
    *color = (Color){(double)(rgb >> 16) / 255, (double)(rgb >> 8 & 255) / 255, (double)(rgb & 255) / 255, 1};
    return true;
}

Color colormap_series(int index)
{
    static const Color palette[] = {{0, 0.447, 0.698, 1},   {0.835, 0.369, 0, 1}, {0, 0.62, 0.451, 1},
                                    {0.8, 0.475, 0.655, 1}, {0.902, 0.624, 0, 1}, {0.337, 0.706, 0.914, 1},
                                    {0.25, 0.25, 0.27, 1}};
    return palette[index % (int)(sizeof palette / sizeof palette[0])];
}

static const double CONSTANT = 1e-3; /* of the values: more like each other a legend cannot tell apart */

ColorScale color_scale_fit(const double *values, int count)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < count; i++) {
        if (!isfinite(values[i])) continue;
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
    }
    if (low > high) return (ColorScale){COLORMAP_VIRIDIS, 0, 1};
    if (low < 0 && high > 0) {
        high = fmax(high, -low);
        return (ColorScale){COLORMAP_DIVERGING, -high, high};
    }
    if (low > 0 && low < 0.2 * high) low = 0;
    if (high < 0 && high > 0.2 * low) high = 0;
    if (high - low <= CONSTANT * fmax(fabs(low), fabs(high))) { /* its colour is the middle */
        double half = low != 0 ? 0.5 * fabs(low) : 0.5;
        low -= half;
        high += half;
    }
    return (ColorScale){COLORMAP_VIRIDIS, low, high};
}

Color color_scale_color(const ColorScale *scale, double value)
{
    return colormap_color(scale->map, (value - scale->low) / (scale->high - scale->low));
}
