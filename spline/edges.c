#include "spline/edges.h"
#include "base/memory.h"
#include "spline/along.h"
#include "spline/isolines.h"
#include <math.h>
#include <stdbool.h>

enum { PER_DETAIL = 3 }; /* pixels: a slope between them is told to a hundredth */

/* What is looked at, and the pieces of lines that are kept. */
typedef struct Search {
    const SplinePage *page;
    const SplineEdgeDef *def;
    SplineField tone;   /* blurred                                                   */
    SplineField slope;  /* width 2: its gradient; no columns: equal tones are sought */
    SplineField second; /* |grad D|^2 D_gg                                           */
    double per_slope;   /* the height of a step, over its slope                      */
    IsoPiece *pieces;
    double *height;
    int count, room;
} Search;

static SplineField looked_at(const SplineField *tone, const SplinePage *page, double detail)
{
    SplineField field = spline_field_resize(tone, page, detail / PER_DETAIL);
    spline_field_blur(&field, page, detail);
    return field;
}

/* ---- Derivatives ---- */

/* By central differences; nothing at the outermost pixels. */
static void differentiate(Search *s)
{
    int columns = s->tone.columns, rows = s->tone.rows;
    double x = columns / s->page->width, y = rows / s->page->height; /* pixels in a unit */
    s->slope = spline_field_like(&s->tone, 2);
    s->second = spline_field_like(&s->tone, 1);
    for (int i = 1; i + 1 < rows; i++)
        for (int j = 1; j + 1 < columns; j++) {
            const double *d = spline_field_pixel(&s->tone, i, j), *up = d - columns, *down = d + columns;
            double *g = spline_field_pixel(&s->slope, i, j);
            g[0] = x * (d[1] - d[-1]) / 2, g[1] = y * (down[0] - up[0]) / 2;
            double xx = x * x * (d[1] - 2 * d[0] + d[-1]), yy = y * y * (down[0] - 2 * d[0] + up[0]);
            double xy = x * y * (down[1] - down[-1] - up[1] + up[-1]) / 4;
            *spline_field_pixel(&s->second, i, j) =
                g[0] * g[0] * xx + 2 * g[0] * g[1] * xy + g[1] * g[1] * yy;
        }
}

/* A unit step, blurred by the Gaussian and the pixels, has this slope as differences see it. */
static double height_per_slope(const Search *s)
{
    double h = s->page->width / s->tone.columns, sigma = sqrt(s->def->detail * s->def->detail + h * h / 12);
    return 2 * h / erf(h / (sqrt(2) * sigma));
}

/* Of an edge in that square; 0 where the gradient is least instead, or nothing is known. */
static double edge_height(const Search *s, int row, int column, const IsoPiece *piece)
{
    double slope[2];
    if (row < 1 || column < 1 || row + 2 >= s->tone.rows || column + 2 >= s->tone.columns) return 0;
    SplineGrid grid = spline_grid(&s->slope);
    Vec2 middle = {(piece->a.x + piece->b.x) / 2, (piece->a.y + piece->b.y) / 2};
    spline_grid_sample(&grid, s->page, middle, slope);
    const double *up = spline_field_pixel(&s->second, row, column), *down = up + s->second.columns;
    double right = up[1] - up[0] + down[1] - down[0], below = down[0] - up[0] + down[1] - up[1];
    return right * slope[0] + below * slope[1] < 0 ? s->per_slope * hypot(slope[0], slope[1]) : 0;
}

/* ---- Lines ---- */

static bool has_room(const Search *s, Vec2 p)
{
    const SplinePage *page = s->page;
    double margin = s->def->margin, depth;
    if (fmin(fmin(p.x, page->width - p.x), fmin(p.y, page->height - p.y)) < margin) return false;
    if (!s->def->outline.columns) return true;
    spline_grid_sample(&s->def->outline, page, p, &depth);
    return depth >= margin;
}

static void take_piece(void *self, int row, int column, const IsoPiece *piece)
{
    Search *s = self;
    double height = s->slope.columns ? edge_height(s, row, column, piece) : s->def->contrast;
    if (height < s->def->contrast / 2 || !has_room(s, piece->a) || !has_room(s, piece->b)) return;
    if (s->count == s->room) {
        size_t room = 2 * (size_t)s->room + 256;
        s->pieces = mem_resize(s->pieces, (size_t)s->room, room, sizeof *s->pieces);
        s->height = mem_resize(s->height, (size_t)s->room, room, sizeof *s->height);
        s->room = (int)room;
    }
    s->pieces[s->count] = *piece;
    s->height[s->count++] = height;
}

/* Long enough, and high enough somewhere. */
static bool is_kept(const Search *s, const Isolines *lines, int line)
{
    double length = 0, highest = 0;
    for (int k = lines->first[line] + 1; k < lines->first[line + 1]; k++) {
        length +=
            hypot(lines->points[k].x - lines->points[k - 1].x, lines->points[k].y - lines->points[k - 1].y);
        highest = fmax(highest, s->height[lines->piece[k]]);
    }
    return length >= s->def->shortest && highest >= s->def->contrast;
}

static void add_strokes(const Search *s, int layer, Strokes *strokes)
{
    Isolines lines = isolines_chain(s->pieces, s->count);
    for (int k = 0; k < lines.count; k++)
        if (is_kept(s, &lines, k))
            strokes_along(lines.points + lines.first[k], lines.first[k + 1] - lines.first[k], s->def->segment,
                          layer, strokes);
    isolines_clear(&lines);
}

static void search_clear(Search *s)
{
    spline_field_clear(&s->tone);
    spline_field_clear(&s->slope);
    spline_field_clear(&s->second);
    mem_free(s->pieces);
    mem_free(s->height);
}

void spline_edge_strokes(const SplineField *tone, const SplinePage *page, const SplineEdgeDef *def, int layer,
                         Strokes *strokes)
{
    Search s = {.page = page, .def = def, .tone = looked_at(tone, page, def->detail)};
    differentiate(&s);
    s.per_slope = height_per_slope(&s);
    isolines_visit(&s.second, page, 0, take_piece, &s);
    add_strokes(&s, layer, strokes);
    search_clear(&s);
}

void spline_level_strokes(const SplineField *field, const SplinePage *page, const SplineEdgeDef *def,
                          double level, int layer, Strokes *strokes)
{
    Search s = {.page = page, .def = def, .tone = looked_at(field, page, def->detail)};
    isolines_visit(&s.tone, page, level, take_piece, &s);
    add_strokes(&s, layer, strokes);
    search_clear(&s);
}
