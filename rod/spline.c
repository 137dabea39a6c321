#include "rod/spline.h"
#include "base/memory.h"
#include <stdbool.h>
#include <string.h>

enum { ORDER = ROD_SPLINE_ORDER, DEGREE = ORDER - 1, PENALISED = 3 };

/* ---- B-splines ---- */

/* A derivative at u of the six splines that are not zero on an interval: the recursion of Cox and de Boor up
 * to degree - derivative, then differences. */
static void basis(const double *knots, int interval, double u, int derivative, RodSplineRow value)
{
    const double *k = knots + interval + DEGREE;
    memset(value, 0, sizeof(RodSplineRow));
    value[0] = 1;
    for (int degree = 1; degree <= DEGREE; degree++) {
        double carry = 0;
        for (int i = 0; i < degree; i++) {
            double right = k[i + 1], left = k[i + 1 - degree], part = value[i] / (right - left);
            bool differs = degree > DEGREE - derivative;
            value[i] = carry + part * (differs ? -degree : right - u);
            carry = part * (differs ? degree : u - left);
        }
        value[degree] = carry;
    }
}

static Vec3 combine(const RodSpline *spline, int interval, const RodSplineRow value)
{
    Vec3 sum = vec3(0, 0, 0);
    for (int i = 0; i < ORDER; i++) sum = vec3_axpy(value[i], spline->c[interval + i], sum);
    return sum;
}

/* The interval of the next point, from that of the one before. */
static int advance(const RodSpline *spline, int interval, double u)
{
    while (interval + 1 < spline->intervals && spline->knots[interval + 1 + DEGREE] <= u) interval++;
    return interval;
}

/* ---- Banded least squares ---- */

/* Rotates a row whose first entry is in column k into a triangle; what is left of its right-hand side is what
 * the unknowns cannot reach. */
static Vec3 add_row(RodSplineRow *triangle, Vec3 *right, int count, int k, const RodSplineRow row, Vec3 value)
{
    double rest[2 * ORDER] = {0};
    memcpy(rest, row, sizeof(RodSplineRow));
    for (int step = 0; step < ORDER && k + step < count; step++) {
        double *r = triangle[k + step], *q = rest + step, size = sqrt(r[0] * r[0] + q[0] * q[0]);
        if (q[0] == 0) continue;
        double c = r[0] / size, s = q[0] / size;
        for (int i = 0; i < ORDER; i++) {
            double old = r[i];
            r[i] = c * old + s * q[i];
            q[i] = c * q[i] - s * old;
        }
        Vec3 old = right[k + step];
        right[k + step] = vec3_axpy(c, old, vec3_scale(s, value));
        value = vec3_axpy(c, value, vec3_scale(-s, old));
    }
    return value;
}

static void add_points(RodSpline *spline)
{
    RodSplineRow value;
    for (int i = 0, interval = 0; i < spline->points; i++) {
        interval = advance(spline, interval, spline->u[i]);
        basis(spline->knots, interval, spline->u[i], 0, value);
        Vec3 left = add_row(spline->data, spline->data_right, spline->coefficients, interval, value,
                            vec3_sub(spline->x[i], spline->x[0]));
        spline->beyond += vec3_dot(left, left);
    }
}

/* int |f'''|^2 exactly: Gauss points of the square of a parabola. The right-hand sides stay zero. */
static void add_penalty(RodSpline *spline)
{
    static const double at[] = {0.1127016653792583, 0.5, 0.8872983346207417}, weight[] = {5, 8, 5};
    RodSplineRow value;
    for (int interval = 0; interval < spline->intervals; interval++) {
        const double *knot = spline->knots + interval + DEGREE;
        double width = knot[1] - knot[0];
        for (int g = 0; g < 3; g++) {
            basis(spline->knots, interval, knot[0] + at[g] * width, PENALISED, value);
            for (int i = 0; i < ORDER; i++) value[i] *= sqrt(weight[g] / 18 * width);
            add_row(spline->penalty, spline->right, spline->coefficients, interval, value, vec3(0, 0, 0));
        }
    }
}

/* Entry (k, l) of a symmetric band of which the upper half is stored. */
static double entry(RodSplineRow *band, int k, int l)
{
    return k < l ? band[k][l - k] : band[l][k - l];
}

/* trace(A^-1 G), A = factor^T factor and G = data^T data; only A^-1's band is needed, which follows from
 * the last column backwards. */
static double trace(const RodSpline *spline)
{
    int count = spline->coefficients;
    RodSplineRow *inverse = mem_alloc((size_t)count + DEGREE, sizeof *inverse);
    double sum = 0;
    for (int k = count - 1; k >= 0; k--) {
        const double *r = spline->factor[k], *d = spline->data[k];
        for (int i = DEGREE; i >= 0; i--) {
            double value = i ? 0 : 1 / (r[0] * r[0]);
            for (int l = 1; l < ORDER; l++) value -= r[l] / r[0] * entry(inverse, k + l, k + i);
            inverse[k][i] = value;
        }
        for (int i = 0; i < ORDER; i++)
            for (int l = 0; l < ORDER; l++) sum += d[i] * d[l] * entry(inverse, k + i, k + l);
    }
    mem_free(inverse);
    return sum;
}

