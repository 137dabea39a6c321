#include "spline/probes.h"
#include "base/memory.h"
#include <math.h>

enum { MAX_TILES = 512 };

/* Probes in the making. */
typedef struct Build {
    const SplinePage *page;
    const ProbesDef *def;
    Probes *probes;
    double *mean;   /* [probes->size] density of each cell   */
    double *radius; /* [probes->size] the least of any in it */
} Build;

ProbesDef probes_default(void)
{
    return (ProbesDef){.radius = 1.6, .radius_min = 1.5, .radius_max = 0.15, .cell = 0.4, .faint = 0.03};
}

static double bound(double density)
{
    return fmin(fmax(density, 0), 1);
}

static double radius_for(const Build *b, double density)
{
    double R = b->def->radius * b->page->pen / fmax(density, 1e-9);
    return fmin(fmax(R, b->def->radius_min * b->page->pen), b->def->radius_max);
}

static double largest(const SplineGrid *grid)
{
    double most = 0;
    for (long k = 0; k < (long)grid->columns * grid->rows; k++) most = fmax(most, grid->values[k]);
    return bound(most);
}

/* From the coarsest level, whose cells suit the largest radius, to the one whose cells suit the darkest
 * place. */
static void lay_out_levels(Build *b, const SplineGrid *density)
{
    Probes *probes = b->probes;
    double width = b->page->width, finest = b->def->cell * radius_for(b, largest(density));
    int coarse = (int)ceil(width / (b->def->cell * b->def->radius_max)), fine = (int)ceil(width / finest);
    while (probes->level_count < PROBES_MAX_LEVELS - 1 && coarse << (probes->level_count + 1) <= fine)
        probes->level_count++;
    int columns = (fine + (1 << probes->level_count) - 1) >> probes->level_count;
    int rows = (int)ceil(b->page->height * columns / width - 1e-9);
    probes->level_count++;
    for (int l = 0; l < probes->level_count; l++) {
        ProbeLevel *level = &probes->levels[l];
        *level = (ProbeLevel){.columns = columns << l, .rows = rows << l, .first = probes->size};
        level->stride = (level->columns + 2 * PACK_LANES - 1) / PACK_LANES * PACK_LANES;
        level->dx = width / level->columns;
        level->dy = b->page->height / level->rows;
        probes->size += (long)level->stride * level->rows + PACK_LANES;
    }
}

static long cell_index(const ProbeLevel *level, int i, int j)
{
    return level->first + (long)j * level->stride + i;
}

/* Samples of the density in the finest cells: nx x ny in each. */
typedef struct Samples {
    Build *build;
    const GridSpline *spline;
    const ProbeLevel *level;
    int nx, ny;
} Samples;

/* Mean and least radius of a row of cells. */
static void sample_row(void *self, int row)
{
    const Samples *s = self;
    const ProbeLevel *level = s->level;
    long count = (long)level->columns * s->nx;
    for (int j = row * s->ny; j < (row + 1) * s->ny; j++) {
        Pack y = pack_set((j + 0.5) * level->dy / s->ny), x = y;
        for (long k = 0; k < count; k += PACK_LANES) {
            GridSample sample;
            for (int l = 0; l < PACK_LANES; l++) x[l] = ((double)(k + l) + 0.5) * level->dx / s->nx;
            grid_spline_sample(s->spline, (Pack2){x, y}, 0, &sample);
            for (int l = 0; l < PACK_LANES && k + l < count; l++) {
                long cell = cell_index(level, (int)((k + l) / s->nx), row);
                double density = bound(sample.value[0][l]);
                s->build->mean[cell] += density / (s->nx * s->ny);
                s->build->radius[cell] = fmin(s->build->radius[cell], radius_for(s->build, density));
            }
        }
    }
}

