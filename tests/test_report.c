/* slender report: the pages of whole runs hold what their results do. The page itself is tested in a browser:
 * tests/report_browser.sh; what its document packs by test_report_document.c. */
#include "base/vec3.h"
#include "report/document.h"
#include "report/report.h"
#include "spline/drawn.h"
#include "tests/leaks.h"
#include "view/show.h"
#include "view/show_mesh.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define NAME "test_report"
#include "tests/run_fixture.h"
#include "tests/report_fixture.h"

#define RESULT NAME ".vtkhdf"
#define HTML   NAME ".html"

/* ---- Whole runs ---- */

static Page report(int frames)
{
    Error err;
    const char *const results[] = {RESULT};
    if (report_write(results, 1, HTML, &(ReportDef){.frames = frames}, &err) != SHOW_DONE)
        fail_msg("%s", err.text);
    return page_read(HTML);
}

/* Frames 0, middle and last of `steps`: the corners of all faces are where they are in the result. */
static void check_body(const Page *page, Result *result, const int *frames, int count)
{
    const char *body = after(page->json, "body");
    Unpacked faces = unpack(page, body, "faces"), points = unpack(page, body, "points");
    Array own = read_all(result, "slender/faces");
    assert_int_equal(faces.width, array_count(&own));
    assert_int_equal(points.rows, count);
    double step = (points.high - points.low) / 65534;
    for (int f = 0; f < count; f++) {
        Array x;
        Error err;
        assert_true(result_read_step(result, "Points", frames[f], &x, &err));
        for (size_t k = 0; k < faces.width; k++)
            for (size_t i = 0; i < 3; i++) {
                double got = points.values[(size_t)f * points.width + 3 * (size_t)faces.values[k] + i],
                       is = ((double *)x.data)[3 * ((int *)own.data)[k] + (int)i];
                assert_true(fabs(got - is) <= 0.51 * step + 1e-8 * fabs(is));
            }
        array_clear(&x);
    }
    array_clear(&own);
    mem_free(faces.values);
    mem_free(points.values);
}

static const char SHEET[] =
    "slender: 1\njob: simulate\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [8, 4]}\n"
    "  thickness: 1 mm\n  poisson: 0.3\n  density: 1000\n  magnetization: [1.0e+4, 0, 0]\n"
    "  young: {formula: \"x < 0.02 ? 1e5 : 1e6\"}\n  gravity: [0, 0, -9.81]\nfix: [{group: root, clamp: "
    "true}]\n"
    "time: {step: 5 ms, steps: 6}\n";

static void test_shell(void **unused)
{
    (void)unused;
    Result *result = run_text(mem_text(SHEET));
    static const int all[] = {0, 1, 2, 3, 4, 5, 6}, some[] = {0, 3, 6};
    Page page = report(0);
    check_body(&page, result, all, 7);
    Unpacked young = unpack(&page, strstr(page.json, "\"name\":\"young\""), "values");
    Array own = read_all(result, "slender/design/young");
    assert_int_equal(young.rows, 1); /* it does not change */
    for (size_t f = 0; f < young.width; f++) {
        double is = ((double *)own.data)[f];
        assert_true(fabs(young.values[f] / is - 1) < 1e-4);
    }
    array_clear(&own);
    mem_free(young.values);
    page_clear(&page);
    page = report(3);
    check_body(&page, result, some, 3);
    assert_non_null(strstr(
        page.json, "\"labels\":[\"t = 0 s\",\"t = 0.015 s\",\"t = 0.03 s\"],\"times\":[0,0.015,0.03]"));
    page_clear(&page);
    result_close(result);
}

static const char PLATE[] =
    "slender: 1\njob: design\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [4, 2]}\n"
    "  thickness: 1 mm\n  poisson: 0.3\n  density: 1000\n  young: 1 MPa\n  magnetization: [1.0e+4, 0, 0]\n"
    "fix: [{group: root, clamp: true}]\n"
    "cases: [{name: up, flux_density: [0, 0, 10 mT], target: {formula: [\"x\", \"y\", \"20*x*x\"]}}]\n"
    "design: {unknowns: {magnetization: {max_magnitude: 1.0e+5}}, objectives: [{target: 1}], iterations: "
    "3}\noutput: {every: 1}\n";

