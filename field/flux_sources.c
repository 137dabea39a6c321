#include "field/flux_sources.h"
#include "field/line_charge.h"
#include "field/ring_nodes.h"
#include <stdbool.h>
#include <string.h>

static const double PER_4PI = 1 / (4 * M_PI);

/* ---- Sums of lines ---- */

/* Derivatives of a sum of F, by numbers of any order of their indices. */
typedef struct LineSum {
    double f[LINE_ALL];
} LineSum;

/* Where in LineField a derivative is: F_i, F_ij, F_ijk; each index in any order. */
static double first_of(const LineSum *sum, int i)
{
    return sum->f[i];
}

static double second_of(const LineSum *sum, int i, int j)
{
    static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    return sum->f[LINE_FIRST + at[i][j]];
}

static double third_of(const LineSum *sum, int i, int j, int k)
{
    static const int at[3][3][3] = {{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}},
                                    {{1, 3, 4}, {3, 6, 7}, {4, 7, 8}},
                                    {{2, 4, 5}, {4, 7, 8}, {5, 8, 9}}};
    return sum->f[LINE_FIRST + LINE_SECOND + at[i][j][k]];
}

/* sample += scale t x F, for a sum of lines whose axes 0, 1, 2 are axis[..] of the sample's, or scale F (t NULL). */
static void add_flux(FluxSample *sample, double scale, const double *t, const LineSum *sum, const int own[3])
{
    for (int c = 0; c < 3; c++) {
        int i = (c + 1) % 3, j = (c + 2) % 3;
        int parts[2] = {t ? j : c, i};
        double factor[2] = {t ? scale * t[i] : scale, t ? -scale * t[j] : 0};
        for (int k = 0; k < (t ? 2 : 1); k++) {
            if (factor[k] == 0) continue;
            int part = own[parts[k]];
            sample->flux[c] += factor[k] * first_of(sum, part);
            for (int l = 0; l < 3; l++) {
                sample->gradient[c][l] += factor[k] * second_of(sum, part, own[l]);
                for (int m = 0; m < 3; m++)
                    sample->curvature[c][l][m] += factor[k] * third_of(sum, part, own[l], own[m]);
            }
        }
    }
}

/* ---- Blocks ---- */

static const Pack first_sign = {-1, -1, 1, 1},
                  second_sign = {-1, 1, -1, 1}; /* of the four edges along an axis */

/* K, with B = K B_r, and its derivatives. */
typedef struct BlockTensor {
    double K[3][3], dK[3][3][3], ddK[3][3][3][3];
} BlockTensor;

/* K_ij of the edges along the third axis k: on each pair of faces B_r.n is a charge, whose field along the face is that of
 * the potentials of its edges. */
static void add_edges(const double half[3], const double x[3], int k, BlockTensor *o)
{
    int i = (k + 1) % 3, j = (k + 2) % 3, own[3];
    own[i] = 0, own[j] = 1, own[k] = 2;
    Pack u = x[i] - first_sign * half[i], v = x[j] - second_sign * half[j], low = pack_set(-half[k] - x[k]),
         high = pack_set(half[k] - x[k]), weights = PER_4PI * first_sign * second_sign;
    LineField line = line_field(u, v, low, high);
    LineSum sum = {{0}};
    for (int f = 0; f < LINE_ALL; f++) sum.f[f] = pack_sum(weights * line.f[f], 4);
    o->K[i][j] = o->K[j][i] = pack_sum(weights * line_potential(u, v, low, high), 4);
    for (int l = 0; l < 3; l++) {
        o->dK[i][j][l] = o->dK[j][i][l] = -first_of(&sum, own[l]);
        for (int m = 0; m < 3; m++)
            o->ddK[i][j][l][m] = o->ddK[j][i][l][m] = -second_of(&sum, own[l], own[m]);
    }
}

/* K_kk of the solid angles of the faces across k, with the step of B_r into the block: atan2 is continuous through their
 * planes. */
static double across(const double half[3], const double x[3], int k)
{
    int i = (k + 1) % 3, j = (k + 2) % 3;
    double sum = 0;
    for (int s = -1; s < 2; s += 2) {
        Pack u = x[i] - first_sign * half[i], v = x[j] - second_sign * half[j],
             w = pack_set(x[k] - s * half[k]);
        Pack R = pack_sqrt(u * u + v * v + w * w);
        sum += s * pack_sum(first_sign * second_sign * pack_atan2(u * v, w * R), 4);
    }
    return PER_4PI * sum;
}

