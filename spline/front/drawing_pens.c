#include "spline/front/drawing_pens.h"
#include "base/memory.h"
#include "model/build.h"
#include <math.h>
#include <string.h>

static const double PEN_MAX = 0.2;    /* of the page                                                      */
static const double PEN_ACROSS = 0.4; /* of its shorter side: lines keep a pen's width away from the edges */

/* Inks of spline_separate in their order, and their screens: lines 30 degrees apart do not beat visibly, and
 * yellow, which shows least, is the one across. */
static const struct {
    const char *name;
    double turn; /* degrees */
} inks[] = {{"cyan", -30}, {"magenta", 30}, {"yellow", 90}, {"black", 0}};

enum { INKS = 4 };

static const double SEEN = 1; /* Delta E, about the least difference that is                              */
static const double GLARE =
    0.01; /* of white's light, that the surface sends back anyway [IEC 61966-2-1]       */

static bool is(const SplineScene *scene, SeparationKind kind)
{
    return scene->separation && scene->separation->kind == (int)kind;
}

static bool is_cmyk(const SplineScene *scene)
{
    return is(scene, SEPARATE_CMYK);
}

double pens_finest(const SplineScene *scene)
{
    double finest = scene->pens_count ? INFINITY : scene->pen;
    for (int k = 0; k < scene->pens_count; k++)
        finest = fmin(finest, isnan(scene->pens[k].width) ? scene->pen : scene->pens[k].width);
    return finest;
}

int pens_ink(const char *name)
{
    for (int k = 0; k < INKS; k++)
        if (!strcmp(name, inks[k].name)) return k;
    return -1;
}

double *pens_limits(const SplineScene *scene)
{
    double *limits = mem_alloc((size_t)scene->pens_count, sizeof *limits);
    for (int k = 1; k < scene->pens_count; k++) limits[k - 1] = scene->pens[k].from;
    return limits;
}

double pens_turn(const SplineScene *scene, const SplinePen *pens, int pen)
{
    if (scene->pens_count && !isnan(scene->pens[pen].turn)) return scene->pens[pen].turn;
    if (is(scene, SEPARATE_MATCH)) return pen * M_PI / scene->pens_count;
    return is_cmyk(scene) ? inks[pens_ink(pens[pen].name)].turn * M_PI / 180 : 0;
}

/* Without a separation each of several pens draws the regions that name it. */
static bool check_regions(const SplineScene *scene, YamlFile *file)
{
    if (scene->pens_count < 2) return true;
    if (!scene->regions_count)
        return yaml_refuse(
            file, "spline.pens",
            "several pens need `separation`: cmyk, match, or tones with `from` of each pen; or "
            "`regions`, each with its `pen`");
    for (int k = 0; k < scene->regions_count; k++)
        if (!scene->regions[k].pen)
            return yaml_refuse(file, key("spline.regions[%d]", k).text,
                               "which of the pens draws this region? Say `pen`, or `separation` for all");
    for (int pen = 0; pen < scene->pens_count; pen++) {
        int k = 0;
        while (k < scene->regions_count && strcmp(scene->regions[k].pen, scene->pens[pen].name)) k++;
        if (k == scene->regions_count)
            return yaml_refuse(file, key("spline.pens[%d]", pen).text, "no region is drawn by this pen");
    }
    return true;
}

static bool check_separation(const SplineScene *scene, YamlFile *file)
{
    static const struct {
        const char *image, *pens; /* why it needs them */
    } rows[] = {
        [SEPARATE_CMYK] = {.image = "only a picture has colours that cmyk can separate"},
        [SEPARATE_TONES] = {.pens = "tones needs `pens`, each with the density `from` which it draws"},
        [SEPARATE_MATCH] = {"only a picture has colours that pens can match",
                            "match needs `pens`, each with its colour"}};
    if (!scene->separation) return check_regions(scene, file);
    const char *image = rows[scene->separation->kind].image, *pens = rows[scene->separation->kind].pens;
    return (!image || scene->image || yaml_refuse(file, "spline.separation", "%s", image)) &&
           (!pens || scene->pens_count > 0 || yaml_refuse(file, "spline.separation", "%s", pens));
}

static bool check_from(const SplineScene *scene, YamlFile *file)
{
    double before = 0;
    for (int k = 1; is(scene, SEPARATE_TONES) && k < scene->pens_count; k++) {
        if (!(scene->pens[k].from > before))
            return yaml_refuse(file, key("spline.pens[%d]", k).text,
                               "this pen needs `from`, a density above the pen's before it, %g", before);
        before = scene->pens[k].from;
    }
    return true;
}

