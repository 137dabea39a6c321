#include "base/memory.h"
#include "io/polyline_reader.h"
#include "io/scan.h"
#include "io/svg_path.h"
#include <expat.h>
#include <string.h>

enum { STRAND_STEPS = 512, CUBIC_STEPS = 8, CHUNK = 1 << 20 };

static const double pixel = 0.0254 / 96; /* m */

/* x' = a x + c y + e, y' = b x + d y + f. */
typedef struct Affine {
    double a, b, c, d, e, f;
} Affine;

/* What holds within an element. */
typedef struct Level {
    Affine map;  /* to metres              */
    bool hidden; /* not shown, only defined */
} Level;

typedef struct Svg {
    XML_Parser parser;
    PolylineReader *reader;
    Level *levels; /* of the open elements */
    int depth;
    size_t room;
    bool ok;
} Svg;

/* "path:line: " before the sentence that is in err; nothing more is read. */
static void stop(Svg *svg)
{
    error_prefix(svg->reader->err, "%s:%lu", svg->reader->path,
                 (unsigned long)XML_GetCurrentLineNumber(svg->parser));
    svg->ok = false;
    XML_StopParser(svg->parser, XML_FALSE);
}

static const char *attribute(const char **attributes, const char *name)
{
    for (; *attributes; attributes += 2)
        if (!strcmp(attributes[0], name)) return attributes[1];
    return NULL;
}

/* ---- Coordinates ---- */

/* First inner, then outer. */
static Affine affine_times(Affine outer, Affine inner)
{
    return (Affine){
        outer.a * inner.a + outer.c * inner.b,           outer.b * inner.a + outer.d * inner.b,
        outer.a * inner.c + outer.c * inner.d,           outer.b * inner.c + outer.d * inner.d,
        outer.a * inner.e + outer.c * inner.f + outer.e, outer.b * inner.e + outer.d * inner.f + outer.f};
}

static Vec2 affine_at(Affine m, Vec2 p)
{
    return (Vec2){m.a * p.x + m.c * p.y + m.e, m.b * p.x + m.d * p.y + m.f};
}

/* One of the functions of a transform with its numbers; false where it is none. */
static bool transform_of(Word name, const double *v, int count, Affine *map)
{
    double radians = v[0] * M_PI / 180, c = cos(radians), s = sin(radians);
    if (word_is(name, "matrix") && count == 6)
        *map = (Affine){v[0], v[1], v[2], v[3], v[4], v[5]};
    else if (word_is(name, "translate") && (count == 1 || count == 2))
        *map = (Affine){1, 0, 0, 1, v[0], count > 1 ? v[1] : 0};
    else if (word_is(name, "scale") && (count == 1 || count == 2))
        *map = (Affine){v[0], 0, 0, v[count - 1], 0, 0};
    else if (word_is(name, "rotate") && (count == 1 || count == 3)) {
        double x = count > 1 ? v[1] : 0, y = count > 1 ? v[2] : 0;
        *map = (Affine){c, s, -s, c, x - c * x + s * y, y - s * x - c * y};
    } else if (word_is(name, "skewX") && count == 1)
        *map = (Affine){1, 0, tan(radians), 1, 0, 0};
    else if (word_is(name, "skewY") && count == 1)
        *map = (Affine){1, tan(radians), 0, 1, 0, 0};
    else
        return false;
    return true;
}

/* A list of functions, the last of which is done first. */
static bool read_transform(const char *text, Affine *map, Error *err)
{
    const char *const blanks = " \t\r\n,";
    const char *at = text + strspn(text, blanks);
    while (*at) {
        double values[6] = {0};
        Affine next;
        const char *name = at;
        size_t length = strcspn(at, " \t\r\n("), open = length + strspn(at + length, " \t\r\n");
        bool ok = length > 0 && at[open] == '(';
        at += open + ok;
        int count = ok ? svg_numbers(&at, values, 6) : 0;
        if (!ok || *at != ')' || !transform_of((Word){name, (int)length}, values, count, &next))
            return error_set(err, "the transform '%.40s' is not understood", name);
        *map = affine_times(*map, next);
        at += 1 + strspn(at + 1, blanks);
    }
    return true;
}

