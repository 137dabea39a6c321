/* term.h - what the terms of a rod share: elements, their turns as dofs, and numbers of p per element. */
#pragma once
#include "base/memory.h"
#include "rod/segment.h"
#include "rod/terms.h"

static inline int rod_term_count(const void *self)
{
    return ((const RodTerm *)self)->rod->elements;
}

/* Elements with six dofs, the turns of their nodes. */
static inline int rod_term_turns(const void *self)
{
    (void)self;
    return 6;
}

static inline void rod_term_turn_dofs(const void *self, int e, int *dof)
{
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; i < 6; i++) dof[i] = layout->turn + 3 * rod_element_node(layout, e) + i;
}

/* Where the rod stretches, the strain of an element is its next three. */
static inline void rod_term_strain_dofs(const void *self, int e, int *dof)
{
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; layout->strain >= 0 && i < 3; i++) dof[i] = layout->strain + 3 * e + i;
}

static inline int rod_term_three(const void *self)
{
    (void)self;
    return 3;
}

/* Elements that are nodes, with three dofs; the node of a lane, the last one fills up. */
static inline int rod_term_nodes(const void *self)
{
    return ((const RodTerm *)self)->layout.nodes;
}

static inline int rod_term_node(const RodTerm *term, int pack, int lane)
{
    int node = pack * PACK_LANES + lane, last = term->layout.nodes - 1;
    return node < last ? node : last;
}

/* Number i of `width` of each element's row in a block of values. */
static inline Pack rod_term_number(const RodTerm *term, int pack, const double *block, int width, int i)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = block[width * segment_lane(&term->layout, pack, l) + i];
    return r;
}

/* m, of the elements. */
static inline Pack rod_term_length(const RodTerm *term, int pack)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++)
        r[l] = rod_element_length(term->rod, segment_lane(&term->layout, pack, l));
    return r;
}

static inline Pack3 rod_term_vector(const RodTerm *term, int pack, const double *block)
{
    return pack3(rod_term_number(term, pack, block, 3, 0), rod_term_number(term, pack, block, 3, 1),
                 rod_term_number(term, pack, block, 3, 2));
}

/* A stiffness, .. of the elements' sections, which begins at `number` in the first element's. */
static inline Pack rod_term_section(const RodTerm *term, int pack, const double *number)
{
    return rod_term_number(term, pack, number, sizeof(RodSection) / sizeof(double), 0);
}

static inline Pack3 rod_term_uniform(const double *v)
{
    return pack3(pack_set(v[0]), pack_set(v[1]), pack_set(v[2]));
}

/* Adds blocks aa, ab, bb to an element Hessian whose turns are its blocks of three number `a` and `a + 1`. */
static inline void rod_term_add_blocks(Pack *H, int a, const PackMat block[3])
{
    element_add_diagonal(H, a, block[0]);
    element_add_block(H, a, a + 1, block[1]);
    element_add_diagonal(H, a + 1, block[2]);
}

/* Gradients of both turns, made those of turns that are not 0. */
static inline void rod_term_turn_gradient(const Segment *s, Pack *g)
{
    pack3_store(g, segment_turned(s->turn_a, pack3_load(g)));
    pack3_store(g + 3, segment_turned(s->turn_b, pack3_load(g + 3)));
}

static inline void rod_term_clear(Pack *g, int count)
{
    memset(g, 0, (size_t)count * sizeof *g);
}

static inline Term rod_term_make(const TermOps *ops, const Rod *rod, RodLayout layout, double hold)
{
    RodTerm *self = mem_alloc(1, sizeof *self);
    *self = (RodTerm){rod, layout, hold};
    return (Term){ops, self};
}
