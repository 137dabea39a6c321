/* slender report: the pages of whole runs hold what their results do. The page itself is tested in a browser:
 * tests/report_browser.sh; what its document packs by test_report_document.c. */
#include "base/vec3.h"
#include "model/frame_flux.h"
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
    return page_of(RESULT, HTML, frames);
}

/* Frames 0, middle and last of `steps`: the corners of all faces are where they are in the result. */
static void check_body(const Page *page, Result *result, const int *frames, int count)
{
    const char *body = after(page->json, "body");
    Unpacked faces = unpack(page, body, "faces"), points = unpack_places(page, body, "points");
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
    Unpacked offsets = unpack(&page, rod, "offsets"), points = unpack_places(&page, rod, "points");
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
    Unpacked radius = unpack(&page, rod, "radius");
    assert_int_equal(radius.width, 41);
    for (size_t k = 0; k < 41; k++) assert_true(fabs(radius.values[k] - 0.6e-3) < 1e-9);
    Unpacked held = unpack_places(&page, page.json, "holds"); /* its first end, where the rod begins */
    for (size_t i = 0; i < 3; i++) assert_true(fabs(held.values[i] - points.values[i]) < 2e-6);
    mem_free(held.values);
    mem_free(radius.values);
    mem_free(offsets.values);
    mem_free(points.values);
    page_clear(&page);
    result_close(result);
}