/* The numbers of a frame, or of the final design, as pictures have them. */
static void check_sizes(ShowMesh *mesh, int step, const double *M)
{
    Error err;
    const double *values;
    const char *name, *unit;
    if (!show_mesh_field(mesh, step, &values, &name, &unit, &err)) fail_msg("%s", err.text);
    assert_string_equal(unit, "A/m");
    ShowRows rows = show_mesh_magnetization(mesh, step);
    for (int f = 0; f < mesh->body.face_count; f++) {
        assert_true(values[f] == vec3_length(vec3_load(M + 3 * f)));
        assert_memory_equal(rows.faces + 3 * f, M + 3 * f, 3 * sizeof *M);
    }
}

/* Frames of a design have the magnetisation of their evaluation, in pictures and in the page. */
static void test_design(void **unused)
{
    (void)unused;
    Error err;
    ShowData data;
    ShowMesh mesh;
    ShowDef def = show_default();
    def.field = "magnetization";
    Result *result = run_text(mem_text(PLATE));
    Array final = read_all(result, "slender/design/magnetization");
    int frames = result_step_count(result);
    Page page = report(0);
    Unpacked arrows = unpack(&page, strstr(page.json, "\"magnetization\":{"), "values");
    show_data_borrow(&data, result, &def);
    assert_true(show_mesh_read(&mesh, &data, &err) && show_mesh_has_own(&mesh, "magnetization"));
    check_sizes(&mesh, -1, final.data);
    assert_true(frames > 1 && arrows.rows == (size_t)frames);
    for (int k = 0; k < frames; k++) {
        Array own;
        assert_true(result_read_step(result, "CellData/magnetization", k, &own, &err));
        const double *M = own.data;
        assert_true(k > 0 || (M[0] == 1e4 && M[1] == 0 && memcmp(M, final.data, 3 * sizeof *M) != 0));
        check_sizes(&mesh, k, M);
        for (size_t i = 0; i < arrows.width; i++)
            assert_true(fabs(arrows.values[(size_t)k * arrows.width + i] - M[i]) < 1e-4 * 1e5);
        array_clear(&own);
    }
    show_mesh_clear(&mesh);
    show_data_clear(&data);
    array_clear(&final);
    mem_free(arrows.values);
    page_clear(&page);
    result_close(result);
}

static void test_solid(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"time.steps=10"};
    Result *result = run_file(SOURCE_DIR "/tests/scene_solid.yaml", settings, 1, false);
    static const int frames[] = {0, 1, 2};
    Page page = report(0);
    check_body(&page, result, frames, 3);
    const char *ball = strstr(page.json, "\"obstacles\"");
    Unpacked points = unpack(&page, ball, "points");
    assert_true(points.width >= 12);
    mem_free(points.values);
    page_clear(&page);
    result_close(result);
}

static void test_rod(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"time.steps=9"};
    Result *result = run_file(SOURCE_DIR "/tests/scene_rod_simulate.yaml", settings, 1, false);
    Page page = report(0);
    const char *rod = strstr(page.json, "\"name\":\"rod\"");
    Unpacked offsets = unpack(&page, rod, "offsets"), points = unpack(&page, rod, "points");
    assert_int_equal(offsets.width, 2);
    assert_int_equal((int)offsets.values[1], 41);
    assert_int_equal(points.rows, 4);
    for (int k = 0; k < 4; k++) {
        Array x;
        Error err;
        assert_true(result_read_step(result, "Points", k, &x, &err));
        for (size_t i = 0; i < points.width; i++)
            assert_true(fabs(points.values[(size_t)k * points.width + i] - ((double *)x.data)[i]) < 2e-6);
        array_clear(&x);
    }
    mem_free(offsets.values);
    mem_free(points.values);
    page_clear(&page);
    result_close(result);
}

/* The frames of an inversion without a round trip have no rod that was simulated: other curves are not called so. */
static void test_inversion(void **unused)
{
    (void)unused;
    result_close(
        run_text(mem_text("slender: 1\njob: invert\nrod:\n"
                          "  curve: {formula: [\"0.05*sin(6*u)\", \"0\", \"-0.2*u\"], range: [0, 1]}\n"
                          "  radius: 1 mm\n  young: 1.0e+8\n  poisson: 0.5\n  density: 1000\n"
                          "  elements: 20\n")));
    Page page = report(0);
    assert_non_null(strstr(page.json, "\"name\":\"natural\""));
    assert_non_null(strstr(page.json, "\"name\":\"input\""));
    assert_null(strstr(page.json, "\"name\":\"rod\""));
    page_clear(&page);
}

