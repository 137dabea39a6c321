#include "spline/ink.h"
#include <math.h>
#include <string.h>

static const double INK = 1e-4, EVEN = 1e-4; /* how much amounts and their squares count */

enum { STEPS = 60, HALVINGS = 30 };

/* ---- CIELAB ---- */

/* sRGB to XYZ [IEC 61966-2-1], each over that of white. */
static const Mat3 xyz_from_rgb = {{0.4124564 / 0.95047, 0.3575761 / 0.95047, 0.1804375 / 0.95047},
                                  {0.2126729, 0.7151522, 0.0721749},
                                  {0.0193339 / 1.08883, 0.1191920 / 1.08883, 0.9503041 / 1.08883}};
/* L*, a*, b* over 100 from the roots of XYZ, less what black has. */
static const Mat3 lab_from_roots = {{0, 1.16, 0}, {5, -5, 0}, {0, 2, -2}};

static const double DARK = 6.0 / 29; /* root below which it is a line */

static double root(double t)
{
    return t > DARK * DARK * DARK ? cbrt(t) : t / (3 * DARK * DARK) + 4.0 / 29;
}

static double root_slope(double t)
{
    double r = cbrt(fmax(t, DARK * DARK * DARK));
    return 1 / (3 * r * r);
}

static Vec3 lab(Vec3 rgb)
{
    Vec3 t = mat3_times(xyz_from_rgb, rgb);
    return mat3_times(lab_from_roots, vec3(root(t.x), root(t.y), root(t.z)));
}

/* How it changes with rgb, in that direction. */
static Vec3 lab_slope(Vec3 rgb, Vec3 way)
{
    Vec3 t = mat3_times(xyz_from_rgb, rgb), w = mat3_times(xyz_from_rgb, way);
    return mat3_times(lab_from_roots,
                      vec3(w.x * root_slope(t.x), w.y * root_slope(t.y), w.z * root_slope(t.z)));
}

double ink_difference(Vec3 a, Vec3 b)
{
    return 100 * vec3_length(vec3_sub(lab(a), lab(b)));
}

/* ---- Mixing ---- */

static Vec3 times(Vec3 a, Vec3 b)
{
    return vec3(a.x * b.x, a.y * b.y, a.z * b.z);
}

/* One coat of ink on what is below. */
static Vec3 coated(const Ink *ink, Vec3 below)
{
    return ink->opaque ? ink->color : times(ink->color, below);
}

Vec3 ink_mix(const InkSet *set, const double *cover)
{
    Vec3 color = set->paper;
    for (int k = 0; k < set->count; k++)
        color = vec3_axpy(cover[k], vec3_sub(coated(&set->inks[k], color), color), color);
    return color;
}

/* ways[k]: its derivative in cover[k]. Upwards what an ink changes there and then, downwards what the later ones leave
 * of a change. */
static Vec3 mix_slopes(const InkSet *set, const double *cover, Vec3 *ways)
{
    Vec3 color = set->paper, left = vec3(1, 1, 1);
    for (int k = 0; k < set->count; k++) {
        ways[k] = vec3_sub(coated(&set->inks[k], color), color);
        color = vec3_axpy(cover[k], ways[k], color);
    }
    for (int k = set->count - 1; k >= 0; k--) {
        Vec3 passed = set->inks[k].opaque ? vec3(0, 0, 0) : set->inks[k].color;
        ways[k] = times(ways[k], left);
        left = times(left, vec3_axpy(cover[k], vec3_sub(passed, vec3(1, 1, 1)), vec3(1, 1, 1)));
    }
    return color;
}

/* ---- Matching ---- */

typedef struct Fit {
    const InkSet *set;
    Vec3 want; /* CIELAB/100 */
} Fit;

static double cost(const Fit *fit, const double *cover)
{
    Vec3 off = vec3_sub(lab(ink_mix(fit->set, cover)), fit->want);
    double ink = 0;
    for (int k = 0; k < fit->set->count; k++) ink += cover[k] * (INK + EVEN * cover[k]);
    return vec3_dot(off, off) + ink;
}

