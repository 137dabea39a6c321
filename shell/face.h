/* face.h - what membrane and magnetic terms share: the faces in packs, and the gradients of their hat functions. */
#pragma once
#include "base/pack.h"
#include "shell/shell.h"

static inline int face_pack_count(const Shell *shell)
{
    return (shell->mesh->face_count + PACK_LANES - 1) / PACK_LANES;
}

/* The face in a lane of a pack; the last one fills up. */
static inline int face_of_lane(const Shell *shell, int pack, int lane)
{
    int face = pack * PACK_LANES + lane, last = shell->mesh->face_count - 1;
    return face < last ? face : last;
}

/* Nine dofs: the three vertices' positions. */
static inline void face_dofs(const Shell *shell, int face, int *dof)
{
    for (int i = 0; i < 9; i++) dof[i] = 3 * shell->mesh->faces[face][i / 3] + i % 3;
}

/* Rest frame of a face: unit normal, and the in-plane gradients of the three hat functions (1/m). */
typedef struct FaceFrame {
    double normal[3], hat[3][3];
} FaceFrame;

FaceFrame face_frame(const Shell *shell, int face);

/* The same gradients in two axes of the face's rest plane, 1/m. */
void face_gradients(const Shell *shell, int face, double b[3][2]);

/* One parameter per face. */
static inline Pack face_param(const Shell *shell, int pack, const double *values, int width, int component)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = values[face_of_lane(shell, pack, l) * width + component];
    return r;
}
