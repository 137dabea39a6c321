#include "solve/sparse.h"
#include "base/clock.h"
#include "base/memory.h"
#include "solve/product.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nonzeros of L, in those of the matrix as it was made, from which on another order is looked for. */
static const double FILL_MOST = 1.6;

enum { GROUP_MOST = 32 }; /* in sparse_slots */

/* The matrix as it is factored: in its own order, or, where L would have too many nonzeros so, in another one. */
typedef struct Elimination {
    Direct *direct; /* NULL: nothing was factored yet      */
    Pattern other;  /* in another order; empty: in its own */
    int *moved;     /* [entries] where each stands there   */
    double *values; /* there                               */
} Elimination;

struct Sparse {
    int n, negative;
    DirectKind direct;
    bool ordered;    /* in an order that was given                             */
    Pattern made;    /* of the groups that it was made of, in their order      */
    Pattern pattern; /* the same, or with others coupled beside them           */
    int *where;      /* [entries of made] where each stands in it; NULL: at its own place */
    Direct *direct_made;
    Elimination elimination;
    Product *product;
    Factor *factor;   /* at hand; NULL: none was made */
    const int *rank;  /* [n] where unknown i went     */
    Workers *workers; /* borrowed                     */
    double *values;
    double *diagonal; /* [n] kept aside while a shift stands on the diagonal                          */
    double *cg;       /* [6][n] x, residual, direction, product, M^-1 residual of it; a solve's b; permuted */
    SparseInfo info;
};

/* rank[i] = where unknown i comes in an order. */
static int *rank_of(int n, const int *order)
{
    int *rank = mem_alloc((size_t)n, sizeof *rank);
    for (int k = 0; k < n; k++) rank[order[k]] = k;
    return rank;
}

static void elimination_clear(Elimination *e)
{
    direct_release(e->direct);
    pattern_destroy(&e->other);
    mem_free(e->moved);
    mem_free(e->values);
    *e = (Elimination){0};
}

/* Takes over what the matrix is from now on; where may be NULL. */
static void set_pattern(Sparse *matrix, Pattern pattern, int *where)
{
    if (matrix->where) pattern_destroy(&matrix->pattern);
    mem_free(matrix->where);
    elimination_clear(&matrix->elimination);
    product_destroy(matrix->product);
    mem_free(matrix->values);
    matrix->pattern = pattern;
    matrix->where = where;
    matrix->product = product_create(&matrix->pattern);
    matrix->values = mem_alloc((size_t)sparse_nonzeros(matrix), sizeof(double));
}

static void note_cost(Sparse *matrix, const Direct *direct)
{
    DirectCost cost = direct_cost(direct);
    matrix->info.factor_nonzeros = cost.nonzeros;
    matrix->info.factor_bytes = cost.bytes;
    matrix->info.factor_flops = cost.flops;
    if (cost.all_bytes < matrix->info.all_bytes) return;
    matrix->info.process_bytes = cost.process_bytes;
    matrix->info.all_bytes = cost.all_bytes;
}

Sparse *sparse_create(int n, Groups groups, SparseDef def)
{
    Sparse *matrix = mem_alloc(1, sizeof *matrix);
    matrix->n = n;
    if (n == 0) return matrix;
    int *rank;
    if (def.order) {
        rank = rank_of(n, def.order);
    } else {
        Pattern plain = pattern_create(n, groups, NULL);
        rank = direct_order(&plain, DIRECT_OFTEN);
        pattern_destroy(&plain);
    }
    matrix->negative = def.negative;
    matrix->direct = def.direct;
    matrix->ordered = def.order != NULL;
    matrix->made = pattern_create(n, groups, rank);
    matrix->direct_made = direct_analyse(matrix->direct, &matrix->made, rank, def.negative);
    mem_free(rank);
    matrix->rank = direct_rank(matrix->direct_made);
    note_cost(matrix, matrix->direct_made);
    set_pattern(matrix, matrix->made, NULL);
    matrix->diagonal = mem_alloc((size_t)n, sizeof(double));
    matrix->cg = mem_alloc(6 * (size_t)n, sizeof *matrix->cg);
    return matrix;
}

void sparse_couple(Sparse *matrix, Groups groups)
{
    if (matrix->n == 0) return;
    if (groups.count == 0) {
        set_pattern(matrix, matrix->made, NULL);
        return;
    }
    Pattern others = pattern_create(matrix->n, groups, matrix->rank);
    int *where = mem_alloc((size_t)sparse_made_nonzeros(matrix), sizeof *where);
    Pattern all = pattern_union(&matrix->made, &others, where);
    pattern_destroy(&others);
    set_pattern(matrix, all, where);
}

