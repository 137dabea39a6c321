#include "world/near.h"
#include "base/memory.h"
#include "base/pack.h"
#include <math.h>
#include <stdlib.h>

/* A node and all below it are nodes[k] .. nodes[k].after - 1; a leaf is of the boxes in the lanes of one pack. */
typedef struct Node {
    Box box;
    int after, leaf; /* leaf: -1: none */
} Node;

typedef struct Leaf {
    Pack low[3], high[3];
    int number[PACK_LANES], count;
} Leaf;

struct NearTree {
    int count, node_count, leaf_count;
    Node *nodes;
    Leaf *leaves;
};

Box box_empty(void)
{
    return (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

void box_add(Box *box, const double x[3])
{
    for (int i = 0; i < 3; i++) {
        if (x[i] < box->low[i]) box->low[i] = x[i];
        if (x[i] > box->high[i]) box->high[i] = x[i];
    }
}

void box_join(Box *box, const Box *other)
{
    for (int i = 0; i < 3; i++) {
        if (other->low[i] < box->low[i]) box->low[i] = other->low[i];
        if (other->high[i] > box->high[i]) box->high[i] = other->high[i];
    }
}

bool box_meets(const Box *a, const Box *b)
{
    bool meets = true;
    for (int i = 0; i < 3; i++) meets &= a->low[i] <= b->high[i] && b->low[i] <= a->high[i];
    return meets;
}

double box_gap_square(const Box *a, const Box *b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double gap = fmax(0, fmax(a->low[i] - b->high[i], b->low[i] - a->high[i]));
        sum += gap * gap;
    }
    return sum;
}

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
    int leaves = (count + PACK_LANES - 1) / PACK_LANES;
    return (leaves + 1) / 2 * PACK_LANES;
}

static void make_node(NearTree *tree, Centre *centres, int count)
{
    Node *node = &tree->nodes[tree->node_count++];
    node->leaf = -1;
    if (count > PACK_LANES) {
        sort(centres, count);
        make_node(tree, centres, half(count));
        make_node(tree, centres + half(count), count - half(count));
    } else {
        node->leaf = tree->leaf_count;
        Leaf *leaf = &tree->leaves[tree->leaf_count++];
        leaf->count = count;
        for (int l = 0; l < count; l++) leaf->number[l] = centres[l].number;
    }
    node->after = tree->node_count;
}

NearTree *near_tree_create(int count, const Box *boxes)
{
    NearTree *tree = mem_alloc(1, sizeof *tree);
    int leaves = (count + PACK_LANES - 1) / PACK_LANES;
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

static Box fit_leaf(Leaf *leaf, const Box *boxes)
{
    Box all = box_empty();
    for (int l = 0; l < PACK_LANES; l++) {
        Box box = l < leaf->count ? boxes[leaf->number[l]] : box_empty();
        for (int i = 0; i < 3; i++) leaf->low[i][l] = box.low[i], leaf->high[i][l] = box.high[i];
        box_join(&all, &box);
    }
    return all;
}

void near_tree_fit(NearTree *tree, const Box *boxes)
{
    for (int k = tree->node_count - 1; k >= 0; k--) {
        Node *node = &tree->nodes[k];
        if (node->leaf >= 0) {
            node->box = fit_leaf(&tree->leaves[node->leaf], boxes);
            continue;
        }
        const Node *left = node + 1, *right = &tree->nodes[left->after];
        node->box = left->box;
        box_join(&node->box, &right->box);
    }
}

static void find_in_leaf(const Leaf *leaf, const Box *box, NearList *found)
{
    PackMask meets = leaf->low[0] <= box->high[0];
    for (int i = 0; i < 3; i++) meets &= (leaf->low[i] <= box->high[i]) & (leaf->high[i] >= box->low[i]);
    if (found->count + PACK_LANES > found->room) {
        int room = 2 * found->room + 64;
        found->list = mem_resize(found->list, (size_t)found->room, (size_t)room, sizeof *found->list);
        found->room = room;
    }
    for (int l = 0; l < leaf->count; l++)
        if (meets[l]) found->list[found->count++] = leaf->number[l];
}

static int by_number(const void *a, const void *b)
{
    const int *i = a, *j = b;
    return (*i > *j) - (*i < *j);
}

void near_tree_find(const NearTree *tree, const Box *box, NearList *found)
{
    found->count = 0;
    for (int k = 0; k < tree->node_count;) {
        const Node *node = &tree->nodes[k];
        if (!box_meets(&node->box, box)) {
            k = node->after;
            continue;
        }
        if (node->leaf >= 0) find_in_leaf(&tree->leaves[node->leaf], box, found);
        k++;
    }
    if (found->count > 1) qsort(found->list, (size_t)found->count, sizeof *found->list, by_number);
}
