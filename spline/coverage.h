/* coverage.h - how much of the page strokes of a round pen cover.
 *
 * A fine raster of at least four pixels per pen width holds how much of each pixel is inked: from the exact
 * distance of its middle to the nearest stroke, as if the edge were straight within the pixel. Where strokes
 * lie on each other they are counted once. The means over its blocks are what comes out. */
#pragma once
#include "spline/page.h"
#include "spline/strokes.h"

typedef struct Coverage {
    int columns, rows;  /* of blocks */
    int block;          /* pixels along a block's side */
    double pixel[2];    /* size of a pixel, in units of the page */
    unsigned char *ink; /* [rows*block][columns*block] 0..255 */
    double *mean;       /* [rows][columns] 0..1 */
} Coverage;

Coverage coverage_create(const SplinePage *page, int columns, int rows);
void coverage_clear(Coverage *coverage);

/* Fills ink and mean. */
void coverage_draw(Coverage *coverage, const Strokes *strokes, double pen);