/* Rods at rest are coloured by what they have at their nodes; they are as thick as they are there. */
static void test_rod_fields(void **unused)
{
    (void)unused;
    static const struct {
        const char *name, *array;
        int first, count;
    } fields[] = {{"curvature", "strain", 1, 2}, {"twist", "strain", 0, 1}, {"moment", "moment", 0, 3}};
    Error err;
    Result *result = run_text(
        mem_text("slender: 1\njob: equilibrium\nrod:\n  natural_strain: [1, \"20*s\", 3]\n  length: 80 mm\n"
                 "  elements: 20\n  radius: {formula: \"1e-3*(1 - s/2/L)\"}\n  young: 1 MPa\n  poisson: 0.4\n"
                 "  density: 1000\n  gravity: [0, 0, -9.81]\n"));
    Page page = report(0);
    const char *rod = strstr(page.json, "\"name\":\"rod\"");
    Unpacked radius = unpack(&page, rod, "radius");
    for (int k = 1; k < 20; k++) assert_true(fabs(radius.values[k] - 1e-3 * (1 - k / 40.)) < 1e-7);
    for (int f = 0; f < 3; f++) {
        char name[40], path[40];
        snprintf(name, sizeof name, "\"name\":\"%s\"", fields[f].name);
        snprintf(path, sizeof path, "PointData/%s", fields[f].array);
        Unpacked values = unpack(&page, strstr(rod, name), "values");
        Array rows;
        if (!result_read_step(result, path, 0, &rows, &err)) fail_msg("%s", err.text);
        assert_int_equal(values.width, 21);
        for (int k = 0; k < 21; k++) {
            const double *row = (const double *)rows.data + 3 * k + fields[f].first;
            double square = 0, size;
            for (int i = 0; i < fields[f].count; i++) square += row[i] * row[i];
            size = fields[f].count == 1 ? *row : sqrt(square);
            assert_true(fabs(values.values[k] - size) <=
                        1e-4 * (values.high - values.low) + 1e-6 * fabs(size));
        }
        assert_true(values.high > values.low);
        array_clear(&rows);
        mem_free(values.values);
    }
    mem_free(radius.values);
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
    Unpacked points = unpack_places(&page, target, "points");
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
    points = unpack_places(&page, target, "points");
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
    double origin[3];
    char *next = (char *)after(page.json, "origin");
    for (int i = 0; i < 3; i++) origin[i] = strtod(next + 1, &next);
    const char *at = after(page.json, "obstacles");
    int frames = result_step_count(result);
    assert_true(frames > 2 && array_count(&poses) == 24 * (size_t)frames);
    for (int o = 0; o < 2; o++) {
        char *rest = (char *)(at = after(at, "poses"));
        for (int k = 0; k < frames; k++)
            for (int i = 0; i < 12; i++) {
                double got = strtod(rest + 1, &rest), is = pose[12 * (2 * k + o) + i];
                if (i % 4 == 3) is -= origin[i / 4];
                assert_true(fabs(got - is) <= 1e-6 * fabs(is));
            }
    }
    array_clear(&poses);
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

/* A coil whose current grows, and a magnet that comes, turns and is beside the body. */
static const char MAGNET[] =
    "slender: 1\njob: simulate\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [8, 4]}\n"
    "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  density: 1000\n  magnetization: [1.0e+4, 0, 0]\n"
    "fix: [{group: root, clamp: true}]\ntime: {step: 5 ms, steps: 4}\nflux_density:\n  - [1 mT, 0, 0]\n"
    "  - {magnet: {at: [20 mm, 10 mm, 30 mm], size: [8 mm, 8 mm, 8 mm], remanence: [0, 0, 1.2]},\n"
    "     move: [\"0\", \"0\", \"-t/2\"], turn: [\"20*t\", \"0\", \"0\"]}\n";

/* The arrows of the page are the field at their places, in each frame; within the magnet there are none. */
static void test_arrows(void **unused)
{
    (void)unused;
    Error err;
    FrameFlux flux;
    Result *result = run_text(mem_text(MAGNET));
    Page page = report(3);
    const char *arrows = after(page.json, "arrows");
    Unpacked points = unpack_places(&page, arrows, "points"), ways = unpack(&page, arrows, "directions"),
             sizes = unpack(&page, arrows, "sizes");
    size_t count = sizes.width, hidden = 0;
    if (!frame_flux_open(&flux, result, &err)) fail_msg("%s", err.text);
    assert_true(points.rows == 3 && sizes.rows == 3 && count > 200 && count < 400);
    assert_true(sizes.low > 1e-4 && sizes.high > 0.1);
    for (size_t n = 0; n < 3 * count; n++) {
        double B[3], size, at[3];
        int frame = 2 * (int)(n / count);
        assert_true(frame_flux_take(&flux, result, frame, 5e-3 * frame, &err));
        memcpy(at, points.values + 3 * n, sizeof at);
        frame_flux_at(&flux, at, B);
        size = vec3_length(vec3_load(B));
        if (isnan(size)) assert_true(isnan(sizes.values[n]) && ++hidden);
        if (isnan(size)) continue;
        assert_true(fabs(sizes.values[n] / size - 1) < 0.02);
        for (size_t i = 0; i < 3; i++) assert_true(fabs(ways.values[3 * n + i] - B[i] / size) < 0.01);
    }
    assert_true(hidden > 0 && hidden < count / 10);
    frame_flux_clear(&flux);
    mem_free(points.values), mem_free(ways.values), mem_free(sizes.values);
    page_clear(&page);
    result_close(result);
}

/* Where the sources cannot be made again all else is there, and the page says why. */
static void test_no_arrows(void **unused)
{
    (void)unused;
    FILE *file = fopen(NAME ".csv", "w");
    assert_non_null(file);
    fputs("x [mm], y [mm], z [mm], Bx [mT], By [mT], Bz [mT]\n-5, 0, 0, 0, 0, 0\n50, 0, 0, 0, 0, 1\n", file);
    assert_int_equal(fclose(file), 0);
    Result *result = run_text(mem_format("%sflux_density: {map: {file: " NAME ".csv}}\n", SHEET));
    Page page = report(0);
    assert_true(strstr(page.json, "\"arrows\":{") && !strstr(page.json, "\"no_arrows\""));
    page_clear(&page);
    unlink(NAME ".csv");
    page = report(0);
    assert_false(strstr(page.json, "\"arrows\":{"));
    assert_non_null(strstr(after(page.json, "no_arrows"), NAME ".csv"));
    assert_non_null(strstr(page.json, "\"charts\""));
    page_clear(&page);
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
                                       cmocka_unit_test_teardown(test_rod_fields, nothing_leaks),
                                       cmocka_unit_test_teardown(test_inversion, nothing_leaks),
                                       cmocka_unit_test_teardown(test_drawing, nothing_leaks),
                                       cmocka_unit_test_teardown(test_targets, nothing_leaks),
                                       cmocka_unit_test_teardown(test_arrows, nothing_leaks),
                                       cmocka_unit_test_teardown(test_no_arrows, nothing_leaks),
                                       cmocka_unit_test_teardown(test_obstacles, nothing_leaks),
                                       cmocka_unit_test_teardown(test_several, nothing_leaks),
                                       cmocka_unit_test_teardown(test_refused, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
