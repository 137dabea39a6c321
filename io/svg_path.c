#include "io/svg_path.h"
#include "base/memory.h"
#include "io/scan.h"
#include <string.h>

static const double eighth = M_PI / 8; /* the longest piece of an arc, rad */

typedef struct Pen {
    SvgPath *path;
    Vec2 at, start; /* here; where the subpath began                                */
    Vec2 control;   /* the last one, which S and T mirror; `at` after anything else */
    bool down;      /* a subpath has begun                                          */
} Pen;

/* ---- Drawing ---- */

static Vec2 between(Vec2 a, Vec2 b, double part)
{
    return (Vec2){a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
}

static void add_cubic(Pen *pen, Vec2 control1, Vec2 control2, Vec2 end, bool straight)
{
    SvgPath *path = pen->path;
    size_t count = (size_t)path->count;
    if (count == path->room) {
        path->room = 2 * count + 16;
        path->cubics = mem_resize(path->cubics, count, path->room, sizeof *path->cubics);
    }
    path->cubics[path->count++] = (SvgCubic){{pen->at, control1, control2, end}, !pen->down, straight};
    pen->down = true;
    pen->at = pen->control = end;
}

static void line_to(Pen *pen, Vec2 end)
{
    add_cubic(pen, between(pen->at, end, 1. / 3), between(pen->at, end, 2. / 3), end, true);
}

static void quadratic_to(Pen *pen, Vec2 control, Vec2 end)
{
    add_cubic(pen, between(pen->at, control, 2. / 3), between(end, control, 2. / 3), end, false);
    pen->control = control;
}

static void cubic_to(Pen *pen, Vec2 control1, Vec2 control2, Vec2 end)
{
    add_cubic(pen, control1, control2, end, false);
    pen->control = control2;
}

static void move_to(Pen *pen, Vec2 place)
{
    pen->at = pen->start = pen->control = place;
    pen->down = false;
}

static void close_path(Pen *pen)
{
    if (pen->down && (pen->at.x != pen->start.x || pen->at.y != pen->start.y)) line_to(pen, pen->start);
    move_to(pen, pen->start);
}

/* An ellipse as centre + cos(angle) axis[0] + sin(angle) axis[1]. */
typedef struct Ellipse {
    Vec2 centre, axis[2];
} Ellipse;

static Vec2 ellipse_at(const Ellipse *e, double c, double s)
{
    return (Vec2){e->centre.x + c * e->axis[0].x + s * e->axis[1].x,
                  e->centre.y + c * e->axis[0].y + s * e->axis[1].y};
}

static void draw_arc(Pen *pen, const Ellipse *e, double from, double sweep, Vec2 end)
{
    int pieces = fabs(sweep) > eighth && fabs(sweep) < 7 ? (int)ceil(fabs(sweep) / eighth) : 1;
    double step = sweep / pieces, reach = 4. / 3 * tan(step / 4);
    for (int k = 0; k < pieces; k++) {
        double a = from + k * step, b = a + step;
        add_cubic(pen, ellipse_at(e, cos(a) - reach * sin(a), sin(a) + reach * cos(a)),
                  ellipse_at(e, cos(b) + reach * sin(b), sin(b) - reach * cos(b)),
                  k + 1 < pieces ? ellipse_at(e, cos(b), sin(b)) : end, false);
    }
}

/* Values of the A command without its end: radii, turn of the first one in degrees, long way, positive
 * angles. The ellipse's centre is found where the ellipse is the unit circle. [F.6.5, F.6.6] */
static void arc_to(Pen *pen, const double *v, Vec2 end)
{
    double rx = fabs(v[0]), ry = fabs(v[1]), c = cos(v[2] * M_PI / 180), s = sin(v[2] * M_PI / 180);
    double dx = (pen->at.x - end.x) / 2, dy = (pen->at.y - end.y) / 2;
    if (dx == 0 && dy == 0) return;
    if (rx == 0 || ry == 0) {
        line_to(pen, end);
        return;
    }
    double x = (c * dx + s * dy) / rx, y = (c * dy - s * dx) / ry, half2 = x * x + y * y;
    if (half2 > 1) rx *= sqrt(half2), ry *= sqrt(half2), x /= sqrt(half2), y /= sqrt(half2), half2 = 1;
    double away = sqrt((1 - half2) / half2) * (v[3] != v[4] ? 1 : -1);
    double cx = away * y, cy = -away * x, from = atan2(y - cy, x - cx),
           sweep = atan2(-y - cy, -x - cx) - from;
    if (v[4] && sweep < 0) sweep += 2 * M_PI;
    if (!v[4] && sweep > 0) sweep -= 2 * M_PI;
    Ellipse e = {.centre = between(pen->at, end, 0.5), .axis = {{rx * c, rx * s}, {-ry * s, ry * c}}};
    e.centre = ellipse_at(&e, cx, cy);
    draw_arc(pen, &e, from, sweep, end);
}

/* ---- Reading ---- */

static bool blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
}

static void skip_blanks(const char **at)
{
    while (blank(**at)) ++*at;
}

