#include "solve/dense.h"
#include "base/pack.h"
#include <cblas.h>
#include <math.h>
#include <string.h>

/* Rows go through registers a Pack at a time, columns so many at once: as many sums as there are registers for. */
#ifdef __AVX512F__
enum { WIDE = 8 };
#else
enum { WIDE = 4 };
#endif

/* From this depth on OpenBLAS is the faster one: it packs its operands first. */
enum { DEEP = 64 };

/* Columns of a triangle that a solve takes at a time. */
enum { FEW = 4 };

typedef double Loose __attribute__((vector_size(8 * PACK_LANES), aligned(8), may_alias)); /* at any double */

static inline Pack load(const double *from)
{
    return *(const Loose *)from;
}

static inline void store(double *to, Pack a)
{
    *(Loose *)to = a;
}

/* s[cols] -= x[depth] B[cols][depth]^T, of which cols is a constant where this is inlined. */
__attribute__((always_inline)) static inline void take(int cols, int depth, const Pack *x, const double *b,
                                                       long ld, Pack *s)
{
    for (int k = 0; k < depth; k++)
        for (int c = 0; c < cols; c++) s[c] -= x[k] * b[c + k * ld];
}

/* x[first + c] for c < cols, of a Pack of rows whose columns before these are done: x = (x - ..) L^-T. */
__attribute__((always_inline)) static inline void follow_columns(int cols, int first, const double *l,
                                                                 long ld, const double *inverse, Pack *x)
{
    Pack s[WIDE];
    for (int c = 0; c < cols; c++) s[c] = x[first + c];
    take(cols, first, x, l + first, ld, s);
    for (int c = 0; c < cols; c++) {
        s[c] *= inverse[first + c];
        for (int d = c + 1; d < cols; d++) s[d] -= s[c] * l[first + d + (first + c) * ld];
    }
    for (int c = 0; c < cols; c++) x[first + c] = s[c];
}

static void follow(int n, const double *l, long ld, const double *inverse, Pack *x)
{
    int c = 0;
    for (; c + WIDE <= n; c += WIDE) follow_columns(WIDE, c, l, ld, inverse, x);
    for (; c + 4 <= n; c += 4) follow_columns(4, c, l, ld, inverse, x);
    for (; c < n; c++) follow_columns(1, c, l, ld, inverse, x);
}

/* The first `rows` of a Pack of rows, n columns of them. */
static void load_rows(int rows, int n, const double *a, long ld, Pack *x)
{
    for (int c = 0; c < n; c++) {
        x[c] = (Pack){0};
        for (int l = 0; l < rows; l++) x[c][l] = a[l + c * ld];
    }
}

static void store_rows(int rows, int n, const Pack *x, double *a, long ld)
{
    for (int c = 0; c < n; c++)
        for (int l = 0; l < rows; l++) a[l + c * ld] = x[c][l];
}

void dense_follow(int rows, int n, const double *l, double *a, long ld)
{
    double inverse[DENSE_PANEL];
    Pack x[DENSE_PANEL];
    int i = 0;
    for (int c = 0; c < n; c++) inverse[c] = 1 / l[c + c * ld];
    for (; i + PACK_LANES <= rows; i += PACK_LANES) {
        for (int c = 0; c < n; c++) x[c] = load(a + i + c * ld);
        follow(n, l, ld, inverse, x);
        for (int c = 0; c < n; c++) store(a + i + c * ld, x[c]);
    }
    if (i == rows) return;
    load_rows(rows - i, n, a + i, ld, x);
    follow(n, l, ld, inverse, x);
    store_rows(rows - i, n, x, a + i, ld);
}

/* The block of rows and columns from `first` on: reduced by the columns before already. */
static bool pivot(int first, int n, double *a, long ld, double *inverse)
{
    for (int c = first; c < n; c++) {
        double *column = a + c * ld, d = column[c];
        if (!(d > 0) || isinf(d)) return false;
        column[c] = sqrt(d);
        inverse[c] = 1 / column[c];
        for (int i = c + 1; i < n; i++) column[i] *= inverse[c];
        for (int e = c + 1; e < n; e++)
            for (int i = e; i < n; i++) a[i + e * ld] -= column[i] * column[e];
    }
    return true;
}

