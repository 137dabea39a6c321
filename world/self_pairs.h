/* self_pairs.h - the pairs that are the elements of self contact and of its friction, and where they are remembered from. */
#pragma once
#include "world/pair_memory.h"
#include "world/touch.h"

typedef struct SelfPairs {
    Neighbours *n;
    PairList list;
    double *known; /* [3*vertex_count] where the list was made */
    bool any_known;
    PairMemory memory; /* of lists before */
    /* Scratch of a step: the pairs on its ways, where these lead, and where they do beside a motion of the whole. */
    PairList *swept;
    double *to, *end;
} SelfPairs;

SelfPairs *self_pairs_create(const SelfContactDef *def);

/* What finds the pairs of such a term. */
static inline Neighbours *self_pairs_neighbours(const Term *term)
{
    return ((const SelfPairs *)term->self)->n;
}

/* What both terms have alike (TermOps); self: SelfPairs. */
int self_pairs_count(const void *self);
int self_pairs_size(const void *self);
void self_pairs_dofs(const void *self, int e, int *dof);
void self_pairs_accept(const void *self, double *x, double *memory);
int self_pairs_memory(const void *self, double *rest);
void self_pairs_destroy(void *self);

/* Has the list follow from x, whole vector, and what is remembered; NULL: there are none. True where it changed. */
bool self_pairs_update(SelfPairs *pairs, const double *x, const double *memory);

/* The element in a lane, of x packs or of whole vectors. */
int self_pairs_of_lane(const SelfPairs *pairs, int pack, int lane);
void self_pairs_gather(const SelfPairs *pairs, int e, const double *x, double own[DISTANCE_DOFS]);

/* The part of the straight ways from `from` to `to` on which every pair keeps `keep` of its distance; [vertex][3]. */
double self_pairs_reach(const SelfPairs *pairs, const double *from, const double *to, double keep);
