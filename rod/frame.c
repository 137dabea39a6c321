#include "rod/frame.h"
#include "base/memory.h"

static Vec3 reflect(Vec3 v, Vec3 across)
{
    double size2 = vec3_dot(across, across);
    return size2 > 0 ? vec3_axpy(-2 * vec3_dot(across, v) / size2, across, v) : v;
}

/* n1 of the station before, carried to the next: reflected in the plane between the places, then between the
 * tangents. */
static Vec3 carry(const RodCurve *curve, int j, Vec3 n1)
{
    Vec3 step = vec3_sub(curve->x[j], curve->x[j - 1]);
    Vec3 t = reflect(curve->t[j - 1], step);
    n1 = reflect(reflect(n1, step), vec3_sub(curve->t[j], t));
    n1 = vec3_axpy(-vec3_dot(n1, curve->t[j]), curve->t[j], n1); /* rounding */
    return vec3_unit(n1);
}

static RodFrame complete(Vec3 t, Vec3 n1)
{
    return (RodFrame){t, n1, vec3_cross(t, n1)};
}

void rod_bishop(const RodCurve *curve, Vec3 normal, RodFrame *frames)
{
    Vec3 n1 = vec3_unit(vec3_axpy(-vec3_dot(normal, curve->t[0]), curve->t[0], normal));
    for (int j = 0; j <= 2 * curve->elements; j++) {
        if (j > 0) n1 = carry(curve, j, n1);
        frames[j] = complete(curve->t[j], n1);
    }
}

static Vec3 any_normal(Vec3 t)
{
    Vec3 axis = fabs(t.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return vec3_unit(vec3_axpy(-vec3_dot(axis, t), t, axis));
}

static const double STRAIGHT = 1e-6; /* radians over the whole curve */

void rod_frenet(const RodCurve *curve, RodFrame *frames)
{
    Vec3 n1 = any_normal(curve->t[0]);
    for (int j = 0; j <= 2 * curve->elements; j++) {
        double bend = vec3_length(curve->c[j]);
        if (bend * curve->length > STRAIGHT)
            n1 = vec3_scale(1 / bend, curve->c[j]);
        else if (j > 0)
            n1 = carry(curve, j, n1);
        frames[j] = complete(curve->t[j], n1);
    }
}

RodFrame rod_turned(RodFrame f, double angle)
{
    double c = cos(angle), s = sin(angle);
    return complete(f.n0, vec3_axpy(c, f.n1, vec3_scale(s, f.n2)));
}

/* Differences on five neighbouring values, every `stride`-th number, one-sided at the ends. */
static double derivative(const double *f, int stride, int count, int j, double h)
{
    static const double rows[5][5] = {{-25, 48, -36, 16, -3},
                                      {-3, -10, 18, -6, 1},
                                      {1, -8, 0, 8, -1},
                                      {-1, 6, -18, 10, 3},
                                      {3, -16, 36, -48, 25}};
    int first = j - 2 < 0 ? 0 : j - 2 > count - 5 ? count - 5 : j - 2;
    double sum = 0;
    for (int k = 0; k < 5; k++) sum += rows[j - first][k] * f[stride * (first + k)];
    return sum / (12 * h);
}

void rod_twist(const RodCurve *curve, const RodFrame *frames, double *twist)
{
    int stations = 2 * curve->elements + 1;
    RodFrame *bishop = mem_alloc((size_t)stations, sizeof *bishop);
    double *angle = mem_alloc((size_t)stations, sizeof *angle);
    rod_bishop(curve, frames[0].n1, bishop);
    for (int j = 0; j < stations; j++) {
        angle[j] = atan2(vec3_dot(frames[j].n1, bishop[j].n2), vec3_dot(frames[j].n1, bishop[j].n1));
        if (j > 0) angle[j] += 2 * M_PI * rint((angle[j - 1] - angle[j]) / (2 * M_PI));
    }
    for (int j = 0; j < stations; j++)
        twist[j] = stations < 5 ? (angle[stations - 1] - angle[0]) / curve->length
                                : derivative(angle, 1, stations, j, curve->length / (stations - 1));
    mem_free(bishop);
    mem_free(angle);
}

/* Magnus with Simpson's rule; to the middle with the parabola through the three rates. */

/* dc/ds; a curve of one element bends alike all along. */
static Vec3 bend_rate(const RodCurve *curve, int j)
{
    int stations = 2 * curve->elements + 1;
    double h = curve->length / (stations - 1), rate[3] = {0};
    for (int i = 0; stations >= 5 && i < 3; i++) rate[i] = derivative(&curve->c[0].x + i, 3, stations, j, h);
    return vec3_load(rate);
}

void rod_torsion(const RodCurve *curve, double *torsion)
{
    for (int j = 0; j <= 2 * curve->elements; j++) {
        Vec3 c = curve->c[j];
        double bend2 = vec3_dot(c, c);
        torsion[j] = sqrt(bend2) * curve->length > STRAIGHT
                         ? vec3_dot(curve->t[j], vec3_cross(c, bend_rate(curve, j))) / bend2
                         : NAN;
    }
}