/* As many samples in each of the finest cells as it has pixels. */
static void sample_finest(Build *b, const SplineGrid *grid)
{
    GridSpline *spline = grid_spline_create(grid, b->page);
    const ProbeLevel *level = &b->probes->levels[b->probes->level_count - 1];
    Samples samples = {b, spline, level, (grid->columns + level->columns - 1) / level->columns,
                       (grid->rows + level->rows - 1) / level->rows};
    workers_run(b->def->workers, level->rows, sample_row, &samples);
    grid_spline_destroy(spline);
}

/* A cell's radius, held to that of cell (i, j) and the distance from there. */
static double graded(const Build *b, const ProbeLevel *level, double radius, int i, int j, double distance)
{
    if (i < 0 || j < 0 || i >= level->columns || j >= level->rows) return radius;
    return fmin(radius, b->radius[cell_index(level, i, j)] + distance);
}

/* Cell by cell after those to the left and above (way 1), or to the right and below (-1): distances go by the
 * eight neighbours, and are at most 8 % too long [Borgefors 1986]. */
static void sweep(Build *b, int way)
{
    const ProbeLevel *level = &b->probes->levels[b->probes->level_count - 1];
    double diagonal = hypot(level->dx, level->dy);
    for (int m = 0; m < level->rows; m++)
        for (int n = 0; n < level->columns; n++) {
            int i = way > 0 ? n : level->columns - 1 - n, j = way > 0 ? m : level->rows - 1 - m;
            double *radius = &b->radius[cell_index(level, i, j)];
            *radius = graded(b, level, *radius, i - way, j, level->dx);
            for (int k = -1; k <= 1; k++)
                *radius = graded(b, level, *radius, i + k, j - way, k ? diagonal : level->dy);
        }
}

static void coarsen(Build *b, int l)
{
    const ProbeLevel *level = &b->probes->levels[l], *finer = level + 1;
    for (int j = 0; j < level->rows; j++)
        for (int i = 0; i < level->columns; i++) {
            long cell = cell_index(level, i, j);
            for (int k = 0; k < 4; k++) {
                long child = cell_index(finer, 2 * i + k % 2, 2 * j + k / 2);
                b->mean[cell] += b->mean[child] / 4;
                b->radius[cell] = fmin(b->radius[cell], b->radius[child]);
            }
        }
}

/* A probe here, or in the four cells below. */
static void place(Build *b, int l, int i, int j)
{
    Probes *probes = b->probes;
    ProbeLevel *level = &probes->levels[l];
    long cell = cell_index(level, i, j);
    double R = b->radius[cell];
    if (l + 1 < probes->level_count && fmax(level->dx, level->dy) > b->def->cell * R) {
        for (int k = 0; k < 4; k++) place(b, l + 1, 2 * i + k % 2, 2 * j + k / 2);
        return;
    }
    probes->inverse[cell] = 1 / (R * R);
    probes->count++;
    level->reach = fmax(level->reach, R);
}

/* The density seen through a probe's W; beyond the page there is none. */
static double blurred(const Build *b, const ProbeLevel *level, int i, int j)
{
    double inverse = b->probes->inverse[cell_index(level, i, j)], sum = 0, total = 0;
    int across = (int)(1 / (sqrt(inverse) * level->dx)), down = (int)(1 / (sqrt(inverse) * level->dy));
    for (int m = j - down; m <= j + down; m++)
        for (int k = i - across; k <= i + across; k++) {
            double x = (k - i) * level->dx, y = (m - j) * level->dy, z = 1 - (x * x + y * y) * inverse;
            if (z <= 0) continue;
            total += z * z * z;
            if (k >= 0 && m >= 0 && k < level->columns && m < level->rows)
                sum += z * z * z * b->mean[cell_index(level, k, m)];
        }
    return sum / total;
}

typedef struct LevelBuild {
    const Build *build;
    const ProbeLevel *level;
} LevelBuild;

