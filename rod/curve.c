#include "rod/curve.h"
#include "base/memory.h"
#include <math.h>

enum { GAUSS = 5, REACH = 4, POINTS = 2 * REACH + 1, PANELS_LEAST = 128, GRID = 1024 };

/* Gauss-Legendre on [0, 1]. */
static const double gauss_at[GAUSS] = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155,
                                       0.95308992296933200};
static const double gauss_weight[GAUSS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                           0.23931433524968324, 0.11846344252809454};

typedef struct Path {
    RodCurvePoint *point;
    RodCurveJet *jet; /* NULL: derivatives by differences of point's places */
    Vec3 *grid;       /* [GRID + 1] places at equal parameters, for these   */
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

/* Weights of the first and second derivative at z of a function known at -REACH .. REACH. [Fornberg 1988] */
static void difference_weights(double z, double *first, double *second)
{
    double w[POINTS][3] = {{1, 0, 0}}, product = 1, offset = -REACH - z;
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
    for (int i = 0; i < POINTS; i++) first[i] = w[i][1], second[i] = w[i][2];
}

/* By differences of eighth order on points within the range. */
static Vec3 difference_slope(Path *path, double u, Vec3 *bend)
{
    double h = (path->u1 - path->u0) / GRID, first[POINTS], second[POINTS];
    double place_of_u = (u - path->u0) / h;
    int middle = (int)fmin(fmax(rint(place_of_u), REACH), GRID - REACH);
    difference_weights(place_of_u - middle, first, second);
    Vec3 sum = vec3(0, 0, 0), sum2 = sum;
    for (int k = 0; k < POINTS; k++) {
        Vec3 x = path->grid[middle + k - REACH];
        sum = vec3_axpy(first[k] / h, x, sum);
        sum2 = vec3_axpy(second[k] / (h * h), x, sum2);
    }
    if (bend) *bend = sum2;
    return sum;
}

/* dx/du and, where it is asked for, d2x/du2. */
static Vec3 slope(Path *path, double u, Vec3 *bend)
{
    if (!path->jet) return difference_slope(path, u, bend);
    Vec3 jet[3];
    path->jet(path->self, u, jet);
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

static void fill_grid(Path *path)
{
    path->grid = mem_alloc(GRID + 1, sizeof *path->grid);
    for (int k = 0; k <= GRID && isnan(path->bad); k++)
        path->grid[k] = place(path, path->u0 + k * ((path->u1 - path->u0) / GRID));
}

/* The number of panels is a multiple of `pieces`, so that the curve is smooth within each panel. */
static bool create(Path path, int pieces, int elements, RodCurve *curve, Error *err)
{
    int least = elements > PANELS_LEAST ? elements : PANELS_LEAST, stations = 2 * elements + 1;
    path.panels = (least + pieces - 1) / pieces * pieces;
    path.bad = NAN;
    path.s = mem_alloc((size_t)path.panels + 1, sizeof *path.s);
    if (!path.jet) fill_grid(&path);
    for (int k = 0; k < path.panels; k++)
        path.s[k + 1] = path.s[k] + length_between(&path, panel_start(&path, k), panel_start(&path, k + 1));
    *curve = (RodCurve){.elements = elements,
                        .length = path.s[path.panels],
                        .x = mem_alloc((size_t)stations, sizeof *curve->x),
                        .t = mem_alloc((size_t)stations, sizeof *curve->t),
                        .c = mem_alloc((size_t)stations, sizeof *curve->c)};
    bool moves = fill_stations(&path, curve), ok = moves && isnan(path.bad);
    if (!isnan(path.bad))
        error_set(err, "the curve has no finite place near %g", path.bad);
    else if (!moves)
        error_set(err, "the curve stands still somewhere: it has no tangent there");
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
