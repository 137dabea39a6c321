/* isolines.h - the lines on which a field has a value, linear between the centres of pixels [Lorensen and Cline 1987,
 * in the plane]. */
#pragma once
#include "spline/grid.h"

/* A straight piece, across a square between the centres of four pixels. Its ends lie on sides of such squares: pieces
 * that go on as each other have the number of a side in common, and no more than two have. */
typedef struct IsoPiece {
    Vec2 a, b;
    int side[2]; /* of a, of b */
} IsoPiece;

/* Calls `piece` for each, square by square; (row, column) is the square's upper left pixel. The field has width 1. */
void isolines_visit(const SplineField *field, const SplinePage *page, double value,
                    void (*piece)(void *self, int row, int column, const IsoPiece *piece), void *self);

/* Pieces end to end. */
typedef struct Isolines {
    int count;
    int *first;   /* [count + 1] of its points; a closed line ends where it begins */
    Vec2 *points; /* [first[count]]                                                */
    int *piece;   /* [first[count]] that lies before it; the first point's is -1   */
} Isolines;

/* Some of the pieces that were visited, as lines. The caller clears them. */
Isolines isolines_chain(const IsoPiece *pieces, int count);
void isolines_clear(Isolines *lines);
