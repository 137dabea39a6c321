#include "optim/design.h"
#include "base/memory.h"
#include <assert.h>
#include <math.h>

enum { MAX_WIDTH = 8 };

void design_add(Design *design, Unknown unknown)
{
    assert(design->unknown_count < DESIGN_MAX_UNKNOWNS && unknown.block->width <= MAX_WIDTH);
    if (!unknown.group) {
        unknown.group_count = unknown.block->count;
        unknown.group = mem_alloc((size_t)unknown.group_count, sizeof(int));
        for (int r = 0; r < unknown.group_count; r++) unknown.group[r] = r;
    }
    unknown.first = design->size;
    int copies = unknown.per_case ? design->case_count : 1;
    design->size += copies * unknown.group_count * unknown.block->width;
    design->unknowns[design->unknown_count++] = unknown;
}

void design_clear(Design *design)
{
    for (int k = 0; k < design->unknown_count; k++) mem_free(design->unknowns[k].group);
    *design = (Design){0};
}

/* A row of the block: its numbers in u and in p. NULL where the row is not unknown. */
static const double *row_of(const Unknown *unknown, int load_case, const double *u, int row)
{
    if (unknown->group[row] < 0) return NULL;
    int copy = unknown->per_case ? load_case : 0, width = unknown->block->width;
    return u + unknown->first + (copy * unknown->group_count + unknown->group[row]) * width;
}

static double length(int width, const double *v)
{
    double sum = 0;
    for (int i = 0; i < width; i++) sum += v[i] * v[i];
    return sqrt(sum);
}

static void map_row(const Unknown *unknown, const double *u, double *p)
{
    int width = unknown->block->width;
    double size = length(width, u), factor = unknown->scale;
    if (unknown->map == UNKNOWN_FIXED_LENGTH) factor = unknown->limit / size;
    if (unknown->map == UNKNOWN_CAPPED_LENGTH) factor /= sqrt(1 + pow(factor * size / unknown->limit, 2));
    for (int i = 0; i < width; i++) p[i] = unknown->map == UNKNOWN_LOG ? exp(factor * u[i]) : factor * u[i];
}

static void unmap_row(const Unknown *unknown, const double *p, double *u)
{
    int width = unknown->block->width;
    double size = length(width, p), factor = 1 / unknown->scale;
    if (unknown->map == UNKNOWN_FIXED_LENGTH) factor = 1 / unknown->limit;
    if (unknown->map == UNKNOWN_CAPPED_LENGTH) factor /= sqrt(fmax(1 - pow(size / unknown->limit, 2), 1e-6));
    for (int i = 0; i < width; i++) u[i] = unknown->map == UNKNOWN_LOG ? factor * log(p[i]) : factor * p[i];
}

/* out = (dp/du) in at a row; the matrix is symmetric for every map. */
static void row_derivative(const Unknown *unknown, const double *u, const double *in, double *out)
{
    int width = unknown->block->width;
    double size = length(width, u), along = 0, factor = unknown->scale, pull = 0;
    for (int i = 0; i < width; i++) along += u[i] * in[i];
    if (unknown->map == UNKNOWN_FIXED_LENGTH) {
        factor = unknown->limit / size;
        pull = factor / (size * size);
    } else if (unknown->map == UNKNOWN_CAPPED_LENGTH) {
        double ratio = factor / unknown->limit, root = sqrt(1 + pow(ratio * size, 2));
        pull = factor * ratio * ratio / (root * root * root);
        factor /= root;
    }
    for (int i = 0; i < width; i++)
        out[i] = unknown->map == UNKNOWN_LOG ? factor * exp(factor * u[i]) * in[i]
                                             : factor * in[i] - pull * along * u[i];
}

void design_apply(const Design *design, int load_case, const double *u, double *p)
{
    for (int k = 0; k < design->unknown_count; k++) {
        const Unknown *unknown = &design->unknowns[k];
        for (int r = 0; r < unknown->block->count; r++) {
            const double *row = row_of(unknown, load_case, u, r);
            if (row) map_row(unknown, row, p + unknown->block->offset + r * unknown->block->width);
        }
    }
}

void design_read(const Design *design, int load_case, const double *p, double *u)
{
    for (int k = 0; k < design->unknown_count; k++) {
        const Unknown *unknown = &design->unknowns[k];
        int width = unknown->block->width;
        double *mean = mem_alloc((size_t)(unknown->group_count * (width + 1)), sizeof *mean);
        for (int r = 0; r < unknown->block->count; r++) {
            if (unknown->group[r] < 0) continue;
            double *sum = mean + unknown->group[r] * (width + 1);
            for (int i = 0; i < width; i++) sum[i] += p[unknown->block->offset + r * width + i];
            sum[width]++;
        }
        for (int g = 0; g < unknown->group_count; g++) {
            double *sum = mean + g * (width + 1);
            int copy = unknown->per_case ? load_case : 0;
            for (int i = 0; i < width; i++) sum[i] /= fmax(sum[width], 1);
            unmap_row(unknown, sum, u + unknown->first + (copy * unknown->group_count + g) * width);
        }
        mem_free(mean);
    }
}

void design_forward(const Design *design, int load_case, const double *u, const double *du, double *dp)
{
    for (int k = 0; k < design->unknown_count; k++) {
        const Unknown *unknown = &design->unknowns[k];
        for (int r = 0; r < unknown->block->count; r++) {
            double *to = dp + unknown->block->offset + r * unknown->block->width;
            for (int i = 0; i < unknown->block->width; i++) to[i] = 0;
            const double *row = row_of(unknown, load_case, u, r);
            if (row) row_derivative(unknown, row, du + (row - u), to);
        }
    }
}

void design_transpose(const Design *design, int load_case, const double *u, const double *dp, double *du)
{
    for (int k = 0; k < design->unknown_count; k++) {
        const Unknown *unknown = &design->unknowns[k];
        for (int r = 0; r < unknown->block->count; r++) {
            const double *row = row_of(unknown, load_case, u, r);
            if (!row) continue;
            double out[MAX_WIDTH];
            row_derivative(unknown, row, dp + unknown->block->offset + r * unknown->block->width, out);
            for (int i = 0; i < unknown->block->width; i++) du[row - u + i] += out[i];
        }
    }
}

static double bound(const Unknown *unknown, double p)
{
    if (unknown->map == UNKNOWN_LINEAR) return p / unknown->scale;
    if (unknown->map == UNKNOWN_LOG) return p > 0 ? log(p) / unknown->scale : -INFINITY;
    return p < 0 ? -INFINITY : INFINITY;
}

void design_bounds(const Design *design, double *lower, double *upper)
{
    for (int k = 0; k < design->unknown_count; k++) {
        const Unknown *unknown = &design->unknowns[k];
        int copies = unknown->per_case ? design->case_count : 1;
        int end = unknown->first + copies * unknown->group_count * unknown->block->width;
        for (int i = unknown->first; i < end; i++) {
            lower[i] = bound(unknown, unknown->lower);
            upper[i] = bound(unknown, unknown->upper);
        }
    }
}
