#include "spline/front/drawing_fields.h"
#include "base/memory.h"
#include "model/build.h"
#include "spline/direction.h"
#include "spline/formula_field.h"
#include "spline/front/drawing_contours.h"
#include "spline/front/drawing_pens.h"
#include "spline/front/drawing_regions.h"
#include "spline/tone_field.h"
#include <math.h>
#include <string.h>

enum {
    SHOWN = 600,    /* pixels of the longer side of what is shown                        */
    STRIP_PENS = 10 /* across a picture, at least, that is alone what is drawn on        */
};

typedef struct Reader {
    const SplineScene *scene;
    Build build;
    SplineToneDef tone;
    double pixel; /* of tones: what the finest pen can draw */
    Image grey;   /* the picture, or nothing                */
    Image rgb[3]; /* its colours, where they are separated  */
} Reader;

static double shown_pixel(const SplinePage *page)
{
    return fmax(page->width, page->height) / SHOWN;
}

static bool refuse(const Reader *r, const char *at, const Error *err)
{
    return yaml_refuse(r->build.file, at, "%s", err->text);
}

/* ---- From formulas ---- */

static Formula *formula_of(const Reader *r, const char *at, char *const *formula, int count,
                           const WhereScene *where, int where_count)
{
    return build_formula(&r->build, key("%s.formula", at), formula, count, where, where_count,
                         spline_formula_variables);
}

/* A field of `width` expressions. */
static bool read_formula(const Reader *r, const char *at, char *const *formula, int width,
                         const WhereScene *where, int where_count, const SplinePage *page, SplineField *field)
{
    Error err;
    Formula *f = formula_of(r, at, formula, width, where, where_count);
    bool ok = f && (spline_field_from_formula(f, page, r->pixel, width, field, &err) || refuse(r, at, &err));
    formula_destroy(f);
    return ok;
}

/* ---- Tones ---- */

static bool read_tone_def(Reader *r)
{
    const ToneScene *from = &r->scene->tone;
    Error err;
    r->tone = spline_tone_default();
    memcpy(r->tone.crop, from->crop, sizeof r->tone.crop);
    r->tone.cover = from->fit == TONE_COVER;
    r->tone.invert = from->invert;
    r->tone.black = from->black, r->tone.white = from->white, r->tone.gamma = from->gamma;
    r->tone.curve = (const double(*)[2])from->curve, r->tone.curve_points = from->curve_count;
    r->tone.density = from->density;
    return spline_tone_check(&r->tone, &err) || refuse(r, "spline.tone", &err);
}

/* As large as its tones and what is shown of it can use. */
static bool read_image(Reader *r, const SplinePage *page)
{
    Error err;
    const char *path = r->scene->image;
    bool coloured = r->scene->separation && r->scene->separation->kind != SEPARATE_TONES;
    double useful[2];
    if (!path) return true;
    spline_tone_useful(page, &r->tone, fmin(r->pixel, shown_pixel(page)), useful);
    return image_read_useful(path, useful, &r->grey, coloured ? r->rgb : NULL, &err) ||
           refuse(r, "spline.image", &err);
}

/* A picture that is shown whole, centred, is all that is drawn on: no stroke leaves it. A strip of fewer pens has no
 * room for lines of its own: they may stick out. */
static void fit_page(Reader *r, SplinePage *page)
{
    const double *c = r->tone.crop, least = STRIP_PENS * page->pen;
    if (!r->grey.grey || r->tone.cover) return;
    double shape = (c[3] - c[1]) * r->grey.height / ((c[2] - c[0]) * r->grey.width);
    *page = spline_page_shaped(page, fmin(fmax(shape, least / page->width), page->height / least));
    r->pixel = spline_tone_pixel(page);
}

/* Of the picture, or of the formula. */
static bool read_tone(const Reader *r, const SplinePage *page, SplineField *tone)
{
    const FieldScene *density = r->scene->density;
    if (!density) return *tone = spline_tone(&r->grey, page, &r->tone, r->pixel), true;
    if (!read_formula(r, "spline.density", (char *const[]){density->formula}, 1, density->where,
                      density->where_count, page, tone))
        return false;
    for (int i = 0; i < tone->columns * tone->rows; i++) tone->values[i] = fmin(fmax(tone->values[i], 0), 1);
    return true;
}

static void separate(const Reader *r, Drawing *d)
{
    Image ink[4];
    spline_separate(r->rgb, r->scene->separation->black, ink);
    for (int k = 0; k < d->pen_count; k++)
        d->tones[k] = spline_tone(&ink[pens_ink(d->pens[k].name)], &d->page, &r->tone, r->pixel);
    for (int c = 0; c < 4; c++) image_clear(&ink[c]);
}

