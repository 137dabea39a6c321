#include "rod/curve.h"
#include "base/memory.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { GAUSS = 5, REACH = 4, POINTS = 2 * REACH + 1, PANELS_LEAST = 128 };
enum { GRID_LEAST = 1024, GRID_MOST = 1 << 17, GRID_PER_PANEL = 8 };

/* Gauss-Legendre on [0, 1]. */
static const double gauss_at[GAUSS] = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155,
                                       0.95308992296933200};
static const double gauss_weight[GAUSS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                           0.23931433524968324, 0.11846344252809454};

typedef struct Path {
    RodCurvePoint *point;
    RodCurveJet *jet; /* NULL: derivatives by differences of point's places */
    Vec3 *grid;       /* [intervals + 1] places at equal parameters, for these */
    int intervals;
    void *self;
    double u0, u1;
    int panels;
    double *s;  /* [panels + 1] arclength at the panels' ends */
    double bad; /* a parameter without a finite place; NAN: none so far */
} Path;

static Vec3 place(Path *path, double u)
{
    Vec3 jet[3] = {{0, 0, 0}};
    bool known = true;
    if (path->jet)
        path->jet(path->self, u, jet);
    else
        known = path->point(path->self, u, jet);
    if (known && isfinite(jet->x + jet->y + jet->z)) return *jet;
    path->bad = u;
    return vec3(0, 0, 0);
}

/* Weights w[point][derivative] at z of a function known at -REACH .. REACH. [Fornberg 1988] */
static void difference_weights(double z, double w[POINTS][3])
{
    double product = 1, offset = -REACH - z;
    memset(w, 0, POINTS * sizeof *w);
    w[0][0] = 1;
    for (int i = 1; i < POINTS; i++) {
        double next = 1, before = offset, x = i - REACH;
        int most = i < 2 ? i : 2;
        offset = x - z;
        for (int j = 0; j < i; j++) {
            double apart = x - (j - REACH);
            next *= apart;
            if (j == i - 1)
                for (int m = most; m >= 0; m--)
                    w[i][m] = product * ((m ? m * w[i - 1][m - 1] : 0) - before * w[i - 1][m]) / next;
            for (int m = most; m >= 0; m--) w[j][m] = (offset * w[j][m] - (m ? m * w[j][m - 1] : 0)) / apart;
        }
        product = next;
    }
}

/* Place and derivatives by differences of eighth order on points within the range. */
static void difference_jet(const Path *path, double u, Vec3 jet[3])
{
    double h = (path->u1 - path->u0) / path->intervals, w[POINTS][3];
    double place_of_u = (u - path->u0) / h;
    int middle = (int)fmin(fmax(rint(place_of_u), REACH), path->intervals - REACH);
    difference_weights(place_of_u - middle, w);
    jet[0] = jet[1] = jet[2] = vec3(0, 0, 0);
    for (int k = 0; k < POINTS; k++) {
        Vec3 x = path->grid[middle + k - REACH];
        jet[0] = vec3_axpy(w[k][0], x, jet[0]);
        jet[1] = vec3_axpy(w[k][1] / h, x, jet[1]);
        jet[2] = vec3_axpy(w[k][2] / (h * h), x, jet[2]);
    }
}

/* dx/du and, where it is asked for, d2x/du2. */
static Vec3 slope(Path *path, double u, Vec3 *bend)
{
    Vec3 jet[3];
    if (path->jet)
        path->jet(path->self, u, jet);
    else
        difference_jet(path, u, jet);
    if (bend) *bend = jet[2];
    return jet[1];
}

static double length_between(Path *path, double a, double b)
{
    double sum = 0;
    for (int k = 0; k < GAUSS; k++)
        sum += gauss_weight[k] * vec3_length(slope(path, a + (b - a) * gauss_at[k], NULL));
    return sum * fabs(b - a);
}

static double panel_start(const Path *path, int panel)
{
    return path->u0 + (path->u1 - path->u0) * panel / path->panels;
}

