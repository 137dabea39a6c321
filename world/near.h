/* near.h - which boxes of many meet which of others: trees of boxes, made once and fitted again wherever they go.
 *
 * What is found is exact, box against box, and follows from the boxes alone. Boxes that are not numbers meet nothing. */
#pragma once
#include <math.h>
#include <stdbool.h>

typedef struct Box {
    double low[3], high[3];
} Box;

/* Nothing: the union with it is the other. */
static inline Box box_empty(void)
{
    return (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static inline void box_add(Box *box, const double x[3])
{
    for (int i = 0; i < 3; i++) {
        box->low[i] = x[i] < box->low[i] ? x[i] : box->low[i];
        box->high[i] = x[i] > box->high[i] ? x[i] : box->high[i];
    }
}

static inline void box_join(Box *box, const Box *other)
{
    for (int i = 0; i < 3; i++) {
        box->low[i] = other->low[i] < box->low[i] ? other->low[i] : box->low[i];
        box->high[i] = other->high[i] > box->high[i] ? other->high[i] : box->high[i];
    }
}

static inline bool box_meets(const Box *a, const Box *b)
{
    bool meets = true;
    for (int i = 0; i < 3; i++) meets &= a->low[i] <= b->high[i] && b->low[i] <= a->high[i];
    return meets;
}

/* Of the gap between two boxes; 0 where they meet. */
static inline double box_gap_square(const Box *a, const Box *b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double up = a->low[i] - b->high[i], down = b->low[i] - a->high[i], gap = up > down ? up : down;
        gap = gap > 0 ? gap : 0;
        sum += gap * gap;
    }
    return sum;
}

typedef struct NearTree NearTree;

/* Neighbours among these boxes come to lie together. */
NearTree *near_tree_create(int count, const Box *boxes);
void near_tree_destroy(NearTree *tree);

/* From now on of these boxes, which are copied. */
void near_tree_fit(NearTree *tree, const Box *boxes);

/* Pairs of numbers, in no order. */
typedef struct NearPairs {
    int count, room, (*list)[2]; /* owned: mem_free */
} NearPairs;

/* By their first number, then by the other. */
void near_pairs_sort(int (*pairs)[2], int count);

/* In place of what the list held: all {i, j} of which a's box i and b's box j meet where the former is widened by
 * `radius`. Within one tree: each pair once, i < j. */
void near_tree_pairs(const NearTree *a, const NearTree *b, double radius, NearPairs *found);