/* To be factored in an order of its own. */
static void reorder(const Sparse *matrix, Elimination *e)
{
    int n = matrix->n, *to = direct_order(&matrix->pattern, DIRECT_SELDOM);
    int *rank = mem_alloc((size_t)n, sizeof *rank);
    size_t entries = (size_t)sparse_nonzeros(matrix);
    e->moved = mem_alloc(entries, sizeof *e->moved);
    e->values = mem_alloc(entries, sizeof *e->values);
    e->other = pattern_permute(&matrix->pattern, to, e->moved);
    for (int i = 0; i < n; i++) rank[i] = to[matrix->rank[i]];
    direct_release(e->direct);
    e->direct = direct_analyse(matrix->direct, &e->other, rank, matrix->negative);
    mem_free(to);
    mem_free(rank);
}

/* How it is factored: found where it is, so that what is coupled and not factored costs nothing of it. */
static void analyse(Sparse *matrix)
{
    Elimination *e = &matrix->elimination;
    if (e->direct) return;
    if (!matrix->where) {
        e->direct = direct_share(matrix->direct_made);
    } else {
        e->direct = direct_analyse(matrix->direct, &matrix->pattern, matrix->rank, matrix->negative);
        double fill =
            (double)direct_cost(e->direct).nonzeros / (double)direct_cost(matrix->direct_made).nonzeros;
        if (!matrix->ordered && fill > FILL_MOST) reorder(matrix, e);
    }
    note_cost(matrix, e->direct);
}

int sparse_made_nonzeros(const Sparse *matrix)
{
    return matrix->n ? matrix->made.start[matrix->n] : 0;
}

const int *sparse_where(const Sparse *matrix)
{
    return matrix->where;
}

void sparse_set_workers(Sparse *matrix, Workers *workers)
{
    matrix->workers = workers;
}

void sparse_destroy(Sparse *matrix)
{
    if (!matrix) return;
    factor_release(matrix->factor);
    elimination_clear(&matrix->elimination);
    direct_release(matrix->direct_made);
    if (matrix->where) pattern_destroy(&matrix->pattern);
    pattern_destroy(&matrix->made);
    mem_free(matrix->where);
    product_destroy(matrix->product);
    mem_free(matrix->values);
    mem_free(matrix->diagonal);
    mem_free(matrix->cg);
    mem_free(matrix);
}

/* Of unknown i. */
static double *diagonal_entry(const Sparse *matrix, int i)
{
    return &matrix->values[matrix->pattern.start[matrix->rank[i]]];
}

int sparse_slot(const Sparse *matrix, int i, int j)
{
    int a = matrix->rank[i], b = matrix->rank[j];
    return pattern_slot(&matrix->pattern, a > b ? a : b, a > b ? b : a);
}

/* Members of the group in the order of elimination; returns how many there are. */
static int sort_group(const Sparse *matrix, int count, const int *unknowns, int *order)
{
    int found = 0;
    for (int i = 0; i < count; i++) {
        if (unknowns[i] < 0) continue;
        int k = found++;
        for (; k > 0 && matrix->rank[unknowns[order[k - 1]]] > matrix->rank[unknowns[i]]; k--)
            order[k] = order[k - 1];
        order[k] = i;
    }
    return found;
}

void sparse_slots(const Sparse *matrix, int count, const int *unknowns, int *slots)
{
    int order[GROUP_MOST];
    for (int k = 0; k < count * (count + 1) / 2; k++) slots[k] = -1;
    assert(count <= GROUP_MOST);
    int found = sort_group(matrix, count, unknowns, order);
    for (int c = 0; c < found; c++) {
        int column = matrix->rank[unknowns[order[c]]], at = matrix->pattern.start[column];
        for (int r = c; r < found; r++) {
            int i = order[c] > order[r] ? order[c] : order[r], j = order[c] + order[r] - i;
            at = pattern_slot_from(&matrix->pattern, matrix->rank[unknowns[order[r]]], column, at);
            slots[i * (i + 1) / 2 + j] = at;
        }
    }
}

double *sparse_values(Sparse *matrix)
{
    return matrix->values;
}

int sparse_nonzeros(const Sparse *matrix)
{
    return matrix->n ? matrix->pattern.start[matrix->n] : 0;
}

void sparse_diagonal(const Sparse *matrix, double *diagonal)
{
    for (int i = 0; i < matrix->n; i++) diagonal[i] = *diagonal_entry(matrix, i);
}