/* The parameter at an arclength: Newton, kept within its panel. */
static double parameter_at(Path *path, int panel, double s)
{
    double a = panel_start(path, panel), b = panel_start(path, panel + 1);
    double part = (s - path->s[panel]) / (path->s[panel + 1] - path->s[panel]), u = a + (b - a) * part;
    for (int k = 0; k < 8; k++) {
        double off = path->s[panel] + length_between(path, a, u) * (u >= a ? 1 : -1) * (b >= a ? 1 : -1) - s;
        double speed = vec3_length(slope(path, u, NULL)) * (b >= a ? 1 : -1);
        if (!(fabs(speed) > 0)) break;
        u = fmin(fmax(u - off / speed, fmin(a, b)), fmax(a, b));
        if (fabs(off) <= 1e-15 * path->s[path->panels]) break;
    }
    return u;
}

/* Places, tangents and curvatures at equal arclengths; false where there is no tangent. */
static bool fill_stations(Path *path, RodCurve *curve)
{
    int stations = 2 * curve->elements + 1, panel = 0;
    double way = path->u1 >= path->u0 ? 1 : -1;
    bool moves = curve->length > 0;
    for (int j = 0; moves && isnan(path->bad) && j < stations; j++) {
        double s = curve->length * j / (stations - 1);
        while (panel + 1 < path->panels && path->s[panel + 1] < s) panel++;
        double u = j == 0 ? path->u0 : j == stations - 1 ? path->u1 : parameter_at(path, panel, s);
        Vec3 bend, along = slope(path, u, &bend);
        curve->x[j] = place(path, u);
        moves = vec3_length(along) > 0;
        Vec3 t = curve->t[j] = vec3_scale(way / vec3_length(along), along);
        curve->c[j] = vec3_scale(1 / vec3_dot(along, along), vec3_axpy(-vec3_dot(bend, t), t, bend));
    }
    return moves;
}

/* How far the curve is from what the grid says of it. */
typedef struct Miss {
    double off, at;           /* the farthest, and its parameter */
    double slope, bend, size; /* the largest dx/du, d2x/du2 and distance from the start */
    double far;               /* the largest distance from (0, 0, 0)                    */
} Miss;

/* At a place in each interval, the golden section's so that no wave hides between them. */
static Miss find_miss(Path *path)
{
    const double golden = 0.6180339887498949;
    double h = (path->u1 - path->u0) / path->intervals;
    Miss miss = {.at = path->u0};
    for (int k = 0; k < path->intervals && isnan(path->bad); k++) {
        Vec3 jet[3];
        double u = path->u0 + h * (k + fmod((k + 1) * golden, 1));
        Vec3 x = place(path, u);
        difference_jet(path, u, jet);
        double off = vec3_length(vec3_sub(x, jet[0]));
        if (off > miss.off) miss.off = off, miss.at = u;
        miss.slope = fmax(miss.slope, vec3_length(jet[1]));
        miss.bend = fmax(miss.bend, vec3_length(jet[2]));
        miss.size = fmax(miss.size, vec3_length(vec3_sub(x, path->grid[0])));
        miss.far = fmax(miss.far, vec3_length(x));
    }
    return miss;
}

/* Halves the grid's intervals until they follow the curve: curvatures are then right to 1e-6 of the largest.
 * Where curvature jumps that is never so, and the finest grid will do; where the tangent jumps it will not. Places far
 * from (0, 0, 0) are rounded by themselves: a finer grid would follow the rounding. */
static bool fill_grid(Path *path, Error *err)
{
    const double follows = 2e-8, rounding = 1e-13, rounding_far = 16 * DBL_EPSILON, smooth = 1e-4;
    for (path->intervals = GRID_LEAST;; path->intervals *= 2) {
        double h = (path->u1 - path->u0) / path->intervals;
        mem_free(path->grid);
        path->grid = mem_alloc((size_t)path->intervals + 1, sizeof *path->grid);
        for (int k = 0; k <= path->intervals && isnan(path->bad); k++)
            path->grid[k] = place(path, path->u0 + k * h);
        Miss miss = find_miss(path);
        double enough = follows * h * h * miss.bend + fmax(rounding * miss.size, rounding_far * miss.far);
        if (!isnan(path->bad) || miss.off <= enough) return true;
        if (path->intervals < GRID_MOST) continue;
        return miss.off <= smooth * fabs(h) * miss.slope ||
               error_set(
                   err,
                   "the curve has a kink near %g, or waves there that are shorter than 1/%d of its range",
                   miss.at, GRID_MOST / 40);
    }
}

