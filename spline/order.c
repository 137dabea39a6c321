#include "spline/order.h"
#include "base/memory.h"
#include "spline/join.h"
#include "spline/tour.h"
#include <string.h>

OrderDef order_default(void)
{
    return (OrderDef){.join_gap = 1.75, .join_angle = acos(-1) / 4, .work = 3000000000};
}

/* One stroke, or several joined end to end; a ring where the last is joined to the first. */
typedef struct Chain {
    Vec2 ends[2];
    int begin[2]; /* the ends (join.h) from which it can be drawn */
    int layer;
} Chain;

static double distance(Vec2 a, Vec2 b)
{
    return hypot(b.x - a.x, b.y - a.y);
}

/* The chains in the order of their first strokes. */
static int find_chains(const Strokes *strokes, const int *partner, Chain *chains)
{
    bool *used = mem_alloc((size_t)strokes->count, sizeof *used);
    int count = 0;
    for (int k = 0; k < strokes->count; k++) {
        if (used[k]) continue;
        int begin = 2 * k, end;
        while (partner[begin] >= 0 && (partner[begin] ^ 1) != 2 * k) begin = partner[begin] ^ 1;
        for (end = begin ^ 1;; end = partner[end] ^ 1) {
            used[end / 2] = true;
            if (partner[end] < 0 || partner[end] == begin) break;
        }
        chains[count++] = (Chain){.ends = {join_end(strokes, begin), join_end(strokes, end)},
                                  .begin = {begin, end},
                                  .layer = strokes->layer[k]};
    }
    mem_free(used);
    return count;
}

static void copy_node(double *to, const double *from, int sign)
{
    to[0] = from[0];
    to[1] = from[1];
    to[2] = sign * from[2];
    to[3] = sign * from[3];
}

/* Adds the nodes of the stroke that begins at that end to the last stroke. A joint takes the place of its
 * first node and of the last one of the stroke before, which ended with `joined_to` (-1: none). */
static void add_nodes(Strokes *to, const Strokes *from, int begin, int joined_to)
{
    int first = from->start[begin / 2], nodes = from->start[begin / 2 + 1] - first;
    int *end = &to->start[to->count], sign = begin & 1 ? -1 : 1, skip = joined_to >= 0;
    if (skip) join_node(from, joined_to, begin, acos(-1), to->q + 4 * (*end - 1));
    for (int k = skip; k < nodes; k++, ++*end)
        copy_node(to->q + 4 * *end, from->q + 4 * (first + (sign > 0 ? k : nodes - 1 - k)), sign);
}

/* The last stroke begins and ends in the joint of those two ends. */
static void close_ring(Strokes *to, const Strokes *from, int end, int begin)
{
    double node[4];
    join_node(from, end, begin, acos(-1), node);
    copy_node(to->q + 4 * to->start[to->count - 1], node, 1);
    copy_node(to->q + 4 * (to->start[to->count] - 1), node, 1);
}

static void add_chain(Strokes *to, const Strokes *from, const int *partner, int begin)
{
    to->layer[to->count] = from->layer[begin / 2];
    to->count++;
    to->start[to->count] = to->start[to->count - 1];
    add_nodes(to, from, begin, -1);
    int end = begin ^ 1;
    for (; partner[end] >= 0 && partner[end] != begin; end = partner[end] ^ 1)
        add_nodes(to, from, partner[end], end);
    if (partner[end] == begin) close_ring(to, from, end, begin);
}

static Vec2 home(const SplinePage *page)
{
    return (Vec2){-page->left / page->unit, -page->top / page->unit};
}

static int layer_count(const Strokes *strokes)
{
    int count = 0;
    for (int k = 0; k < strokes->count; k++)
        if (strokes->layer[k] >= count) count = strokes->layer[k] + 1;
    return count;
}

/* Adds the chains of a layer in a good order; false where work ended the search for it. */
static bool add_layer(Strokes *to, const Strokes *from, const int *partner, const Chain *chains, int count,
                      Vec2 start, long work)
{
    Vec2 *ends = mem_alloc(2 * (size_t)count, sizeof *ends);
    int *tour = mem_alloc((size_t)count, sizeof *tour);
    for (int k = 0; k < count; k++) {
        memcpy(ends + 2 * k, chains[k].ends, sizeof chains[k].ends);
        tour[k] = 2 * k;
    }
    bool whole = tour_shorten(ends, count, start, work, tour);
    for (int k = 0; k < count; k++) add_chain(to, from, partner, chains[tour[k] / 2].begin[tour[k] & 1]);
    mem_free(ends);
    mem_free(tour);
    return whole;
}

static Strokes arrange(const Strokes *from, const SplinePage *page, const int *partner, long work,
                       bool *whole)
{
    size_t count = (size_t)from->count;
    Chain *chains = mem_alloc(count, sizeof *chains), *of_layer = mem_alloc(count, sizeof *of_layer);
    int all = find_chains(from, partner, chains);
    Strokes to = {.start = mem_alloc((size_t)all + 1, sizeof(int)),
                  .layer = mem_alloc((size_t)all, sizeof(int)),
                  .q = mem_alloc(4 * (size_t)strokes_node_count(from), sizeof(double))};
    *whole = true;
    for (int layer = 0; layer < layer_count(from); layer++) {
        int of = 0;
        for (int k = 0; k < all; k++)
            if (chains[k].layer == layer) of_layer[of++] = chains[k];
        *whole &= of == 0 || add_layer(&to, from, partner, of_layer, of, home(page), work);
    }
    mem_free(chains);
    mem_free(of_layer);
    return to;
}

double order_travel(const Strokes *strokes, const SplinePage *page)
{
    double travel = 0;
    for (int layer = 0; layer < layer_count(strokes); layer++) {
        Vec2 at = home(page);
        for (int k = 0; k < strokes->count; k++) {
            if (strokes->layer[k] != layer) continue;
            travel += distance(at, join_end(strokes, 2 * k));
            at = join_end(strokes, 2 * k + 1);
        }
        travel += distance(at, home(page));
    }
    return travel;
}

OrderInfo order_strokes(Strokes *strokes, const SplinePage *page, OrderDef def)
{
    OrderInfo info = {.before = order_travel(strokes, page)};
    int *partner = mem_alloc(2 * (size_t)strokes->count, sizeof *partner);
    info.joints =
        join_find(strokes, (JoinDef){def.join_gap * page->pen, def.join_angle, def.outline, page}, partner);
    Strokes ordered = arrange(strokes, page, partner, def.work, &info.whole);
    info.after = order_travel(&ordered, page);
    if (info.after > info.before) { /* as good as never: a joint has led the pen astray */
        strokes_clear(&ordered);
        for (int e = 0; e < 2 * strokes->count; e++) partner[e] = -1;
        info.joints = 0;
        ordered = arrange(strokes, page, partner, def.work, &info.whole);
        info.after = order_travel(&ordered, page);
    }
    mem_free(partner);
    strokes_clear(strokes);
    *strokes = ordered;
    return info;
}
