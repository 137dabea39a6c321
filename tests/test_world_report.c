/* What check and run say of what a body meets, and what they warn of. */
#include "model/world_report.h"
#include "tests/scene_fixture.h"
#include <stdio.h>

/* A sheet of 10 x 10 mm whose middle is at z = 0, and what it meets. */
static Built build(const char *more)
{
    return scene_build(mem_format("slender: 1\njob: simulate\nshell:\n"
                                  "  mesh: {shape: sheet, size: [10 mm, 10 mm], cells: [2, 2]}\n"
                                  "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n"
                                  "  density: 1000\n  gravity: [0, 0, -9.81]\n"
                                  "time: {step: 1 ms, steps: 10}\n%s",
                                  more));
}

static void expect_lines(const char *more, const char *lines)
{
    Built b = build(more);
    char *text = world_describe(b.model, &b.scene);
    if (lines)
        assert_string_equal(text, lines);
    else
        assert_null(text);
    mem_free(text);
    clear(&b);
}

static void test_lines(void **state)
{
    (void)state;
    expect_lines("", NULL);
    expect_lines("water: {}\n", "water: 1000 kg/m^3\n");
    expect_lines("water: {density: 800, velocity: [1, 0, 0]}\n", "water: 800 kg/m^3, it flows\n");
    expect_lines("obstacles: [{name: floor, plane: {point: [0, 0, -1]}}]\ncontact: {stiffness: 50}\n",
                 "1 obstacle: floor (plane)\n"
                 "contact: 9 vertices; the body stays 0.0005 m away, with 50 N/m at each\n");
    expect_lines(
        "obstacles:\n  - {plane: {point: [0, 0, -1]}}\n"
        "  - {name: ball, sphere: {center: [0, 0, -1], radius: 2 mm}, friction: 0.3,\n"
        "     move: [\"t\", \"0\", \"0\"]}\n"
        "contact: {friction: 0.5, self: true, stiffness: 50}\n",
        "2 obstacles: obstacle1 (plane, friction 0.5), ball (sphere, moves, friction 0.3)\n"
        "contact: 9 vertices, and middles of 16 edges and 8 faces longer than an obstacle's detail of "
        "0.002 m; the body stays 0.0005 m away, with 50 N/m at each\n"
        "self contact: parts nearer than 0.001 m, with 0.001 J; friction 0.5\n");
}

static void expect_warning(const char *more, const char *sentence)
{
    Built b = build(more);
    assert_int_equal(b.model->report.warning_count, sentence != NULL);
    if (sentence) assert_string_equal(b.model->report.warnings[0], sentence);
    clear(&b);
}

static void test_warnings(void **state)
{
    (void)state;
    expect_warning("obstacles: [{plane: {point: [0, 0, -0.5 mm]}}]\n", NULL); /* it lies on it */
    expect_warning("obstacles: [{plane: {point: [0, 0, -0.49 mm]}}]\n", NULL);
    expect_warning(
        "obstacles: [{name: floor, plane: {point: [0, 0, 0.4 mm]}}]\n",
        "where case1 starts, the body is inside the obstacle 'floor': vertex 0 by 0.0009 m (its outside is "
        "0.0005 m off). It is driven out at once");
    expect_warning(
        "obstacles: [{name: floor, plane: {point: [0, 0, -1 mm]}, move: [\"0\", \"0\", \"0.003\"]}]\n",
        "where case1 starts, the body is inside the obstacle 'floor': vertex 0 by 0.0025 m (its outside is "
        "0.0005 m off). It is driven out at once");
    expect_warning("contact: {self: {distance: 0.95 mm}}\n", NULL);
    expect_warning("contact: {self: {distance: 0.8 mm}}\n",
                   "self contact begins where middles are 0.0008 m apart, but the body is 0.001 m thick: its "
                   "parts reach into each other");
}

/* A ball, of which the faces know their outer sides; two triangles that begin a micrometre apart, and nearer. */
static void test_files(void **state)
{
    (void)state;
    static const char scene[] = "slender: 1\njob: simulate\nshell:\n  mesh: {file: %s}\n"
                                "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n"
                                "time: {step: 1 ms, steps: 10}\n%s";
    Built b = scene_build(mem_format(scene, SOURCE_DIR "/scenes/meshes/ball.obj", "water: {sides: outer}\n"));
    char *text = world_describe(b.model, &b.scene);
    assert_string_equal(text, "water: 1000 kg/m^3, on the outer sides of faces\n");
    mem_free(text);
    clear(&b);
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen("world_near.obj", "w");
        assert_non_null(file);
        fprintf(file, "v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\nv 0.002 0.002 %g\nv 0.002 0.002 0.01\n",
                k ? 9e-7 : 1e-6);
        fputs("v 0.003 0.002 0.01\nf 1 2 3\nf 4 5 6\n", file);
        assert_int_equal(fclose(file), 0);
        b = scene_build(mem_format(scene, "world_near.obj", "contact: {self: true}\n"));
        assert_int_equal(b.model->report.warning_count, k);
        if (k)
            assert_string_equal(
                b.model->report.warnings[0],
                "where case1 starts, parts of the body are 9e-07 m apart, at vertices 3 and 0, and "
                "self contact begins at 0.001 m. They are driven apart at once");
        clear(&b);
    }
}

/* 1e-4 kg of nine vertices fall at m g/(9 gamma); a rod at that of a metre, which is much for one that is little damped. */
static void test_damping(void **state)
{
    (void)state;
    Built b = scene_build(mem_text("slender: 1\njob: simulate\nshell:\n"
                                   "  mesh: {shape: sheet, size: [10 mm, 10 mm], cells: [2, 2]}\n"
                                   "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  density: 1000\n"
                                   "  gravity: [0, 0, -9.81]\n  damping: 0.01\n"
                                   "obstacles: [{plane: {point: [0, 0, -1 mm]}}]\n"
                                   "time: {step: 1 ms, steps: 10}\n"));
    assert_int_equal(b.model->report.warning_count, 1);
    assert_string_equal(b.model->report.warnings[0],
                        "damping outweighs all else: with 0.01 N s/m at each point the body falls at 0.011 "
                        "m/s at most");
    clear(&b);
    static const char *const damping[] = {"0.003", "0.3"};
    for (int k = 0; k < 2; k++) {
        b = scene_build(
            mem_format("slender: 1\njob: simulate\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.1\n"
                       "  radius: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  density: 1000\n"
                       "  damping: %s\nobstacles: [{plane: {point: [0, 0, -1 mm]}}]\n"
                       "time: {step: 1 ms, steps: 10}\n",
                       damping[k]));
        assert_int_equal(b.model->report.warning_count, k);
        if (k)
            assert_string_equal(b.model->report.warnings[0], "damping outweighs all else: with 0.3 N s/m^2 "
                                                             "the body falls at 0.1 m/s at most");
        clear(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lines), cmocka_unit_test(test_warnings),
                                       cmocka_unit_test(test_files), cmocka_unit_test(test_damping)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
