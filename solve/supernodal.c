#include "base/memory.h"
#include "base/pack.h"
#include "solve/supernodal_private.h"
#include <stdlib.h>

/* A branch has at most this part of the factorisation's work: then a few threads have enough to share, and the crown is
 * not too much of it. */
static const double BRANCH_PART = 1.0 / 16;

static int whole_packs(int rows)
{
    return (rows + PACK_LANES - 1) / PACK_LANES * PACK_LANES;
}

/* Rows below the diagonal block, without those that fill up. */
static int count_of(const Supernode *node)
{
    return node->rows - node->width;
}

/* Shapes, parents, and the places of the numbers. */
static void set_nodes(Supernodal *plan, const SupernodalDef *def)
{
    int *owner = mem_alloc((size_t)plan->n, sizeof *owner); /* of a column */
    long at = 0;
    for (int s = 0; s < plan->count; s++)
        for (long c = def->first[s]; c < def->first[s + 1]; c++) owner[c] = s;
    for (int s = plan->count - 1; s >= 0; s--) {
        Supernode *node = &plan->nodes[s];
        int width = (int)(def->first[s + 1] - def->first[s]), rows = (int)(def->start[s + 1] - def->start[s]);
        int parent = rows > width ? owner[def->rows[def->start[s] + width]] : -1;
        *node = (Supernode){.first = (int)def->first[s],
                            .width = width,
                            .rows = rows,
                            .below = whole_packs(rows - width),
                            .height = width + whole_packs(rows - width),
                            .parent = parent,
                            .child = -1,
                            .sibling = parent < 0 ? -1 : plan->nodes[parent].child};
        if (parent >= 0) plan->nodes[parent].child = s;
    }
    for (int s = 0; s < plan->count; s++) {
        Supernode *node = &plan->nodes[s];
        node->at = at;
        node->numbers_at = plan->numbers;
        at += count_of(node);
        plan->numbers += (long)node->height * node->width;
    }
    plan->rows = mem_alloc((size_t)at, sizeof(int));
    plan->places = mem_alloc((size_t)at, sizeof(int));
    plan->targets = mem_alloc((size_t)at, sizeof(int));
    mem_free(owner);
}

/* to[i] = where rows[i] comes among all[..]; both ascending, all of the former in the latter. */
static void find_places(int count, const int *rows, const long *all, int *to)
{
    for (int i = 0, k = 0; i < count; i++) {
        while (all[k] < rows[i]) k++;
        to[i] = k;
    }
}

static void set_places(Supernodal *plan, const SupernodalDef *def)
{
    for (int s = 0; s < plan->count; s++) {
        const Supernode *node = &plan->nodes[s];
        int *rows = plan->rows + node->at;
        for (int i = 0; i < count_of(node); i++) rows[i] = (int)def->rows[def->start[s] + node->width + i];
        if (node->parent >= 0)
            find_places(count_of(node), rows, def->rows + def->start[node->parent], plan->places + node->at);
    }
}

static void set_slots(Supernodal *plan, const Pattern *pattern, const SupernodalDef *def)
{
    int *place = mem_alloc((size_t)plan->n, sizeof *place); /* of a row in the supernode at hand */
    plan->slots = mem_alloc((size_t)pattern->start[plan->n], sizeof(int));
    for (int s = 0; s < plan->count; s++) {
        for (long k = def->start[s]; k < def->start[s + 1]; k++)
            place[def->rows[k]] = (int)(k - def->start[s]);
        for (int k = pattern->start[def->first[s]]; k < pattern->start[def->first[s + 1]]; k++)
            plan->slots[k] = place[pattern->rows[k]];
    }
    mem_free(place);
}

/* The operations of a supernode. */
static double node_work(const Supernode *node)
{
    double w = node->width, r = count_of(node);
    return w * (w * w / 3 + w * r + r * r);
}

typedef struct Subtree {
    double work;
    int count, low; /* supernodes, the first of them */
} Subtree;

