/* vertex_term.h - what terms share whose elements are single vertices with three position dofs each (3v ..
 * 3v+2): their struct begins with `int vertex_count`. */
#pragma once
#include "base/pack.h"

static inline int vertex_term_count(const void *self)
{
    return *(const int *)self;
}

static inline int vertex_term_size(const void *self)
{
    (void)self;
    return 3;
}

static inline void vertex_term_dofs(const void *self, int vertex, int *dof)
{
    (void)self;
    for (int i = 0; i < 3; i++) dof[i] = 3 * vertex + i;
}

/* The vertex in a lane of a pack; the last one fills up. */
static inline int vertex_of_lane(const void *self, int pack, int lane)
{
    int vertex = pack * PACK_LANES + lane, last = vertex_term_count(self) - 1;
    return vertex < last ? vertex : last;
}
