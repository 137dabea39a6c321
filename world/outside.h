/* outside.h - how far a body's outside is from its middle where that is not the same everywhere: half a shell's thickness,
 * which its faces have, or a rod's radius, which its elements have. Either are its cells.
 *
 * A part of the body (a vertex, an edge or a face, or the middle of one) has the mean of the cells that it belongs to, by
 * their sizes at rest, wherever on it something touches: nearest points move with kinks, and forces that heeded them would
 * jump. */
#pragma once
#include "world/samples.h"

typedef struct Outside {
    const double *cells; /* [cell] m, as a scene has it; borrowed                 */
    int doubled;         /* first entry in p of twice that; -1: p does not have it */
    int *first;          /* [part + 1] its entries:                               */
    int *cell;
    double *weight; /* those of a part add up to 1                           */
} Outside;

/* Of parts with these corners, each in a cell at least; the cells' corners are those of other samples. Places at rest, m. */
Outside *outside_create(const Samples *parts, const Samples *cells, const double (*rest)[3], int vertex_count,
                        const double *outside, int doubled);
void outside_destroy(Outside *outside);

/* Of a part, m: by p, or by the scene where p is NULL. */
double outside_at(const Outside *outside, int part, const double *p);

/* Its change with dp, and dp += amount times its derivative. */
double outside_change(const Outside *outside, int part, const double *dp);
void outside_back(const Outside *outside, int part, double amount, double *dp);
