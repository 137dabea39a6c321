/* tet_patches.h - tetrahedra in patches whose volume is to change as a whole: a quadratic one by itself; linear ones with
 * neighbours, up to six and eight nodes, so that a cell of six is a patch. */
#pragma once
#include "solid/tets.h"

enum { PATCH_TETS = 6, PATCH_NODES = 10, PATCH_LINEAR_NODES = 8 };

typedef struct TetPatch {
    int tet_count, tets[PATCH_TETS], node_count, nodes[PATCH_NODES];
} TetPatch;

/* They share nothing out twice and leave nothing out. Which, follows from the tetrahedra alone. Caller: mem_free. */
TetPatch *tet_patches(const Tets *tets, int *count);