static Subtree *measure_subtrees(const Supernodal *plan)
{
    Subtree *trees = mem_alloc((size_t)plan->count, sizeof *trees);
    for (int s = 0; s < plan->count; s++) trees[s].low = s;
    for (int s = 0; s < plan->count; s++) {
        const Supernode *node = &plan->nodes[s];
        trees[s].work += node_work(node);
        trees[s].count++;
        if (node->parent < 0) continue;
        Subtree *parent = &trees[node->parent];
        parent->work += trees[s].work;
        parent->count += trees[s].count;
        if (trees[s].low < parent->low) parent->low = trees[s].low;
    }
    return trees;
}

/* Its supernodes are in a row; those of a given order need not be. */
static bool in_a_row(const Subtree *tree, int s)
{
    return tree->low == s - tree->count + 1;
}

/* Largest subtrees of not too much work become branches. */
static void set_branches(Supernodal *plan, const Subtree *trees)
{
    double most = 0;
    for (int s = 0; s < plan->count; s++) most += node_work(&plan->nodes[s]) * BRANCH_PART;
    plan->branches = mem_alloc((size_t)plan->count, sizeof *plan->branches);
    for (int s = plan->count - 1; s >= 0; s--) {
        Supernode *node = &plan->nodes[s];
        node->branch = node->parent < 0 ? -1 : plan->nodes[node->parent].branch;
        if (node->branch >= 0 || trees[s].work > most || !in_a_row(&trees[s], s)) continue;
        const Supernode *first = &plan->nodes[trees[s].low];
        plan->branches[plan->branch_count] = (Branch){.first = trees[s].low,
                                                      .last = s,
                                                      .column = first->first,
                                                      .columns = node->first + node->width - first->first,
                                                      .border = count_of(node),
                                                      .work = trees[s].work};
        node->branch = plan->branch_count++;
    }
}

static int compare_work(const void *a, const void *b)
{
    const Branch *c = a, *d = b;
    return c->work != d->work ? (c->work < d->work ? 1 : -1) : (c->first > d->first) - (c->first < d->first);
}

/* The long ones first, so that threads end together. */
static void sort_branches(Supernodal *plan)
{
    qsort(plan->branches, (size_t)plan->branch_count, sizeof *plan->branches, compare_work);
    for (int b = 0; b < plan->branch_count; b++)
        for (int s = plan->branches[b].first; s <= plan->branches[b].last; s++) plan->nodes[s].branch = b;
}

/* Two stacks, of the supernodes of even and of odd depth in the tree. In postorder a supernode finds its children's updates
 * on top of the one, and leaves its own on the other. */
typedef struct Stacks {
    long top[2], peak[2];
} Stacks;

static void push_update(Supernodal *plan, int s, int side, bool postordered, Stacks *stacks)
{
    Supernode *node = &plan->nodes[s];
    long size = (long)node->below * node->below;
    node->update_at = stacks->top[side];
    stacks->top[side] += size;
    if (stacks->top[side] > stacks->peak[side]) stacks->peak[side] = stacks->top[side];
    int child = node->child;
    while (child >= 0 && plan->nodes[child].branch != node->branch) child = plan->nodes[child].sibling;
    if (postordered && child >= 0) stacks->top[!side] = plan->nodes[child].update_at;
}

/* Places of the updates of supernodes first .. last that are of this branch (-1: of the crown); the room they need. */
static long set_updates(Supernodal *plan, int first, int last, int branch, const char *odd, bool postordered)
{
    Stacks stacks = {0};
    for (int s = first; s <= last; s++)
        if (plan->nodes[s].branch == branch) push_update(plan, s, odd[s], postordered, &stacks);
    for (int s = first; s <= last; s++)
        if (plan->nodes[s].branch == branch && odd[s]) plan->nodes[s].update_at += stacks.peak[0];
    return stacks.peak[0] + stacks.peak[1];
}