static void set_target_row(void *self, int row)
{
    const LevelBuild *b = self;
    const ProbeLevel *level = b->level;
    Probes *probes = b->build->probes;
    for (int i = 0; i < level->columns; i++) {
        long cell = cell_index(level, i, row);
        if (probes->inverse[cell] == 0) continue;
        probes->target[cell] = blurred(b->build, level, i, row);
        probes->gain[cell] = level->dx * level->dy / fmax(probes->target[cell], b->build->def->faint);
    }
}

static void set_targets(const Build *b, const ProbeLevel *level)
{
    workers_run(b->def->workers, level->rows, set_target_row, &(LevelBuild){b, level});
}

static int tile_of(double x, double size, int count)
{
    int k = (int)floor(x / size);
    return k < 0 ? 0 : k < count ? k : count - 1;
}

static void mark_tiles(Probes *probes, int l)
{
    const ProbeLevel *level = &probes->levels[l];
    for (int j = 0; j < level->rows; j++)
        for (int i = 0; i < level->columns; i++) {
            double inverse = probes->inverse[cell_index(level, i, j)];
            if (inverse == 0) continue;
            double x = (i + 0.5) * level->dx, y = (j + 0.5) * level->dy, R = 1 / sqrt(inverse);
            int left = tile_of(x - R, probes->tile_dx, probes->tile_columns);
            int right = tile_of(x + R, probes->tile_dx, probes->tile_columns);
            int bottom = tile_of(y + R, probes->tile_dy, probes->tile_rows);
            for (int m = tile_of(y - R, probes->tile_dy, probes->tile_rows); m <= bottom; m++)
                for (int k = left; k <= right; k++)
                    probes->tiles[m * probes->tile_columns + k] |= (uint16_t)(1 << l);
        }
}

static void create_tiles(Probes *probes, const SplinePage *page)
{
    const ProbeLevel *finest = &probes->levels[probes->level_count - 1];
    probes->tile_columns = finest->columns < MAX_TILES ? finest->columns : MAX_TILES;
    probes->tile_rows = finest->rows < MAX_TILES ? finest->rows : MAX_TILES;
    probes->tile_dx = page->width / probes->tile_columns;
    probes->tile_dy = page->height / probes->tile_rows;
    probes->tiles =
        mem_alloc((size_t)probes->tile_columns * (size_t)probes->tile_rows, sizeof *probes->tiles);
    for (int l = 0; l < probes->level_count; l++) mark_tiles(probes, l);
}

Probes *probes_create(const SplinePage *page, const SplineGrid *density, const ProbesDef *def)
{
    Probes *probes = mem_alloc(1, sizeof *probes);
    Build b = {.page = page, .def = def, .probes = probes};
    lay_out_levels(&b, density);
    size_t size = (size_t)probes->size;
    probes->inverse = mem_alloc(size, sizeof *probes->inverse);
    probes->target = mem_alloc(size, sizeof *probes->target);
    probes->gain = mem_alloc(size, sizeof *probes->gain);
    b.mean = mem_alloc(2 * size, sizeof *b.mean);
    b.radius = b.mean + size;
    for (size_t k = 0; k < size; k++) b.radius[k] = def->radius_max;
    sample_finest(&b, density);
    sweep(&b, 1);
    sweep(&b, -1);
    for (int l = probes->level_count - 2; l >= 0; l--) coarsen(&b, l);
    for (int j = 0; j < probes->levels[0].rows; j++)
        for (int i = 0; i < probes->levels[0].columns; i++) place(&b, 0, i, j);
    for (int l = 0; l < probes->level_count; l++) set_targets(&b, &probes->levels[l]);
    create_tiles(probes, page);
    mem_free(b.mean);
    return probes;
}

void probes_destroy(Probes *probes)
{
    if (!probes) return;
    mem_free(probes->inverse);
    mem_free(probes->target);
    mem_free(probes->gain);
    mem_free(probes->tiles);
    mem_free(probes);
}