/* The first group of faces has the faces that the result's has. */
static void check_group(const Page *page, Result *result, const char *name)
{
    const char *group = after(page->json, "groups");
    Unpacked faces = unpack(page, group, "members");
    Array names = read_all(result, "slender/groups/names"),
          offsets = read_all(result, "slender/groups/offsets"),
          members = read_all(result, "slender/groups/members");
    assert_true(!strncmp(names.data, name, strlen(name)) &&
                !strncmp(after(group, "name") + 1, name, strlen(name)));
    assert_int_equal(faces.width, ((int *)offsets.data)[1]);
    assert_true(faces.width > 0);
    for (size_t k = 0; k < faces.width; k++) assert_int_equal((int)faces.values[k], ((int *)members.data)[k]);
    array_clear(&names);
    array_clear(&offsets);
    array_clear(&members);
    mem_free(faces.values);
}

/* Each case's target is that of its frame, of a shell as of a rod. */
static void test_targets(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"design.iterations=0", "output.every=1", "shell.mesh.n=2"};
    SlenderError trouble;
    Result *result = run_to(slender_scene_read(SOURCE_DIR "/tests/scene_small.yaml", settings, 3, &trouble),
                            &trouble, false, SLENDER_NOT_CONVERGED);
    Page page = report(0);
    const char *target = after(page.json, "target");
    static const char of[] =
        "[1,0,1]"; /* the last frames are those of the cases, the others the last case's */
    assert_int_equal(strncmp(after(target, "of"), of, strlen(of)), 0);
    Unpacked points = unpack(&page, target, "points");
    static const char *const paths[] = {"slender/cases/up/target", "slender/cases/down/target"};
    for (size_t k = 0; k < 2; k++) {
        Array own = read_all(result, paths[k]);
        assert_int_equal(array_count(&own), points.width);
        for (size_t i = 0; i < points.width; i++)
            assert_true(fabs(points.values[k * points.width + i] - ((double *)own.data)[i]) < 1e-6);
        array_clear(&own);
    }
    mem_free(points.values);
    check_group(&page, result, "hub");
    page_clear(&page);
    result_close(result);
    result = run_to(slender_scene_read(SOURCE_DIR "/tests/scene_rod_design.yaml", settings, 1, &trouble),
                    &trouble, false, SLENDER_NOT_CONVERGED);
    page = report(0);
    target = strstr(page.json, "\"name\":\"target\"");
    assert_non_null(target);
    points = unpack(&page, target, "points");
    Array names = read_all(result, "slender/case_names");
    char *path = mem_format("slender/cases/%.*s/target", (int)strcspn(names.data, "\n"), (char *)names.data);
    Array own = read_all(result, path);
    for (size_t i = 0; i < points.width; i++) {
        double is = ((double *)own.data)[i];
        assert_true(isnan(is) || fabs(points.values[i] - is) < 2e-6);
    }
    array_clear(&own);
    array_clear(&names);
    mem_free(path);
    mem_free(points.values);
    page_clear(&page);
    result_close(result);
}

/* Each obstacle is where it is in the result, in every frame. */
static void test_obstacles(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"time.steps=6"};
    Result *result = run_file(SOURCE_DIR "/tests/scene_contact.yaml", settings, 1, false);
    Page page = report(0);
    Array poses = read_all(result, "slender/frames/obstacle_pose");
    const double *pose = poses.data;
    const char *at = after(page.json, "obstacles");
    int frames = result_step_count(result);
    assert_true(frames > 2 && array_count(&poses) == 24 * (size_t)frames);
    for (int o = 0; o < 2; o++) {
        char *rest = (char *)(at = after(at, "poses"));
        for (int k = 0; k < frames; k++)
            for (int i = 0; i < 12; i++) {
                double got = strtod(rest + 1, &rest), is = pose[12 * (2 * k + o) + i];
                assert_true(fabs(got - is) <= 1e-6 * fabs(is));
            }
    }
    array_clear(&poses);
    page_clear(&page);
    result_close(result);
}

/* Frames of a sequence are called after what it changes; its energies are a chart. */
static void test_stages(void **unused)
{
    (void)unused;
    Result *result = run_text(mem_format(
        "slender: 1\njob: equilibrium\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [4, 2]}\n"
        "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  magnetization: [1.0e+4, 0, 0]\n"
        "fix: [{group: root, clamp: true}]\n"
        "probes: {tip: {group: tip}}\n"
        "sequence: {flux_density: {from: [0, 0, 0], to: [0, 0, 1 mT], count: 3}}\n"));
    Page page = report(2);
    assert_non_null(strstr(page.json, "\"stages\":[0,2]"));
    const char *probed = strstr(page.json, "{\"x\":{\"label\":\"flux density\",\"unit\":\"T\"}");
    assert_non_null(probed);
    assert_int_equal(strncmp(after(probed, "of_stages"), "true", 4), 0);
    page_clear(&page);
    page = report(0);
    assert_non_null(strstr(page.json, "\"labels\":[\"stage 0: 0 T\",\"stage 1: 500 µT\",\"stage 2: 1 mT\"]"));
    Array energy = read_all(result, "slender/stages/energy/bending");
    const char *chart = strstr(page.json, "\"y\":{\"label\":\"energy\",\"unit\":\"J\"}");
    assert_non_null(chart);
    const char *y = after(strstr(chart, "\"name\":\"bending\""), "y");
    char *rest;
    for (int k = 0; k < 3; k++, y = rest) {
        double is = ((double *)energy.data)[k], got = strtod(y + 1, &rest);
        assert_true(fabs(got - is) <= 1e-6 * fabs(is));
    }
    array_clear(&energy);
    page_clear(&page);
    result_close(result);
}