static double rounded(double x, double length)
{
    return fabs(x) < 1e-9 * length ? 0 : x;
}

bool rod_curve_refuse_turn(Vec3 x, double length, Error *err)
{
    return error_set(err, "the curve turns back on itself at (%.4g, %.4g, %.4g) m: no rod does",
                     rounded(x.x, length), rounded(x.y, length), rounded(x.z, length));
}

/* Does the tangent turn by half a circle, or nearly, between two of the places that lengths are measured at? They are so
 * near that no curve of a rod does. */
static bool turns_back(Path *path, double *at)
{
    const double nearly = -0.99;
    Vec3 before = vec3(0, 0, 0);
    double u_before = path->u0;
    for (int k = 0; k < GAUSS * path->panels; k++) {
        double start = panel_start(path, k / GAUSS), end = panel_start(path, k / GAUSS + 1),
               u = start + (end - start) * gauss_at[k % GAUSS];
        Vec3 along = slope(path, u, NULL);
        *at = (u_before + u) / 2;
        if (vec3_dot(before, along) < nearly * vec3_length(before) * vec3_length(along)) return true;
        if (vec3_length(along) > 0) before = along, u_before = u;
    }
    return false;
}

/* The number of panels is a multiple of `pieces`, so that the curve is smooth within each panel. */
static bool create(Path path, int pieces, int elements, RodCurve *curve, Error *err)
{
    *curve = (RodCurve){0};
    path.bad = NAN;
    if (!path.jet && !fill_grid(&path, err)) {
        mem_free(path.grid);
        return false;
    }
    int least = elements > PANELS_LEAST ? elements : PANELS_LEAST, stations = 2 * elements + 1;
    if (path.intervals / GRID_PER_PANEL > least) least = path.intervals / GRID_PER_PANEL;
    path.panels = (least + pieces - 1) / pieces * pieces;
    path.s = mem_alloc((size_t)path.panels + 1, sizeof *path.s);
    for (int k = 0; k < path.panels; k++)
        path.s[k + 1] = path.s[k] + length_between(&path, panel_start(&path, k), panel_start(&path, k + 1));
    *curve = (RodCurve){.elements = elements,
                        .length = path.s[path.panels],
                        .x = mem_alloc((size_t)stations, sizeof *curve->x),
                        .t = mem_alloc((size_t)stations, sizeof *curve->t),
                        .c = mem_alloc((size_t)stations, sizeof *curve->c)};
    bool moves = fill_stations(&path, curve), ok = false;
    double at;
    if (!isnan(path.bad))
        error_set(err, "the curve has no finite place near %g", path.bad);
    else if (turns_back(&path, &at))
        rod_curve_refuse_turn(place(&path, at), path.s[path.panels], err);
    else
        ok = moves || error_set(err, "the curve stands still somewhere: it has no tangent there");
    mem_free(path.s);
    mem_free(path.grid);
    if (!ok) rod_curve_clear(curve);
    return ok;
}

bool rod_curve_create(RodCurvePoint *point, void *self, double u0, double u1, int elements, RodCurve *curve,
                      Error *err)
{
    return create((Path){.point = point, .self = self, .u0 = u0, .u1 = u1}, 1, elements, curve, err);
}

bool rod_curve_create_pieces(RodCurveJet *jet, void *self, int pieces, int elements, RodCurve *curve,
                             Error *err)
{
    return create((Path){.jet = jet, .self = self, .u1 = pieces}, pieces, elements, curve, err);
}

void rod_curve_clear(RodCurve *curve)
{
    mem_free(curve->x);
    mem_free(curve->t);
    mem_free(curve->c);
    *curve = (RodCurve){0};
}
