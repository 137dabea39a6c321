/* Objectives of one point of the body: waypoints and distances to curves. */
#include "base/memory.h"
#include "base/vec3.h"
#include "optim/objectives.h"
#include "optim/segment.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct Tracked {
    Probe probe;
    double at[3]; /* waypoint */
    int point_count;
    double (*points)[3]; /* polyline */
    double blend;
    Vec3 center, e1, e2, axis; /* arc: e1 to its start, e2 ahead of it */
    double radius, angle;      /* ... from e1 towards e2               */
} Tracked;

/* ---- Waypoint ---- */

static double waypoint_value(const void *self, double weight, const double *x, const double *p, double *dx,
                             double *dp)
{
    const Tracked *tracked = self;
    Vec3 d = vec3_sub(probe_at(&tracked->probe, x, p), vec3_load(tracked->at));
    if (dx) probe_pull(&tracked->probe, x, p, vec3_scale(2 * weight, d), dx, dp);
    return vec3_dot(d, d);
}

static void waypoint_product(const void *self, double weight, const double *x, const double *p,
                             const double *vx, const double *vp, double *hx, double *hp)
{
    const Probe *probe = &((const Tracked *)self)->probe;
    probe_pull(probe, x, p, vec3_scale(2 * weight, probe_change(probe, x, p, vx, vp)), hx, hp);
}

/* ---- Polyline ---- */

static Vec3 from_piece(const Tracked *tracked, int s, Vec3 q, Vec3 *t)
{
    double part;
    return from_segment(vec3_load(tracked->points[s]), vec3_load(tracked->points[s + 1]), q, t, &part);
}

static double least_distance2(const Tracked *tracked, Vec3 q)
{
    double least = INFINITY;
    for (int s = 0; s + 1 < tracked->point_count; s++) {
        Vec3 t, d = from_piece(tracked, s, q, &t);
        least = fmin(least, vec3_dot(d, d));
    }
    return least;
}

/* The weight of a segment, not yet divided by their sum. */
static double segment_weight(const Tracked *tracked, double distance2, double least)
{
    return exp((least - distance2) / (tracked->blend * tracked->blend));
}

static double polyline_value(const void *self, double weight, const double *x, const double *p, double *dx,
                             double *dp)
{
    const Tracked *tracked = self;
    Vec3 q = probe_at(&tracked->probe, x, p), t;
    double least = least_distance2(tracked, q), sum = 0, mean = 0;
    for (int s = 0; s + 1 < tracked->point_count; s++) {
        Vec3 d = from_piece(tracked, s, q, &t);
        double d2 = vec3_dot(d, d), w = segment_weight(tracked, d2, least);
        sum += w;
        mean += w * d2;
    }
    mean /= sum;
    for (int s = 0; dx && s + 1 < tracked->point_count; s++) {
        Vec3 d = from_piece(tracked, s, q, &t);
        double d2 = vec3_dot(d, d), w = segment_weight(tracked, d2, least) / sum;
        double amount = 2 * weight * w * (1 - (d2 - mean) / (tracked->blend * tracked->blend));
        probe_pull(&tracked->probe, x, p, vec3_scale(amount, d), dx, dp);
    }
    return mean;
}

/* The distance's projector is I - t t^T inside a segment and I at its ends. */
static void polyline_product(const void *self, double weight, const double *x, const double *p,
                             const double *vx, const double *vp, double *hx, double *hp)
{
    const Tracked *tracked = self;
    const Probe *probe = &tracked->probe;
    Vec3 q = probe_at(probe, x, p), v = probe_change(probe, x, p, vx, vp), t;
    double least = least_distance2(tracked, q), sum = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int s = 0; s + 1 < tracked->point_count; s++) {
            Vec3 d = from_piece(tracked, s, q, &t);
            double w = segment_weight(tracked, vec3_dot(d, d), least);
            if (pass == 0)
                sum += w;
            else
                probe_pull(probe, x, p, vec3_scale(2 * weight * w / sum, vec3_axpy(-vec3_dot(t, v), t, v)),
                           hx, hp);
        }
}

/* ---- Arc ---- */

/* From the nearest point of the arc to q; t: its tangent there, 0 at an end. */
static Vec3 from_arc(const Tracked *tracked, Vec3 q, Vec3 *t)
{
    Vec3 d = vec3_sub(q, tracked->center);
    double u = vec3_dot(d, tracked->e1), v = vec3_dot(d, tracked->e2), angle = atan2(v, u);
    if (angle < 0) angle += 2 * M_PI;
    bool inside = angle <= tracked->angle;
    if (!inside)
        angle = angle - tracked->angle < 2 * M_PI - angle ? tracked->angle : 0; /* the end that is nearer */
    double c = cos(angle), s = sin(angle);
    *t = inside ? vec3_axpy(c, tracked->e2, vec3_scale(-s, tracked->e1)) : vec3(0, 0, 0);
    Vec3 out = vec3_axpy(s, tracked->e2, vec3_scale(c, tracked->e1));
    return vec3_axpy(-tracked->radius, out, d);
}

static double arc_value(const void *self, double weight, const double *x, const double *p, double *dx,
                        double *dp)
{
    const Probe *probe = &((const Tracked *)self)->probe;
    Vec3 t, d = from_arc(self, probe_at(probe, x, p), &t);
    if (dx) probe_pull(probe, x, p, vec3_scale(2 * weight, d), dx, dp);
    return vec3_dot(d, d);
}

