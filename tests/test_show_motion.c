/* Of trajectories: what they record of what they were to follow, and pictures of it, read back from SVG. */
#include "base/vec3.h"
#include "io/result.h"
#include "leaks.h"
#include "page_fixture.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME "test_show_motion"

enum { STEPS = 12, EVERY = 3, FRAMES = STEPS / EVERY + 1, CORNERS = 3, CHORDS = 128 };

#define MOTION                                                                                               \
    "time: {step: 2 ms, steps: 12}\noutput: {every: 3, precision: double}\n"                                 \
    "flux_density: [\"0.001\", \"0.002*t/0.024\", \"0.002\"]\n"
#define DESIGN(tip)                                                                                          \
    "design:\n  unknowns: {flux_density: {per: frame, bounds: [-0.05, 0.05]}}\n  optimizer: gauss_newton\n"  \
    "  iterations: 1\n  objectives:\n"                                                                       \
    "    - {waypoint: {vertex: " tip ", frame: 4, at: [28 mm, 5 mm, 3 mm]}}\n"                               \
    "    - {field_magnitude: 1.0e-9}\n"                                                                      \
    "    - {curve: {vertex: " tip ", frames: [4, 12], points: [[28 mm, 5 mm, 3 mm], [28 mm, 5 mm, 6 mm], "   \
    "[24 mm, 5 mm, 6 mm]]}}\n"                                                                               \
    "    - {waypoint: {vertex: 5, frames: [9, 12], at: [1 mm, 2 mm, 3 mm]}}\n"                               \
    "    - {curve: {vertex: " tip ", frames: [2, 3], arc: [[1 mm, 0, 0], [0, 0, 1 mm], [-1 mm, 0, 0]]}}\n"
#define SHELL                                                                                                \
    "slender: 1\njob: trajectory\nshell:\n"                                                                  \
    "  mesh: {shape: sheet, size: [30 mm, 10 mm], cells: [6, 2], pattern: crossed}\n"                        \
    "  thickness: 1 mm\n  young: 0.1 MPa\n  poisson: 0.5\n  density: 1000\n"                                 \
    "  magnetization: [5.0e+4, 0, 0]\n  damping: 1.0e-4\n"                                                   \
    "fix:\n  - {box: [[-1.0e-9, -1, -1], [1.0e-9, 1, 1]], clamp: true}\n"
#define ROD                                                                                                  \
    "slender: 1\njob: trajectory\nrod:\n  natural_strain: [0, 0, 0]\n  length: 30 mm\n  elements: 8\n"       \
    "  radius: 0.5 mm\n  young: 1 MPa\n  poisson: 0.5\n  density: 1200\n  magnetization: [5.0e+4, 0, 0]\n"   \
    "  damping: 0.01\n"
#define SOLID                                                                                                \
    "slender: 1\njob: trajectory\nsolid:\n  mesh: {shape: box, size: [30 mm, 10 mm, 5 mm], cells: [3, 1, "   \
    "1]}\n"                                                                                                  \
    "  young: 0.1 MPa\n  poisson: 0.4\n  density: 1000\n  magnetization: [5.0e+4, 0, 0]\n"                   \
    "fix:\n  - {box: [[-1.0e-9, -1, -1], [1.0e-9, 1, 1]]}\n"

/* ---- What is recorded ---- */

typedef struct Recorded {
    Array followed, names, frames, follows, offsets, points, distance, largest, x, flux;
} Recorded;

static Array array_of(Result *result, const char *path)
{
    Error err;
    Array array = {0};
    if (!result_read(result, path, &array, &err)) fail_msg("%s", err.text);
    return array;
}

static Recorded record(void)
{
    Error err;
    Result *result = result_open(NAME ".vtkhdf", &err);
    if (!result) fail_msg("%s", err.text);
    Recorded all = {.followed = array_of(result, "slender/trajectory/followed"),
                    .names = array_of(result, "slender/trajectory/reference/names"),
                    .frames = array_of(result, "slender/trajectory/reference/frames"),
                    .follows = array_of(result, "slender/trajectory/reference/follows"),
                    .offsets = array_of(result, "slender/trajectory/reference/offsets"),
                    .points = array_of(result, "slender/trajectory/reference/points"),
                    .distance = array_of(result, "slender/trajectory/reference/distance"),
                    .largest = array_of(result, "slender/metrics/largest_distance"),
                    .x = array_of(result, "slender/frames/x"),
                    .flux = array_of(result, "slender/trajectory/flux_density")};
    result_close(result);
    return all;
}

static void clear(Recorded *all)
{
    Array *arrays = (Array *)all;
    for (size_t k = 0; k < sizeof *all / sizeof *arrays; k++) array_clear(&arrays[k]);
}

static double between(const double *a, const double *b)
{
    return vec3_length(vec3_sub(vec3_load(a), vec3_load(b)));
}

/* Is it where some vertex was, in all frames that are stored? */
static bool is_a_vertex(const Recorded *all, const double (*way)[3])
{
    int vertices = all->x.dims[1];
    const double *x = all->x.data;
    for (int v = 0; v < vertices; v++) {
        bool same = true;
        for (int f = 0; f < FRAMES; f++)
            same = same && !memcmp(way[EVERY * f], x + 3 * (f * vertices + v), sizeof *way);
        if (same) return true;
    }
    return false;
}