static void test_drawing(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"spline.rounds=0", "spline.iterations=5", "output.film=2"};
    SlenderError trouble;
    Error err;
    Result *result = run_to(slender_scene_read(SOURCE_DIR "/tests/scene_draw.yaml", settings, 3, &trouble),
                            &trouble, false, SLENDER_NOT_CONVERGED);
    Drawn drawn = {0};
    assert_true(drawn_read(result, &drawn, &err));
    Page page = report(0);
    const PlotLayer *layer = &drawn.plot.layers[0];
    const char *layers = after(page.json, "layers"), *film = after(page.json, "film");
    assert_int_equal((int)number_after(film, "iteration"), 0);
    assert_int_equal((int)number_after(after(film, "iteration"), "iteration"), 2);
    Unpacked offsets = unpack(&page, layers, "offsets"), points = unpack(&page, layers, "points");
    assert_int_equal(offsets.width, layer->count + 1);
    for (size_t k = 0; k < offsets.width; k++) assert_int_equal((int)offsets.values[k], layer->start[k]);
    for (size_t k = 0; k < points.width; k++)
        assert_true(fabs(points.values[k] - (&layer->points[0].x)[k]) < 1e-3); /* mm */
    mem_free(offsets.values);
    mem_free(points.values);
    page_clear(&page);
    drawn_clear(&drawn);
    result_close(result);
}

/* ---- Several, and none ---- */

static void test_several(void **unused)
{
    (void)unused;
    Error err;
    const char *const results[] = {RESULT, RESULT};
    result_close(run_text(mem_text(SHEET)));
    Page once = report(2);
    page_clear(&once);
    char *first = page_text(HTML);
    once = report(2);
    page_clear(&once);
    char *second = page_text(HTML);
    assert_string_equal(first, second);
    mem_free(first);
    mem_free(second);
    assert_int_equal(report_write(results, 2, HTML, &(ReportDef){.frames = 2}, &err), SHOW_DONE);
    Page both = page_read(HTML);
    const char *other = strstr(after(both.json, "body"), "\"status\"");
    assert_non_null(other);
    Unpacked points = unpack(&both, after(other, "body"), "points");
    assert_int_equal(points.rows, 2);
    mem_free(points.values);
    page_clear(&both);
}

static void test_refused(void **unused)
{
    (void)unused;
    Error err;
    const char *const missing[] = {RESULT, "missing.vtkhdf"}, *const there[] = {RESULT};
    result_close(run_text(mem_text(SHEET)));
    unlink(HTML);
    assert_int_equal(report_write(missing, 2, HTML, &(ReportDef){0}, &err), SHOW_HAS_NOT);
    assert_non_null(strstr(err.text, "missing.vtkhdf"));
    assert_int_equal(access(HTML, F_OK), -1);
    assert_int_equal(report_write(there, 1, "no/such/folder.html", &(ReportDef){0}, &err), SHOW_CANNOT_WRITE);
    assert_non_null(strstr(err.text, "no/such/folder.html"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_shell, nothing_leaks),
                                       cmocka_unit_test_teardown(test_design, nothing_leaks),
                                       cmocka_unit_test_teardown(test_solid, nothing_leaks),
                                       cmocka_unit_test_teardown(test_rod, nothing_leaks),
                                       cmocka_unit_test_teardown(test_inversion, nothing_leaks),
                                       cmocka_unit_test_teardown(test_drawing, nothing_leaks),
                                       cmocka_unit_test_teardown(test_targets, nothing_leaks),
                                       cmocka_unit_test_teardown(test_obstacles, nothing_leaks),
                                       cmocka_unit_test_teardown(test_stages, nothing_leaks),
                                       cmocka_unit_test_teardown(test_several, nothing_leaks),
                                       cmocka_unit_test_teardown(test_refused, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
