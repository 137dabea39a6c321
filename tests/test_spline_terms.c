/* Every energy of a drawing against differences, on strokes and fields at random. */
#include "base/memory.h"
#include "base/random.h"
#include "solve/check.h"
#include "spline/terms.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { STROKES = 6, NODES = 5, COLUMNS = 24, ROWS = 16 };

typedef struct Fixture {
    SplinePage page;
    SplineTarget *target;
    Strokes strokes;
    double *rest;
    SplineModel *model;
    SplineWeights weights;
} Fixture;

static double *random_grid(int width, double low, double high, Random *random)
{
    double *values = mem_alloc((size_t)(COLUMNS * ROWS * width), sizeof *values);
    for (int i = 0; i < COLUMNS * ROWS * width; i++)
        values[i] = low + (high - low) * (0.5 + 0.5 * random_signed(random));
    return values;
}

static SplineGrid grid_of(int width, const double *values)
{
    return (SplineGrid){COLUMNS, ROWS, width, values};
}

/* Strokes that wander, of uneven speed; the first one along the edge, within reach of the wall. */
static void add_strokes(Fixture *f, Random *random)
{
    for (int k = 0; k < STROKES; k++) {
        bool edge = k == 0;
        double q[NODES][4], angle = edge ? 0 : 3 * random_signed(random), turn = edge ? 0.02 : 0.5;
        double x = f->page.width * (0.4 + 0.1 * random_signed(random)),
               y = edge ? 1.4 * f->page.pen : f->page.height * (0.5 + 0.1 * random_signed(random));
        for (int i = 0; i < NODES; i++) {
            double step = 0.05 * (1 + 0.3 * random_signed(random));
            q[i][0] = x, q[i][1] = y, q[i][2] = step * cos(angle) / 3, q[i][3] = step * sin(angle) / 3;
            angle += turn * random_signed(random);
            x += step * cos(angle), y += step * sin(angle);
        }
        strokes_add(&f->strokes, NODES, (const double(*)[4])q, 0);
    }
}

static Fixture fixture_create(Random *random)
{
    Fixture f = {.page = spline_page(0.12, 0.08, 0.005, 0.0008)};
    double *density = random_grid(1, 0.1, 0.6, random), *align = random_grid(3, -0.2, 0.8, random),
           *potential = random_grid(1, 0, 1, random), *flow = random_grid(2, -1, 1, random);
    SplineFields fields = {grid_of(1, density), grid_of(3, align), grid_of(1, potential), grid_of(2, flow)};
    ProbesDef probes = probes_default();
    f.target = spline_target_create(&f.page, &fields, &probes);
    add_strokes(&f, random);
    int segments = strokes_segment_count(&f.strokes);
    f.rest = mem_alloc((size_t)segments, sizeof *f.rest);
    for (int k = 0; k < segments; k++) f.rest[k] = 0.05;
    SplineModelDef def = spline_model_default();
    f.model = spline_model_create(f.target, &f.strokes, f.rest, &def);
    f.weights = (SplineWeights){0.5, 0.1, 0.5, 0.1, 0.4, 0.2, 0.3, 0.2, 0.1, 1, 0.5};
    f.weights = spline_weights_scaled(f.weights, f.page.pen, f.target->spacing);
    mem_free(density);
    mem_free(align);
    mem_free(potential);
    mem_free(flow);
    return f;
}

static void fixture_clear(Fixture *f)
{
    spline_model_destroy(f->model);
    spline_target_destroy(f->target);
    strokes_clear(&f->strokes);
    mem_free(f->rest);
}

static void test_derivatives(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Random random = random_seed(5);
    Fixture f = fixture_create(&random);
    double dof_size[TERM_MAX_DOF];
    Point at = {.x = f.strokes.q, .p = (const double *)&f.weights};
    Params params = {0};
    params_add(&params, "weights", "", SPLINE_WEIGHT_COUNT, 1, false);
    for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = 0.01;
    for (int r = 0; r < SPLINE_WEIGHT_COUNT; r++) {
        const SplineTermRow *row = &spline_term_rows[r];
        TermError worst;
        if (row->term) {
            Term term = row->term(f.model, SPLINE_EXACT);
            worst = check_term(&term, &params, &at, dof_size, &random);
            term.ops->destroy(term.self);
        } else {
            Bulk bulk = row->bulk(f.model, SPLINE_EXACT);
            worst = check_bulk(&bulk, &at, 4 * strokes_node_count(&f.strokes), 0.002);
            bulk.ops->destroy(bulk.self);
        }
        print_message("%-10s gradient %.1e  hessian %.1e\n", row->name, worst.gradient, worst.hessian);
        assert_true(worst.gradient < 1e-7 && worst.hessian < 1e-6);
    }
    fixture_clear(&f);
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
