#include "base/cubic.h"
#include <stdbool.h>

/* The polar form: affine in each of its arguments, and the curve where they are equal. */
static double polar(double a, double b, double c, double d, double r, double s, double t)
{
    double ab = a + r * (b - a), bc = b + r * (c - b), cd = c + r * (d - c);
    double abc = ab + s * (bc - ab), bcd = bc + s * (cd - bc);
    return abc + t * (bcd - abc);
}

static Vec2 polar_point(const Vec2 c[4], double r, double s, double t)
{
    return (Vec2){polar(c[0].x, c[1].x, c[2].x, c[3].x, r, s, t),
                  polar(c[0].y, c[1].y, c[2].y, c[3].y, r, s, t)};
}

Vec2 cubic_at(const Vec2 c[4], double s)
{
    return polar_point(c, s, s, s);
}

void cubic_part(const Vec2 c[4], double from, double to, Vec2 part[4])
{
    part[0] = polar_point(c, from, from, from);
    part[1] = polar_point(c, from, from, to);
    part[2] = polar_point(c, from, to, to);
    part[3] = polar_point(c, to, to, to);
}

int cubic_steps(const Vec2 c[4], double tolerance)
{
    double m0 = hypot(c[0].x - 2 * c[1].x + c[2].x, c[0].y - 2 * c[1].y + c[2].y);
    double m1 = hypot(c[1].x - 2 * c[2].x + c[3].x, c[1].y - 2 * c[2].y + c[3].y);
    double steps = ceil(sqrt(0.75 * fmax(m0, m1) / tolerance));
    return (int)fmax(1, fmin(steps, 10000));
}

/* Zeros in (0, 1) of the derivative. */
static int turning_points(const double b[4], double at[2])
{
    double p = b[1] - b[0], q = b[2] - b[1], r = b[3] - b[2]; /* p (1-s)^2 + 2 q s(1-s) + r s^2 */
    double square = p - 2 * q + r, half = q - p, under = half * half - square * p;
    int count = 0;
    if (!(under > 0)) return 0;
    double k = -(half + copysign(sqrt(under), half));
    double first = k / square, second = p / k;
    if (first > second) {
        double swap = first;
        first = second;
        second = swap;
    }
    if (first > 0 && first < 1) at[count++] = first;
    if (second > 0 && second < 1) at[count++] = second;
    return count;
}

int cubic_roots(const double b[4], double roots[3])
{
    double stop[4] = {0};
    int count = 0, stops = 1 + turning_points(b, stop + 1);
    stop[stops] = 1;
    for (int k = 0; k < stops; k++) { /* the polynomial is monotonic from stop to stop */
        double low = stop[k], high = stop[k + 1];
        bool below = polar(b[0], b[1], b[2], b[3], low, low, low) < 0;
        if ((polar(b[0], b[1], b[2], b[3], high, high, high) < 0) == below) continue;
        for (int i = 0; i < 60; i++) {
            double middle = 0.5 * (low + high);
            if ((polar(b[0], b[1], b[2], b[3], middle, middle, middle) < 0) == below)
                low = middle;
            else
                high = middle;
        }
        if (low > 0 && high < 1) roots[count++] = 0.5 * (low + high);
    }
    return count;
}
