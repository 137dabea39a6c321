#include "world/near.h"
#include "base/memory.h"
#include "base/pack.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A node and all below it are nodes[k] .. nodes[k].after - 1, and leaves up to its last one; a leaf is of the boxes in the
 * lanes of one pack. */
typedef struct Node {
    Box box;
    int after, last_leaf;
    bool is_leaf;
} Node;

typedef struct Leaf {
    Box box;
    Pack low[3], high[3];
    int number[PACK_LANES], count;
} Leaf;

struct NearTree {
    int count, node_count, leaf_count;
    Node *nodes;
    Leaf *leaves;
};

/* ---- Making ---- */

typedef struct Centre {
    double x[3];
    int number, axis;
} Centre;

static int by_axis(const void *a, const void *b)
{
    const Centre *i = a, *j = b;
    double u = i->x[i->axis], v = j->x[j->axis];
    return u != v ? (u > v) - (u < v) : (i->number > j->number) - (i->number < j->number);
}

/* Sorts along the axis in which they spread most. */
static void sort(Centre *centres, int count)
{
    Box box = box_empty();
    int axis = 0;
    for (int i = 0; i < count; i++) box_add(&box, centres[i].x);
    for (int i = 1; i < 3; i++)
        if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
    for (int i = 0; i < count; i++) centres[i].axis = axis;
    qsort(centres, (size_t)count, sizeof *centres, by_axis);
}

/* The middle one's place, such that all leaves but the last are full. */
static int half(int count)
{
    int leaves = pack_count(count);
    return (leaves + 1) / 2 * PACK_LANES;
}

static void make_node(NearTree *tree, Centre *centres, int count)
{
    Node *node = &tree->nodes[tree->node_count++];
    if (count > PACK_LANES) {
        sort(centres, count);
        make_node(tree, centres, half(count));
        make_node(tree, centres + half(count), count - half(count));
    } else {
        node->is_leaf = true;
        Leaf *leaf = &tree->leaves[tree->leaf_count++];
        leaf->count = count;
        for (int l = 0; l < count; l++) leaf->number[l] = centres[l].number;
    }
    node->after = tree->node_count;
    node->last_leaf = tree->leaf_count - 1;
}

NearTree *near_tree_create(int count, const Box *boxes)
{
    NearTree *tree = mem_alloc(1, sizeof *tree);
    int leaves = pack_count(count);
    tree->count = count;
    tree->nodes = mem_alloc(2 * (size_t)leaves, sizeof *tree->nodes);
    tree->leaves = mem_alloc((size_t)leaves, sizeof *tree->leaves);
    if (count == 0) return tree;
    Centre *centres = mem_alloc((size_t)count, sizeof *centres);
    for (int k = 0; k < count; k++) {
        centres[k].number = k;
        for (int i = 0; i < 3; i++) centres[k].x[i] = (boxes[k].low[i] + boxes[k].high[i]) / 2;
    }
    make_node(tree, centres, count);
    mem_free(centres);
    near_tree_fit(tree, boxes);
    return tree;
}

void near_tree_destroy(NearTree *tree)
{
    if (!tree) return;
    mem_free(tree->nodes);
    mem_free(tree->leaves);
    mem_free(tree);
}

/* ---- Fitting and finding ---- */

static void fit_leaf(Leaf *leaf, const Box *boxes)
{
    leaf->box = box_empty();
    for (int l = 0; l < PACK_LANES; l++) {
        Box box = l < leaf->count ? boxes[leaf->number[l]] : box_empty();
        for (int i = 0; i < 3; i++) leaf->low[i][l] = box.low[i], leaf->high[i][l] = box.high[i];
        box_join(&leaf->box, &box);
    }
}

void near_tree_fit(NearTree *tree, const Box *boxes)
{
    for (int k = 0; k < tree->leaf_count; k++) fit_leaf(&tree->leaves[k], boxes);
    for (int k = tree->node_count - 1; k >= 0; k--) {
        Node *node = &tree->nodes[k];
        if (node->is_leaf) {
            node->box = tree->leaves[node->last_leaf].box;
            continue;
        }
        const Node *left = node + 1, *right = &tree->nodes[left->after];
        node->box = left->box;
        box_join(&node->box, &right->box);
    }
}

static void make_room(NearPairs *found)
{
    if (found->count + PACK_LANES <= found->room) return;
    int room = 2 * found->room + 1024;
    found->list = mem_resize(found->list, (size_t)found->room, (size_t)room, sizeof *found->list);
    found->room = room;
}

/* Of two leaves; from: the first lane of b for lane l of a is from * (l + 1). */
static void pair_leaves(const Leaf *a, const Leaf *b, double radius, int from, NearPairs *found)
{
    for (int l = 0; l < a->count; l++) {
        PackMask meets = a->low[0][l] - radius <= b->high[0];
        for (int i = 0; i < 3; i++)
            meets &= (b->low[i] <= a->high[i][l] + radius) & (b->high[i] >= a->low[i][l] - radius);
        long long lanes[PACK_LANES];
        memcpy(lanes, &meets, sizeof lanes);
        make_room(found);
        for (int m = from * (l + 1); m < b->count; m++) {
            found->list[found->count][0] = a->number[l];
            found->list[found->count][1] = b->number[m];
            found->count -= (int)lanes[m]; /* -1: yes */
        }
    }
}

void near_tree_pairs(const NearTree *a, const NearTree *b, double radius, NearPairs *found)
{
    found->count = 0;
    for (int leaf = 0; leaf < a->leaf_count; leaf++) {
        const Leaf *own = &a->leaves[leaf];
        Box wide = own->box;
        for (int i = 0; i < 3; i++) wide.low[i] -= radius, wide.high[i] += radius;
        for (int k = 0; k < b->node_count;) {
            const Node *node = &b->nodes[k];
            bool before = a == b && node->last_leaf < leaf;
            if (before || !box_meets(&node->box, &wide)) {
                k = node->after;
                continue;
            }
            if (node->is_leaf)
                pair_leaves(own, &b->leaves[node->last_leaf], radius, a == b && node->last_leaf == leaf,
                            found);
            k++;
        }
    }
    for (int k = 0; a == b && k < found->count; k++) {
        int *pair = found->list[k], low = pair[0] < pair[1] ? pair[0] : pair[1];
        pair[1] += pair[0] - low, pair[0] = low;
    }
}

static int by_numbers(const void *a, const void *b)
{
    const int *i = a, *j = b;
    return i[0] != j[0] ? (i[0] > j[0]) - (i[0] < j[0]) : (i[1] > j[1]) - (i[1] < j[1]);
}

void near_pairs_sort(int (*pairs)[2], int count)
{
    if (count > 1) qsort(pairs, (size_t)count, sizeof *pairs, by_numbers);
}
