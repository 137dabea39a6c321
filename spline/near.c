#include "spline/near.h"
#include "base/memory.h"
#include <stdbool.h>

enum { NEAR_MOST = 64 };

struct Near {
    int count, columns, rows;
    Vec2 low;
    double cell;
    Vec2 *points;
    int *group;
    int *first;  /* [cells + 1] where a cell's points begin in `inside` */
    int *alive;  /* [cells] how many of them have not been removed; these come first */
    int *inside; /* [count] points by cell */
    int *place;  /* [count] where a point is in `inside` */
};

static int clamp(double cell, int cells)
{
    return (int)fmax(0, fmin(cell, cells - 1));
}

static int cell_of(const Near *near, Vec2 p)
{
    int i = clamp((p.x - near->low.x) / near->cell, near->columns);
    int j = clamp((p.y - near->low.y) / near->cell, near->rows);
    return j * near->columns + i;
}

/* Two points per cell on the average, also where all are near a line. */
static void fit_cells(Near *near)
{
    Vec2 low = near->count ? near->points[0] : (Vec2){0, 0}, high = low;
    for (int k = 1; k < near->count; k++) {
        Vec2 p = near->points[k];
        low = (Vec2){fmin(low.x, p.x), fmin(low.y, p.y)};
        high = (Vec2){fmax(high.x, p.x), fmax(high.y, p.y)};
    }
    double width = high.x - low.x, height = high.y - low.y, longer = fmax(width, height);
    double count = fmax(1, near->count), cell = fmax(sqrt(2 * width * height / count), 2 * longer / count);
    near->low = low;
    near->cell = cell > 0 ? cell : 1;
    near->columns = 1 + (int)(width / near->cell);
    near->rows = 1 + (int)(height / near->cell);
}

Near *near_create(const Vec2 *points, const int *group, int count)
{
    Near *near = mem_alloc(1, sizeof *near);
    near->count = count;
    near->points = mem_copy(points, (size_t)count, sizeof *points);
    near->group = mem_copy(group, (size_t)count, sizeof *group);
    fit_cells(near);
    size_t cells = (size_t)near->columns * (size_t)near->rows;
    near->first = mem_alloc(cells + 1, sizeof(int));
    near->alive = mem_alloc(cells, sizeof(int));
    near->inside = mem_alloc((size_t)count, sizeof(int));
    near->place = mem_alloc((size_t)count, sizeof(int));
    for (int k = 0; k < count; k++) near->first[cell_of(near, points[k]) + 1]++;
    for (size_t c = 0; c < cells; c++) near->first[c + 1] += near->first[c];
    for (int k = 0; k < count; k++) {
        int c = cell_of(near, points[k]);
        near->place[k] = near->first[c] + near->alive[c]++;
        near->inside[near->place[k]] = k;
    }
    return near;
}

void near_destroy(Near *near)
{
    if (!near) return;
    mem_free(near->points);
    mem_free(near->group);
    mem_free(near->first);
    mem_free(near->alive);
    mem_free(near->inside);
    mem_free(near->place);
    mem_free(near);
}

void near_remove(Near *near, int point)
{
    int c = cell_of(near, near->points[point]), last = near->first[c] + near->alive[c] - 1;
    int at = near->place[point], moved = near->inside[last];
    if (at > last) return;
    near->inside[at] = moved;
    near->place[moved] = at;
    near->inside[last] = point;
    near->place[point] = last;
    near->alive[c]--;
}

/* What has been found so far. */
typedef struct Search {
    const Near *near;
    Vec2 at;
    int skip, most, count;
    int *found;
    double square[NEAR_MOST]; /* of the distances */
    double reach;             /* square of the distance from which on nothing is wanted */
} Search;

static void search_cell(Search *search, int cell)
{
    const Near *near = search->near;
    for (int k = near->first[cell]; k < near->first[cell] + near->alive[cell]; k++) {
        int point = near->inside[k], slot = search->count;
        double dx = near->points[point].x - search->at.x, dy = near->points[point].y - search->at.y;
        double square = dx * dx + dy * dy;
        if (square > search->reach || near->group[point] == search->skip) continue;
        if (slot == search->most) slot--;
        if (slot < search->count && (square > search->square[slot] ||
                                     (square == search->square[slot] && point > search->found[slot])))
            continue;
        for (; slot > 0 && (square < search->square[slot - 1] ||
                            (square == search->square[slot - 1] && point < search->found[slot - 1]));
             slot--) {
            search->square[slot] = search->square[slot - 1];
            search->found[slot] = search->found[slot - 1];
        }
        search->square[slot] = square;
        search->found[slot] = point;
        if (search->count < search->most) search->count++;
        if (search->count == search->most) search->reach = search->square[search->most - 1];
    }
}

/* The cells that are `ring` steps away; false where all of these are outside. */
static bool search_ring(Search *search, int i, int j, int ring)
{
    int columns = search->near->columns, rows = search->near->rows;
    int top = j - ring, bottom = j + ring, left = i - ring, right = i + ring;
    if (top < 0 && bottom >= rows && left < 0 && right >= columns) return false;
    for (int r = top < 0 ? 0 : top; r <= (bottom < rows ? bottom : rows - 1); r++) {
        bool whole = r == top || r == bottom;
        int step = whole || ring == 0 ? 1 : right - left;
        for (int c = left; c <= right; c += step)
            if (c >= 0 && c < columns) search_cell(search, r * columns + c);
    }
    return true;
}

int near_find(const Near *near, Vec2 at, int skip, double reach, int most, int *found)
{
    Search search = {.near = near,
                     .at = at,
                     .skip = skip,
                     .most = most < NEAR_MOST ? most : NEAR_MOST,
                     .found = found,
                     .reach = reach * reach};
    /* Seen from the nearest point of the grid everything in it is as near or nearer. */
    double x = fmin(fmax((at.x - near->low.x) / near->cell, 0), near->columns);
    double y = fmin(fmax((at.y - near->low.y) / near->cell, 0), near->rows);
    int i = clamp(x, near->columns), j = clamp(y, near->rows);
    double inside = fmin(fmin(x - i, i + 1 - x), fmin(y - j, j + 1 - y));
    for (int ring = 0; search_ring(&search, i, j, ring); ring++) {
        double seen = near->cell * (ring + inside);
        if (seen > 0 && seen * seen > search.reach) break;
    }
    return search.count;
}
