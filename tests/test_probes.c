/* Probes beside hard edges: their radii are graded, and strokes that relax stay where there is tone. */
#include "energy_fixture.h"
#include "spline/direction.h"
#include "spline/relax.h"
#include "spline/streamlines.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* How far a place is outside of the dark square; negative within. */
static double outside(double x, double y)
{
    return fmax(fabs(x - 0.5), fabs(y - 0.5)) - 0.25;
}

static double square(double x, double y)
{
    return outside(x, y) < 0 ? 0.8 : 0;
}

/* A probe's disc. */
typedef struct Disc {
    double x, y, R, half; /* half: the diagonal of its leaf */
} Disc;

static Disc *discs_of(const Probes *probes)
{
    Disc *discs = mem_alloc((size_t)probes->count, sizeof *discs), *next = discs;
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeLevel *level = &probes->levels[l];
        for (int j = 0; j < level->rows; j++)
            for (int i = 0; i < level->columns; i++) {
                double inverse = probes->inverse[level->first + (long)j * level->stride + i];
                if (inverse == 0) continue;
                *next++ = (Disc){(i + 0.5) * level->dx, (j + 0.5) * level->dy, 1 / sqrt(inverse),
                                 hypot(level->dx, level->dy) / 2};
            }
    }
    assert_int_equal(next - discs, probes->count);
    return discs;
}

/* R(a) <= R(b) + |a - b|, but for the way by neighbours (8 % longer) and the size of leaves. */
static void test_graded(void **state)
{
    (void)state;
    SplinePage page = {.width = 1, .height = 1, .pen = 0.01};
    SplineFields fields = {.density = grid_of(&page, 200, 1, (Surface *[]){square})};
    ProbesDef def = probes_default();
    Probes *probes = probes_create(&page, &fields.density, &def);
    Disc *discs = discs_of(probes);
    double widest = 0;
    for (int a = 0; a < probes->count; a++) {
        widest = fmax(widest, discs[a].R);
        for (int b = 0; b < probes->count; b++) {
            double d = hypot(discs[a].x - discs[b].x, discs[a].y - discs[b].y);
            d += discs[a].half + discs[b].half;
            assert_true(discs[a].R <= discs[b].R + 1.083 * d);
        }
    }
    print_message("%d probes, radii up to %.3f\n", probes->count, widest);
    assert_true(widest > 0.1); /* far away they are wide */
    mem_free(discs);
    probes_destroy(probes);
    clear_fields(&fields);
}

/* No stroke reaches a pen's width beyond the edge, whether it runs along it or against it. */
static void test_edge(void **state)
{
    (void)state;
    SplinePage page = {.width = 1, .height = 1, .pen = 0.006};
    SplineFields fields = {.density = grid_of(&page, 333, 1, (Surface *[]){square})};
    ProbesDef probes = probes_default();
    for (int degrees = 0; degrees < 90; degrees += 30) {
        SplineField direction = spline_direction_constant(&page, degrees * M_PI / 180);
        SplineGrid along = spline_grid(&direction);
        SplineFields all = {.density = fields.density, .align = along};
        SplineTarget *target = spline_target_create(&page, &all, &probes);
        RelaxDef def = relax_default();
        SplineStartDef start = spline_start_default();
        Strokes strokes = {0};
        spline_streamlines(&fields.density, &along, &page, &start, 0, &strokes);
        spline_relax(target, &def, &strokes, NULL);
        double most = -1;
        for (int k = 0; k < strokes_node_count(&strokes); k++)
            most = fmax(most, outside(strokes.q[4 * k], strokes.q[4 * k + 1]));
        print_message("%d degrees, %d strokes: up to %.1f pens outside\n", degrees, strokes.count,
                      most / page.pen);
        assert_true(strokes.count > 10 && most < page.pen);
        strokes_clear(&strokes);
        spline_target_destroy(target);
        spline_field_clear(&direction);
    }
    clear_fields(&fields);
}

static void test_leaks(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_graded), cmocka_unit_test(test_edge),
                                       cmocka_unit_test(test_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
