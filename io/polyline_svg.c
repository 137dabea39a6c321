/* SVG drawings: walks the tree of elements (svg_tree.h) and draws what is shown [SVG 1.1]. */
#include "base/memory.h"
#include "io/polyline_reader.h"
#include "io/scan.h"
#include "io/svg_path.h"
#include "io/svg_tree.h"
#include <string.h>

enum { STRAND_STEPS = 512, CUBIC_STEPS = 8, CLONES_MOST = 32, ELEMENTS_MOST = 10000000 };

static const double pixel = 0.0254 / 96; /* m */

/* x' = a x + c y + e, y' = b x + d y + f. */
typedef struct Affine {
    double a, b, c, d, e, f;
} Affine;

/* What holds within an element. */
typedef struct Level {
    Affine map;     /* to metres                                       */
    double view[2]; /* sides of the viewport, in its units: 100 %      */
    bool hidden;    /* by `visibility`, which an element within may end */
    int clones;     /* <use> around it                                 */
} Level;

typedef struct Svg {
    SvgTree tree;
    PolylineReader *reader;
    long drawn; /* elements so far */
    bool said;  /* the error has its place */
} Svg;

static bool draw(Svg *svg, const SvgNode *node, Level level);

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
    } else if (word_is(name, "translateX") && count == 1)
        *map = (Affine){1, 0, 0, 1, v[0], 0};
    else if (word_is(name, "translateY") && count == 1)
        *map = (Affine){1, 0, 0, 1, 0, v[0]};
    else if (word_is(name, "scaleX") && count == 1)
        *map = (Affine){v[0], 0, 0, 1, 0, 0};
    else if (word_is(name, "scaleY") && count == 1)
        *map = (Affine){1, 0, 0, v[0], 0, 0};
    else if (word_is(name, "skewX") && count == 1)
        *map = (Affine){1, 0, tan(radians), 1, 0, 0};
    else if (word_is(name, "skewY") && count == 1)
        *map = (Affine){1, tan(radians), 0, 1, 0, 0};
    else
        return false;
    return true;
}

/* Values in brackets; of a style they may have the units px and deg. */
static int transform_values(const char **at, double values[6])
{
    int count = 0;
    while (count < 6 && svg_numbers(at, &values[count], 1)) {
        count++;
        if (!strncmp(*at, "px", 2)) *at += 2;
        if (!strncmp(*at, "deg", 3)) *at += 3;
        *at += strspn(*at, " \t\r\n,");
    }
    return count;
}

/* A list of functions, the last of which is done first. */
static bool read_transform(const char *text, Affine *map, Error *err)
{
    const char *const blanks = " \t\r\n,";
    const char *at = text + strspn(text, blanks);
    while (*at && strcmp(at, "none")) {
        double values[6] = {0};
        Affine next;
        const char *name = at;
        size_t length = strcspn(at, " \t\r\n("), open = length + strspn(at + length, " \t\r\n");
        bool ok = length > 0 && at[open] == '(';
        at += open + ok;
        int count = ok ? transform_values(&at, values) : 0;
        if (!ok || *at != ')' || !transform_of((Word){name, (int)length}, values, count, &next))
            return error_set(err, "the transform '%.40s' is not understood", name);
        *map = affine_times(*map, next);
        at += 1 + strspn(at + 1, blanks);
    }
    return true;
}

static const struct {
    const char *unit;
    double size; /* m */
} units[] = {{"px", 0.0254 / 96}, {"mm", 1e-3},       {"cm", 1e-2},   {"in", 0.0254},
             {"pt", 0.0254 / 72}, {"pc", 0.0254 / 6}, {"Q", 0.25e-3}, {"", 0.0254 / 96}};

/* Metres; 0 where there is no length, or one that depends on the window. */
static double read_length(const char *text)
{
    double value;
    if (!text || svg_numbers(&text, &value, 1) == 0) return 0;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (!strcmp(text, units[k].unit)) return value * units[k].size;
    return 0;
}

/* An attribute in user units, of which one is a pixel; absent: as it is. whole: 100 %. */
static bool length_of(const Svg *svg, const SvgNode *node, const char *name, double whole, double *value)
{
    const char *text = svg_attribute(node, name), *at = text;
    if (!text) return true;
    if (svg_numbers(&at, value, 1) == 0)
        return error_set(svg->reader->err, "%s of the %s is no number", name, node->name);
    if (!strcmp(at, "%")) {
        *value *= whole / 100;
        return true;
    }
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (!strcmp(at, units[k].unit)) {
            *value *= units[k].size / pixel;
            return true;
        }
    return error_set(svg->reader->err, "%s of the %s is '%.40s': its unit is not read", name, node->name,
                     text);
}

