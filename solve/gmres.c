#include "solve/gmres.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* The Krylov space in the making: the basis, and the triangle that rotations make of its Hessenberg matrix. */
typedef struct Krylov {
    int n, room;
    double *basis;             /* [room + 1][n]                                       */
    double *R;                 /* [room][room + 1] columns                            */
    double *cosine, *sine, *g; /* [room], [room], [room + 1] what is left, rotated    */
} Krylov;

static double *basis_vector(const Krylov *k, int j)
{
    return k->basis + (size_t)j * (size_t)k->n;
}

static double *column_of(const Krylov *k, int j)
{
    return k->R + (size_t)j * ((size_t)k->room + 1);
}

/* (I + K) v_j, orthogonal to the basis (twice is enough), becomes v_j+1. */
static void extend(Krylov *k, int j, GmresProduct *product, void *self)
{
    double *v = basis_vector(k, j), *next = basis_vector(k, j + 1), *h = column_of(k, j);
    product(self, v, next);
    for (int i = 0; i < k->n; i++) next[i] += v[i];
    for (int pass = 0; pass < 2; pass++)
        for (int m = 0; m <= j; m++) {
            double part = dot(k->n, basis_vector(k, m), next);
            h[m] += part;
            for (int i = 0; i < k->n; i++) next[i] -= part * basis_vector(k, m)[i];
        }
    h[j + 1] = sqrt(dot(k->n, next, next));
    for (int i = 0; h[j + 1] > 0 && i < k->n; i++) next[i] /= h[j + 1];
}

/* Givens rotations so far and one more, that makes h[j + 1] vanish. */
static void rotate(Krylov *k, int j)
{
    double *h = column_of(k, j);
    for (int m = 0; m < j; m++) {
        double a = h[m], b = h[m + 1];
        h[m] = k->cosine[m] * a + k->sine[m] * b;
        h[m + 1] = k->cosine[m] * b - k->sine[m] * a;
    }
    double size = hypot(h[j], h[j + 1]);
    k->cosine[j] = size > 0 ? h[j] / size : 1;
    k->sine[j] = size > 0 ? h[j + 1] / size : 0;
    h[j] = size, h[j + 1] = 0;
    k->g[j + 1] = -k->sine[j] * k->g[j];
    k->g[j] *= k->cosine[j];
}

static void combine(Krylov *k, int count, double *x)
{
    for (int j = count - 1; j >= 0; j--) {
        for (int m = j + 1; m < count; m++) k->g[j] -= column_of(k, m)[j] * k->g[m];
        k->g[j] /= column_of(k, j)[j];
    }
    memset(x, 0, (size_t)k->n * sizeof *x);
    for (int j = 0; j < count; j++)
        for (int i = 0; i < k->n; i++) x[i] += k->g[j] * basis_vector(k, j)[i];
}

bool gmres_solve(int n, GmresProduct *product, void *self, const double *b, double tolerance,
                 int max_iterations, double *x)
{
    double size = sqrt(dot(n, b, b));
    if (!(size > 0)) {
        if (x != b) memcpy(x, b, (size_t)n * sizeof *x);
        return size == 0;
    }
    size_t room = (size_t)max_iterations;
    Krylov k = {.n = n, .room = max_iterations, .basis = mem_alloc((room + 1) * (size_t)n, sizeof(double))};
    k.R = mem_alloc(room * (room + 1), sizeof(double));
    k.cosine = mem_alloc(3 * room + 1, sizeof(double));
    k.sine = k.cosine + room, k.g = k.sine + room;
    for (int i = 0; i < n; i++) k.basis[i] = b[i] / size;
    k.g[0] = size;
    int count = 0;
    while (count < max_iterations && fabs(k.g[count]) > tolerance * size) {
        extend(&k, count, product, self);
        rotate(&k, count++);
    }
    bool reached = fabs(k.g[count]) <= tolerance * size;
    combine(&k, count, x);
    mem_free(k.basis);
    mem_free(k.R);
    mem_free(k.cosine);
    return reached;
}