/* What branches leave to the crown is kept apart from their work space, for which they take turns. */
static void keep_updates(Supernodal *plan)
{
    for (int b = 0; b < plan->branch_count; b++) {
        Supernode *last = &plan->nodes[plan->branches[b].last];
        last->kept = true;
        last->update_at = plan->work_size;
        plan->work_size += (long)last->below * last->below;
    }
}

static void set_work(Supernodal *plan, const Subtree *trees)
{
    char *odd = mem_alloc((size_t)plan->count, sizeof *odd);
    bool postordered = true;
    for (int s = plan->count - 1; s >= 0; s--) {
        odd[s] = plan->nodes[s].parent >= 0 && !odd[plan->nodes[s].parent];
        postordered = postordered && in_a_row(&trees[s], s);
    }
    for (int b = 0; b < plan->branch_count; b++) {
        const Branch *branch = &plan->branches[b];
        long size = set_updates(plan, branch->first, branch->last, b, odd, postordered);
        if (size > plan->desk_size) plan->desk_size = size;
    }
    plan->work_size = set_updates(plan, 0, plan->count - 1, -1, odd, postordered);
    for (int s = 0; s < plan->count; s++) plan->nodes[s].kept = plan->nodes[s].branch < 0;
    keep_updates(plan);
    mem_free(odd);
}

/* Where rows come in the vectors that solves work on. */
static void set_targets(Supernodal *plan)
{
    for (int s = 0; s < plan->count; s++) {
        const Supernode *node = &plan->nodes[s];
        const Branch *branch = node->branch < 0 ? NULL : &plan->branches[node->branch];
        const int *border = branch ? plan->rows + plan->nodes[branch->last].at : NULL;
        for (int i = 0, k = 0; i < count_of(node); i++) {
            int row = plan->rows[node->at + i], *to = &plan->targets[node->at + i];
            *to = row;
            if (!branch) continue;
            *to -= branch->column;
            if (*to < branch->columns) continue;
            while (border[k] < row) k++;
            *to = branch->columns + k;
        }
    }
}

/* Rows of the highest of the supernodes first .. last. */
static int highest(const Supernodal *plan, int first, int last)
{
    int most = 0;
    for (int s = first; s <= last; s++)
        if (plan->nodes[s].height > most) most = plan->nodes[s].height;
    return most;
}

static void set_vectors(Supernodal *plan)
{
    for (int b = 0; b < plan->branch_count; b++) {
        Branch *branch = &plan->branches[b];
        branch->vector_at = plan->vector_size;
        plan->vector_size += branch->columns + branch->border + highest(plan, branch->first, branch->last);
    }
    plan->crown_at = plan->vector_size;
    plan->vector_size += highest(plan, 0, plan->count - 1);
}

Supernodal *supernodal_create(const Pattern *pattern, const SupernodalDef *def)
{
    Supernodal *plan = mem_alloc(1, sizeof *plan);
    plan->n = pattern->n;
    plan->count = def->count;
    plan->nodes = mem_alloc((size_t)def->count, sizeof *plan->nodes);
    set_nodes(plan, def);
    set_places(plan, def);
    set_slots(plan, pattern, def);
    Subtree *trees = measure_subtrees(plan);
    set_branches(plan, trees);
    sort_branches(plan);
    set_work(plan, trees);
    set_targets(plan);
    set_vectors(plan);
    mem_free(trees);
    plan->vector = mem_alloc((size_t)plan->vector_size, sizeof *plan->vector);
    return plan;
}

void supernodal_destroy(Supernodal *plan)
{
    if (!plan) return;
    mem_free(plan->nodes);
    mem_free(plan->branches);
    mem_free(plan->rows);
    mem_free(plan->places);
    mem_free(plan->targets);
    mem_free(plan->slots);
    for (int d = 0; d < plan->desk_count; d++) mem_free(plan->desks[d].work);
    mem_free(plan->desks);
    mem_free(plan->work);
    mem_free(plan->vector);
    mem_free(plan);
}

long supernodal_size(const Supernodal *plan)
{
    return plan->numbers;
}