/* The lengths of an element that has them: x, y, .. in turn, of width and height in turn. */
static bool lengths_of(const Svg *svg, const SvgNode *node, const Level *level, const char *const *names,
                       double *values)
{
    bool ok = true;
    for (int i = 0; ok && names[i]; i++) ok = length_of(svg, node, names[i], level->view[i % 2], &values[i]);
    return ok;
}

static bool view_box(const SvgNode *node, double box[4])
{
    const char *text = svg_attribute(node, "viewBox");
    return text && svg_numbers(&text, box, 4) == 4 && box[2] > 0 && box[3] > 0;
}

/* A view box into a viewport at x, y of these sides [7.8]. */
static Affine fit(const SvgNode *node, const double place[4], const double box[4])
{
    const char *how = svg_attribute(node, "preserveAspectRatio");
    if (!how) how = "";
    double scale[2] = {place[2] / box[2], place[3] / box[3]}, shift[2];
    bool slice = strstr(how, "slice") != NULL;
    if (!strstr(how, "none")) {
        bool first = slice ? scale[0] > scale[1] : scale[0] < scale[1];
        scale[0] = scale[1] = scale[first ? 0 : 1];
    }
    const char *const ends[2][2] = {{"xMin", "xMax"}, {"YMin", "YMax"}};
    for (int i = 0; i < 2; i++) {
        double part = strstr(how, ends[i][0]) ? 0 : strstr(how, ends[i][1]) ? 1 : 0.5;
        shift[i] = place[i] + part * (place[2 + i] - scale[i] * box[2 + i]) - scale[i] * box[i];
    }
    return (Affine){scale[0], 0, 0, scale[1], shift[0], shift[1]};
}

/* The outermost svg's units to metres, y up, from the upper left corner of its viewport. A side that is not
 * given goes with the other one; without any, or without a view box, one unit is a pixel. */
