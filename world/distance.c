#include "world/distance.h"
#include "base/vec3.h"
#include <string.h>

/* Squared sine: edges that are nearer to parallel have their nearest points at an end; of a triangle: it has no inside. */
static const double FLAT = 1e-16;

static Vec3 vertex(const double *x, int i)
{
    return vec3_load(x + 3 * i);
}

static Vec3 between(const double *x, int from, int to)
{
    return vec3_sub(vertex(x, to), vertex(x, from));
}

/* Vertex p and the nearest point of the edge from i to j; sign: of p's weight. */
typedef struct Candidate {
    Vec3 c; /* from the edge to the vertex */
    double square, t, sign;
    int p, i, j;
} Candidate;

static Candidate try_edge(const double *x, int p, int i, int j, double sign)
{
    Vec3 r = between(x, i, p), e = between(x, i, j);
    double length = vec3_dot(e, e), t = length > 0 ? vec3_dot(r, e) / length : 0;
    t = t > 0 ? t < 1 ? t : 1 : 0;
    Vec3 c = vec3_axpy(-t, e, r);
    return (Candidate){c, vec3_dot(c, c), t, sign, p, i, j};
}

static const Candidate *nearer(const Candidate *a, const Candidate *b)
{
    return b->square < a->square ? b : a;
}

static Distance distance_of(const Candidate *best)
{
    Distance d = {.square = best->square, .slides = best->t > 0 && best->t < 1};
    double sign = best->sign;
    vec3_store(d.c, vec3_scale(sign, best->c));
    d.w[best->p] = sign, d.w[best->i] = -sign * (1 - best->t), d.w[best->j] = -sign * best->t;
    d.W[0][best->i] = sign, d.W[0][best->j] = -sign;
    return d;
}

/* c along n where both nearest points are inside: r is from the other's first vertex to the first's. */
static void set_normal(Distance *d, Vec3 n, double square, Vec3 r)
{
    Vec3 c = vec3_scale(vec3_dot(r, n) / square, n);
    vec3_store(d->c, c);
    d->square = vec3_dot(c, c);
    d->slides = 2;
}

Distance distance_point_edge(const double x[DISTANCE_DOFS])
{
    Candidate only = try_edge(x, 0, 1, 2, 1);
    return distance_of(&only);
}

Distance distance_point_triangle(const double x[DISTANCE_DOFS])
{
    Vec3 a = between(x, 1, 2), b = between(x, 1, 3), r = between(x, 1, 0), n = vec3_cross(a, b);
    double square = vec3_dot(n, n);
    if (square > FLAT * vec3_dot(a, a) * vec3_dot(b, b)) {
        double u = vec3_dot(vec3_cross(r, b), n) / square, v = vec3_dot(vec3_cross(a, r), n) / square;
        if (u > 0 && v > 0 && u + v < 1) {
            Distance d = {.w = {1, u + v - 1, -u, -v}, .W = {{0, 1, -1, 0}, {0, 1, 0, -1}}};
            set_normal(&d, n, square, r);
            return d;
        }
    }
    Candidate sides[3] = {try_edge(x, 0, 1, 2, 1), try_edge(x, 0, 2, 3, 1), try_edge(x, 0, 3, 1, 1)};
    return distance_of(nearer(nearer(&sides[0], &sides[1]), &sides[2]));
}

Distance distance_edges(const double x[DISTANCE_DOFS])
{
    Vec3 a = between(x, 0, 1), b = between(x, 2, 3), r = between(x, 2, 0), n = vec3_cross(a, b);
    double square = vec3_dot(n, n);
    if (square > FLAT * vec3_dot(a, a) * vec3_dot(b, b)) {
        double s = vec3_dot(vec3_cross(b, r), n) / square, t = vec3_dot(vec3_cross(a, r), n) / square;
        if (s > 0 && s < 1 && t > 0 && t < 1) {
            Distance d = {.w = {1 - s, s, t - 1, -t}, .W = {{-1, 1, 0, 0}, {0, 0, 1, -1}}};
            set_normal(&d, n, square, r);
            return d;
        }
    }
    Candidate ends[4] = {try_edge(x, 0, 2, 3, 1), try_edge(x, 1, 2, 3, 1), try_edge(x, 2, 0, 1, -1),
                         try_edge(x, 3, 0, 1, -1)};
    return distance_of(nearer(nearer(nearer(&ends[0], &ends[1]), &ends[2]), &ends[3]));
}

