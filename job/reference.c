#include "job/reference.h"
#include "base/memory.h"
#include "optim/objectives.h"
#include <string.h>

/* Rows of objectives of points, and the points that they follow, each once. */
typedef struct Reference {
    int count, frames, followed_count, point_count;
    const Objective **rows; /* [count] */
    int *follows;           /* [count] which point */
    double *followed;       /* [followed_count][frames][3] */
    int *offsets;           /* [count + 1] into points */
    double (*points)[3];
} Reference;

static void find_rows(Reference *ref, const Case *c, Trajectory *t)
{
    double q[3];
    ref->rows = mem_alloc((size_t)c->objective_count, sizeof(Objective *));
    for (int k = 0; k < c->objective_count; k++)
        if (objective_point(&c->objectives[k], trajectory_frame(t, 0).x, trajectory_params(t, 0), q))
            ref->rows[ref->count++] = &c->objectives[k];
}

/* The way of row k's point: that of an earlier row, if it is the same. */
static void follow(Reference *ref, Trajectory *t, int k)
{
    size_t numbers = 3 * (size_t)ref->frames, known = (size_t)ref->followed_count;
    ref->followed = mem_resize(ref->followed, known * numbers, (known + 1) * numbers, sizeof(double));
    double *way = ref->followed + known * numbers;
    for (int n = 0; n < ref->frames; n++)
        objective_point(ref->rows[k], trajectory_frame(t, n).x, trajectory_params(t, n), way + 3 * n);
    int point = 0;
    while (memcmp(ref->followed + (size_t)point * numbers, way, numbers * sizeof *way)) point++;
    if (point == ref->followed_count) ref->followed_count++;
    ref->follows[k] = point;
}

static void add_points(Reference *ref, int k)
{
    int count;
    double(*points)[3] = objective_reference(ref->rows[k], &count);
    size_t old = (size_t)ref->point_count, more = (size_t)count;
    ref->points = mem_resize(ref->points, old, old + more, sizeof *points);
    memcpy(ref->points + old, points, more * sizeof *points);
    ref->offsets[k + 1] = ref->point_count += count;
    mem_free(points);
}

/* What each row is, at which frames it counts, and how far its point is away. */
static void add_rows(const Reference *ref, Trajectory *t, Arrays *list)
{
    char *names = mem_text("");
    int *frames = arrays_keep(list, mem_alloc(2 * (size_t)ref->count, sizeof *frames));
    double *distance = arrays_numbers(list, (size_t)ref->count * (size_t)ref->frames);
    for (int k = 0; k < ref->count; k++) {
        names = mem_join(names, ref->rows[k]->ops->name, "\n");
        frames[2 * k] = ref->rows[k]->first, frames[2 * k + 1] = ref->rows[k]->last;
        for (int n = 0; n < ref->frames; n++)
            distance[k * ref->frames + n] =
                objective_distance(ref->rows[k], trajectory_frame(t, n).x, trajectory_params(t, n));
    }
    arrays_add(list, array_text("trajectory/reference/names", arrays_keep(list, names)));
    arrays_add(list, array_int("trajectory/reference/frames", frames, 2, ref->count, 2));
    arrays_add(list, array_float("trajectory/reference/distance", "m", distance, 2, ref->count, ref->frames));
}

void reference_add(const Case *c, Trajectory *t, int steps, Arrays *list)
{
    Reference ref = {.frames = steps + 1};
    find_rows(&ref, c, t);
    ref.follows = arrays_keep(list, mem_alloc((size_t)ref.count, sizeof(int)));
    ref.offsets = arrays_keep(list, mem_alloc((size_t)ref.count + 1, sizeof(int)));
    for (int k = 0; k < ref.count; k++) {
        follow(&ref, t, k);
        add_points(&ref, k);
    }
    arrays_keep(list, ref.followed);
    arrays_keep(list, ref.points);
    if (ref.count > 0) {
        Array followed =
            array_float("trajectory/followed", "m", ref.followed, 3, ref.followed_count, ref.frames);
        followed.dims[2] = 3;
        arrays_add(list, followed);
        arrays_add(list, array_int("trajectory/reference/follows", ref.follows, 1, ref.count, 0));
        arrays_add(list, array_int("trajectory/reference/offsets", ref.offsets, 1, ref.count + 1, 0));
        arrays_add(list,
                   array_float("trajectory/reference/points", "m", ref.points[0], 2, ref.point_count, 3));
        add_rows(&ref, t, list);
    }
    mem_free(ref.rows);
}
