/* The part of a law's stiffness that is not negative: at each point the eigenvalues of d2psi/dF dF are known from the
 * singular values of F [Smith, de Goes, Kim 2019], and negative ones become 0. With D_m its nine eigenvectors times the
 * roots of their eigenvalues, the block of nodes a and b is w sum_m (D_m grad N_a) (D_m grad N_b)^T. */
#include "solid/law.h"
#include "solve/element.h"

/* Turns columns i and j of a[3][3]. */
static void turn(double a[3][3], int i, int j, double c, double s)
{
    for (int k = 0; k < 3; k++) {
        double x = a[k][i], y = a[k][j];
        a[k][i] = c * x + s * y, a[k][j] = c * y - s * x;
    }
}

static double column_dot(double a[3][3], int i, int j)
{
    return a[0][i] * a[0][j] + a[1][i] * a[1][j] + a[2][i] * a[2][j];
}

static void set_across(double a[3][3], int i)
{
    int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int r = 0; r < 3; r++) {
        int p = (r + 1) % 3, q = (r + 2) % 3;
        a[r][i] = a[p][j] * a[q][k] - a[q][j] * a[p][k];
    }
}

/* U's columns: those of U S over S, and what completes a rotation where S is 0 (or F has no direction there). */
static void complete(double U[3][3], double s[3], double tiny)
{
    int largest = 0;
    for (int i = 1; i < 3; i++)
        if (s[i] > s[largest]) largest = i;
    int j = (largest + 1) % 3, k = (largest + 2) % 3;
    if (s[k] > s[j]) j = k, k = (largest + 1) % 3;
    for (int i = 0; i < 3; i++)
        for (int r = 0; s[i] > tiny && r < 3; r++) U[r][i] /= s[i];
    if (s[largest] <= tiny)
        for (int r = 0; r < 3; r++) U[r][largest] = r == largest;
    if (s[j] <= tiny) { /* any direction across the first */
        int least = 0;
        for (int r = 1; r < 3; r++)
            if (fabs(U[r][largest]) < fabs(U[least][largest])) least = r;
        double part = U[least][largest], length = sqrt(1 - part * part);
        for (int r = 0; r < 3; r++) U[r][j] = ((r == least) - part * U[r][largest]) / length;
    }
    double third[3] = {U[0][k], U[1][k], U[2][k]}, along = 0;
    set_across(U, k);
    for (int r = 0; r < 3; r++) along += third[r] * U[r][k];
    if (s[k] > tiny && along < 0) s[k] = -s[k];
}

/* F = U S V^T with rotations U and V, the least singular value with the sign of det F: columns of F are turned until they
 * are across each other [one-sided Jacobi: Hestenes 1958]. */
static void decompose(double F[3][3], double U[3][3], double s[3], double V[3][3])
{
    for (int i = 0; i < 9; i++) U[i / 3][i % 3] = F[i / 3][i % 3], V[i / 3][i % 3] = i % 4 == 0;
    for (int sweep = 0; sweep < 12; sweep++)
        for (int i = 0; i < 3; i++)
            for (int j = i + 1; j < 3; j++) {
                double angle =
                    0.5 * atan2(2 * column_dot(U, i, j), column_dot(U, i, i) - column_dot(U, j, j));
                turn(U, i, j, cos(angle), sin(angle));
                turn(V, i, j, cos(angle), sin(angle));
            }
    double size = 0;
    for (int i = 0; i < 3; i++) s[i] = sqrt(column_dot(U, i, i)), size = fmax(size, s[i]);
    complete(U, s, 1e-14 * size);
}

/* Eigenvectors (columns) and eigenvalues of a symmetric A, which is lost. */
static void eigen(double A[3][3], double vectors[3][3], double values[3])
{
    for (int i = 0; i < 9; i++) vectors[i / 3][i % 3] = i % 4 == 0;
    for (int sweep = 0; sweep < 12; sweep++)
        for (int i = 0; i < 3; i++)
            for (int j = i + 1; j < 3; j++) {
                double angle = 0.5 * atan2(2 * A[i][j], A[i][i] - A[j][j]), c = cos(angle), sine = sin(angle);
                turn(A, i, j, c, sine);
                for (int k = 0; k < 3; k++) {
                    double x = A[i][k], y = A[j][k];
                    A[i][k] = c * x + sine * y, A[j][k] = c * y - sine * x;
                }
                turn(vectors, i, j, c, sine);
            }
    for (int i = 0; i < 3; i++) values[i] = A[i][i];
}

/* a u_i v_j^T is added to D. */
static void add_outer(double D[3][3], double a, double U[3][3], int i, double V[3][3], int j)
{
    for (int k = 0; k < 9; k++) D[k / 3][k % 3] += a * U[k / 3][i] * V[k % 3][j];
}

/* D_m of one point. */
static void roots(const Law *law, Lame lame, double F[3][3], double D[9][3][3])
{
    double U[3][3], s[3], V[3][3], vectors[3][3], values[3];
    decompose(F, U, s, V);
    LawModes modes = law->modes(lame, s);
    eigen(modes.stretch, vectors, values);
    memset(D, 0, 9 * sizeof *D);
    for (int m = 0; m < 3; m++) {
        double stretch = sqrt(fmax(values[m], 0)), twist = sqrt(0.5 * fmax(modes.twist[m], 0)),
               flip = sqrt(0.5 * fmax(modes.flip[m], 0));
        int i = (m + 1) % 3, j = (m + 2) % 3;
        for (int k = 0; k < 3; k++) add_outer(D[m], stretch * vectors[k][m], U, k, V, k);
        add_outer(D[3 + m], twist, U, i, V, j), add_outer(D[3 + m], -twist, U, j, V, i);
        add_outer(D[6 + m], flip, U, i, V, j), add_outer(D[6 + m], flip, U, j, V, i);
    }
}

/* The same of a pack. */
static void pack_roots(const Law *law, Lame lame, const PackMat *F, PackMat D[9])
{
    for (int l = 0; l < PACK_LANES; l++) {
        double own[3][3] = {{F->r0.x[l], F->r0.y[l], F->r0.z[l]},
                            {F->r1.x[l], F->r1.y[l], F->r1.z[l]},
                            {F->r2.x[l], F->r2.y[l], F->r2.z[l]}},
               modes[9][3][3];
        roots(law, lame, own, modes);
        for (int m = 0; m < 9; m++) {
            Pack3 *rows[3] = {&D[m].r0, &D[m].r1, &D[m].r2};
            for (int r = 0; r < 3; r++)
                rows[r]->x[l] = modes[m][r][0], rows[r]->y[l] = modes[m][r][1],
                rows[r]->z[l] = modes[m][r][2];
        }
    }
}

void law_clamped_stiffness(const Law *law, Lame lame, const LawPoint *points, int point_count, int nodes,
                           Pack *H)
{
    for (int q = 0; q < point_count; q++) {
        PackMat D[9];
        pack_roots(law, lame, &points[q].F, D);
        for (int m = 0; m < 9; m++) {
            Pack3 v[TET_MAX_NODES];
            for (int a = 0; a < nodes; a++) v[a] = pack_mat_times(D[m], points[q].gradient[a]);
            for (int a = 0; a < nodes; a++) {
                Pack3 weighted = pack3_scale(points[q].weight, v[a]);
                element_add_diagonal(H, a, pack_mat_outer(weighted, v[a]));
                for (int b = 0; b < a; b++) element_add_block(H, a, b, pack_mat_outer(weighted, v[b]));
            }
        }
    }
}
