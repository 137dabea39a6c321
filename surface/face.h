/* face.h - what terms over triangles share: faces in packs, and the gradients of their hat functions. A face is the
 * numbers of its three vertices, which number places (rest[vertex]) and dofs (3*vertex + axis). */
#pragma once
#include "base/pack.h"
#include "surface/mesh.h"

/* Nine dofs: the three vertices' positions. */
static inline void face_dofs(const int *face, int *dof)
{
    for (int i = 0; i < 9; i++) dof[i] = 3 * face[i / 3] + i % 3;
}

/* Rest frame of a face: unit normal, and the in-plane gradients of the three hat functions (1/m). */
typedef struct FaceFrame {
    double normal[3], hat[3][3];
} FaceFrame;

FaceFrame face_frame(double (*rest)[3], const int *face);

/* The same gradients in two axes of the face's rest plane, 1/m. */
void face_gradients(double (*rest)[3], const int *face, double b[3][2]);

/* Faces that bear a layer of material: a shell's own, the skin of a solid. Its vertices may be some of a body's. */
typedef struct FaceLayer {
    int count;
    int (*faces)[3];   /* [face] vertices, whichever way round; owned                           */
    int *rows;         /* [face] its row in blocks of parameters; owned                         */
    double *volume;    /* [face] m^3 at rest: area by thickness; of thicknesses in p m^2; owned */
    int thickness;     /* first entry in p of [row] m; -1: it is in the volume                  */
    double (*rest)[3]; /* [vertex] m; borrowed, and read only where a term is made of the layer */
} FaceLayer;

/* Of a mesh; rows NULL: each face has its own. Only of the faces whose row is on (NULL: all); of thickness 0 none. */
FaceLayer face_layer(const Mesh *mesh, double thickness, const int *rows, const bool *on);
void face_layer_clear(FaceLayer *layer);

/* The row of the face in a lane of a pack. */
static inline int face_layer_row(const FaceLayer *layer, int pack, int lane)
{
    return layer->rows[pack_element(layer->count, pack, lane)];
}

/* A component of the layer's faces, of values[row][width]. */
static inline Pack face_layer_param(const FaceLayer *layer, int pack, const double *values, int width,
                                    int component)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = values[face_layer_row(layer, pack, l) * width + component];
    return r;
}

/* The volumes of a pack at p, of FaceLayer.volume as terms keep it, m^3; how they change with p, dp laid out as p; and
 * dp += amount times their derivative. */
static inline Pack face_layer_volume(const FaceLayer *layer, int pack, Pack volume, const double *p)
{
    return layer->thickness < 0 ? volume : volume * face_layer_param(layer, pack, p + layer->thickness, 1, 0);
}
static inline Pack face_layer_volume_change(const FaceLayer *layer, int pack, Pack volume, const double *dp)
{
    return layer->thickness < 0 ? pack_set(0) : face_layer_volume(layer, pack, volume, dp);
}
static inline void face_layer_add_volume(const FaceLayer *layer, int pack, int lanes, Pack volume,
                                         Pack amount, double *dp)
{
    for (int l = 0; layer->thickness >= 0 && l < lanes; l++)
        dp[layer->thickness + face_layer_row(layer, pack, l)] += volume[l] * amount[l];
}