Slide distance_slide(const Distance *d, const double x[DISTANCE_DOFS])
{
    Slide slide = {0};
    Vec3 t[2] = {{0}};
    for (int k = 0; k < d->slides; k++) {
        for (int i = 1; i < 4; i++) t[k] = vec3_axpy(d->W[k][i], between(x, 0, i), t[k]);
        vec3_store(slide.t[k], t[k]);
        for (int i = 0; i < DISTANCE_DOFS; i++)
            slide.q[k][i] = d->W[k][i / 3] * d->c[i % 3] + d->w[i / 3] * slide.t[k][i % 3];
    }
    if (d->slides == 1) slide.inverse[0] = 1 / vec3_dot(t[0], t[0]);
    if (d->slides < 2) return slide;
    Vec3 n = vec3_cross(t[0], t[1]);
    double square = vec3_dot(n, n);
    slide.inverse[0] = vec3_dot(t[1], t[1]) / square;
    slide.inverse[1] = -vec3_dot(t[0], t[1]) / square;
    slide.inverse[2] = vec3_dot(t[0], t[0]) / square;
    return slide;
}

void distance_add_hessian(const Distance *d, const double x[DISTANCE_DOFS], double a, double b,
                          double H[DISTANCE_LOWER])
{
    Slide s = distance_slide(d, x);
    double g[DISTANCE_DOFS], r[2][DISTANCE_DOFS]; /* r = b (t.t)^-1 q */
    for (int i = 0; i < DISTANCE_DOFS; i++) {
        g[i] = 2 * d->w[i / 3] * d->c[i % 3];
        r[0][i] = 2 * b * (s.inverse[0] * s.q[0][i] + s.inverse[1] * s.q[1][i]);
        r[1][i] = 2 * b * (s.inverse[1] * s.q[0][i] + s.inverse[2] * s.q[1][i]);
    }
    for (int i = 0, k = 0; i < DISTANCE_DOFS; i++)
        for (int j = 0; j <= i; j++, k++) {
            H[k] += a * g[i] * g[j] - r[0][i] * s.q[0][j] - r[1][i] * s.q[1][j];
            if (i % 3 == j % 3) H[k] += 2 * b * d->w[i / 3] * d->w[j / 3];
        }
}

/* Of |a x b|^2 with a = x1 - x0, b = x3 - x2, over (a, b). */
static void cross_hessian(Vec3 a, Vec3 b, double H[6][6])
{
    double u[2][3], aa = vec3_dot(a, a), bb = vec3_dot(b, b), ab = vec3_dot(a, b);
    vec3_store(u[0], a);
    vec3_store(u[1], b);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            H[i][j] = 2 * ((i == j) * bb - u[1][i] * u[1][j]);
            H[3 + i][3 + j] = 2 * ((i == j) * aa - u[0][i] * u[0][j]);
            H[i][3 + j] = H[3 + j][i] = 2 * (2 * u[0][i] * u[1][j] - u[1][i] * u[0][j] - (i == j) * ab);
        }
}

double parallel_weight(const double x[DISTANCE_DOFS], double least, double g[DISTANCE_DOFS], double b,
                       double *H)
{
    Vec3 a = between(x, 0, 1), e = between(x, 2, 3), n = vec3_cross(a, e);
    double ratio = vec3_dot(n, n) / least, slope = 2 * (1 - ratio) / least, of[6], C[6][6];
    memset(g, 0, DISTANCE_DOFS * sizeof *g);
    if (ratio >= 1) return 1;
    vec3_store(of, vec3_scale(2, vec3_cross(e, n)));
    vec3_store(of + 3, vec3_scale(-2, vec3_cross(a, n)));
    for (int i = 0; i < DISTANCE_DOFS; i++) g[i] = (i / 3 % 2 ? slope : -slope) * of[i / 6 * 3 + i % 3];
    if (!H) return (2 - ratio) * ratio;
    cross_hessian(a, e, C);
    for (int i = 0, k = 0; i < DISTANCE_DOFS; i++)
        for (int j = 0; j <= i; j++, k++) {
            int p = i / 6 * 3 + i % 3, q = j / 6 * 3 + j % 3;
            double sign = i / 3 % 2 == j / 3 % 2 ? b : -b;
            H[k] += sign * (slope * C[p][q] - 2 / (least * least) * of[p] * of[q]);
        }
    return (2 - ratio) * ratio;
}
