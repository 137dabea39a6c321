#include "solve/product.h"
#include "base/memory.h"
#include <string.h>

/* Entries that are worth a block, and most blocks. */
enum { BLOCK_ENTRIES = 8192, MOST_BLOCKS = 32 };

/* Columns first .. last. Its vectors have a place for each of them and, after these, one for each row beyond that its
 * entries touch: the border. */
typedef struct Block {
    int first, last, border;
    long border_at, vector_at;
} Block;

struct Product {
    int count;
    Block *blocks;
    int *places;   /* [entry] of its row in the block's vectors              */
    int *borders;  /* [border_at + i] row i beyond                           */
    double *x, *y; /* [vector_at + i] what the block sees of x, and its sums */
};

typedef struct Multiplying {
    const Product *product;
    const Pattern *pattern;
    const double *values, *x;
    double *y;
} Multiplying;

/* Blocks of about as many entries each. */
static void set_blocks(Product *p, const Pattern *pattern)
{
    int most = 1 + pattern->start[pattern->n] / BLOCK_ENTRIES,
        count = most < MOST_BLOCKS ? most : MOST_BLOCKS;
    p->blocks = mem_alloc((size_t)count, sizeof *p->blocks);
    for (int first = 0, last; first < pattern->n; first = last) {
        long end = (long)pattern->start[pattern->n] * (p->count + 1) / count;
        for (last = first + 1; last < pattern->n && pattern->start[last] < end;) last++;
        p->blocks[p->count++] = (Block){.first = first, .last = last};
    }
}

/* The block's border, in the order in which its entries touch it, and the places of its entries. place[n] is -1 before and
 * after. */
static void set_places(Product *p, const Pattern *pattern, Block *block, int *place)
{
    int *border = p->borders + block->border_at, columns = block->last - block->first;
    for (int k = pattern->start[block->first]; k < pattern->start[block->last]; k++) {
        int row = pattern->rows[k];
        if (row >= block->last && place[row] < 0) {
            place[row] = columns + block->border;
            border[block->border++] = row;
        }
        p->places[k] = row < block->last ? row - block->first : place[row];
    }
    for (int i = 0; i < block->border; i++) place[border[i]] = -1;
}

Product *product_create(const Pattern *pattern)
{
    Product *p = mem_alloc(1, sizeof *p);
    size_t entries = (size_t)pattern->start[pattern->n];
    int *place = mem_alloc((size_t)pattern->n, sizeof *place);
    long border = 0, vector = 0;
    set_blocks(p, pattern);
    p->places = mem_alloc(entries, sizeof *p->places);
    p->borders = mem_alloc(entries, sizeof *p->borders);
    for (int i = 0; i < pattern->n; i++) place[i] = -1;
    for (int b = 0; b < p->count; b++) {
        Block *block = &p->blocks[b];
        block->border_at = border;
        block->vector_at = vector;
        set_places(p, pattern, block, place);
        border += block->border;
        vector += block->last - block->first + block->border;
    }
    p->borders = mem_resize(p->borders, (size_t)border, (size_t)border, sizeof *p->borders);
    p->x = mem_alloc((size_t)vector, sizeof *p->x);
    p->y = mem_alloc((size_t)vector, sizeof *p->y);
    mem_free(place);
    return p;
}

void product_destroy(Product *product)
{
    if (!product) return;
    mem_free(product->blocks);
    mem_free(product->places);
    mem_free(product->borders);
    mem_free(product->x);
    mem_free(product->y);
    mem_free(product);
}

static void block_task(void *self, int task)
{
    const Multiplying *m = self;
    const Product *p = m->product;
    const Block *block = &p->blocks[task];
    const int *start = m->pattern->start, *places = p->places, columns = block->last - block->first;
    double *x = p->x + block->vector_at, *y = p->y + block->vector_at;
    memcpy(x, m->x + block->first, (size_t)columns * sizeof *x);
    for (int i = 0; i < block->border; i++) x[columns + i] = m->x[p->borders[block->border_at + i]];
    memset(y, 0, (size_t)(columns + block->border) * sizeof *y);
    for (int c = 0; c < columns; c++) {
        int k = start[block->first + c], end = start[block->first + c + 1];
        double own = x[c], sum = m->values[k] * own;
        for (k++; k < end; k++) {
            y[places[k]] += m->values[k] * own;
            sum += m->values[k] * x[places[k]];
        }
        y[c] += sum;
    }
    memcpy(m->y + block->first, y, (size_t)columns * sizeof *y);
}

void product_apply(Product *product, const Pattern *pattern, const double *values, const double *x, double *y,
                   Workers *workers)
{
    Multiplying m = {product, pattern, values, x, y};
    workers_run(workers, product->count, block_task, &m);
    for (int b = 0; b < product->count; b++) {
        const Block *block = &product->blocks[b];
        const double *border = product->y + block->vector_at + block->last - block->first;
        for (int i = 0; i < block->border; i++) y[product->borders[block->border_at + i]] += border[i];
    }
}
