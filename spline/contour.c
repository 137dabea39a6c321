#include "spline/contour.h"
#include "base/memory.h"
#include "spline/isolines.h"

typedef struct Contour {
    const SplineField *cover;
    const SplinePage *page;
    IsoPiece *pieces;
    int count, room;
    int *nearest;   /* [rows][columns] piece, -1: none yet */
    double *square; /* [rows][columns] of its distance     */
} Contour;

static size_t pixel_index(const SplineField *field, int row, int column)
{
    return (size_t)row * (size_t)field->columns + (size_t)column;
}

static double piece_square(const IsoPiece *piece, Vec2 p)
{
    double dx = piece->b.x - piece->a.x, dy = piece->b.y - piece->a.y;
    double x = p.x - piece->a.x, y = p.y - piece->a.y, length = dx * dx + dy * dy;
    double s = length > 0 ? fmin(fmax((x * dx + y * dy) / length, 0), 1) : 0;
    x -= s * dx, y -= s * dy;
    return x * x + y * y;
}

static void try_piece(Contour *c, int row, int column, int piece)
{
    if (piece < 0) return;
    size_t at = pixel_index(c->cover, row, column);
    double square = piece_square(&c->pieces[piece], spline_field_center(c->cover, c->page, row, column));
    if (c->nearest[at] >= 0 && square >= c->square[at]) return;
    c->square[at] = square;
    c->nearest[at] = piece;
}

static void add_piece(void *self, int row, int column, const IsoPiece *piece)
{
    Contour *c = self;
    if (c->count == c->room) {
        int room = 2 * c->room + 256;
        c->pieces = mem_resize(c->pieces, (size_t)c->room, (size_t)room, sizeof *c->pieces);
        c->room = room;
    }
    c->pieces[c->count] = *piece;
    for (int k = 0; k < 4; k++) try_piece(c, row + k / 2, column + k % 2, c->count);
    c->count++;
}

/* Tries the pieces of neighbours in the row before, and of that one beside. */
static void take_from(Contour *c, int row, int column, int way_down, int way_right)
{
    for (int k = -1; k <= 2; k++) {
        int i = k < 2 ? row - way_down : row, j = k < 2 ? column + k : column - way_right;
        if (i >= 0 && j >= 0 && i < c->cover->rows && j < c->cover->columns)
            try_piece(c, row, column, c->nearest[pixel_index(c->cover, i, j)]);
    }
}

/* All rows, from the top (way 1) or from the bottom (-1), each there and back. */
static void sweep(Contour *c, int way)
{
    int rows = c->cover->rows, columns = c->cover->columns;
    for (int m = 0; m < rows; m++) {
        int row = way > 0 ? m : rows - 1 - m;
        for (int j = 0; j < columns; j++) take_from(c, row, j, way, 1);
        for (int j = columns - 1; j >= 0; j--) take_from(c, row, j, way, -1);
    }
}

SplineField spline_contour_distance(const SplineField *cover, const SplinePage *page)
{
    SplineField distance = spline_field_like(cover, 1);
    size_t count = (size_t)cover->columns * (size_t)cover->rows;
    Contour c = {.cover = cover, .page = page};
    c.nearest = mem_alloc(count, sizeof *c.nearest);
    c.square = mem_alloc(count, sizeof *c.square);
    for (size_t k = 0; k < count; k++) c.nearest[k] = -1;
    isolines_visit(cover, page, 0.5, add_piece, &c);
    sweep(&c, 1);
    sweep(&c, -1);
    for (size_t k = 0; k < count; k++)
        distance.values[k] = (cover->values[k] >= 0.5 ? 1 : -1) * (c.count ? sqrt(c.square[k]) : 1);
    mem_free(c.pieces);
    mem_free(c.nearest);
    mem_free(c.square);
    return distance;
}
