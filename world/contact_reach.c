/* How far samples may go at once: to where they are so deep in an obstacle that it is time to look at the forces, and not
 * through it. */
#include "world/contact_private.h"
#include "world/pierce.h"

static const double DEEP =
    50; /* smoothing lengths: half a thickness, or half of what is thin in an obstacle */

/* The part of the way from `from` to `to` that keeps sample e above the level of one obstacle, by sphere tracing [Hart 1996]:
 * phi changes by no more than its steepest slope. What is below it already goes where it likes. */
static double trace(const Contact *c, int k, int e, const double from[3], const double to[3])
{
    enum { STEPS = 200 };
    const Obstacle *obstacle = &c->def.obstacles[k];
    double level = c->offset[e] - fmin(DEEP * c->smoothing[e], obstacle->feature / 2),
           little = 0.01 * c->smoothing[e], length = 0, t = 0;
    for (int i = 0; i < 3; i++) length += (to[i] - from[i]) * (to[i] - from[i]);
    length = sqrt(length) * fmax(1, obstacle->steepest);
    if (obstacle_is_beyond(obstacle, &c->poses.end[k], from, fmax(level, 0) + length)) return 1;
    for (int n = 0; n < STEPS && t < 1; n++) {
        Gap gap;
        double place[3];
        for (int i = 0; i < 3; i++) place[i] = from[i] + t * (to[i] - from[i]);
        obstacle_gap(obstacle, &c->poses.end[k], place, &gap);
        double free = gap.value - level;
        if (free < little) return n == 0 ? 1 : t;
        if (!(free < length)) return 1; /* NaN is for the energy to tell */
        t += free / length;
    }
    return fmin(t, 1);
}

/* The same over all samples that are not held, and all obstacles. */
static double part_of_way(const Contact *c, const double *from, const double *to)
{
    const Samples *samples = &c->def.samples;
    double part = 1;
    for (int e = 0; e < samples->count; e++) {
        double start[3], end[3];
        if (c->held[e]) continue;
        samples_place(samples, e / PACK_LANES, e % PACK_LANES, from, start);
        samples_place(samples, e / PACK_LANES, e % PACK_LANES, to, end);
        for (int k = 0; k < c->def.obstacle_count; k++) part = fmin(part, trace(c, k, e, start, end));
    }
    return part;
}

double contact_reach(const void *self, const Point *at, const double *d)
{
    const Contact *c = self;
    for (int i = 0; i < c->dofs; i++) c->trial[i] = at->x[i] + d[i];
    return part_of_way(c, at->x, c->trial);
}

void contact_project(const void *self, const double *from, double *x)
{
    const Contact *c = self;
    double part = part_of_way(c, from, x);
    for (int i = c->def.samples.first; part < 1 && i < c->dofs; i++) {
        bool held =
            c->def.derived || (c->def.fixed && c->def.fixed[i - c->def.samples.first] && x[i] != from[i]);
        x[i] = held ? NAN : from[i] + part * (x[i] - from[i]);
    }
}

bool contact_passes(const void *self, const Point *at)
{
    const Contact *c = self;
    return pierce_find(&c->poses, &c->def.faces, at->x_prev, at->x).count > 0;
}
