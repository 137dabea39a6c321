#include "solid/tet_patches.h"
#include "base/memory.h"
#include <limits.h>
#include <string.h>

static bool has_node(const TetPatch *patch, int node)
{
    for (int i = 0; i < patch->node_count; i++)
        if (patch->nodes[i] == node) return true;
    return false;
}

/* How many nodes the patch would get with it. */
static int new_nodes(const Tets *tets, const TetPatch *patch, int tet)
{
    int count = 0;
    for (int i = 0; i < tets->each; i++) count += !has_node(patch, tets->nodes[tet * tets->each + i]);
    return count;
}

static void add(const Tets *tets, TetPatch *patch, int tet, bool *taken)
{
    for (int i = 0; i < tets->each; i++) {
        int node = tets->nodes[tet * tets->each + i];
        if (!has_node(patch, node)) patch->nodes[patch->node_count++] = node;
    }
    patch->tets[patch->tet_count++] = tet;
    taken[tet] = true;
}

/* The neighbour of the patch that adds the fewest nodes, the first such; -1: none that fits. */
static int best_neighbour(const Tets *tets, const TetPatch *patch, const bool *taken)
{
    int best = -1, fewest = INT_MAX;
    for (int k = 0; k < 4 * patch->tet_count; k++) {
        int tet = tets->across[4 * patch->tets[k / 4] + k % 4];
        if (tet < 0 || taken[tet]) continue;
        int nodes = new_nodes(tets, patch, tet);
        if (patch->node_count + nodes > PATCH_LINEAR_NODES) continue;
        if (nodes < fewest || (nodes == fewest && tet < best)) best = tet, fewest = nodes;
    }
    return best;
}

TetPatch *tet_patches(const Tets *tets, int *count)
{
    bool *taken = mem_alloc((size_t)tets->count, sizeof *taken);
    TetPatch *list = mem_alloc((size_t)tets->count, sizeof *list);
    *count = 0;
    for (int t = 0; t < tets->count; t++) {
        if (taken[t]) continue;
        TetPatch *patch = &list[(*count)++];
        for (int next = t; next >= 0;) {
            add(tets, patch, next, taken);
            bool full = tets->order == TET_QUADRATIC || patch->tet_count == PATCH_TETS;
            next = full ? -1 : best_neighbour(tets, patch, taken);
        }
    }
    mem_free(taken);
    return list;
}