/* What a field without curl and divergence leaves for the diagonal. */
static void fill_diagonal(BlockTensor *o, int k)
{
    for (int l = 0; l < 3; l++) {
        if (l == k) continue;
        o->dK[k][k][l] = o->dK[k][l][k];
        o->dK[k][k][k] -= o->dK[k][l][l];
        for (int m = 0; m < 3; m++) o->ddK[k][k][l][m] = o->ddK[k][l][k][m];
        o->ddK[k][k][k][l] = o->ddK[k][l][k][k];
        o->ddK[k][k][k][k] -= o->ddK[k][l][l][k];
    }
}

void flux_of_block(const double half[3], const double remanence[3], const double x[3], FluxSample *sample)
{
    BlockTensor o = {0};
    for (int k = 0; k < 3; k++) add_edges(half, x, k, &o);
    for (int k = 0; k < 3; k++) {
        o.K[k][k] = across(half, x, k);
        fill_diagonal(&o, k);
    }
    *sample = (FluxSample){0};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) {
            sample->flux[k] += o.K[k][j] * remanence[j];
            for (int l = 0; l < 3; l++) {
                sample->gradient[k][l] += o.dK[k][j][l] * remanence[j];
                for (int m = 0; m < 3; m++) sample->curvature[k][l][m] += o.ddK[k][j][l][m] * remanence[j];
            }
        }
}

/* ---- Around an axis ---- */

/* Sums around a circle, over 2 pi times their weights cos psi and sin psi, psi from the point, which is at (rho, 0, z). */
typedef struct RingSum {
    LineSum cosine, sine;
} RingSum;

/* A circle, or a cylinder around it from -half to half, and where the point is. */
typedef struct Ring {
    double radius, half, rho, z;
} Ring;

/* Level with a cylinder the point is nearer to its side than to its rims, or it is deep within. */
static bool is_beside(const Ring *ring)
{
    return fabs(ring->rho - ring->radius) < ring->half - fabs(ring->z);
}

/* Of a cylinder without ends: within it constant, beyond it a dipole in the plane. */
static void add_endless(const Ring *ring, LineSum *sum)
{
    double a = ring->radius, rho = ring->rho, first = a / (rho * rho), second = 2 * first / rho,
           third = 3 * second / rho;
    if (rho < a) {
        sum->f[0] -= 1 / a, sum->f[1] -= 1 / a;
        return;
    }
    sum->f[0] += first, sum->f[1] -= first;
    sum->f[3] -= second, sum->f[4] += second, sum->f[6] += second;
    sum->f[9] += third, sum->f[10] -= third, sum->f[12] -= third, sum->f[15] += third;
}

/* Around the circle, of lines or, a half of 0, of points: beside them those of their ends, and the rest in closed form. What is
 * odd in y goes with sin psi, all else with cos psi. */
static RingSum ring_sum(const Ring *ring)
{
    static const bool odd[LINE_ALL] = {
        [1] = true, [4] = true, [7] = true, [10] = true, [13] = true, [15] = true, [17] = true};
    bool beside = is_beside(ring);
    double level = beside ? -1 : 1, away = fmax(0, level * (fabs(ring->z) - ring->half)),
           delta = ring->rho - ring->radius;
    RingNodes nodes = ring_nodes(ring->radius, ring->rho, away);
    Pack z = pack_set(ring->z), low = -ring->half - z, high = ring->half - z;
    LineSum sum = {{0}};
    for (int k = 0; k < nodes.packs; k++) {
        RingNode at = ring_node(&nodes, k);
        Pack x = delta + 2 * ring->radius * at.sine * at.sine, y = -2 * ring->radius * at.sine * at.cosine;
        LineField field = beside           ? line_ends(x, y, low, high)
                          : ring->half > 0 ? line_field(x, y, low, high)
                                           : point_field(pack3(x, y, z));
        Pack cosine = at.share * (1 - 2 * at.sine * at.sine), sine = at.share * (2 * at.sine * at.cosine);
        for (int i = 0; i < LINE_ALL; i++)
            sum.f[i] += pack_sum((odd[i] ? sine : cosine) * field.f[i], PACK_LANES);
    }
    if (beside) add_endless(ring, &sum);
    RingSum parts = {{{0}}, {{0}}};
    for (int i = 0; i < LINE_ALL; i++) *(odd[i] ? &parts.sine.f[i] : &parts.cosine.f[i]) = sum.f[i];
    return parts;
}

static const int same_axes[3] = {0, 1, 2};
static const double x_axis[3] = {1, 0, 0}, y_axis[3] = {0, 1, 0};

/* The winding's direction is (-sin, cos, 0). */
static void add_current(FluxSample *sample, double scale, const RingSum *sum)
{
    add_flux(sample, -scale, x_axis, &sum->sine, same_axes);
    add_flux(sample, scale, y_axis, &sum->cosine, same_axes);
}