/* What takes away red, green and blue, after the tone's curve. */
static SplineField colours(const Reader *r, const SplinePage *page, SplineToneDef def, double pixel)
{
    SplineField dark = {0};
    def.density = 1;
    for (int c = 0; c < 3; c++) {
        SplineField one = spline_tone(&r->rgb[c], page, &def, pixel);
        if (c == 0) dark = spline_field_like(&one, 3);
        for (int i = 0; i < one.columns * one.rows; i++) dark.values[3 * i + c] = one.values[i];
        spline_field_clear(&one);
    }
    return dark;
}

/* 1 where the picture is, 0 beside it. */
static SplineField picture_cover(const Reader *r, const SplinePage *page, double pixel)
{
    size_t pixels = (size_t)r->grey.width * (size_t)r->grey.height;
    Image black = {r->grey.width, r->grey.height, mem_alloc(pixels, sizeof *black.grey)};
    SplineToneDef def = spline_tone_default();
    memcpy(def.crop, r->tone.crop, sizeof def.crop);
    def.cover = r->tone.cover, def.density = 1;
    SplineField cover = spline_tone(&black, page, &def, pixel);
    image_clear(&black);
    return cover;
}

/* As much of each pen as makes the picture's colours, and these; paper beside it stays blank. */
static void match(const Reader *r, Drawing *d)
{
    Ink inks[INK_MAX];
    InkSet set = pens_inks(d->paper, d->pens, d->pen_count, inks);
    set.most = r->tone.density;
    InkIntent intent = (InkIntent)r->scene->separation->intent;
    SplineToneDef open = r->tone;
    open.extend = true;
    SplineField dark = colours(r, &d->page, open, r->pixel), cover = picture_cover(r, &d->page, r->pixel);
    ink_table_cover(&set, intent, &dark, d->tones);
    for (int k = 0; k < d->pen_count; k++) spline_field_multiply(&d->tones[k], &cover);
    spline_field_clear(&dark);
    spline_field_clear(&cover);
    dark = colours(r, &d->page, open, shown_pixel(&d->page));
    cover = picture_cover(r, &d->page, shown_pixel(&d->page));
    d->light = ink_table_light(&set, intent, &dark);
    spline_field_multiply(&d->light, &cover);
    spline_field_clear(&dark);
    spline_field_clear(&cover);
}

/* What each pen shall cover; `tone` is what all do. */
static void share_tone(const Reader *r, const SplineField *tone, Drawing *d)
{
    d->tones = mem_alloc((size_t)d->pen_count, sizeof *d->tones);
    if (r->rgb[0].grey) {
        (r->scene->separation->kind == SEPARATE_MATCH ? match : separate)(r, d);
        return;
    }
    if (!r->scene->separation) { /* where there are several, each has regions of its own */
        for (int k = 0; k < d->pen_count; k++) d->tones[k] = spline_field_copy(tone);
        return;
    }
    double *limits = pens_limits(r->scene);
    spline_tone_layers(tone, d->pen_count, limits, d->tones);
    mem_free(limits);
}

/* ---- Directions ---- */

/* What a `direction` says, and the field that it becomes. */
typedef struct DirectionReader {
    const Reader *reader;
    const DirectionScene *from;
    const char *at; /* its key */
    const SplinePage *page;
    SplineField *direction;
} DirectionReader;

static bool direction_from_file(const DirectionReader *d)
{
    Image rgb[3];
    Error err;
    if (!image_read_rgb(d->from->file, rgb, &err)) return refuse(d->reader, key("%s.file", d->at).text, &err);
    size_t bytes = (size_t)rgb[0].width * (size_t)rgb[0].height * sizeof(double);
    bool grey = !memcmp(rgb[0].grey, rgb[1].grey, bytes) && !memcmp(rgb[0].grey, rgb[2].grey, bytes);
    *d->direction =
        grey ? spline_direction_from_grey(&rgb[0], d->page) : spline_direction_from_rgb(rgb, d->page);
    for (int c = 0; c < 3; c++) image_clear(&rgb[c]);
    return true;
}

static bool direction_from_formula(const DirectionReader *d)
{
    const DirectionScene *from = d->from;
    Error err;
    Formula *f = formula_of(d->reader, d->at, from->formula, 2, from->where, from->where_count);
    bool ok = f && (spline_direction_from_formula(f, d->page, d->direction, &err) ||
                    refuse(d->reader, key("%s.formula", d->at).text, &err));
    formula_destroy(f);
    return ok;
}

/* A tone that goes on beside the picture, so that its frame is no edge; no finer than `detail` needs it. */
static bool read_open_tone(const Reader *r, const SplinePage *page, double detail, SplineField *tone)
{
    Reader open = *r;
    open.tone.extend = true;
    open.pixel = fmax(open.pixel, detail / 2);
    return read_tone(&open, page, tone);
}

