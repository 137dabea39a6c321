/* What the entries of a scene become in a rod: natural strains from tables, a start that is not its natural
 * shape. */
#include "rod/front/rod_model.h"
#include "rod/rod.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static Built build(const char *job, const char *lines)
{
    char *text = mem_format("slender: 1\njob: %s\nrod:\n  radius: 1 mm\n  young: 10 MPa\n  poisson: 0.5\n"
                            "  density: 1000\n  gravity: [0, 0, 0]\n%s",
                            job, lines);
    Built b = scene_try(text);
    mem_free(text);
    return b;
}

static const double *strains(const Built *b)
{
    if (!b->model) fail_msg("%s", yaml_report(b->file));
    return b->model->cases[0].stages[0].p + ((const RodModel *)b->model->self)->rod->natural_strain;
}

/* k1 grows as 100 s/L to the end of the rows, at s = last; at elements' middles if `middles`. */
static void write_profile(int rows, double last, bool middles)
{
    FILE *file = fopen("test_rod_scene.csv", "w");
    assert_non_null(file);
    for (int i = 0; i < rows; i++) {
        double s = middles ? last * (i + 0.5) / rows : last * i / (rows - 1);
        fprintf(file, "%.17g, 0, %.17g, 0\n", s, 100 * s);
    }
    fclose(file);
}

/* The same profile is the same rod, whatever the number of its rows; a row for each element is taken as it
 * is. */
static void test_strain_tables(void **state)
{
    (void)state;
    const char *lines = "  length: 0.3\n  natural_strain: {file: test_rod_scene.csv}\n";
    for (int rows = 199; rows <= 201; rows++) {
        write_profile(rows, 0.15, false);
        Built b = build("equilibrium", lines);
        const double *k = strains(&b);
        for (int e = 0; e < 200; e++)
            assert_true(fabs(k[3 * e + 1] - fmin(100 * 0.3 * (e + 0.5) / 200, 15)) < 1e-12);
        clear(&b);
    }
    write_profile(200, 0.3, true);
    Built b = build("equilibrium", lines);
    for (int e = 0; e < 200; e++) assert_true(strains(&b)[3 * e + 1] == 100 * (0.3 * (e + 0.5) / 200));
    clear(&b);
    write_profile(200, 300, false);
    b = build("equilibrium", lines);
    assert_null(b.model);
    char *report = yaml_report(b.file);
    assert_non_null(strstr(report, "s goes from 0 to 300 m, and the rod is 0.3 m long"));
    mem_free(report);
    clear(&b);
    unlink("test_rod_scene.csv");
}

/* A naturally straight rod that is let go in a curve: it begins there, and nothing of the curve is in its
 * shape. */
static void test_posed(void **state)
{
    (void)state;
    enum { N = 50 };
    Built b = build("simulate", "  curve: {formula: [\"u\", \"0\", \"5*u*u*u\"], range: [0, 0.2]}\n"
                                "  natural_strain: [0, 0, 0]\n  start: curve\n  elements: 50\n"
                                "time: {step: 1 ms, steps: 1}\n");
    for (int i = 0; i < 3 * N; i++) assert_true(strains(&b)[i] == 0);
    const RodModel *rm = b.model->self;
    double place[3 * (N + 1)], off = 0, crooked = 0;
    rod_places(rm->rod, &rm->layout, b.model->x, N + 1, place);
    for (int i = 0; i <= N; i++) {
        off = fmax(off, vec3_length(vec3_sub(vec3_load(place + 3 * i), rm->curves[0].x[2 * i])));
        Vec3 straight = vec3(rod_length(rm->rod) * i / N, 0, 0);
        crooked = fmax(crooked, vec3_length(vec3_sub(vec3_load(rm->natural + 3 * i), straight)));
    }
    print_message("starts %.1e m off its curve; its natural shape is straight to %.1e m\n", off, crooked);
    assert_true(off < 2e-5 && crooked < 1e-14);
    clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_strain_tables), cmocka_unit_test(test_posed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