bool dense_cholesky(int n, double *a, long ld)
{
    double inverse[DENSE_PANEL];
    Pack x[DENSE_PANEL];
    for (int i = 0; i < n; i += PACK_LANES) {
        int rows = n - i < PACK_LANES ? n - i : PACK_LANES;
        load_rows(rows, i + rows, a + i, ld, x);
        follow(i, a, ld, inverse, x);
        store_rows(rows, i, x, a + i, ld);
        for (int c = i; c < i + rows; c++) take(1, i, x, a + c, ld, x + c);
        store_rows(rows, rows, x + i, a + i + i * ld, ld);
        if (!pivot(i, i + rows, a, ld, inverse)) return false;
    }
    return true;
}

/* Of a Pack of rows. */
__attribute__((always_inline)) static inline void
subtract_columns(int cols, int depth, const Pack *x, const double *b, long ld, double *c, long ldc)
{
    Pack s[WIDE];
    for (int e = 0; e < cols; e++) s[e] = load(c + e * ldc);
    take(cols, depth, x, b, ld, s);
    for (int e = 0; e < cols; e++) store(c + e * ldc, s[e]);
}

static void subtract_rows(int cols, int depth, const Pack *x, const double *b, long ld, double *c, long ldc)
{
    int j = 0;
    for (; j + WIDE <= cols; j += WIDE) subtract_columns(WIDE, depth, x, b + j, ld, c + j * ldc, ldc);
    for (; j + 4 <= cols; j += 4) subtract_columns(4, depth, x, b + j, ld, c + j * ldc, ldc);
    for (; j < cols; j++) subtract_columns(1, depth, x, b + j, ld, c + j * ldc, ldc);
}

/* The rest of rows that make no Pack. */
static void subtract_rest(int rows, int cols, int depth, const double *a, const double *b, long ld, double *c,
                          long ldc)
{
    Pack x[DEEP], s;
    load_rows(rows, depth, a, ld, x);
    for (int j = 0; j < cols; j++) {
        load_rows(rows, 1, c + j * ldc, ldc, &s);
        take(1, depth, x, b + j, ld, &s);
        store_rows(rows, 1, &s, c + j * ldc, ldc);
    }
}

void dense_subtract(int rows, int cols, int depth, const double *a, const double *b, long ld, double *c,
                    long ldc)
{
    if (depth == 0) return;
    if (depth > DEEP) {
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, cols, depth, -1, a, (int)ld, b, (int)ld, 1,
                    c, (int)ldc);
        return;
    }
    Pack x[DEEP];
    int i = 0;
    for (; i + PACK_LANES <= rows; i += PACK_LANES) {
        for (int k = 0; k < depth; k++) x[k] = load(a + i + k * ld);
        subtract_rows(cols, depth, x, b, ld, c + i, ldc);
    }
    if (i < rows) subtract_rest(rows - i, cols, depth, a + i, b, ld, c + i, ldc);
}

void dense_subtract_square(int n, int depth, const double *a, long ld, double *c, long ldc)
{
    if (depth == 0) return;
    if (depth > DEEP) {
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, depth, -1, a, (int)ld, 1, c, (int)ldc);
        return;
    }
    Pack x[DEEP];
    int i = 0;
    for (; i + PACK_LANES <= n; i += PACK_LANES) {
        for (int k = 0; k < depth; k++) x[k] = load(a + i + k * ld);
        subtract_rows(i + PACK_LANES, depth, x, a, ld, c + i, ldc);
    }
    if (i < n) subtract_rest(n - i, n, depth, a + i, a, ld, c + i, ldc);
}