/* The ring that x is beside, and axes from it to x: on the axis those of x. */
static Ring ring_of(double radius, double half, const double x[3], double axes[3][3])
{
    Ring ring = {radius, half, hypot(x[0], x[1]), x[2]};
    double c = ring.rho > 0 ? x[0] / ring.rho : 1, s = ring.rho > 0 ? x[1] / ring.rho : 0;
    double rows[3][3] = {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
    memcpy(axes, rows, sizeof rows);
    return ring;
}

/* Across its axis it is a charge on its side, along it a sheet of current there [Caciagli et al. 2018, Derby & Olbert
 * 2010, before their elliptic integrals]. */
void flux_of_cylinder(double radius, double half, const double remanence[3], const double x[3],
                      FluxSample *sample)
{
    double axes[3][3];
    Ring ring = ring_of(radius, half, x, axes);
    RingSum sum = ring_sum(&ring);
    *sample = (FluxSample){0};
    add_current(sample, radius / 2 * remanence[2], &sum);
    const LineSum *charges[2] = {&sum.cosine, &sum.sine};
    for (int k = 0; k < 2; k++) {
        double across = axes[k][0] * remanence[0] + axes[k][1] * remanence[1];
        add_flux(sample, radius / 2 * across, NULL, charges[k], same_axes);
    }
    flux_sample_turn((const double(*)[3])axes, sample);
    if (ring.rho >= radius || fabs(x[2]) >= half) return;
    for (int k = 0; k < 2; k++) sample->flux[k] += remanence[k]; /* B = H + B_r */
}

static const double MU_0_PER_4PI = 1e-7;

/* I around, on a cylinder I/(2 half) along it. */
void flux_of_round_coil(double radius, double half, double current, const double x[3], FluxSample *sample)
{
    double axes[3][3];
    Ring ring = ring_of(radius, half, x, axes);
    RingSum sum = ring_sum(&ring);
    *sample = (FluxSample){0};
    add_current(sample, MU_0_PER_4PI * 2 * M_PI * radius * current / (half > 0 ? 2 * half : 1), &sum);
    flux_sample_turn((const double(*)[3])axes, sample);
}

void flux_of_rectangular_coil(const double half[2], double current, const double x[3], FluxSample *sample)
{
    *sample = (FluxSample){0};
    for (int along = 0; along < 2; along++)
        for (int s = -1; s < 2; s += 2) {
            int other = 1 - along, own[3];
            own[along] = 2, own[other] = 0, own[2] = 1;
            LineField line = line_field(pack_set(x[other] - s * half[other]), pack_set(x[2]),
                                        pack_set(-half[along] - x[along]), pack_set(half[along] - x[along]));
            LineSum sum;
            for (int k = 0; k < LINE_ALL; k++) sum.f[k] = line.f[k][0];
            /* counter-clockwise: along x at y < 0, along y at x > 0 */
            double direction = along == 0 ? -s : s;
            add_flux(sample, MU_0_PER_4PI * current * direction, along == 0 ? x_axis : y_axis, &sum, own);
        }
}

/* ---- Dipoles ---- */

/* B = mu_0/4 pi (3 r (m.r)/r^5 - m/r^3), differentiated twice. */
void flux_of_dipole(const double m[3], const double r[3], FluxSample *sample)
{
    double square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], d = sqrt(square);
    double mr = m[0] * r[0] + m[1] * r[1] + m[2] * r[2];
    double s3 = 1e-7 / (d * d * d), s5 = s3 / (d * d), s7 = s5 / (d * d), s9 = s7 / (d * d);
    for (int k = 0; k < 3; k++) {
        sample->flux[k] = 3 * r[k] * mr * s5 - m[k] * s3;
        for (int l = 0; l < 3; l++) {
            double kl = k == l;
            sample->gradient[k][l] =
                3 * s5 * (kl * mr + r[k] * m[l] + m[k] * r[l]) - 15 * s7 * mr * r[k] * r[l];
            for (int n = 0; n < 3; n++) {
                double kn = k == n, ln = l == n;
                sample->curvature[k][l][n] =
                    3 * s5 * (kl * m[n] + kn * m[l] + ln * m[k]) -
                    15 * s7 * (kl * mr * r[n] + r[k] * m[l] * r[n] + m[k] * r[l] * r[n]) -
                    15 * s7 * (m[n] * r[k] * r[l] + mr * (kn * r[l] + ln * r[k])) +
                    105 * s9 * mr * r[k] * r[l] * r[n];
            }
        }
    }
}