static Level page(const SvgNode *node)
{
    double box[4], place[4] = {0, 0, read_length(svg_attribute(node, "width")),
                               read_length(svg_attribute(node, "height"))};
    bool boxed = view_box(node, box);
    Affine map = {pixel, 0, 0, pixel, 0, 0};
    Level level = {.view = {place[2] / pixel, place[3] / pixel}};
    if (boxed) {
        double scale = place[2] > 0 ? place[2] / box[2] : place[3] > 0 ? place[3] / box[3] : pixel;
        for (int i = 2; i < 4; i++)
            if (place[i] <= 0) place[i] = scale * box[i];
        map = fit(node, place, box);
        memcpy(level.view, box + 2, sizeof level.view);
    }
    level.map = affine_times((Affine){1, 0, 0, -1, 0, 0}, map);
    return level;
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
static bool add_strand(Svg *svg, const SvgNode *node, Affine map, const SvgCubic *cubics, int count)
{
    bool straight = true;
    double length = 0;
    for (int k = 0; k < count; k++) {
        straight &= cubics[k].straight;
        length += cubic_length(&cubics[k]);
    }
    polyline_begin(svg->reader, node->line);
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

static bool add_path(Svg *svg, const SvgNode *node, Affine map, const SvgPath *path)
{
    bool ok = true;
    for (int k = 0, next; ok && k < path->count; k = next) {
        for (next = k + 1; next < path->count && !path->cubics[next].starts;) next++;
        ok = add_strand(svg, node, map, path->cubics + k, next - k);
    }
    return ok;
}

/* ---- Shapes ---- */

static bool draw_data(Svg *svg, const SvgNode *node, Affine map, const char *data)
{
    SvgPath path = {0};
    bool ok = svg_path_parse(data, &path, svg->reader->err) && add_path(svg, node, map, &path);
    svg_path_clear(&path);
    return ok;
}

static bool draw_path(Svg *svg, const SvgNode *node, const Level *level)
{
    const char *data = svg_attribute(node, "d");
    return !data || draw_data(svg, node, level->map, data);
}

static bool draw_points(Svg *svg, const SvgNode *node, const Level *level)
{
    const char *points = svg_attribute(node, "points");
    SvgPath path = {0};
    bool ok =
        !points || (svg_path_parse_points(points, !strcmp(node->name, "polygon"), &path, svg->reader->err) &&
                    add_path(svg, node, level->map, &path));
    svg_path_clear(&path);
    return ok;
}

static bool draw_line(Svg *svg, const SvgNode *node, const Level *level)
{
    static const char *const names[] = {"x1", "y1", "x2", "y2", NULL};
    double v[4] = {0};
    if (!lengths_of(svg, node, level, names, v)) return false;
    polyline_begin(svg->reader, node->line);
    return add_place(svg, level->map, (Vec2){v[0], v[1]}) && add_place(svg, level->map, (Vec2){v[2], v[3]});
}

/* From the right, clockwise as it is seen; nothing where a radius is zero. */
static bool draw_ellipse(Svg *svg, const SvgNode *node, const Level *level)
{
    static const char *const names[] = {"cx", "cy", "rx", "ry", NULL};
    double v[4] = {0};
    if (!lengths_of(svg, node, level, names, v)) return false;
    if (!strcmp(node->name, "circle")) {
        if (!length_of(svg, node, "r", hypot(level->view[0], level->view[1]) / sqrt(2), &v[2])) return false;
        v[3] = v[2];
    }
    if (!svg_attribute(node, "rx") && v[3] > 0 && v[2] == 0) v[2] = v[3];
    if (!svg_attribute(node, "ry") && v[2] > 0 && v[3] == 0) v[3] = v[2];
    if (!(v[2] > 0 && v[3] > 0)) return true;
    char *data = mem_format("M%.17g %.17gA%.17g %.17g 0 0 1 %.17g %.17gA%.17g %.17g 0 0 1 %.17g %.17gZ",
                            v[0] + v[2], v[1], v[2], v[3], v[0] - v[2], v[1], v[2], v[3], v[0] + v[2], v[1]);
    bool ok = draw_data(svg, node, level->map, data);
    mem_free(data);
    return ok;
}

/* From the end of the upper left corner; a radius that is not given is the other one. */
static bool draw_rect(Svg *svg, const SvgNode *node, const Level *level)
{
    static const char *const names[] = {"x", "y", "width", "height", "rx", "ry", NULL};
    double v[6] = {0, 0, 0, 0, -1, -1}, x = 0, y = 0;
    if (!lengths_of(svg, node, level, names, v)) return false;
    if (!(v[2] > 0 && v[3] > 0)) return true;
    x = fmin(fmax(v[4] < 0 ? v[5] : v[4], 0), v[2] / 2), y = fmin(fmax(v[5] < 0 ? v[4] : v[5], 0), v[3] / 2);
    double right = v[0] + v[2], low = v[1] + v[3];
    char *data =
        x > 0 && y > 0
            ? mem_format(
                  "M%.17g %.17gH%.17gA%.17g %.17g 0 0 1 %.17g %.17gV%.17gA%.17g %.17g 0 0 1 %.17g %.17g"
                  "H%.17gA%.17g %.17g 0 0 1 %.17g %.17gV%.17gA%.17g %.17g 0 0 1 %.17g %.17gZ",
                  v[0] + x, v[1], right - x, x, y, right, v[1] + y, low - y, x, y, right - x, low, v[0] + x,
                  x, y, v[0], low - y, v[1] + y, x, y, v[0] + x, v[1])
            : mem_format("M%.17g %.17gH%.17gV%.17gH%.17gZ", v[0], v[1], right, low, v[0]);
    bool ok = draw_data(svg, node, level->map, data);
    mem_free(data);
    return ok;
}

/* ---- Elements ---- */

static bool draw_children(Svg *svg, const SvgNode *node, const Level *level)
{
    bool ok = true;
    for (const SvgNode *child = node->first; ok && child; child = child->next) ok = draw(svg, child, *level);
    return ok;
}

static bool draw_group(Svg *svg, const SvgNode *node, const Level *level)
{
    return draw_children(svg, node, level);
}

/* The first alternative that asks for nothing. */
static bool draw_switch(Svg *svg, const SvgNode *node, const Level *level)
{
    for (const SvgNode *child = node->first; child; child = child->next)
        if (!svg_attribute(child, "requiredExtensions") && !svg_attribute(child, "systemLanguage"))
            return draw(svg, child, *level);
    return true;
}

/* An svg within an svg, or a clone of it or of a symbol: sides as `by` says, else its own, else all there is.
 */
static bool draw_viewport(Svg *svg, const SvgNode *node, const SvgNode *by, Level level)
{
    static const char *const places[] = {"x", "y", "width", "height", NULL}, *const sides[] = {
                                                                                 "width", "height", NULL};
    double place[4] = {0, 0, level.view[0], level.view[1]}, box[4];
    if (strcmp(node->name, "symbol") && !lengths_of(svg, node, &level, places, place)) return false;
    if (by && !lengths_of(svg, by, &level, sides, place + 2)) return false;
    if (place[2] <= 0 || place[3] <= 0) place[2] = place[3] = 0;
    bool boxed = view_box(node, box) && place[2] > 0;
    level.map =
        affine_times(level.map, boxed ? fit(node, place, box) : (Affine){1, 0, 0, 1, place[0], place[1]});
    memcpy(level.view, boxed ? box + 2 : place + 2, sizeof level.view);
    return draw_children(svg, node, &level);
}

static bool draw_svg(Svg *svg, const SvgNode *node, const Level *level)
{
    return node->parent ? draw_viewport(svg, node, NULL, *level) : draw_children(svg, node, level);
}

static bool draw_use(Svg *svg, const SvgNode *node, const Level *level)
{
    static const char *const places[] = {"x", "y", NULL};
    const char *link = svg_attribute(node, "href");
    if (!link) link = svg_attribute(node, "xlink:href");
    if (!link) return true;
    const SvgNode *target = *link == '#' ? svg_by_id(&svg->tree, link + 1) : NULL;
    double at[2] = {0};
    if (!target) return error_set(svg->reader->err, "a <use> of '%.60s', which is not in this file", link);
    if (level->clones == CLONES_MOST)
        return error_set(svg->reader->err, "a <use> of itself, or %d deep", CLONES_MOST);
    if (!lengths_of(svg, node, level, places, at)) return false;
    Level here = *level;
    here.clones++;
    here.map = affine_times(here.map, (Affine){1, 0, 0, 1, at[0], at[1]});
    bool viewport = !strcmp(target->name, "symbol") || !strcmp(target->name, "svg");
    return viewport ? draw_viewport(svg, target, node, here) : draw(svg, target, here);
}

static bool refuse_element(Svg *svg, const SvgNode *node, const Level *level)
{
    return level->hidden ||
           error_set(svg->reader->err, "a <%s> is not read: make paths of it, or hide it", node->name);
}

/* All that may be shown; what is not here draws nothing, or only where it is used. */
static const struct {
    const char *name;
    bool (*draw)(Svg *svg, const SvgNode *node, const Level *level);
    bool shape; /* it is not drawn where it is invisible */
} elements[] = {{"svg", draw_svg, false},
                {"g", draw_group, false},
                {"a", draw_group, false},
                {"switch", draw_switch, false},
                {"use", draw_use, false},
                {"path", draw_path, true},
                {"polyline", draw_points, true},
                {"polygon", draw_points, true},
                {"line", draw_line, true},
                {"rect", draw_rect, true},
                {"circle", draw_ellipse, true},
                {"ellipse", draw_ellipse, true},
                {"text", refuse_element, false},
                {"image", refuse_element, false},
                {"foreignObject", refuse_element, false}};

/* What the element's styles do to its level; *shown: is it displayed at all? */
static bool enter(Svg *svg, const SvgNode *node, Level *level, bool *shown)
{
    char *display = svg_property(&svg->tree, node, "display"),
         *visibility = svg_property(&svg->tree, node, "visibility"),
         *transform = svg_property(&svg->tree, node, "transform"),
         *origin = transform ? svg_property(&svg->tree, node, "transform-origin") : NULL;
    *shown = !display || strcmp(display, "none");
    if (visibility && strcmp(visibility, "inherit")) level->hidden = strcmp(visibility, "visible") != 0;
    bool ok = !*shown || !transform || read_transform(transform, &level->map, svg->reader->err);
    if (ok && *shown && origin) ok = error_set(svg->reader->err, "a transform-origin is not read");
    mem_free(display);
    mem_free(visibility);
    mem_free(transform);
    mem_free(origin);
    return ok;
}

/* An element in the level around it; a sentence gets the line of the innermost one. */
static bool draw(Svg *svg, const SvgNode *node, Level level)
{
    PolylineReader *reader = svg->reader;
    bool shown, ok = true;
    for (size_t k = 0; k < sizeof elements / sizeof *elements; k++) {
        if (strcmp(node->name, elements[k].name)) continue;
        if (++svg->drawn > ELEMENTS_MOST)
            error_set(reader->err, "more than %d elements are drawn", ELEMENTS_MOST);
        ok = svg->drawn <= ELEMENTS_MOST && enter(svg, node, &level, &shown);
        if (ok && shown && !(elements[k].shape && level.hidden)) ok = elements[k].draw(svg, node, &level);
    }
    if (!ok && !svg->said) error_prefix(reader->err, "%s:%d", reader->path, node->line);
    svg->said |= !ok;
    return ok;
}

bool polyline_read_svg(PolylineReader *reader, const char *text, size_t length)
{
    Svg svg = {.reader = reader};
    if (!svg_tree_parse(reader->path, text, length, &svg.tree, reader->err)) return false;
    const SvgNode *root = svg.tree.root;
    bool ok = !strcmp(root->name, "svg");
    if (ok)
        ok = draw(&svg, root, page(root));
    else
        error_set(reader->err, "%s:%d: this is no SVG: it begins with '%.40s'", reader->path, root->line,
                  root->name);
    svg_tree_clear(&svg.tree);
    return ok;
}