static bool direction_from_tone(const DirectionReader *d)
{
    const DirectionScene *from = d->from;
    SplineDirectionDef def = spline_direction_default(d->page);
    SplineField tone;
    if (!isnan(from->detail)) def.detail = from->detail / d->page->unit;
    if (!isnan(from->smooth)) def.smooth = from->smooth / d->page->unit;
    if (!isnan(from->spread)) def.spread = from->spread / d->page->unit;
    if (!read_open_tone(d->reader, d->page, def.detail, &tone)) return false;
    *d->direction = spline_direction_from_tone(&tone, d->page, &def);
    spline_field_clear(&tone);
    return true;
}

static bool read_direction(const DirectionReader *d)
{
    bool ok = true;
    if (d->from->formula)
        ok = direction_from_formula(d);
    else if (d->from->file)
        ok = direction_from_file(d);
    else if (!isnan(d->from->angle))
        *d->direction = spline_direction_constant(d->page, d->from->angle);
    else
        ok = direction_from_tone(d);
    if (ok && d->from->turn != 0) spline_direction_turn(d->direction, d->from->turn);
    return ok;
}

/* The drawing's, and those of regions that have their own. */
static bool read_directions(const Reader *r, Drawing *d)
{
    const SplineScene *scene = r->scene;
    bool ok =
        read_direction(&(DirectionReader){r, &scene->direction, "spline.direction", &d->page, &d->direction});
    for (int k = 0; ok && k < d->region_count; k++) {
        Key at = key("spline.regions[%d].direction", k);
        ok = !scene->regions[k].direction ||
             read_direction(&(DirectionReader){r, scene->regions[k].direction, at.text, &d->page,
                                               &d->regions[k].direction});
    }
    return ok;
}

static bool read_contours(const Reader *r, Drawing *d)
{
    const ContoursScene *contours = r->scene->contours;
    SplineField tone;
    if (!contours) return true;
    if (!drawing_check_levels(contours, r->build.file)) return false;
    SplineEdgeDef def = drawing_contours_def(d, contours);
    if (!contours->levels_count && contours->kind == CONTOURS_OUTLINES) {
        drawing_find_outlines(d, &def);
        return d->region_count > 0 || yaml_refuse(r->build.file, "spline.contours",
                                                  "outlines are those of `regions`, and there are none");
    }
    if (!read_open_tone(r, &d->page, def.detail, &tone)) return false;
    drawing_find_contours(d, contours, &def, &tone);
    spline_field_clear(&tone);
    return true;
}

/* Of the energies of Linewise. */
static bool read_energy_fields(const Reader *r, Drawing *d)
{
    const FieldScene *potential = r->scene->potential;
    const FlowScene *flow = r->scene->flow;
    if (r->scene->energies.flow > 0 && !flow)
        return yaml_refuse(r->build.file, "spline.energies.flow",
                           "the energy flow needs `spline.flow`, two formulas");
    return (!potential || read_formula(r, "spline.potential", (char *const[]){potential->formula}, 1,
                                       potential->where, potential->where_count, &d->page, &d->potential)) &&
           (!flow || read_formula(r, "spline.flow", flow->formula, 2, flow->where, flow->where_count,
                                  &d->page, &d->flow));
}

/* ---- What is shown beside the drawing ---- */

static void make_picture(const Reader *r, const SplineField *tone, Drawing *d)
{
    double pixel = shown_pixel(&d->page);
    d->picture =
        r->rgb[0].grey ? colours(r, &d->page, r->tone, pixel) : spline_field_resize(tone, &d->page, pixel);
}

bool drawing_read_fields(Drawing *d, const SplineScene *scene, YamlFile *file)
{
    Reader r = {.scene = scene, .build = {.file = file}, .pixel = spline_tone_pixel(&d->page)};
    SplineField tone = {0};
    bool ok = read_tone_def(&r) && read_image(&r, &d->page);
    if (ok) fit_page(&r, &d->page);
    ok = ok && pens_read(scene, file, &d->page, &d->paper, &d->pens, &d->pen_count);
    d->layer_count = d->pen_count + (scene->contours && d->pens);
    ok = ok && read_tone(&r, &d->page, &tone);
    if (ok) {
        share_tone(&r, &tone, d);
        make_picture(&r, &tone, d);
    }
    ok = ok && drawing_read_regions(d, scene, file, &r.tone, r.pixel) && read_directions(&r, d) &&
         read_energy_fields(&r, d) && read_contours(&r, d);
    if (ok && d->region_count) drawing_mask(d, &d->picture);
    if (ok && d->region_count && d->light.columns) drawing_mask(d, &d->light);
    spline_field_clear(&tone);
    image_clear(&r.grey);
    for (int c = 0; c < 3; c++) image_clear(&r.rgb[c]);
    return ok;
}
