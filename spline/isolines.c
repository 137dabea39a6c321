#include "spline/isolines.h"
#include "base/memory.h"
#include <stdbool.h>
#include <stdlib.h>

/* ---- Pieces ---- */

/* The corners of a square in turn: to the right, down, to the left, up. */
static const int around[5][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}};

/* The number of a square's k-th side: its upper or left pixel, and which way it goes from there. */
static int side_number(const SplineField *field, int row, int column, int k)
{
    int i = row + (k == 2), j = column + (k == 1);
    return 2 * (i * field->columns + j) + k % 2;
}

static Vec2 cut_side(const SplineField *field, const SplinePage *page, const int from[2], const int to[2],
                     double s)
{
    Vec2 a = spline_field_center(field, page, from[0], from[1]),
         b = spline_field_center(field, page, to[0], to[1]);
    return (Vec2){a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
}

/* A line comes in and leaves once or twice around a square. Returns how many pieces. */
static int cut_square(const SplineField *field, const SplinePage *page, double value, int row, int column,
                      IsoPiece pieces[2])
{
    Vec2 cuts[4];
    int sides[4], count = 0;
    for (int k = 0; k < 4; k++) {
        int from[2] = {row + around[k][0], column + around[k][1]},
            to[2] = {row + around[k + 1][0], column + around[k + 1][1]};
        double a = *spline_field_pixel(field, from[0], from[1]) - value,
               b = *spline_field_pixel(field, to[0], to[1]) - value;
        if ((a >= 0) == (b >= 0)) continue;
        sides[count] = side_number(field, row, column, k);
        cuts[count++] = cut_side(field, page, from, to, a / (a - b));
    }
    for (int k = 0; k + 1 < count; k += 2)
        pieces[k / 2] = (IsoPiece){cuts[k], cuts[k + 1], {sides[k], sides[k + 1]}};
    return count / 2;
}

void isolines_visit(const SplineField *field, const SplinePage *page, double value,
                    void (*piece)(void *self, int row, int column, const IsoPiece *piece), void *self)
{
    for (int i = 0; i + 1 < field->rows; i++)
        for (int j = 0; j + 1 < field->columns; j++) {
            IsoPiece pieces[2];
            int count = cut_square(field, page, value, i, j, pieces);
            for (int k = 0; k < count; k++) piece(self, i, j, &pieces[k]);
        }
}

/* ---- Lines ---- */

/* End 2k is a of piece k, end 2k + 1 its b. */
typedef struct End {
    int side, end;
} End;

static int by_side(const void *a, const void *b)
{
    const End *x = a, *y = b;
    if (x->side != y->side) return x->side < y->side ? -1 : 1;
    return (x->end > y->end) - (x->end < y->end);
}

/* [2 count] of each end the one on the same side; -1: none. */
static int *find_partners(const IsoPiece *pieces, int count)
{
    End *ends = mem_alloc(2 * (size_t)count, sizeof *ends);
    int *partner = mem_alloc(2 * (size_t)count, sizeof *partner);
    for (int k = 0; k < 2 * count; k++) ends[k] = (End){pieces[k / 2].side[k % 2], k}, partner[k] = -1;
    qsort(ends, 2 * (size_t)count, sizeof *ends, by_side);
    for (int k = 0; k + 1 < 2 * count; k++) {
        if (ends[k].side != ends[k + 1].side) continue;
        partner[ends[k].end] = ends[k + 1].end;
        partner[ends[k + 1].end] = ends[k].end;
    }
    mem_free(ends);
    return partner;
}

typedef struct Chaining {
    const IsoPiece *pieces;
    const int *partner;
    bool *taken; /* pieces */
    Isolines lines;
} Chaining;

static Vec2 end_place(const Chaining *c, int end)
{
    const IsoPiece *piece = &c->pieces[end / 2];
    return end % 2 ? piece->b : piece->a;
}

static void add_point(Isolines *lines, Vec2 at, int piece)
{
    int point = lines->first[lines->count]++;
    lines->points[point] = at;
    lines->piece[point] = piece;
}

/* From an end of a piece that nothing has taken on to where the line ends, or comes back. */
static void follow(Chaining *c, int end)
{
    Isolines *lines = &c->lines;
    lines->count++;
    lines->first[lines->count] = lines->first[lines->count - 1];
    add_point(lines, end_place(c, end), -1);
    while (end >= 0 && !c->taken[end / 2]) {
        c->taken[end / 2] = true;
        add_point(lines, end_place(c, end ^ 1), end / 2);
        end = c->partner[end ^ 1];
    }
}

Isolines isolines_chain(const IsoPiece *pieces, int count)
{
    int *partner = find_partners(pieces, count);
    Chaining c = {.pieces = pieces, .partner = partner, .taken = mem_alloc((size_t)count, sizeof *c.taken)};
    c.lines.first = mem_alloc((size_t)count + 1, sizeof *c.lines.first);
    c.lines.points = mem_alloc(2 * (size_t)count, sizeof *c.lines.points);
    c.lines.piece = mem_alloc(2 * (size_t)count, sizeof *c.lines.piece);
    for (int k = 0; k < 2 * count; k++) /* those that end somewhere */
        if (partner[k] < 0 && !c.taken[k / 2]) follow(&c, k);
    for (int k = 0; k < count; k++)
        if (!c.taken[k]) follow(&c, 2 * k);
    mem_free(partner);
    mem_free(c.taken);
    return c.lines;
}

void isolines_clear(Isolines *lines)
{
    mem_free(lines->first);
    mem_free(lines->points);
    mem_free(lines->piece);
    *lines = (Isolines){0};
}