void dense_clear(int rows, int cols, double *a, long ld)
{
    if (rows == ld)
        memset(a, 0, (size_t)rows * (size_t)cols * sizeof *a);
    else
        for (int c = 0; c < cols; c++) memset(a + c * ld, 0, (size_t)rows * sizeof *a);
}

static inline double sum_product(int n, const double *a, const double *b)
{
    Pack sum = {0};
    double rest = 0;
    int i = 0;
    for (; i + PACK_LANES <= n; i += PACK_LANES) sum += load(a + i) * load(b + i);
    for (; i < n; i++) rest += a[i] * b[i];
    return rest + pack_sum(sum, PACK_LANES);
}

void dense_multiply(int rows, int n, const double *a, long ld, const double *x, double *y)
{
    int c = 0;
    for (; c + 4 <= n; c += 4, a += 4 * ld)
        for (int i = 0; i < rows; i++)
            y[i] -=
                a[i] * x[c] + a[i + ld] * x[c + 1] + (a[i + 2 * ld] * x[c + 2] + a[i + 3 * ld] * x[c + 3]);
    for (; c < n; c++, a += ld)
        for (int i = 0; i < rows; i++) y[i] -= a[i] * x[c];
}

/* Four columns of A at a time, so that y is read once for them. */
static void multiply_four(int rows, const double *a, long ld, const double *y, double *x)
{
    Pack sum[4] = {{0}};
    double rest[4] = {0};
    int i = 0;
    for (; i + PACK_LANES <= rows; i += PACK_LANES)
        for (int c = 0; c < 4; c++) sum[c] += load(a + i + c * ld) * load(y + i);
    for (; i < rows; i++)
        for (int c = 0; c < 4; c++) rest[c] += a[i + c * ld] * y[i];
    for (int c = 0; c < 4; c++) x[c] -= rest[c] + pack_sum(sum[c], PACK_LANES);
}

void dense_multiply_transposed(int rows, int n, const double *a, long ld, const double *y, double *x)
{
    int c = 0;
    for (; c + 4 <= n; c += 4) multiply_four(rows, a + c * ld, ld, y, x + c);
    for (; c < n; c++) x[c] -= sum_product(rows, a + c * ld, y);
}

/* Of few columns. */
static void forward_columns(int n, const double *l, long ld, double *x)
{
    for (int c = 0; c < n; c++) {
        x[c] /= l[c + c * ld];
        for (int i = c + 1; i < n; i++) x[i] -= l[i + c * ld] * x[c];
    }
}

static void backward_columns(int n, const double *l, long ld, double *x)
{
    for (int c = n - 1; c >= 0; c--) {
        for (int i = c + 1; i < n; i++) x[c] -= l[i + c * ld] * x[i];
        x[c] /= l[c + c * ld];
    }
}

void dense_forward(int n, const double *l, long ld, double *x)
{
    for (int c = 0; c < n; c += FEW, l += FEW * (ld + 1)) {
        int few = n - c < FEW ? n - c : FEW;
        forward_columns(few, l, ld, x + c);
        dense_multiply(n - c - few, few, l + few, ld, x + c, x + c + few);
    }
}

void dense_backward(int n, const double *l, long ld, double *x)
{
    l += (n - 1) / FEW * FEW * (ld + 1);
    for (int c = (n - 1) / FEW * FEW; c >= 0; c -= FEW, l -= FEW * (ld + 1)) {
        int few = n - c < FEW ? n - c : FEW;
        dense_multiply_transposed(n - c - few, few, l + few, ld, x + c + few, x + c);
        backward_columns(few, l, ld, x + c);
    }
}

bool dense_is_finite(long count, const double *values)
{
    Pack sum = {0};
    double rest = 0;
    long i = 0;
    for (; i + PACK_LANES <= count; i += PACK_LANES) sum += load(values + i) * 0;
    for (; i < count; i++) rest += values[i] * 0;
    return rest + pack_sum(sum, PACK_LANES) == 0;
}
