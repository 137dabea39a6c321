#include "world/self_pairs.h"
#include "base/memory.h"
#include "world/ccd.h"
#include <math.h>
#include <string.h>

SelfPairs *self_pairs_create(const SelfContactDef *def)
{
    SelfPairs *pairs = mem_alloc(1, sizeof *pairs);
    size_t n = 3 * (size_t)def->vertex_count;
    pairs->n = neighbours_create(def);
    pairs->memory = pair_memory_create(def->vertex_count);
    pairs->known = mem_alloc(n, sizeof(double));
    pairs->to = mem_alloc(n, sizeof(double));
    pairs->end = mem_alloc(n, sizeof(double));
    pairs->swept = mem_alloc(1, sizeof *pairs->swept);
    return pairs;
}

void self_pairs_destroy(void *self)
{
    SelfPairs *pairs = self;
    neighbours_destroy(pairs->n);
    pair_memory_clear(&pairs->memory);
    pair_list_clear(&pairs->list);
    pair_list_clear(pairs->swept);
    mem_free(pairs->swept);
    mem_free(pairs->known);
    mem_free(pairs->to);
    mem_free(pairs->end);
    mem_free(pairs);
}

int self_pairs_count(const void *self)
{
    return ((const SelfPairs *)self)->list.count;
}

int self_pairs_size(const void *self)
{
    (void)self;
    return DISTANCE_DOFS;
}

void self_pairs_dofs(const void *self, int e, int *dof)
{
    const SelfPairs *pairs = self;
    int vertices[4];
    neighbours_vertices(pairs->n, &pairs->list, e, vertices);
    for (int i = 0; i < DISTANCE_DOFS; i++) dof[i] = pairs->n->def.first + 3 * vertices[i / 3] + i % 3;
}

int self_pairs_memory(const void *self, double *rest)
{
    const SelfContactDef *def = &((const SelfPairs *)self)->n->def;
    if (rest) memcpy(rest, def->rest[0], 3 * (size_t)def->vertex_count * sizeof *rest);
    return 3 * def->vertex_count;
}

void self_pairs_accept(const void *self, double *x, double *memory)
{
    const Neighbours *n = ((const SelfPairs *)self)->n;
    if (memory && neighbours_moved(n, x + n->def.first, memory) > n->def.margin / 2)
        memcpy(memory, x + n->def.first, 3 * (size_t)n->def.vertex_count * sizeof *memory);
}

static bool forget(SelfPairs *pairs)
{
    bool changed = pairs->list.count > 0;
    pairs->list.count = pairs->list.points = 0;
    pairs->any_known = false;
    return changed;
}

bool self_pairs_update(SelfPairs *pairs, const double *x, const double *memory)
{
    Neighbours *n = pairs->n;
    size_t size = 3 * (size_t)n->def.vertex_count * sizeof(double);
    if (!x) return forget(pairs);
    const double *own = x + n->def.first;
    const double *y = neighbours_moved(n, own, memory) > n->def.margin / 2 ? own : memory;
    if (pairs->any_known && !memcmp(pairs->known, y, size)) return false;
    memcpy(pairs->known, y, size);
    pairs->any_known = true;
    PairList before = pairs->list;
    pairs->list = *pairs->swept;
    if (!pair_memory_find(&pairs->memory, y, &pairs->list)) {
        neighbours_find(n, y, n->def.distance + n->def.margin, &pairs->list);
        pair_memory_keep(&pairs->memory, y, &pairs->list);
    }
    *pairs->swept = before;
    const PairList *now = &pairs->list;
    return now->count != before.count || now->points != before.points ||
           (now->count && memcmp(now->pairs, before.pairs, (size_t)now->count * sizeof *now->pairs));
}

int self_pairs_of_lane(const SelfPairs *pairs, int pack, int lane)
{
    int e = pack * PACK_LANES + lane;
    return e < pairs->list.count ? e : pairs->list.count - 1;
}

void self_pairs_gather(const SelfPairs *pairs, int e, const double *x, double own[DISTANCE_DOFS])
{
    int vertices[4];
    neighbours_vertices(pairs->n, &pairs->list, e, vertices);
    neighbours_gather(vertices, x + pairs->n->def.first, own);
}

/* Do the boxes around their ways meet? */
static bool ways_meet(const double *from, const double *to, int second, double grow)
{
    const int all[4] = {0, 1, 2, 3};
    Box a = neighbours_box(all, second, from, to, grow),
        b = neighbours_box(all + second, 4 - second, from, to, grow);
    return box_meets(&a, &b);
}

static double reach_of_list(const SelfPairs *pairs, const PairList *list, const double *from, double keep)
{
    double reach = 1, x[DISTANCE_DOFS], to[DISTANCE_DOFS];
    for (int k = 0; k < list->count; k++) {
        int vertices[4];
        bool edges = k >= list->points;
        neighbours_vertices(pairs->n, list, k, vertices);
        neighbours_gather(vertices, from, x);
        neighbours_gather(vertices, pairs->end, to);
        if (ways_meet(x, to, edges ? 2 : 1, keep / (1 - keep)))
            reach = ccd_reach(neighbours_distance(pairs->n, list, k), x, to, keep, reach);
    }
    return reach;
}

/* Sets pairs->end; the largest way beside that of the whole. */
static double find_end(const SelfPairs *pairs, const double *from, const double *to)
{
    int count = pairs->n->def.vertex_count;
    double mean[3] = {0}, largest = 0;
    for (int i = 0; i < 3 * count; i++) mean[i % 3] += (to[i] - from[i]) / count;
    for (int v = 0; v < count; v++) {
        double square = 0;
        for (int i = 3 * v; i < 3 * v + 3; i++) {
            double way = to[i] - from[i] - mean[i % 3];
            pairs->end[i] = from[i] + way;
            square += way * way;
        }
        largest = square <= largest ? largest : square;
    }
    return sqrt(largest);
}

/* A pair whose vertices go the ways L and M comes too near only where it is nearer than (L + M)/(1 - keep) before, and
 * then its ways come nearer than `keep` of that: in slow motion the list at hand has all these, in a fast one they are
 * found by boxes around the ways. Others reach all the way, so that it does not matter which of the two it is. */
double self_pairs_reach(const SelfPairs *pairs, const double *from, const double *to, double keep)
{
    const Neighbours *n = pairs->n;
    double way = find_end(pairs, from, to);
    if (!(way > 0 && isfinite(way))) return 1;
    bool known = pairs->any_known && 2 * way / (1 - keep) + 2 * neighbours_moved(n, from, pairs->known) <
                                         n->def.distance + n->def.margin;
    if (known) return reach_of_list(pairs, &pairs->list, from, keep);
    neighbours_sweep(pairs->n, from, pairs->end, keep / (1 - keep), pairs->swept);
    return reach_of_list(pairs, pairs->swept, from, keep);
}