/* Rows are the point's objectives in their order, two points are followed, and distances are those of the way. */
static void check_recorded(const char *scene)
{
    page_run(NAME, scene);
    Recorded all = record();
    const double(*way)[STEPS + 1][3] = (const double(*)[STEPS + 1][3]) all.followed.data,
                               *distance = all.distance.data, *largest = all.largest.data;
    const double(*points)[3] = (const double(*)[3])all.points.data;
    static const int follows[] = {0, 0, 1, 0}, offsets[] = {0, 1, 4, 5, 6 + CHORDS},
                     frames[] = {4, 4, 4, 12, 9, 12, 2, 3};
    assert_string_equal(all.names.data, "waypoint\ncurve\nwaypoint\ncurve\n");
    assert_memory_equal(all.follows.data, follows, sizeof follows);
    assert_memory_equal(all.offsets.data, offsets, sizeof offsets);
    assert_memory_equal(all.frames.data, frames, sizeof frames);
    assert_int_equal(all.followed.dims[0], 2);
    assert_true(is_a_vertex(&all, way[0]) && is_a_vertex(&all, way[1]));
    assert_true(memcmp(way[0], way[1], sizeof *way) && between(way[0][0], way[0][STEPS]) > 1e-4);
    for (int n = 0; n <= STEPS; n++) {
        assert_float_equal(distance[n], between(way[0][n], points[0]), 1e-17);
        assert_float_equal(distance[2 * (STEPS + 1) + n], between(way[1][n], points[4]), 1e-17);
    }
    double most = 0;
    for (int n = 4; n <= STEPS; n++) most = fmax(most, distance[STEPS + 1 + n]);
    assert_true(most == largest[2] && isnan(largest[1]) && distance[4] == largest[0]);
    for (int k = 5; k < 6 + CHORDS; k++) { /* half a circle of 1 mm, evenly */
        double angle = M_PI * (k - 5) / CHORDS, at[] = {1e-3 * cos(angle), 0, 1e-3 * sin(angle)};
        assert_true(between(points[k], at) < 1e-17);
    }
    clear(&all);
}

static void test_recorded(void **state)
{
    (void)state;
    check_recorded(ROD MOTION DESIGN("tip"));
    check_recorded(SOLID MOTION DESIGN("3"));
    check_recorded(SHELL MOTION DESIGN("tip"));
}

/* ---- What is drawn ---- */

typedef struct Polyline {
    int count;
    double at[256][2];
} Polyline;

static char *write_svg(const ShowDef *def)
{
    Error err = {""};
    if (show_result(NAME ".vtkhdf", NAME ".svg", def, &err) != SHOW_DONE) fail_msg("%s", err.text);
    return page_text(NAME ".svg");
}

/* The k-th open line of that colour: "rgb(25%,25%,27%)". */
static Polyline line_of(const char *svg, const char *color, int k)
{
    Polyline line = {0};
    char stroke[64];
    snprintf(stroke, sizeof stroke, "stroke:%s", color);
    for (const char *at = svg; (at = strstr(at, stroke)); at++) {
        if (k-- > 0) continue;
        const char *d = strstr(at, " d=\"M ") + 4;
        int used;
        while (line.count < 256 &&
               sscanf(d, "%*1[ML] %lf %lf %n", &line.at[line.count][0], &line.at[line.count][1], &used) == 2)
            line.count++, d += used;
        return line;
    }
    return line;
}

static const char REFERENCE[] = "rgb(83.5%,36.9%,0%)", PATH[] = "rgb(25%,25%,27%)",
                  MARK[] = "rgb(50%,50%,52%)";

/* Are they at the places in the world, seen along y? SVG has positions to 2^-8 pt, and the scale is that of 3 mm. */
static void check_seen(const Polyline *line, const double (*points)[3], int count, double scale,
                       const double origin[2])
{
    assert_int_equal(line->count, count);
    for (int k = 0; k < count; k++) {
        assert_float_equal(line->at[k][0], origin[0] + scale * points[k][0], 0.05);
        assert_float_equal(line->at[k][1], origin[1] - scale * points[k][2], 0.05);
    }
}

