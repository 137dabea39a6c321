/* body.h - what a result's body looks like to other programs: triangles or lines that move, and the colours on them. */
#pragma once
#include "export/moments.h"

typedef struct ExportBody {
    const char *name;
    bool lines; /* else triangles */
    int point_count, index_count;
    const int *indices;        /* [index_count] points: three for each triangle, two for each line */
    Vec3 middle;               /* m; the origin, but for what is far away (moments_middle) */
    const float (**x)[3];      /* [moment][point] m, from the middle                  */
    int color_count;           /* 0: plain; 1: the same at all moments; else as many as these */
    const float (**colors)[3]; /* [color_count][point] light, 0..1 */
    const float
        *values; /* [point] the number that the last of its colours stands for; NULL: not everywhere */
    const char *field_name, *field_unit; /* of them                                            */
} ExportBody;

/* The mesh, one point for each vertex and all of its faces that have the same colours; kept in the data. False and a sentence where there is none. */
bool body_of_mesh(ShowData *data, const Moments *moments, ExportBody *body, Error *err);

/* The simulated strands as tubes of twelve sides, as thick as what the world meets, closed by caps; as lines where the result does
 * not say how thick they are (of inversions). */
bool body_of_rods(ShowData *data, const Moments *moments, ExportBody *body, Error *err);