static void arc_product(const void *self, double weight, const double *x, const double *p, const double *vx,
                        const double *vp, double *hx, double *hp)
{
    const Probe *probe = &((const Tracked *)self)->probe;
    Vec3 v = probe_change(probe, x, p, vx, vp), t;
    from_arc(self, probe_at(probe, x, p), &t);
    probe_pull(probe, x, p, vec3_scale(2 * weight, vec3_axpy(-vec3_dot(t, v), t, v)), hx, hp);
}

/* ---- Rows ---- */

static void tracked_destroy(void *self)
{
    Tracked *tracked = self;
    probe_clear(&tracked->probe);
    mem_free(tracked->points);
    mem_free(tracked);
}

static const ObjectiveOps waypoint_ops = {"waypoint", waypoint_value, waypoint_product, tracked_destroy};
static const ObjectiveOps polyline_ops = {"curve", polyline_value, polyline_product, tracked_destroy};
static const ObjectiveOps arc_ops = {"curve", arc_value, arc_product, tracked_destroy};

static Tracked *track(const Probe *probe)
{
    Tracked *tracked = mem_alloc(1, sizeof *tracked);
    tracked->probe = probe_copy(probe);
    return tracked;
}

Objective objective_waypoint(const Probe *probe, const double at[3], double weight)
{
    Tracked *tracked = track(probe);
    memcpy(tracked->at, at, sizeof tracked->at);
    return (Objective){&waypoint_ops, tracked, weight, 0, 0};
}

Objective objective_polyline(const Probe *probe, int count, const double (*points)[3], double blend,
                             double weight)
{
    Tracked *tracked = track(probe);
    tracked->point_count = count;
    tracked->points = mem_copy(points, (size_t)count, sizeof *points);
    tracked->blend = blend;
    return (Objective){&polyline_ops, tracked, weight, 0, 0};
}

Objective objective_arc(const Probe *probe, const double points[3][3], double weight)
{
    Tracked *tracked = track(probe);
    Vec3 a = vec3_load(points[0]), ab = vec3_sub(vec3_load(points[1]), a),
         ac = vec3_sub(vec3_load(points[2]), a);
    Vec3 normal = vec3_cross(ab, ac);
    /* The circumcentre of three points in space. */
    Vec3 to_center = vec3_scale(1 / (2 * vec3_dot(normal, normal)),
                                vec3_add(vec3_scale(vec3_dot(ac, ac), vec3_cross(normal, ab)),
                                         vec3_scale(vec3_dot(ab, ab), vec3_cross(ac, normal))));
    tracked->center = vec3_add(a, to_center);
    tracked->radius = vec3_length(to_center);
    tracked->axis = vec3_scale(1 / vec3_length(normal), normal);
    tracked->e1 = vec3_scale(-1 / tracked->radius, to_center);
    tracked->e2 = vec3_cross(tracked->axis, tracked->e1);
    Vec3 end = vec3_sub(vec3_load(points[2]), tracked->center);
    tracked->angle = atan2(vec3_dot(end, tracked->e2), vec3_dot(end, tracked->e1));
    if (tracked->angle < 0) tracked->angle += 2 * M_PI;
    return (Objective){&arc_ops, tracked, weight, 0, 0};
}

double objective_distance(const Objective *objective, const double *x, const double *p)
{
    Vec3 t;
    const Tracked *tracked = objective->self;
    if (objective->ops == &waypoint_ops)
        return vec3_length(vec3_sub(probe_at(&tracked->probe, x, p), vec3_load(tracked->at)));
    if (objective->ops == &polyline_ops)
        return sqrt(least_distance2(tracked, probe_at(&tracked->probe, x, p)));
    if (objective->ops == &arc_ops)
        return vec3_length(from_arc(tracked, probe_at(&tracked->probe, x, p), &t));
    return NAN;
}

static const Tracked *tracked_of(const Objective *objective)
{
    return objective->ops->destroy == tracked_destroy ? objective->self : NULL;
}

bool objective_point(const Objective *objective, const double *x, const double *p, double q[3])
{
    const Tracked *tracked = tracked_of(objective);
    if (tracked) vec3_store(q, probe_at(&tracked->probe, x, p));
    return tracked != NULL;
}

static double (*arc_points(const Tracked *tracked))[3]
{
    double(*points)[3] = mem_alloc(OBJECTIVE_CHORDS + 1, sizeof *points);
    for (int k = 0; k <= OBJECTIVE_CHORDS; k++) {
        double angle = tracked->angle * k / OBJECTIVE_CHORDS, r = tracked->radius;
        Vec3 out = vec3_axpy(r * sin(angle), tracked->e2, vec3_scale(r * cos(angle), tracked->e1));
        vec3_store(points[k], vec3_add(tracked->center, out));
    }
    return points;
}

double (*objective_reference(const Objective *objective, int *count))[3]
{
    const Tracked *tracked = tracked_of(objective);
    bool arc = objective->ops == &arc_ops, place = objective->ops == &waypoint_ops;
    *count = !tracked ? 0 : arc ? OBJECTIVE_CHORDS + 1 : place ? 1 : tracked->point_count;
    if (!tracked) return NULL;
    if (arc) return arc_points(tracked);
    return mem_copy(place ? &tracked->at : (const double(*)[3])tracked->points, (size_t)*count,
                    sizeof tracked->at);
}