/* In each frame the curves, the way up to then, and a line in the charts at its time. */
static void test_drawn(void **state)
{
    (void)state;
    page_run(NAME, SHELL MOTION DESIGN("tip"));
    Recorded all = record();
    const double(*way)[STEPS + 1][3] = (const double(*)[STEPS + 1][3]) all.followed.data,
                               (*points)[3] = (const double(*)[3])all.points.data;
    ShowDef def = show_default();
    def.view[1] = -1, def.arrows = false;
    for (def.frame = 1; def.frame < FRAMES; def.frame++) {
        char *svg = write_svg(&def);
        Polyline corner = line_of(svg, REFERENCE, 0), path = line_of(svg, PATH, 0),
                 charts[2] = {line_of(svg, MARK, 0), line_of(svg, MARK, 1)};
        double scale = hypot(corner.at[0][0] - corner.at[1][0], corner.at[0][1] - corner.at[1][1]) / 3e-3;
        double origin[] = {corner.at[0][0] - scale * points[1][0], corner.at[0][1] + scale * points[1][2]};
        check_seen(&corner, points + 1, CORNERS, scale, origin);
        check_seen(&path, way[0], EVERY * def.frame + 1, scale, origin);
        Polyline arc = line_of(svg, REFERENCE, 1);
        check_seen(&arc, points + 5, CHORDS + 1, scale, origin);
        for (int k = 0; k < 2; k++) { /* as far from the first frame's as time goes */
            static double first[2];
            if (def.frame == 1) first[k] = charts[k].at[0][0];
            assert_int_equal(charts[k].count, 2);
            assert_float_equal(charts[k].at[0][0], charts[k].at[1][0], 0);
            double third = charts[k].at[0][0] - first[k];
            static double step[2];
            if (def.frame == 2) step[k] = third;
            if (def.frame > 1) assert_float_equal(third, (def.frame - 1) * step[k], 0.04);
            if (def.frame == 2) assert_true(third > 40);
        }
        mem_free(svg);
    }
    clear(&all);
}

static int count_of(const char *svg, const char *what)
{
    int count = 0;
    for (const char *at = svg; (at = strstr(at, what)); at++) count++;
    return count;
}

/* All six moments are marked in both charts; a film has as many pages as there are moments. */
static void test_pages(void **state)
{
    (void)state;
    ShowDef def = show_default();
    char *svg = write_svg(&def);
    assert_int_equal(count_of(svg, MARK), 2 * FRAMES);
    mem_free(svg);
    page_run(NAME, ROD MOTION DESIGN("tip"));
    svg = write_svg(&def);
    Polyline path = line_of(svg, "rgb(0%,62%,45.1%)", 1); /* after the legend's */
    assert_int_equal(path.count, STEPS + 1);
    mem_free(svg);
    for (int k = 0; k < 2; k++) {
        Error err = {""};
        page_run(NAME, k ? SHELL MOTION DESIGN("tip") : ROD MOTION DESIGN("tip"));
        def.seconds = 0.2, def.width = 400;
        if (show_result(NAME ".vtkhdf", NAME ".webp", &def, &err) != SHOW_DONE) fail_msg("%s", err.text);
    }
}

/* ---- Targets ---- */

static void check_refused(PictureTarget target, double seconds, const char *sentence)
{
    Error err = {""};
    ShowDef def = show_default();
    def.target = target, def.seconds = seconds, def.width = 400;
    const char *file = seconds > 0 ? NAME ".webp" : NAME ".png";
    ShowStatus status = show_result(NAME ".vtkhdf", file, &def, &err);
    if (sentence) assert_string_equal(err.text, sentence);
    assert_int_equal(status, sentence ? SHOW_HAS_NOT : SHOW_DONE);
}

/* A target that was asked for is there, and where it was asked for, or it is said. */
static void test_targets(void **state)
{
    (void)state;
    static const char none[] = "--target: there is none: no shape of a load case that is shown, no place or "
                               "curve of a motion";
    page_run(NAME, SHELL MOTION DESIGN("tip"));
    check_refused(PICTURE_TARGET_OVER, 0, NULL);
    check_refused(PICTURE_TARGET_OVER, 0.1, NULL);
    check_refused(PICTURE_TARGET_BESIDE, 0,
                  "--target: the places and curves of a motion are always over the body");
    page_run(NAME, SHELL MOTION "target: {formula: [x, y, \"z + 0.002\"]}\n"
                                "design:\n  unknowns: {flux_density: {per: frame, bounds: [-0.05, 0.05]}}\n"
                                "  iterations: 0\n  objectives: [{target: 1}]\n");
    check_refused(PICTURE_TARGET_OVER, 0, NULL);
    check_refused(PICTURE_TARGET_BESIDE, 0, NULL);
    check_refused(PICTURE_TARGET_BOTH, 0.1, "--target: an animation has its target over the body");
    page_run(NAME, ROD MOTION DESIGN("tip"));
    check_refused(PICTURE_TARGET_OVER, 0, NULL);
    check_refused(PICTURE_TARGET_BOTH, 0,
                  "--target: the input of a rod is always drawn under the simulated curve");
    page_run(NAME,
             "slender: 1\njob: evaluate\nshell: {mesh: {shape: sheet, size: [30 mm, 10 mm], cells: [6, 2]},\n"
             "  thickness: 1 mm, young: 1 MPa, poisson: 0.3, density: 1000}\n");
    check_refused(PICTURE_TARGET_OVER, 0, none);
    check_refused(PICTURE_TARGET_AUTO, 0, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_recorded), cmocka_unit_test(test_drawn),
                                       cmocka_unit_test(test_pages), cmocka_unit_test(test_targets)};
    int failed = cmocka_run_group_tests(tests, NULL, nothing_leaks);
    page_remove_files(NAME);
    unlink(NAME ".svg");
    unlink(NAME ".webp");
    return failed;
}
