/* near.h - which boxes of many meet a box: a tree of boxes, made once and fitted again wherever they go.
 *
 * What is found is exact, box against box, and follows from the boxes alone. Boxes that are not numbers meet nothing. */
#pragma once
#include <stdbool.h>

typedef struct Box {
    double low[3], high[3];
} Box;

/* Nothing: the union with it is the other. */
Box box_empty(void);
void box_add(Box *box, const double x[3]);
void box_join(Box *box, const Box *other);
bool box_meets(const Box *a, const Box *b);

/* Of the gap between two boxes; 0 where they meet. */
double box_gap_square(const Box *a, const Box *b);

typedef struct NearTree NearTree;

/* Neighbours among these boxes come to lie together. */
NearTree *near_tree_create(int count, const Box *boxes);
void near_tree_destroy(NearTree *tree);

/* From now on of these boxes, which are copied. */
void near_tree_fit(NearTree *tree, const Box *boxes);

/* Numbers in the order they are found in. */
typedef struct NearList {
    int count, room, *list; /* owned: mem_free */
} NearList;

/* In place of what the list held: the boxes that meet that one, ascending. */
void near_tree_find(const NearTree *tree, const Box *box, NearList *found);