/* Metres; 0 where there is no length, or one that depends on the window. */
static double read_length(const char *text)
{
    static const struct {
        const char *unit;
        double size;
    } units[] = {{"px", 0.0254 / 96}, {"mm", 1e-3},       {"cm", 1e-2},   {"in", 0.0254},
                 {"pt", 0.0254 / 72}, {"pc", 0.0254 / 6}, {"Q", 0.25e-3}, {"", 0.0254 / 96}};
    double value;
    if (!text || svg_numbers(&text, &value, 1) == 0) return 0;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (!strcmp(text, units[k].unit)) return value * units[k].size;
    return 0;
}

/* The outermost svg's units to metres, y up, from the upper left corner of its view box. */
static Affine page(const char **attributes)
{
    double box[4] = {0}, scale = INFINITY;
    const double size[2] = {read_length(attribute(attributes, "width")),
                            read_length(attribute(attributes, "height"))};
    const char *text = attribute(attributes, "viewBox");
    if (!text || svg_numbers(&text, box, 4) < 4) box[0] = box[1] = box[2] = box[3] = 0;
    for (int i = 0; i < 2; i++)
        if (size[i] > 0 && box[2 + i] > 0) scale = fmin(scale, size[i] / box[2 + i]);
    if (isinf(scale)) scale = pixel;
    return (Affine){scale, 0, 0, -scale, -scale * box[0], scale * box[1]};
}

/* ---- Strands ---- */

static Vec2 cubic_at(const SvgCubic *cubic, double t)
{
    double s = 1 - t, w[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    Vec2 sum = {0, 0};
    for (int k = 0; k < 4; k++) sum.x += w[k] * cubic->at[k].x, sum.y += w[k] * cubic->at[k].y;
    return sum;
}

/* Of its control polygon. */
static double cubic_length(const SvgCubic *cubic)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += hypot(cubic->at[k + 1].x - cubic->at[k].x, cubic->at[k + 1].y - cubic->at[k].y);
    return sum;
}

static bool add_place(Svg *svg, Affine map, Vec2 p)
{
    Vec2 x = affine_at(map, p);
    if (!isfinite(x.x) || !isfinite(x.y)) return error_set(svg->reader->err, "a path leaves all bounds");
    return polyline_add(svg->reader, vec3(x.x, x.y, 0));
}

/* One subpath. */
static bool add_strand(Svg *svg, Affine map, const SvgCubic *cubics, int count)
{
    bool straight = true;
    double length = 0;
    for (int k = 0; k < count; k++) {
        straight &= cubics[k].straight;
        length += cubic_length(&cubics[k]);
    }
    polyline_begin(svg->reader, 0);
    bool ok = add_place(svg, map, cubics[0].at[0]);
    for (int k = 0; ok && k < count; k++) {
        double part = length > 0 && isfinite(length) ? cubic_length(&cubics[k]) / length : 0;
        int least = cubics[k].straight ? 1 : CUBIC_STEPS,
            steps = straight ? 1 : (int)ceil(STRAND_STEPS * part);
        if (steps < least) steps = least;
        for (int i = 1; ok && i <= steps; i++)
            ok = add_place(svg, map, i < steps ? cubic_at(&cubics[k], (double)i / steps) : cubics[k].at[3]);
    }
    return ok;
}

static bool add_path(Svg *svg, Affine map, const SvgPath *path)
{
    bool ok = true;
    for (int k = 0, next; ok && k < path->count; k = next) {
        for (next = k + 1; next < path->count && !path->cubics[next].starts;) next++;
        ok = add_strand(svg, map, path->cubics + k, next - k);
    }
    return ok;
}

/* ---- Elements ---- */

