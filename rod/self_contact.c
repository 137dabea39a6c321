#include "rod/self_contact.h"
#include "base/memory.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static double clamp(double a)
{
    return a < 0 ? 0 : a > 1 ? 1 : a;
}

/* [Ericson 2005, 5.1.9]; the cross product loses no digits where the segments are almost parallel. */
double rod_segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1)
{
    Vec3 u = vec3_sub(a1, a0), v = vec3_sub(b1, b0), r = vec3_sub(a0, b0), across = vec3_cross(u, v);
    double uu = vec3_dot(u, u), vv = vec3_dot(v, v), uv = vec3_dot(u, v), area2 = vec3_dot(across, across);
    double ur = vec3_dot(u, r), vr = vec3_dot(v, r);
    double s = area2 > 0 ? clamp(vec3_dot(vec3_cross(v, r), across) / area2) : 0;
    double t = vv > 0 ? (uv * s + vr) / vv : 0;
    if (!(t >= 0 && t <= 1) || vv == 0) {
        t = clamp(t);
        s = uu > 0 ? clamp((uv * t - ur) / uu) : 0;
    }
    return vec3_length(vec3_axpy(s, u, vec3_axpy(-t, v, r)));
}

typedef struct Cell {
    int x, y, z;
} Cell;

/* Consecutive segments in chunks about as long as the distance; chunks in chains by the hash of the cell of
 * their middle node. Two chunks with points nearer than the distance are in neighbouring cells. */
typedef struct Grid {
    const Vec3 *x;
    int segments, size, chunks; /* size: segments in a chunk */
    double longest, cell;
    Cell *cells; /* [chunks] */
    uint32_t mask;
    int *head, *next; /* [mask + 1], [chunks]; -1 ends a chain */
} Grid;

/* [Teschner 2003], with the high bits mixed into the low ones */
static uint32_t bucket(const Grid *grid, Cell c)
{
    uint32_t hash = (uint32_t)c.x * 73856093u ^ (uint32_t)c.y * 19349663u ^ (uint32_t)c.z * 83492791u;
    return (hash ^ hash >> 15) & grid->mask;
}

static Cell cell_of(const Grid *grid, int chunk)
{
    int first = chunk * grid->size, middle = first + grid->size / 2;
    Vec3 x = vec3_sub(grid->x[middle < grid->segments ? middle : grid->segments], grid->x[0]);
    return (Cell){(int)floor(x.x / grid->cell), (int)floor(x.y / grid->cell), (int)floor(x.z / grid->cell)};
}

static Grid grid_create(const Vec3 *x, int segments, double distance, double longest)
{
    Grid grid = {.x = x, .segments = segments, .size = 1, .longest = longest, .mask = 1};
    if (distance > longest) grid.size = distance < segments * longest ? (int)(distance / longest) : segments;
    grid.chunks = (segments + grid.size - 1) / grid.size;
    grid.cell = distance + (grid.size + 1) * longest;
    while (grid.mask < (uint32_t)grid.chunks) grid.mask = 2 * grid.mask + 1;
    grid.cells = mem_alloc((size_t)grid.chunks, sizeof *grid.cells);
    grid.next = mem_alloc((size_t)grid.chunks, sizeof *grid.next);
    grid.head = mem_alloc((size_t)grid.mask + 1, sizeof *grid.head);
    memset(grid.head, -1, ((size_t)grid.mask + 1) * sizeof *grid.head);
    for (int c = 0; c < grid.chunks; c++) {
        grid.cells[c] = cell_of(&grid, c);
        int *head = &grid.head[bucket(&grid, grid.cells[c])];
        grid.next[c] = *head;
        *head = c;
    }
    return grid;
}

static void grid_clear(Grid *grid)
{
    mem_free(grid->cells);
    mem_free(grid->next);
    mem_free(grid->head);
}

static int by_number(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* The chunk and those after it in the cells around, ascending. Returns how many. */
static int chunks_near(const Grid *grid, int chunk, int *found)
{
    int count = 0;
    Cell own = grid->cells[chunk];
    for (int k = 0; k < 27; k++) {
        Cell cell = {own.x + k % 3 - 1, own.y + k / 3 % 3 - 1, own.z + k / 9 - 1};
        /* Chains descend. */
        for (int c = grid->head[bucket(grid, cell)]; c >= chunk; c = grid->next[c]) {
            Cell other = grid->cells[c];
            if (other.x == cell.x && other.y == cell.y && other.z == cell.z) found[count++] = c;
        }
    }
    qsort(found, (size_t)count, sizeof *found, by_number);
    return count;
}

typedef struct Search {
    double distance;
    int room; /* in the list */
    RodContacts *contacts;
} Search;

static void keep(Search *search, RodContact contact, bool same_pass)
{
    RodContacts *c = search->contacts;
    if (contact.distance < c->nearest.distance) c->nearest = contact;
    if (same_pass) {
        if (contact.distance < c->list[c->count - 1].distance) c->list[c->count - 1] = contact;
        return;
    }
    if (c->count == search->room) {
        int room = 2 * search->room + 64;
        c->list = mem_resize(c->list, (size_t)search->room, (size_t)room, sizeof *c->list);
        search->room = room;
    }
    c->list[c->count++] = contact;
}

/* Segment e1 against those from first on in the chunks. */
static void search_from(Search *search, const Grid *grid, int e1, int first, const int *chunks, int count)
{
    const Vec3 *x = grid->x;
    int last = -1; /* segment of the present pass */
    for (int i = 0; i < count; i++) {
        int e2 = chunks[i] * grid->size, end = e2 + grid->size;
        if (e2 < first) e2 = first;
        while (e2 < end && e2 < grid->segments) {
            double d = rod_segment_distance(x[e1], x[e1 + 1], x[e2], x[e2 + 1]);
            if (d < search->distance) {
                keep(search, (RodContact){e1, e2, d}, e2 == last + 1);
                last = e2++;
            } else /* from one to the next the distance falls by no more than a segment's length */
                e2 += 1 + (int)fmin((d - search->distance) / grid->longest, grid->size);
        }
    }
}

static void search_all(Search *search, const Grid *grid, const double *s)
{
    int *near = mem_alloc((size_t)grid->chunks, sizeof *near), far = 0;
    for (int c = 0; c < grid->chunks; c++) {
        int found = chunks_near(grid, c, near), end = (c + 1) * grid->size;
        for (int e1 = c * grid->size; e1 < end && e1 < grid->segments; e1++) {
            while (far < grid->segments && s[far] - s[e1 + 1] < M_PI / 2 * search->distance) far++;
            search_from(search, grid, e1, far, near, found);
        }
    }
    mem_free(near);
}

RodContacts rod_self_contacts(const Vec3 *x, int count, double distance)
{
    RodContacts contacts = {.nearest = {-1, -1, INFINITY}};
    double longest = 0, *s = mem_alloc((size_t)count + 1, sizeof *s); /* arclength of the nodes */
    for (int e = 0; e < count - 1; e++) {
        double length = vec3_length(vec3_sub(x[e + 1], x[e]));
        s[e + 1] = s[e] + length;
        longest = fmax(longest, length);
    }
    if (longest > 0 && distance > 0) {
        Grid grid = grid_create(x, count - 1, distance, longest);
        search_all(&(Search){distance, 0, &contacts}, &grid, s);
        grid_clear(&grid);
    }
    mem_free(s);
    return contacts;
}

void rod_contacts_clear(RodContacts *contacts)
{
    mem_free(contacts->list);
    *contacts = (RodContacts){0};
}
