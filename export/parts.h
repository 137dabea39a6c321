/* parts.h - a body as closed volumes that can be printed, one for each level of its magnetisation, or each group.
 *
 * A shell gets its thickness on both sides. Its points move along the normal, the mean of the faces' around them by their
 * angles there, by half of their thickness over the mean cosine between it and theirs, so that faces at a fold keep their
 * thickness (twice as far at most). Walls along the normals close it at its edges, along slits, and between parts, which
 * share them: they touch without gaps. A point where a part touches itself at a corner only is there once for each side.
 *
 * Of a solid a part is the surface of its tetrahedra, four triangles for each side of a quadratic one. Where
 * tetrahedra of a part touch along an edge only, that edge has four triangles. */
#pragma once
#include "base/error.h"
#include "export/bytes.h"
#include "io/colormap.h"
#include "io/result.h"

typedef struct PartsDef {
    int frame; /* -1: at rest, with the final thickness and magnetisation; of a frame its own */
    int levels; /* of |M|, equal steps from the least to the largest; what is not magnetised is a part of its own; 0: none */
    bool groups; /* the named groups, the smallest where there are several; and what is in none */
} PartsDef;

typedef struct Part {
    char *name; /* owned */
    Color color;
    double volume; /* m^3 */
    int point_count, face_count;
    double (*points)[3]; /* m; owned                     */
    int (*faces)[3];     /* normals point outwards; owned */
} Part;

typedef struct Parts {
    int count; /* none of them empty */
    Part *list;
} Parts;

/* Clear them in any case. */
bool parts_make(Result *result, const PartsDef *def, Parts *parts, Error *err);
void parts_clear(Parts *parts);

/* Binary STL of one of them, and 3MF of all as one object, in mm. */
void parts_write_stl(const Part *part, Bytes *file);
bool parts_write_3mf(const Parts *parts, Bytes *file, Error *err);