static bool add_line(Svg *svg, Affine map, const char **attributes)
{
    static const char *const names[] = {"x1", "y1", "x2", "y2"};
    double v[4] = {0};
    for (int i = 0; i < 4; i++) {
        const char *text = attribute(attributes, names[i]);
        if (text && svg_numbers(&text, &v[i], 1) == 0)
            return error_set(svg->reader->err, "%s of the line is no number", names[i]);
    }
    polyline_begin(svg->reader, 0);
    return add_place(svg, map, (Vec2){v[0], v[1]}) && add_place(svg, map, (Vec2){v[2], v[3]});
}

static bool read_shape(Svg *svg, const char *name, const char **attributes, Affine map)
{
    Error *err = svg->reader->err;
    const char *data = attribute(attributes, "d"), *points = attribute(attributes, "points");
    bool closed = !strcmp(name, "polygon"), ok = true;
    SvgPath path = {0};
    if (!strcmp(name, "path") && data)
        ok = svg_path_parse(data, &path, err);
    else if ((closed || !strcmp(name, "polyline")) && points)
        ok = svg_path_parse_points(points, closed, &path, err);
    else if (!strcmp(name, "line"))
        ok = add_line(svg, map, attributes);
    ok = ok && add_path(svg, map, &path);
    svg_path_clear(&path);
    return ok;
}

static bool is_hidden(const char *name, const char **attributes)
{
    static const char *const definitions[] = {"defs", "symbol", "clipPath", "mask", "marker", "pattern"};
    for (size_t k = 0; k < sizeof definitions / sizeof *definitions; k++)
        if (!strcmp(name, definitions[k])) return true;
    const char *display = attribute(attributes, "display"), *style = attribute(attributes, "style");
    return (display && !strcmp(display, "none")) ||
           (style && (strstr(style, "display:none") || strstr(style, "display: none")));
}

/* The element's level and what it draws. */
static bool read_element(Svg *svg, const char *name, const char **attributes, Level *level)
{
    Error *err = svg->reader->err;
    if (svg->depth > 0)
        *level = svg->levels[svg->depth - 1];
    else if (!strcmp(name, "svg"))
        *level = (Level){.map = page(attributes)};
    else
        return error_set(err, "this is no SVG: it begins with '%.40s'", name);
    const char *transform = attribute(attributes, "transform");
    if (transform && !read_transform(transform, &level->map, err)) return false;
    level->hidden |= is_hidden(name, attributes);
    return level->hidden || read_shape(svg, name, attributes, level->map);
}

static void begin_element(void *self, const char *name, const char **attributes)
{
    Svg *svg = self;
    Level level;
    if (!svg->ok) return;
    if (!strncmp(name, "svg:", 4)) name += 4;
    if (!read_element(svg, name, attributes, &level)) {
        stop(svg);
        return;
    }
    size_t depth = (size_t)svg->depth;
    if (depth == svg->room) {
        svg->room = 2 * depth + 16;
        svg->levels = mem_resize(svg->levels, depth, svg->room, sizeof *svg->levels);
    }
    svg->levels[svg->depth++] = level;
}

static void end_element(void *self, const char *name)
{
    (void)name;
    ((Svg *)self)->depth--;
}

bool polyline_read_svg(PolylineReader *reader, const char *text, size_t length)
{
    Svg svg = {.parser = XML_ParserCreate(NULL), .reader = reader, .ok = true};
    enum XML_Status status = XML_STATUS_OK;
    if (!svg.parser) return error_set(reader->err, "%s: no memory is left to read it", reader->path);
    XML_SetUserData(svg.parser, &svg);
    XML_SetElementHandler(svg.parser, begin_element, end_element);
    for (size_t at = 0; status == XML_STATUS_OK && at <= length; at += CHUNK) {
        size_t left = length - at, part = left < CHUNK ? left : CHUNK;
        status = XML_Parse(svg.parser, text + at, (int)part, left <= CHUNK);
        if (left <= CHUNK) break;
    }
    if (svg.ok && status != XML_STATUS_OK) {
        error_set(reader->err, "%s", XML_ErrorString(XML_GetErrorCode(svg.parser)));
        stop(&svg);
    }
    XML_ParserFree(svg.parser);
    mem_free(svg.levels);
    return svg.ok;
}
