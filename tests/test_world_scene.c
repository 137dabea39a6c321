/* What scenes say of obstacles, contact and water becomes what it says. */
#include "base/memory.h"
#include "tests/obstacle_fixture.h"
#include "tests/scene_fixture.h"
#include <stdio.h>

/* A body that moves, and what it meets. */
static Built build_of(const char *mesh, const char *world)
{
    return scene_build(mem_format("slender: 1\njob: simulate\nshell:\n  mesh: {%s}\n"
                                  "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n"
                                  "time: {at: 2, step: 1 ms, steps: 10}\n%s",
                                  mesh, world));
}

/* A sheet. */
static Built build(const char *world)
{
    return build_of("shape: sheet, size: [10 mm, 10 mm], cells: [2, 2]", world);
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* The effective scene makes the same model again, and says the same. */
static void check_written(const Built *b)
{
    char *text = yaml_write(scene_table(), &b->scene);
    Built again = scene_try(text);
    if (!again.model) fail_msg("%s", yaml_report(again.file));
    char *other = yaml_write(scene_table(), &again.scene);
    assert_string_equal(text, other);
    assert_int_equal(again.model->world != NULL, b->model->world != NULL);
    assert_int_equal(self_contact_is_asked(&again.scene.contact.self),
                     self_contact_is_asked(&b->scene.contact.self));
    mem_free(text);
    mem_free(other);
    clear(&again);
}

static void test_obstacles(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    write_file("world_step.pgm", "P2 3 2 10\n10 10 10\n0 0 5\n"); /* high at +y, half as high at +x, -y */
    write_file("world_corner.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    Built b =
        build("obstacles:\n"
              "  - {plane: {point: [0, 0, -1]}}\n"
              "  - {name: ball, sphere: {center: [0, 0, 1], radius: 10 mm, inside: true}, friction: 0.3}\n"
              "  - {cylinder: {point: [0, 0, 1], axis: [2, 0, 0], radius: 0.5}}\n"
              "  - {box: {center: [0, 0, 0], half: [1, 2, 3]}}\n"
              "  - {height_field: {formula: \"1 + s*y\", where: {s: \"2*x\"}, range: [[0, 0], [1, 2]]}}\n"
              "  - {height_field: {image: world_step.pgm, height: 3, range: [[0, 0], [3, 2]]}}\n"
              "  - {height_field: {formula: \"x\", range: [[0, 0], [1, 2]], cells: [2, 4]}}\n"
              "  - {tube: {axis: y, radius: \"1 + 0.1*s\", center: [\"0.5\", \"s\"], range: [0, 4]}}\n"
              "  - {mesh: {file: world_corner.obj, scale: 2, cell: 0.05}}\n"
              "  - {plane: {}, move: [\"0\", \"0\", \"t\"], turn: [\"pi/2\", \"0\", \"0\"]}\n");
    check_written(&b);
    const Obstacle *o = b.model->world->obstacles;
    assert_int_equal(b.model->world->obstacle_count, 10);
    assert_string_equal(o[0].name, "obstacle1");
    assert_string_equal(o[1].name, "ball");
    assert_true(isnan(b.scene.obstacles[0].friction) && b.scene.obstacles[1].friction == 0.3);
    assert_near(value_at(&o[0], 5, 6, 1), 2, 0);
    assert_near(value_at(&o[1], 0, 0, 1), 0.01, 0);
    assert_near(value_at(&o[2], 7, 1, 1), 0.5, 1e-15);
    assert_near(value_at(&o[3], 2, 0, 0), 1, 0);
    assert_near(o[3].feature, 0.1, 0);
    assert_near(value_at(&o[4], 0.3, 0.7, 4), 3 - 2 * 0.3 * 0.7, 1e-12);
    assert_near(o[4].feature, 1.0 / 64, 1e-15);
    assert_near(value_at(&o[5], 1, 2, 0), -3, 1e-12);
    assert_near(value_at(&o[5], 0, 0, 0), 0, 1e-12);
    assert_near(value_at(&o[5], 3, 0, 0), -1.5, 1e-12);
    assert_near(o[5].feature, 1, 1e-15);
    assert_near(o[6].feature, 0.5, 1e-15);
    assert_near(value_at(&o[7], 0.5, 2, 2), 1.2, 1e-12);
    assert_near(value_at(&o[7], 1, 2, 2), 0.7, 1e-12);
    assert_near(value_at(&o[8], 0.5, 0.5, -0.1), 0.1, 1e-6);
    assert_near(value_at(&o[8], 0.5, 0.5, 0.1), -0.1, 1e-3);
    RigidPose pose;
    Gap gap;
    Error err;
    assert_true(obstacle_pose(&o[9], 2, &pose, &err));
    obstacle_gap(&o[9], &pose, (double[3]){0, -3, 0}, &gap); /* free towards -y; a point of it at (0, 0, 2) */
    assert_near(gap.value, 3, 1e-14);
    clear(&b);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_contact(void **state)
{
    (void)state;
    Built b = build("");
    assert_null(b.model->world);
    assert_false(self_contact_is_asked(&b.scene.contact.self));
    assert_null(b.scene.water);
    clear(&b);
    b = build("obstacles: [{plane: {}}]\n");
    assert_true(b.scene.contact.friction == 0 && b.scene.contact.slip_speed == 1e-3);
    assert_true(b.scene.contact.stiffness.mode == 0 && b.scene.contact.offset.mode == 0);
    assert_int_equal(b.scene.contact.coupling, COUPLING_LAGGED);
    clear(&b);
    b = build("obstacles: [{plane: {}}]\ncontact: {stiffness: 1e4, offset: 0, coupling: implicit}\n");
    assert_true(b.scene.contact.stiffness.mode == -1 && b.scene.contact.stiffness.value == 1e4);
    assert_true(b.scene.contact.offset.mode == -1 && b.scene.contact.offset.value == 0);
    assert_int_equal(b.scene.contact.coupling, COUPLING_IMPLICIT);
    clear(&b);
    static const struct {
        const char *text;
        bool asked;
    } selves[] = {{"true", true}, {"false", false}, {"{distance: 1 mm}", true}, {"{stiffness: 1e-6}", true}};
    for (size_t k = 0; k < sizeof selves / sizeof *selves; k++) {
        char *world = mem_format("contact: {self: %s}\n", selves[k].text);
        b = build(world);
        assert_int_equal(self_contact_is_asked(&b.scene.contact.self), selves[k].asked);
        check_written(&b);
        mem_free(world);
        clear(&b);
    }
}

/* What a rod is pressed with, what its weight, its load and its fall ask for: the largest stands. */
static void test_rod_stiffness(void **state)
{
    (void)state;
    const struct {
        const char *young, *loads, *step;
        double exact;
    } cases[] = {
        {"1 GPa", "", "1 s", 1e9 * M_PI / 40 * 1e-6 / (0.005 * 0.01)},
        {"1 Pa", "", "1 s", 50 * 1000 * M_PI * 1e-6 * 0.01 * 10 / (0.005 * 1e-3)},
        {"1 Pa", "  loads: [{point: 0.1, force: [3, 0, -4]}]\n", "1 s", 5 / (0.005 * 1e-3)},
        {"1 Pa", "", "1 ms", 1000 * M_PI * 1e-6 * 0.01 * sqrt(2 * 10 * 0.1) / (1e-3 * 0.005 * 1e-3)},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Built b = scene_build(mem_format("slender: 1\njob: simulate\nrod:\n  natural_strain: [0, 0, 0]\n"
                                         "  length: 0.1\n  elements: 10\n  radius: 1 mm\n  young: %s\n"
                                         "  poisson: 0.3\n  density: 1000\n  gravity: [0, 0, -10]\n%s"
                                         "time: {step: %s, steps: 1}\nobstacles: [{plane: {}}]\n",
                                         cases[k].young, cases[k].loads, cases[k].step));
        const double *p = b.model->cases[0].stages[0].p;
        assert_near(p[b.model->world->stiffness] / cases[k].exact, 1, 1e-12);
        clear(&b);
    }
}

static void test_water(void **state)
{
    (void)state;
    Built b = build("water: {}\n");
    assert_true(b.scene.water->density == 1000 && b.scene.water->viscosity == 1e-3);
    assert_true(b.scene.water->velocity.value[2] == 0 && b.scene.water->sides == SIDES_TWO);
    clear(&b);
    b = build_of("file: " SOURCE_DIR "/scenes/meshes/ball.obj",
                 "water: {density: 800, velocity: [\"t\", \"x*y\", \"0\"], sides: outer}\n");
    assert_int_equal(b.scene.water->velocity.formula_count, 3);
    assert_int_equal(b.scene.water->sides, SIDES_OUTER);
    clear(&b);
}

/* Two triangles; a sheet of eight whose slit of three vertices on three others ends at two that are one. */
static void test_touching(void **state)
{
    (void)state;
    static const char scene[] = "slender: 1\njob: simulate\nshell:\n  mesh: {file: world_touching.obj}\n"
                                "  thickness: 0.1\n  young: 1 MPa\n  poisson: 0.3\n"
                                "time: {step: 1 ms, steps: 1}\ncontact: {self: true}\n";
    write_file("world_touching.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 0\nv 0.2 0.2 1\nv 0.3 0.2 1\n"
                                     "f 1 2 3\nf 4 5 6\n");
    Built b = scene_try(scene);
    assert_null(b.model);
    char *report = yaml_report(b.file);
    assert_non_null(strstr(report, "no distance between them"));
    mem_free(report);
    clear(&b);
    write_file("world_touching.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 2 0\nv 1 2 0\nv 2 0 0\nv 2 1 0\n"
               "v 2 2 0\nv 1 1 0\nv 1 2 0\n"
               "f 1 2 4\nf 1 4 3\nf 3 4 6\nf 3 6 5\nf 2 7 8\nf 2 8 10\nf 10 8 9\nf 10 9 11\n");
    b = scene_try(scene);
    if (!b.model) fail_msg("%s", yaml_report(b.file));
    int pair[1][2];
    double *x = b.model->cases[0].state.x; /* on either side of the slit, by what rounding does, askew */
    for (int i = 0; i < 33; i++) x[i] += 1e-17 * (i * i * 7 % 11 - 5);
    x[3 * 9] -= 1e-12, x[3 * 10] -= 1e-12, x[3 * 9 + 2] += 1e-13, x[3 * 10 + 2] -= 1e-13;
    assert_int_equal(world_crossings(b.model->world, x, pair, 1), 0);
    x[3 * 6] = 0.2, x[3 * 6 + 2] = -1, x[3 * 7] = 0.2, x[3 * 7 + 2] = 1,
          x[3 * 7 + 1] = 0.6; /* through others */
    assert_true(world_crossings(b.model->world, x, pair, 1) > 0);
    clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_obstacles), cmocka_unit_test(test_contact),
                                       cmocka_unit_test(test_rod_stiffness), cmocka_unit_test(test_water),
                                       cmocka_unit_test(test_touching)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