void rod_spline_fit(RodSpline *spline, double weight)
{
    int count = spline->coefficients;
    memset(spline->factor, 0, (size_t)count * sizeof *spline->factor);
    memset(spline->right, 0, (size_t)count * sizeof *spline->right);
    for (int k = 0; k < count; k++) {
        RodSplineRow row;
        for (int i = 0; i < ORDER; i++) row[i] = sqrt(weight) * spline->penalty[k][i];
        add_row(spline->factor, spline->right, count, k, spline->data[k], spline->data_right[k]);
        add_row(spline->factor, spline->right, count, k, row, vec3(0, 0, 0));
    }
    for (int k = count - 1; k >= 0; k--) {
        Vec3 sum = spline->right[k];
        for (int i = 1; i < ORDER && k + i < count; i++)
            sum = vec3_axpy(-spline->factor[k][i], spline->c[k + i], sum);
        spline->c[k] = vec3_scale(1 / spline->factor[k][0], sum);
    }
    spline->weight = weight;
    spline->freedom = trace(spline);
    spline->squares = spline->beyond;
    for (int k = 0; k < count; k++) {
        Vec3 off = vec3_scale(-1, spline->data_right[k]);
        for (int i = 0; i < ORDER && k + i < count; i++)
            off = vec3_axpy(spline->data[k][i], spline->c[k + i], off);
        spline->squares += vec3_dot(off, off);
    }
}

/* ---- The spline ---- */

/* Knots at every points / intervals'th point, in between if need be; none closer than a thousandth of the
 * mean to the one before. As many unknowns as points have theirs at all points but the second and third from
 * either end ("not a knot"). */
static void place_knots(RodSpline *spline, int intervals)
{
    const double close = 1e-3;
    double end = spline->u[spline->points - 1], last = 0;
    int kept = 1;
    bool through = intervals == spline->points - DEGREE;
    for (int k = 1; k < intervals; k++) {
        double place = through ? k + ORDER / 2 - 1 : (double)k * (spline->points - 1) / intervals;
        int i = (int)place;
        double knot = spline->u[i] + (place - i) * (spline->u[i + 1] - spline->u[i]);
        if (knot < last + close || knot > end - close) continue;
        spline->knots[kept++ + DEGREE] = last = knot;
    }
    for (int i = 0; i < ORDER; i++) spline->knots[kept + DEGREE + i] = end;
    spline->intervals = kept;
    spline->coefficients = kept + DEGREE;
}

RodSpline rod_spline_create(const double *u, const Vec3 *x, int points, int intervals)
{
    size_t most = (size_t)intervals + 2 * ORDER;
    RodSpline spline = {.points = points,
                        .x = x,
                        .u = mem_alloc((size_t)points, sizeof *spline.u),
                        .knots = mem_alloc(most, sizeof *spline.knots),
                        .c = mem_alloc(most, sizeof *spline.c),
                        .data = mem_alloc(most, sizeof *spline.data),
                        .penalty = mem_alloc(most, sizeof *spline.penalty),
                        .factor = mem_alloc(most, sizeof *spline.factor),
                        .data_right = mem_alloc(most, sizeof *spline.data_right),
                        .right = mem_alloc(most, sizeof *spline.right)};
    for (int i = 0; i < points; i++) spline.u[i] = u[i] * (intervals / u[points - 1]);
    place_knots(&spline, intervals);
    add_points(&spline);
    add_penalty(&spline);
    return spline;
}

void rod_spline_jet(void *self, double at, Vec3 jet[3])
{
    const RodSpline *spline = self;
    int interval = at < spline->intervals ? (int)at : spline->intervals - 1;
    const double *knot = spline->knots + interval + DEGREE;
    double width = knot[1] - knot[0], scale = 1;
    for (int derivative = 0; derivative < 3; derivative++, scale *= width) {
        RodSplineRow value;
        basis(spline->knots, interval, knot[0] + (at - interval) * width, derivative, value);
        jet[derivative] = vec3_scale(scale, combine(spline, interval, value));
    }
    jet[0] = vec3_add(jet[0], spline->x[0]);
}

/* From where the spline has the i-th point; *interval: that of the point before, then its own. */
static Vec3 miss_of(const RodSpline *spline, int i, int *interval)
{
    RodSplineRow value;
    *interval = advance(spline, *interval, spline->u[i]);
    basis(spline->knots, *interval, spline->u[i], 0, value);
    return vec3_sub(vec3_sub(spline->x[i], spline->x[0]), combine(spline, *interval, value));
}

double rod_spline_worst(const RodSpline *spline)
{
    double worst = 0;
    for (int i = 0, interval = 0; i < spline->points; i++)
        worst = fmax(worst, vec3_length(miss_of(spline, i, &interval)));
    return worst;
}

double rod_spline_squares_across(const RodSpline *spline)
{
    double sum = 0;
    for (int i = 0, interval = 0; i < spline->points; i++) {
        RodSplineRow value;
        Vec3 off = miss_of(spline, i, &interval);
        basis(spline->knots, interval, spline->u[i], 1, value);
        Vec3 along = combine(spline, interval, value);
        double along2 = vec3_dot(along, along), part = vec3_dot(off, along);
        sum += vec3_dot(off, off) - (along2 > 0 ? part * part / along2 : 0);
    }
    return sum;
}

void rod_spline_clear(RodSpline *spline)
{
    mem_free(spline->u);
    mem_free(spline->knots);
    mem_free(spline->c);
    mem_free(spline->data);
    mem_free(spline->penalty);
    mem_free(spline->factor);
    mem_free(spline->data_right);
    mem_free(spline->right);
    *spline = (RodSpline){0};
}
