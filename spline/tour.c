#include "spline/tour.h"
#include "base/memory.h"
#include "spline/near.h"
#include <string.h>

enum { NEIGHBOURS = 16, OR_LINES = 3 };

static double distance(Vec2 a, Vec2 b)
{
    return sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

double tour_travel(const Vec2 *ends, int count, Vec2 home, const int *tour)
{
    double travel = 0;
    Vec2 at = home;
    for (int k = 0; k < count; k++) {
        travel += distance(at, ends[tour[k]]);
        at = ends[tour[k] ^ 1];
    }
    return travel + distance(at, home);
}

static Near *near_ends(const Vec2 *end, const int *which, int count)
{
    Vec2 *points = mem_alloc((size_t)count, sizeof *points);
    int *group = mem_alloc((size_t)count, sizeof *group);
    for (int k = 0; k < count; k++) {
        points[k] = end[which[k]];
        group[k] = which[k] >> 1;
    }
    Near *near = near_create(points, group, count);
    mem_free(points);
    mem_free(group);
    return near;
}

/* The grid is made anew whenever half of its points are gone, so that searches stay short. */
static void tour_greedy(const Vec2 *end, int count, Vec2 home, int *tour)
{
    int *left = mem_alloc(2 * (size_t)count, sizeof *left), lefts = 0;
    int *slot = mem_alloc(2 * (size_t)count, sizeof *slot); /* of an end in `left` */
    bool *drawn = mem_alloc((size_t)count, sizeof *drawn);
    Near *near = NULL;
    Vec2 at = home;
    for (int k = 0, next = 0; k < count; k++) {
        if (k == next) {
            lefts = 0;
            for (int e = 0; e < 2 * count; e++) {
                if (drawn[e >> 1]) continue;
                slot[e] = lefts;
                left[lefts++] = e;
            }
            near_destroy(near);
            near = near_ends(end, left, lefts);
            next = k + (count - k + 1) / 2;
        }
        int found;
        near_find(near, at, -1, INFINITY, 1, &found);
        tour[k] = left[found];
        drawn[tour[k] >> 1] = true;
        near_remove(near, slot[tour[k]]);
        near_remove(near, slot[tour[k] ^ 1]);
        at = end[tour[k] ^ 1];
    }
    near_destroy(near);
    mem_free(left);
    mem_free(slot);
    mem_free(drawn);
}

/* A closed way: home is the last line, with both ends at the same place. */
typedef struct Way {
    const Vec2 *end;
    int count;       /* of lines, home included */
    int *at;         /* [count] the end where the k-th line begins */
    int *place;      /* [count] k of a line */
    int *neighbours; /* [2 count][NEIGHBOURS], -1: none */
    int *queue;      /* [2 count] ends to be tried, a ring */
    bool *queued;    /* [2 count] */
    int first, waiting;
    long work;
} Way;

static int wrap(const Way *way, int k)
{
    return k < 0 ? k + way->count : k >= way->count ? k - way->count : k;
}

static void put(Way *way, int k, int end)
{
    way->at[k] = end;
    way->place[end >> 1] = k;
}

static bool begins(const Way *way, int end)
{
    return way->at[way->place[end >> 1]] == end;
}

/* The end from which, or to which, the lifted pen moves. */
static int partner(const Way *way, int end)
{
    int k = way->place[end >> 1];
    return way->at[k] == end ? way->at[wrap(way, k - 1)] ^ 1 : way->at[wrap(way, k + 1)];
}

static double gap(const Way *way, int a, int b)
{
    return distance(way->end[a], way->end[b]);
}

static void enqueue(Way *way, int end)
{
    if (way->queued[end]) return;
    int last = way->first + way->waiting;
    way->queued[end] = true;
    way->queue[last < 2 * way->count ? last : last - 2 * way->count] = end;
    way->waiting++;
}

static int dequeue(Way *way)
{
    int end = way->queue[way->first];
    way->first = way->first + 1 < 2 * way->count ? way->first + 1 : 0;
    way->waiting--;
    way->queued[end] = false;
    return end;
}

/* Turns the lines from place i to place j (both included, onwards), or all the others, which is the same way.
 */
static void turn(Way *way, int i, int j)
{
    int inside = wrap(way, j - i) + 1;
    if (2 * inside > way->count) {
        int swap = i;
        i = wrap(way, j + 1);
        j = wrap(way, swap - 1);
        inside = way->count - inside;
    }
    way->work -= inside;
    for (int k = 0; k < (inside + 1) / 2; k++) {
        int front = way->at[i] ^ 1, back = way->at[j] ^ 1;
        put(way, i, back);
        put(way, j, front);
        i = wrap(way, i + 1);
        j = wrap(way, j - 1);
    }
}

/* Moves the `lines` lines from place i on to between the places k and k + 1, turned round or not. Those in
 * between give way, on the side where there are fewer. */
static void move(Way *way, int i, int lines, int k, bool turned)
{
    int moved[OR_LINES], before = wrap(way, i - 1 - k), after = wrap(way, k - (i + lines - 1));
    for (int l = 0; l < lines; l++) moved[l] = way->at[wrap(way, i + l)];
    int from = after < before ? wrap(way, i + lines) : wrap(way, i - 1);
    int to = after < before ? i : wrap(way, i + lines - 1), step = after < before ? 1 : -1;
    int count = after < before ? after : before;
    way->work -= count;
    for (; count > 0; count--) {
        put(way, to, way->at[from]);
        to = wrap(way, to + step);
        from = wrap(way, from + step);
    }
    int begin = after < before ? to : wrap(way, to - lines + 1);
    for (int l = 0; l < lines; l++)
        put(way, wrap(way, begin + l), turned ? moved[lines - 1 - l] ^ 1 : moved[l]);
}

/* e - f and g - h become e - g and f - h. */
static void apply_two_opt(Way *way, int e, int g)
{
    int i = way->place[e >> 1], j = way->place[g >> 1];
    if (begins(way, e))
        turn(way, i, wrap(way, j - 1));
    else
        turn(way, wrap(way, i + 1), j);
}

/* The part of `lines` lines that begins with end g moves to between e and its partner, g next to e. */
static void apply_or_opt(Way *way, int e, int g, int lines)
{
    bool onwards = begins(way, g), before = begins(way, e);
    int i = way->place[g >> 1], k = way->place[e >> 1];
    move(way, onwards ? i : wrap(way, i - lines + 1), lines, before ? wrap(way, k - 1) : k,
         onwards == before);
}

/* Tries to bring the part that begins with g to e, whose partner f is d away. */
static bool try_or_opt(Way *way, int e, int f, int g, double d)
{
    int h = partner(way, g), z = g ^ 1;
    for (int lines = 1; lines <= OR_LINES && lines < way->count - 2; lines++) {
        if (z >> 1 == e >> 1 || z >> 1 == f >> 1) return false;
        int y = partner(way, z);
        double gain = d + gap(way, g, h) + gap(way, z, y) - gap(way, e, g) - gap(way, z, f) - gap(way, h, y);
        if (gain > 1e-12 * d) {
            int touched[6] = {e, f, g, h, y, z};
            apply_or_opt(way, e, g, lines);
            for (int t = 0; t < 6; t++) enqueue(way, touched[t]);
            return true;
        }
        z = y ^ 1;
    }
    return false;
}

static bool try_two_opt(Way *way, int e, int f, int g, double d)
{
    int h = partner(way, g);
    if (begins(way, e) != begins(way, g)) return false;
    double gain = d + gap(way, g, h) - gap(way, e, g) - gap(way, f, h);
    if (!(gain > 1e-12 * d)) return false;
    apply_two_opt(way, e, g);
    int touched[4] = {e, f, g, h};
    for (int t = 0; t < 4; t++) enqueue(way, touched[t]);
    return true;
}

static bool improve(Way *way, int e)
{
    int f = partner(way, e);
    double d = gap(way, e, f);
    for (int k = 0; k < NEIGHBOURS; k++) {
        int g = way->neighbours[NEIGHBOURS * e + k];
        if (g < 0 || !(gap(way, e, g) < d)) break;
        if (g == f) continue;
        way->work--;
        if (try_two_opt(way, e, f, g, d) || try_or_opt(way, e, f, g, d)) return true;
    }
    return false;
}

static void find_neighbours(Way *way)
{
    int *all = mem_alloc(2 * (size_t)way->count, sizeof *all);
    for (int e = 0; e < 2 * way->count; e++) all[e] = e;
    Near *near = near_ends(way->end, all, 2 * way->count);
    for (int e = 0; e < 2 * way->count; e++) {
        int *found = way->neighbours + NEIGHBOURS * e;
        for (int k = near_find(near, way->end[e], e >> 1, INFINITY, NEIGHBOURS, found); k < NEIGHBOURS; k++)
            found[k] = -1;
    }
    near_destroy(near);
    mem_free(all);
}

/* Improves until nothing is left or work is used up. */
static bool way_improve(Way *way)
{
    for (int k = 0; k < way->count; k++) {
        enqueue(way, way->at[k]);
        enqueue(way, way->at[k] ^ 1);
    }
    while (way->waiting && way->work > 0) {
        int e = dequeue(way);
        while (way->work > 0 && improve(way, e)) continue;
    }
    return way->waiting == 0;
}

/* end[] has home as the last of the lines; tour[] does without it. */
static bool tour_improve(const Vec2 *end, int lines, long work, int *tour)
{
    size_t count = (size_t)lines;
    Way way = {.end = end,
               .count = lines,
               .at = mem_alloc(count, sizeof(int)),
               .place = mem_alloc(count, sizeof(int)),
               .neighbours = mem_alloc(2 * count * NEIGHBOURS, sizeof(int)),
               .queue = mem_alloc(2 * count, sizeof(int)),
               .queued = mem_alloc(2 * count, sizeof(bool)),
               .work = work};
    for (int k = 0; k < lines; k++) put(&way, k, k < lines - 1 ? tour[k] : 2 * k);
    find_neighbours(&way);
    bool whole = way_improve(&way);

    int home = way.place[lines - 1]; /* turned round, the way runs backwards */
    bool backwards = way.at[home] & 1;
    for (int k = 0; k < lines - 1; k++)
        tour[k] = backwards ? way.at[wrap(&way, home - 1 - k)] ^ 1 : way.at[wrap(&way, home + 1 + k)];
    mem_free(way.at);
    mem_free(way.place);
    mem_free(way.neighbours);
    mem_free(way.queue);
    mem_free(way.queued);
    return whole;
}

bool tour_shorten(const Vec2 *ends, int count, Vec2 home, long work, int *tour)
{
    size_t lines = (size_t)count + 1;
    int *greedy = mem_alloc(lines, sizeof *greedy);
    Vec2 *end = mem_alloc(2 * lines, sizeof *end);
    if (count) memcpy(end, ends, 2 * (size_t)count * sizeof *end);
    end[2 * count] = end[2 * count + 1] = home;
    tour_greedy(end, count, home, greedy);
    double before = tour_travel(ends, count, home, tour);
    if (tour_travel(ends, count, home, greedy) < before) memcpy(tour, greedy, (size_t)count * sizeof *tour);
    bool whole = tour_improve(end, count + 1, work, tour);
    mem_free(greedy);
    mem_free(end);
    return whole;
}