/* x of a x = b, a symmetric and positive, by Cramer's rule. */
static Vec3 solve3(Mat3 a, Vec3 b)
{
    Vec3 yz = vec3_cross(a.r1, a.r2);
    return vec3_scale(1 / vec3_dot(a.r0, yz), vec3(vec3_dot(b, yz), vec3_dot(a.r0, vec3_cross(b, a.r2)),
                                                   vec3_dot(a.r0, vec3_cross(a.r1, b))));
}

/* The problem made linear at `cover`. */
typedef struct Linear {
    const InkSet *set;
    const double *cover;
    Vec3 off, slopes[INK_MAX]; /* J                             */
    bool held[INK_MAX];        /* stays at the bound where it is */
} Linear;

static bool leaves(const Linear *l, int k, double way)
{
    return (l->cover[k] <= 0 && way < 0) || (l->cover[k] >= l->set->most && way > 0);
}

static Linear linear(const Fit *fit, const double *cover)
{
    Linear l = {.set = fit->set, .cover = cover};
    Vec3 color = mix_slopes(fit->set, cover, l.slopes);
    l.off = vec3_sub(lab(color), fit->want);
    for (int k = 0; k < fit->set->count; k++) {
        l.slopes[k] = lab_slope(color, l.slopes[k]);
        l.held[k] = leaves(&l, k, -(vec3_dot(l.slopes[k], l.off) + EVEN * cover[k] + INK / 2));
    }
    return l;
}

/* The least of it with those that are held where they are: b = -J^T (J J^T + e I)^-1 (r - J (a + i)) - i of the free
 * ones, e = EVEN and i = INK/2e: a matrix of three rows however many inks there are. */
static void solve(const Linear *l, double *to)
{
    const double shift = INK / (2 * EVEN);
    Vec3 rest = l->off;
    Mat3 square = mat3_scale(EVEN, mat3_identity());
    for (int k = 0; k < l->set->count; k++) {
        if (l->held[k]) continue;
        rest = vec3_axpy(-l->cover[k] - shift, l->slopes[k], rest);
        square = mat3_add(square, mat3_outer(l->slopes[k], l->slopes[k]));
    }
    rest = solve3(square, rest);
    for (int k = 0; k < l->set->count; k++)
        to[k] = l->held[k] ? l->cover[k] : -vec3_dot(l->slopes[k], rest) - shift;
}

/* Where to go. An ink at a bound that it would leave only outwards stays there, and what the others do without it is
 * found anew: all that is left then leads downhill. */
static void aim(const Fit *fit, const double *cover, double *to)
{
    Linear l = linear(fit, cover);
    for (bool again = true; again;) {
        again = false;
        solve(&l, to);
        for (int k = 0; k < l.set->count; k++)
            if (!l.held[k] && leaves(&l, k, to[k] - cover[k])) again = l.held[k] = true;
    }
}

/* A step of that part of the way, within the bounds. */
static void step(const Fit *fit, const double *from, const double *to, double part, double *cover)
{
    for (int k = 0; k < fit->set->count; k++)
        cover[k] = fmin(fmax(from[k] + part * (to[k] - from[k]), 0), fit->set->most);
}

/* From where cover is to a minimum; what it costs. */
static double descend(const Fit *fit, double *cover)
{
    double now = cost(fit, cover), to[INK_MAX], next[INK_MAX];
    for (int k = 0; k < STEPS; k++) {
        double part = 1, then = INFINITY;
        aim(fit, cover, to);
        for (int h = 0; h < HALVINGS && !(then < now); h++, part /= 2) {
            step(fit, cover, to, part, next);
            then = cost(fit, next);
        }
        if (!(then < now)) break;
        bool settled = now - then < 1e-13;
        memcpy(cover, next, (size_t)fit->set->count * sizeof *cover);
        now = then;
        if (settled) break;
    }
    return now;
}

void ink_match(const InkSet *set, Vec3 color, double *cover)
{
    Fit fit = {set, lab(color)};
    double other[INK_MAX];
    for (int k = 0; k < set->count; k++) cover[k] = 0, other[k] = set->most / 2;
    if (descend(&fit, other) < descend(&fit, cover)) memcpy(cover, other, (size_t)set->count * sizeof *cover);
}