/* Names are a line each in the result and on the terminal, and words of the SVG file's XML. */
static bool check_name(const SplineScene *scene, YamlFile *file, int pen)
{
    const char *name = scene->pens[pen].name;
    Key at = key("spline.pens[%d]", pen);
    if (!spline_pen_is_name(name)) return yaml_refuse(file, at.text, "the name of a pen is a line of text");
    if (is_cmyk(scene) && pens_ink(name) < 0)
        return yaml_refuse(file, at.text, "the pens of cmyk are cyan, magenta, yellow and black");
    for (int k = 0; is_cmyk(scene) && k < pen; k++)
        if (!strcmp(name, scene->pens[k].name))
            return yaml_refuse(file, at.text, "%s is there twice, and would draw all of its ink twice", name);
    return true;
}

static bool read_pen(const SplineScene *scene, YamlFile *file, const SplinePage *page, const PenScene *from,
                     Key at, SplinePen *pen)
{
    Error err;
    double width = isnan(from->width) ? scene->pen : from->width;
    pen->width = width / page->unit;
    pen->opaque = from->opaque;
    if (pen->width > PEN_MAX || pen->width > PEN_ACROSS * fmin(page->width, page->height))
        return yaml_refuse(file, at.text, "a pen of %g m is too wide for a page of %g x %g m", width,
                           page->paper[0], page->paper[1]);
    if (color_parse(from->color ? from->color : from->name, &pen->color, &err)) return true;
    if (from->color) return yaml_refuse(file, at.text, "%s", err.text);
    if (is(scene, SEPARATE_MATCH))
        return yaml_refuse(file, at.text, "which colour does this pen draw? Its name is none; say `color`");
    pen->color = (Color){0, 0, 0, 1}; /* of a pen whose name is no colour */
    return true;
}

static bool read_paper(const SplineScene *scene, YamlFile *file, Color *paper)
{
    Error err;
    return color_parse(scene->paper ? scene->paper : "white", paper, &err) ||
           yaml_refuse(file, "spline.paper", "%s", err.text);
}

InkSet pens_inks(Color paper, const SplinePen *pens, int count, Ink *coats)
{
    for (int k = 0; k < count; k++) coats[k] = (Ink){ink_linear(pens[k].color), pens[k].opaque};
    return (InkSet){ink_linear(paper), count, coats, 1};
}

static bool is_seen(Color paper, const SplinePen *pen)
{
    Ink coat;
    InkSet set = pens_inks(paper, pen, 1, &coat);
    Vec3 covered = ink_mix(&set, (const double[]){1}), light = vec3_sub(covered, set.paper);
    return ink_difference(covered, set.paper) >= SEEN &&
           fmax(fmax(fabs(light.x), fabs(light.y)), fabs(light.z)) >= GLARE;
}

static bool check_seen(YamlFile *file, Color paper, const SplinePen *pen, Key at)
{
    return is_seen(paper, pen) ||
           yaml_refuse(file, at.text,
                       pen->opaque
                           ? "its ink has the colour of the paper, and is not seen on it; say another `color`"
                           : "its ink is transparent, and not seen on paper of this colour; say `opaque: "
                             "true` of a pen that covers what is below, and its `color`");
}

/* The pen of the contours, if there are any. */
static bool read_contours(const SplineScene *scene, YamlFile *file, const SplinePage *page, Color paper,
                          SplinePen *pen)
{
    const ContoursScene *from = scene->contours;
    Key at = key("spline.contours");
    if (!from) return true;
    PenScene given = {"contours", from->color ? from->color : "black", from->width, .opaque = from->opaque};
    pen->name = mem_text(given.name);
    return read_pen(scene, file, page, &given, at, pen) && check_seen(file, paper, pen, at);
}

bool pens_read(const SplineScene *scene, YamlFile *file, const SplinePage *page, Color *paper,
               SplinePen **pens, int *count)
{
    if (!read_paper(scene, file, paper) || !check_separation(scene, file) || !check_from(scene, file))
        return false;
    bool own = scene->pens_count > 0, ok = true;
    *count = own ? scene->pens_count : is_cmyk(scene) ? INKS : 1;
    *pens = mem_alloc((size_t)*count + 1, sizeof **pens);
    for (int k = 0; k < *count; k++) {
        char *name = (char *)(is_cmyk(scene) ? inks[k].name : "black");
        PenScene given = {.name = name, .width = NAN};
        Key at = own ? key("spline.pens[%d]", k) : key("spline.pen");
        if (own) given = scene->pens[k];
        (*pens)[k].name = mem_text(given.name);
        ok = ok && (!own || check_name(scene, file, k)) &&
             read_pen(scene, file, page, &given, at, &(*pens)[k]) &&
             check_seen(file, *paper, &(*pens)[k], at);
    }
    return ok && read_contours(scene, file, page, *paper, &(*pens)[*count]);
}
