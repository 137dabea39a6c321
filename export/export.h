/* export.h - results as files for other programs. Each writer makes the inside of a file; who asked for it writes it.
 *
 * What a writer cannot make of a result is false and a sentence. Lengths are metres, but for what is printed: millimetres. */
#pragma once
#include "base/error.h"
#include "export/bytes.h"
#include "io/result.h"

typedef struct ExportDef {
    const char *field; /* the colours, as a picture's (view/show.h); NULL: what tells most */
    int frame;         /* -1: all of them, or the final state                              */
    int frames;        /* at most so many of a motion                                      */
} ExportDef;

enum { EXPORT_FRAMES = 60 }; /* the usual number of them */

/* glTF 2.0, binary: the mesh in the colours of a field, or rods as tubes, with its frames as morph targets and an animation
 * of them: seconds of a motion, of other frames one second each. Obstacles and sources are nodes that move with it. z is up
 * in the world: a node above all turns it to glTF's y. */
bool export_glb(Result *result, const ExportDef *def, Bytes *file, Error *err);

/* PLY 1.0, binary: the mesh at a frame (-1: the final state), with the frame's numbers on points and faces. */
bool export_ply(Result *result, int frame, Bytes *file, Error *err);

/* CSV: a row for each named group of faces or tetrahedra that is magnetised, and one for what is in none: what stands at the
 * magnetiser. The mean magnetisation, and thickness and modulus where a design has looked for them or they vary. */
bool export_groups(Result *result, Bytes *file, Error *err);

/* NumPy's .npz: every dataset of /slender by its path, and the frames of /VTKHDF with a dimension of time. */
bool export_npz(Result *result, Bytes *file, Error *err);
