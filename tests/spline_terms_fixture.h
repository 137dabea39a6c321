/* spline_terms_fixture.h - the drawing of spline_reference.h: two strokes, smooth fields, probes of no meaning. */
#pragma once
#include "energy_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static inline double m_xx(double x, double y)
{
    return 0.9 + 0.3 * x - 0.2 * y;
}
static inline double m_xy(double x, double y)
{
    return 0.2 - 0.4 * x + 0.3 * y;
}
static inline double m_yy(double x, double y)
{
    return 0.7 - 0.1 * x + 0.5 * y;
}
static inline double v_x(double x, double y)
{
    return 0.3 + 0.5 * x - 0.8 * y;
}
static inline double v_y(double x, double y)
{
    return -0.2 + 0.9 * x + 0.4 * y;
}
static inline double phi(double x, double y)
{
    return 0.4 + 0.8 * x - 0.6 * y + 1.1 * x * x - 0.7 * x * y + 0.9 * y * y;
}
static inline double tone_of(double x, double y)
{
    return 0.5 + 0.3 * sin(3 * x) * cos(4 * y);
}

typedef struct Fixture {
    SplinePage page;
    SplineFields fields;
    SplineTarget *target;
    Strokes strokes;
    SplineModel *model;
    SplineWeights weights;
} Fixture;

/* Probes in two levels, each coarse cell either one or divided; with targets and gains of no meaning. */
static inline void set_probes(Probes *probes)
{
    double *arrays[] = {probes->inverse, probes->target, probes->gain};
    for (int a = 0; a < 3; a++) memset(arrays[a], 0, (size_t)probes->size * sizeof(double));
    for (int l = 0; l < 2; l++) {
        ProbeLevel *level = &probes->levels[l];
        assert_true(level->columns == 10 << l && level->rows == 7 << l);
        level->reach = l ? 0.13 : 0.26;
        for (int j = 0; j < level->rows; j++)
            for (int i = 0; i < level->columns; i++) {
                bool divided = ((i >> l) + (j >> l)) % 2;
                double R = l ? 0.11 + 0.01 * ((i + 2 * j) % 3) : 0.2 + 0.02 * ((3 * i + j) % 4);
                long k = level->first + (long)j * level->stride + i;
                if (divided != (l == 1)) continue;
                probes->inverse[k] = 1 / (R * R);
                probes->target[k] = 0.1 + 0.05 * (i * j % 5);
                probes->gain[k] = level->dx * level->dy * (1 + 0.2 * ((i + j) % 3));
            }
    }
    memset(probes->tiles, 0xff, (size_t)(probes->tile_columns * probes->tile_rows) * sizeof *probes->tiles);
}

static inline Strokes reference_strokes(void)
{
    static const int nodes[] = {3, 2};
    Strokes strokes = {0};
    for (int s = 0, k = 0; s < 2; s++) {
        double q[3][4];
        for (int i = 0; i < nodes[s]; i++, k++) {
            q[i][0] = 0.35 + fmod(0.17 * k, 0.5) + 0.02 * cos(3.0 * k);
            q[i][1] = 0.3 + fmod(0.04 * k, 0.25) + 0.05 * sin(2.0 * k);
            q[i][2] = 0.07 + 0.02 * cos(k);
            q[i][3] = 0.05 * sin(1.3 * k);
        }
        strokes_add(&strokes, nodes[s], (const double(*)[4])q, 0);
    }
    return strokes;
}

static inline Fixture fixture_create(PairKernel kernel)
{
    Fixture f = {.page = {.width = 1.25, .height = 0.8, .pen = 0.22}, .strokes = reference_strokes()};
    f.fields.density = grid_of(&f.page, 40, 1, (Surface *[]){tone_of});
    f.fields.align = grid_of(&f.page, 100, 3, (Surface *[]){m_xx, m_xy, m_yy});
    f.fields.potential = grid_of(&f.page, 100, 1, (Surface *[]){phi});
    f.fields.flow = grid_of(&f.page, 100, 2, (Surface *[]){v_x, v_y});
    ProbesDef probes = {
        .radius = 0, .radius_min = 0.1251 / 0.22, .radius_max = 0.2501, .cell = 0.5, .faint = 0.03};
    f.target = spline_target_create(&f.page, &f.fields, &probes);
    double *rest = same_rest(&f.strokes, 0.3);
    SplineModelDef def = spline_model_default();
    def.pair_kernel = kernel;
    def.pair_radius = 0.25 / f.target->spacing;
    f.model = spline_model_create(f.target, &f.strokes, rest, &def);
    mem_free(rest);
    f.weights = (SplineWeights){.strain = 2,
                                .bend = 0.3,
                                .align = 1.5,
                                .wall = 0.7,
                                .stretch = 2.5,
                                .curvature = 0.02,
                                .potential = 1.3,
                                .flow = 0.6,
                                .boundary = 0.05,
                                .outline = 0.9,
                                .tone = 3,
                                .pair = 1.7,
                                .length = 1.9};
    return f;
}

/* A region whose outline is near and round. */
static inline double depth(double x, double y)
{
    return 0.35 - 0.6 * (x - 0.6) * (x - 0.6) - 0.9 * (y - 0.4) * (y - 0.4) + 0.1 * x * y;
}

static inline void add_outline(Fixture *f)
{
    f->fields.outline = grid_of(&f->page, 100, 1, (Surface *[]){depth});
    f->target->outline = grid_spline_create(&f->fields.outline, &f->page);
    f->model->outline_rule = spline_rule_even(9);
}

static inline void fixture_clear(Fixture *f)
{
    spline_model_destroy(f->model);
    strokes_clear(&f->strokes);
    spline_target_destroy(f->target);
    clear_fields(&f->fields);
}
