/* Films of drawings that relax: the strokes of each moment, as the SVG file of that iteration has them. */
#include "io/plot_file.h"
#include "leaks.h"
#include "page_fixture.h"
#include "spline/film.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME "test_film"

enum { EVERY = 10 };

static const char scene[] =
    "slender: 1\njob: draw\nspline:\n  density: {formula: \"0.2 + 0.3*u\"}\n"
    "  direction: {formula: [\"1\", \"sin(4*u)\"]}\n  cross: {angle: 80 deg, from: [0, 0.3]}\n"
    "  page: {size: [60 mm, 40 mm], margin: 5 mm}\n  pen: 0.6 mm\n  rounds: 1\n"
    "output: {every: 10, film: 10}\n";

/* The same words, and numbers that differ by no more than a tolerance; returns how many there are. */
static int compare(const char *a, const char *b, double tolerance)
{
    int numbers = 0;
    while (*a && *b) {
        char *end_a, *end_b;
        double x = strtod(a, &end_a), y = strtod(b, &end_b);
        if (end_a == a || end_b == b) {
            assert_int_equal(*a, *b);
            a++, b++;
            continue;
        }
        assert_float_equal(x, y, tolerance);
        a = end_a, b = end_b, numbers++;
    }
    assert_int_equal(*a, *b);
    return numbers;
}

/* Where the run has left an SVG file, the film's frame has the same curves, to a micrometre and a digit of the file (mm). */
static void test_moments(void **state)
{
    (void)state;
    Error err;
    Drawn drawn;
    Film film;
    page_run(NAME, scene);
    Result *result = result_open(NAME ".vtkhdf", &err);
    assert_non_null(result);
    assert_true(drawn_read(result, &drawn, &err) && film_read(result, &drawn, &film, &err));
    Array nodes;
    assert_true(result_read(result, "slender/spline/film/nodes", &nodes, &err));
    assert_string_equal(nodes.unit, "um");
    array_clear(&nodes);
    result_close(result);
    int compared = 0, numbers = 0;
    assert_true(film.count > 5);
    for (int k = 0; k < film.count; k++) {
        char path[64];
        assert_int_equal(film_iteration(&film, k), EVERY * k);
        snprintf(path, sizeof path, NAME "-%06d.svg", film_iteration(&film, k));
        char *there = page_text(path);
        if (k == 0) continue; /* as it starts: no file has that */
        assert_non_null(there);
        Plot plot = film_plot(&film, &drawn, k);
        assert_true(plot_write_svg("test_film_frame.svg", &plot, &err));
        char *here = page_text("test_film_frame.svg");
        numbers += compare(here, there, 2.1e-3);
        compared++;
        mem_free(here);
        mem_free(there);
        spline_plot_clear(&plot);
        unlink(path);
    }
    print_message("%d frames, %d of them compared with files, %d numbers\n", film.count, compared, numbers);
    assert_true(compared == film.count - 1 && numbers > 500 * compared);
    film_clear(&film);
    drawn_clear(&drawn);
}

/* A frame that has none is refused, the last one is the drawing; the page shows them and the energy's iteration. */
static void test_pages(void **state)
{
    (void)state;
    Error err = {""};
    ShowDef def = show_default();
    def.width = 400;
    Page first, last, other;
    def.frame = 0, first = page_draw(NAME, &def);
    def.frame = 1, other = page_draw(NAME, &def);
    assert_true(first.width == other.width && first.height == other.height);
    assert_true(memcmp(first.rgb, other.rgb, 3 * (size_t)(first.width * first.height)) != 0);
    int frame = 2;
    for (def.frame = frame; page_show(NAME, &def, &err) == SHOW_DONE; def.frame++) frame = def.frame;
    assert_non_null(strstr(err.text, "frames, from 0"));
    def.frame = frame, last = page_draw(NAME, &def);
    mem_free(first.rgb);
    mem_free(last.rgb);
    mem_free(other.rgb);
    def.frame = -1, def.seconds = 0.2;
    assert_int_equal(show_result(NAME ".vtkhdf", NAME ".webp", &def, &err), SHOW_DONE);
    unlink(NAME ".webp");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_moments), cmocka_unit_test(test_pages)};
    int failed = cmocka_run_group_tests(tests, NULL, nothing_leaks);
    page_remove_files(NAME);
    unlink(NAME ".svg");
    unlink("test_film_frame.svg");
    return failed;
}
