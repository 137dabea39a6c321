/* The distance of a cloud of points to the body's line. */
#include "base/memory.h"
#include "optim/objectives.h"
#include "optim/segment.h"
#include <string.h>

typedef struct CloudSelf {
    int segment_count, point_count;
    int (*segments)[2];
    double (*points)[3];
    bool axes[3]; /* that count */
    double blend;
} CloudSelf;

/* Where a segment stands with respect to a point of the cloud. */
typedef struct Near {
    Vec3 d, t; /* from_segment */
    double part, d2;
} Near;

/* What lies farther than that many squares of the blend beyond the nearest segment has no weight in double precision. */
static const double NO_WEIGHT = 40;

static Vec3 seen(const CloudSelf *self, const double *x)
{
    return vec3(self->axes[0] ? x[0] : 0, self->axes[1] ? x[1] : 0, self->axes[2] ? x[2] : 0);
}

static Near near_segment(const CloudSelf *self, int s, Vec3 q, const double *x)
{
    Near near;
    const int *v = self->segments[s];
    near.d = from_segment(seen(self, x + 3 * v[0]), seen(self, x + 3 * v[1]), q, &near.t, &near.part);
    near.d2 = vec3_dot(near.d, near.d);
    return near;
}

/* Of one point of the cloud: all segments, and those that count, with their weights, which add up to 1. */
typedef struct Work {
    Near *near; /* [segment_count] */
    int *list, count;
    double *weights; /* [count] */
} Work;

static Work work_of(const CloudSelf *self)
{
    size_t count = (size_t)self->segment_count;
    return (Work){.near = mem_alloc(count, sizeof(Near)),
                  .list = mem_alloc(count, sizeof(int)),
                  .weights = mem_alloc(count, sizeof(double))};
}

static void work_free(Work *work)
{
    mem_free(work->near);
    mem_free(work->list);
    mem_free(work->weights);
}

/* The squared distance of a point to the nearest segment, blended with those that are nearly as near. */
static double blended(const CloudSelf *self, Vec3 q, const double *x, Work *work)
{
    double least = INFINITY, b2 = self->blend * self->blend, sum = 0, mean = 0;
    for (int s = 0; s < self->segment_count; s++) {
        work->near[s] = near_segment(self, s, q, x);
        least = fmin(least, work->near[s].d2);
    }
    work->count = 0;
    for (int s = 0; s < self->segment_count; s++) {
        double d2 = work->near[s].d2;
        if (d2 - least > NO_WEIGHT * b2) continue;
        double w = exp((least - d2) / b2);
        work->weights[work->count] = w, work->list[work->count++] = s;
        sum += w, mean += w * d2;
    }
    for (int k = 0; k < work->count; k++) work->weights[k] /= sum;
    return mean / sum;
}

/* Adds -amount g to the ends of a segment, as its nearest point is made of them. */
static void take_from_ends(const int v[2], double part, double amount, Vec3 g, double *dx)
{
    for (int end = 0; end < 2; end++) {
        double *to = dx + 3 * v[end], factor = amount * (end ? part : 1 - part);
        to[0] -= factor * g.x, to[1] -= factor * g.y, to[2] -= factor * g.z;
    }
}

static double cloud_value(const void *object, double weight, const double *x, const double *p, double *dx,
                          double *dp)
{
    (void)p, (void)dp;
    const CloudSelf *self = object;
    Work work = work_of(self);
    double sum = 0, b2 = self->blend * self->blend;
    for (int k = 0; k < self->point_count; k++) {
        double mean = blended(self, seen(self, self->points[k]), x, &work);
        sum += mean;
        for (int i = 0; dx && i < work.count; i++) {
            int s = work.list[i];
            const Near *near = &work.near[s];
            double part = work.weights[i] * (1 - (near->d2 - mean) / b2);
            take_from_ends(self->segments[s], near->part, 2 * weight * part, near->d, dx);
        }
    }
    work_free(&work);
    return sum;
}

/* Residuals are the distances to the segments that count, each times the root of its weight, which is held: the nearest
 * point's motion along a segment that it is inside of changes no distance. */
static void cloud_product(const void *object, double weight, const double *x, const double *p,
                          const double *vx, const double *vp, double *hx, double *hp)
{
    (void)p, (void)vp, (void)hp;
    const CloudSelf *self = object;
    Work work = work_of(self);
    for (int k = 0; k < self->point_count; k++) {
        blended(self, seen(self, self->points[k]), x, &work);
        for (int i = 0; i < work.count; i++) {
            const Near *near = &work.near[work.list[i]];
            const int *v = self->segments[work.list[i]];
            Vec3 moved = vec3_axpy(near->part, seen(self, vx + 3 * v[1]),
                                   vec3_scale(1 - near->part, seen(self, vx + 3 * v[0])));
            moved = vec3_axpy(-vec3_dot(near->t, moved), near->t, moved);
            take_from_ends(v, near->part, -2 * weight * work.weights[i], moved, hx);
        }
    }
    work_free(&work);
}

static void cloud_destroy(void *object)
{
    CloudSelf *self = object;
    mem_free(self->segments);
    mem_free(self->points);
    mem_free(self);
}

static const ObjectiveOps cloud_ops = {"target", cloud_value, cloud_product, cloud_destroy};

Objective objective_cloud(const PointCloud *cloud, double weight)
{
    CloudSelf *self = mem_alloc(1, sizeof *self);
    *self = (CloudSelf){
        .segment_count = cloud->segment_count, .point_count = cloud->point_count, .blend = cloud->blend};
    self->segments = mem_copy(cloud->segments, (size_t)cloud->segment_count, sizeof *cloud->segments);
    self->points = mem_copy(cloud->points, (size_t)cloud->point_count, sizeof *cloud->points);
    for (int i = 0; i < 3; i++) self->axes[i] = !isnan(cloud->points[0][i]);
    return (Objective){&cloud_ops, self, weight, 0, 0};
}
