/* samples.h - where a body touches obstacles: its vertices, and the middles of edges or faces that are longer than an
 * obstacle's detail, which would come between the vertices.
 *
 * A sample is the mean of its corners; a term's element is a sample, with three dofs for each corner. */
#pragma once
#include "solve/element.h"

typedef struct Samples {
    int count, corners; /* 1: vertices, 2: middles of edges, 3: of faces       */
    int *vertices;      /* [count][corners]                                    */
    int first;          /* positions of vertex v are the dofs first + 3v .. + 2 */
} Samples;

static inline void samples_dofs(const Samples *samples, int e, int *dof)
{
    for (int i = 0; i < 3 * samples->corners; i++)
        dof[i] = samples->first + 3 * samples->vertices[e * samples->corners + i / 3] + i % 3;
}

/* Of a pack's corners. */
static inline Pack3 samples_mean(const Samples *samples, const Pack *x)
{
    Pack3 sum = pack3_load(x);
    for (int i = 1; i < samples->corners; i++) sum = pack3_add(sum, pack3_load(x + 3 * i));
    return pack3_scale(pack_set(1.0 / samples->corners), sum);
}

/* The samples of a pack in a whole vector, one lane. */
static inline void samples_place(const Samples *samples, int pack, int lane, const double *x, double place[3])
{
    int e = pack * PACK_LANES + lane;
    const int *v = &samples->vertices[(e < samples->count ? e : samples->count - 1) * samples->corners];
    for (int i = 0; i < 3; i++) {
        place[i] = 0;
        for (int c = 0; c < samples->corners; c++) place[i] += x[samples->first + 3 * v[c] + i];
        place[i] /= samples->corners;
    }
}

/* What a vector at the sample is to its corners, and a matrix: written over g, added to H. */
static inline void samples_spread(const Samples *samples, Pack3 a, Pack *g)
{
    Pack part = pack_set(1.0 / samples->corners);
    for (int i = 0; i < samples->corners; i++) pack3_store(g + 3 * i, pack3_scale(part, a));
}

static inline void samples_spread_matrix(const Samples *samples, PackMat A, Pack *H)
{
    int n = samples->corners;
    A = pack_mat_scale(pack_set(1.0 / (n * n)), A);
    element_clear(H, 3 * n);
    for (int i = 0; i < n; i++) {
        element_add_diagonal(H, i, A);
        for (int j = 0; j < i; j++) element_add_block(H, i, j, A);
    }
}