/* Of the values as they stand. */
static bool factor_values(Sparse *matrix)
{
    Elimination *e = &matrix->elimination;
    if (!e->moved)
        return direct_factor(e->direct, &matrix->pattern, matrix->values, &matrix->factor, matrix->workers);
    for (int k = 0; k < sparse_nonzeros(matrix); k++) e->values[e->moved[k]] = matrix->values[k];
    return direct_factor(e->direct, &e->other, e->values, &matrix->factor, matrix->workers);
}

bool sparse_factor(Sparse *matrix, const double *shift)
{
    if (matrix->n == 0) return true;
    double begin = clock_seconds();
    analyse(matrix);
    for (int i = 0; i < matrix->n; i++) {
        double *entry = diagonal_entry(matrix, i);
        matrix->diagonal[i] = *entry;
        if (shift) *entry += shift[i];
    }
    bool definite = factor_values(matrix);
    note_cost(matrix, matrix->elimination.direct);
    for (int i = 0; i < matrix->n; i++) *diagonal_entry(matrix, i) = matrix->diagonal[i];
    matrix->info.factorizations++;
    matrix->info.factor_seconds += clock_seconds() - begin;
    return definite;
}

/* x = M^-1 b with the factor at hand, which may have an order of its own; both in the matrix's. */
static void solve_permuted(Sparse *matrix, const double *b, double *x)
{
    const Factor *factor = matrix->factor;
    const int *own = matrix->rank, *other = factor_rank(factor);
    double begin = clock_seconds(), *from = matrix->cg + 5 * (size_t)matrix->n;
    for (int i = 0; own != other && i < matrix->n; i++) from[other[i]] = b[own[i]];
    const double *to = factor_solve(factor, own == other ? b : from, matrix->workers);
    for (int i = 0; i < matrix->n; i++) x[own[i]] = to[other[i]];
    matrix->info.solves++;
    matrix->info.solve_seconds += clock_seconds() - begin;
}

void sparse_solve(Sparse *matrix, const double *b, double *x)
{
    if (matrix->n == 0) return;
    double *work = matrix->cg;
    for (int i = 0; i < matrix->n; i++) work[matrix->rank[i]] = b[i];
    solve_permuted(matrix, work, work);
    for (int i = 0; i < matrix->n; i++) x[i] = work[matrix->rank[i]];
}

static void multiply_permuted(const Sparse *matrix, const double *from, double *to)
{
    product_apply(matrix->product, &matrix->pattern, matrix->values, from, to, matrix->workers);
}

void sparse_multiply(const Sparse *matrix, const double *x, double *y)
{
    int n = matrix->n;
    if (n == 0) return;
    double *from = matrix->cg, *to = from + n;
    for (int i = 0; i < n; i++) from[matrix->rank[i]] = x[i];
    multiply_permuted(matrix, from, to);
    for (int i = 0; i < n; i++) y[i] = to[matrix->rank[i]];
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

int sparse_solve_cg(Sparse *matrix, const double *b, double tolerance, int max_iterations, double *x)
{
    int n = matrix->n, k = 0;
    if (n == 0) return 0;
    double *solution = matrix->cg, *residual = solution + n, *direction = residual + n,
           *product = direction + n, *z = product + n;
    memset(solution, 0, (size_t)n * sizeof *solution);
    for (int i = 0; i < n; i++) residual[matrix->rank[i]] = b[i];
    solve_permuted(matrix, residual, z);
    double size = dot(n, residual, z), stop = tolerance * tolerance * size;
    memcpy(direction, z, (size_t)n * sizeof *direction);
    for (; size > stop; k++) {
        multiply_permuted(matrix, direction, product);
        double curvature = dot(n, direction, product), a = size / curvature;
        if (curvature <= 0) return SPARSE_INDEFINITE;
        if (k == max_iterations || !(curvature > 0)) return -1;
        for (int i = 0; i < n; i++) {
            solution[i] += a * direction[i];
            residual[i] -= a * product[i];
        }
        solve_permuted(matrix, residual, z);
        double next = dot(n, residual, z), ratio = next / size;
        for (int i = 0; i < n; i++) direction[i] = z[i] + ratio * direction[i];
        size = next;
    }
    for (int i = 0; i < n; i++) x[i] = solution[matrix->rank[i]];
    return isfinite(size) ? k : -1;
}

Factor *sparse_share_factor(Sparse *matrix)
{
    return factor_share(matrix->factor);
}

bool sparse_use_factor(Sparse *matrix, Factor *factor)
{
    if (matrix->n == 0) return true;
    if (!factor || factor_size(factor) != matrix->n) return false;
    factor_share(factor);
    factor_release(matrix->factor);
    matrix->factor = factor;
    return true;
}

SparseInfo sparse_info(const Sparse *matrix)
{
    return matrix->info;
}