static void skip_comma(const char **at)
{
    skip_blanks(at);
    if (**at == ',') ++*at;
    skip_blanks(at);
}

static const char *skip_digits(const char *at)
{
    while (*at >= '0' && *at <= '9') at++;
    return at;
}

/* Numbers may follow each other without a blank: 1-2 and .5.5 are two each. */
static bool number(const char **at, double *value)
{
    const char *end = *at + (**at == '+' || **at == '-');
    end = skip_digits(end);
    if (*end == '.') end = skip_digits(end + 1);
    if (*end == 'e' || *end == 'E') {
        const char *power = end + 1 + (end[1] == '+' || end[1] == '-'), *stop = skip_digits(power);
        if (stop > power) end = stop;
    }
    long length = end - *at;
    if (length > 60 || !word_number((Word){*at, (int)length}, value)) return false;
    *at = end;
    return true;
}

int svg_numbers(const char **at, double *values, int most)
{
    int count = 0;
    skip_blanks(at);
    while (count < most && number(at, &values[count])) {
        count++;
        skip_comma(at);
    }
    return count;
}

/* The seven values of an arc, of which two are a single digit. */
static int arc_numbers(const char **at, double *values)
{
    int count = svg_numbers(at, values, 3);
    while (count >= 3 && count < 5 && (**at == '0' || **at == '1')) {
        values[count++] = *(*at)++ - '0';
        skip_comma(at);
    }
    return count < 5 ? count : count + svg_numbers(at, values + 5, 2);
}

static int values_of(char command)
{
    static const char commands[] = "MLHVCSQTAZ";
    static const int counts[] = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};
    const char *found = strchr(commands, command);
    return found && command ? counts[found - commands] : -1;
}

static void draw(Pen *pen, char command, const double *v, Vec2 from)
{
    Vec2 p[3] = {{0, 0}};
    for (int k = 0; k < 3 && 2 * k + 1 < values_of(command); k++)
        p[k] = (Vec2){v[2 * k] + from.x, v[2 * k + 1] + from.y};
    Vec2 mirrored = between(pen->control, pen->at, 2);
    switch (command) {
    case 'M':
        move_to(pen, p[0]);
        break;
    case 'L':
        line_to(pen, p[0]);
        break;
    case 'H':
        line_to(pen, (Vec2){v[0] + from.x, pen->at.y});
        break;
    case 'V':
        line_to(pen, (Vec2){pen->at.x, v[0] + from.y});
        break;
    case 'C':
        cubic_to(pen, p[0], p[1], p[2]);
        break;
    case 'S':
        cubic_to(pen, mirrored, p[0], p[1]);
        break;
    case 'Q':
        quadratic_to(pen, p[0], p[1]);
        break;
    case 'T':
        quadratic_to(pen, mirrored, p[0]);
        break;
    case 'A':
        arc_to(pen, v, (Vec2){v[5] + from.x, v[6] + from.y});
        break;
    default:
        close_path(pen);
    }
}

static bool refuse(Error *err, const char *data, const char *at)
{
    if (!*at) return error_set(err, "the path's data ends too early");
    return error_set(err, "the path's data is wrong at character %td, '%.12s'", at - data + 1, at);
}

bool svg_path_parse(const char *data, SvgPath *path, Error *err)
{
    Pen pen = {.path = path};
    const char *at = data;
    char command = 0, last = 0;
    for (skip_blanks(&at); *at; skip_comma(&at)) {
        bool letter = (*at | 32) >= 'a' && (*at | 32) <= 'z';
        const char *here = at;
        if (letter)
            command = *at++;
        else if (command == 'M' || command == 'm') /* further pairs are lines */
            command += 'L' - 'M';
        char kind = command & ~32;
        double v[7];
        int needed = values_of(kind);
        if (needed < 0 || (!letter && needed == 0) || (!last && kind != 'M')) return refuse(err, data, here);
        int got = kind == 'A' ? arc_numbers(&at, v) : svg_numbers(&at, v, needed);
        if (got < needed) return refuse(err, data, at);
        /* A control is mirrored only by its own kind of curve. */
        bool follows = kind == 'S' ? strchr("CS", last) != NULL : kind == 'T' && strchr("QT", last);
        if (!follows) pen.control = pen.at;
        draw(&pen, kind, v, command == kind ? (Vec2){0, 0} : pen.at);
        last = kind;
    }
    return true;
}

bool svg_path_parse_points(const char *points, bool closed, SvgPath *path, Error *err)
{
    Pen pen = {.path = path};
    const char *at = points;
    double v[2];
    for (int k = 0, got; (got = svg_numbers(&at, v, 2)) > 0; k++) {
        if (got < 2) return error_set(err, "the points have an x without a y");
        Vec2 place = {v[0], v[1]};
        if (k == 0)
            move_to(&pen, place);
        else
            line_to(&pen, place);
    }
    if (*at) return error_set(err, "the points are wrong at character %td, '%.12s'", at - points + 1, at);
    if (closed) close_path(&pen);
    return true;
}

void svg_path_clear(SvgPath *path)
{
    mem_free(path->cubics);
    *path = (SvgPath){0};
}
