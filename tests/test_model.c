/* What the entries of a scene become: values, loads, motion, fields, unknowns. */
#include "shell/shell.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const Shell *shell_of(const Built *b)
{
    return b->model->self;
}

/* A scene of a 4 x 2 sheet, 40 x 20 mm, with these lines below. */
static Built build(const char *job, const char *shell, const char *lines)
{
    return scene_build(mem_format(
        "slender: 1\njob: %s\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [4, 2]}\n"
        "  thickness: 1 mm\n  poisson: 0.3\n%s%s",
        job, shell, lines));
}

static const double *params_of(const Built *b, int load_case, int stage)
{
    return b->model->cases[load_case].stages[stage].p;
}

static void sum_loads(const Built *b, const double *p, double *sum)
{
    memset(sum, 0, 3 * sizeof *sum);
    for (int i = 0; i < 3 * b->model->mesh->vertex_count; i++) sum[i % 3] += p[shell_of(b)->load + i];
}

static void test_values(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Built b = build("equilibrium",
                    "  young: \"1e6*(1 + step(x - 0.02))\"\n  magnetization: {formula: [\"a\", \"0\", "
                    "\"x\"], where: {a: \"2*y\"}}\n",
                    "fix: [{group: root, clamp: true}, {vertices: [9], axes: z}]\n");
    const Shell *shell = b.model->self;
    const Mesh *mesh = shell->mesh;
    const double *p = params_of(&b, 0, 0);
    for (int f = 0; f < mesh->face_count; f++) {
        double x = 0, y = 0;
        for (int i = 0; i < 3; i++)
            x += mesh->rest[mesh->faces[f][i]][0] / 3, y += mesh->rest[mesh->faces[f][i]][1] / 3;
        assert_true(p[shell->young + f] == (x > 0.02 ? 2e6 : 1e6));
        assert_true(fabs(p[shell->magnetization + 3 * f] - 2 * y) < 1e-15 &&
                    fabs(p[shell->magnetization + 3 * f + 2] - x) < 1e-15);
    }
    int fixed = 0, clamped = 0;
    for (int i = 0; i < 3 * mesh->vertex_count; i++) fixed += shell->fixed[i];
    for (int e = 0; e < mesh->edge_count; e++) clamped += shell->clamped[e];
    assert_int_equal(fixed, 3 * 3 + 1);
    assert_int_equal(clamped, 2);
    clear(&b);
    assert_int_equal(mem_live_count(), blocks);
}

static void write_numbers(const char *path, const char *header, int count)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "%s\n", header);
    for (int k = 1; k <= count; k++) fprintf(file, "%d\n", k);
    fclose(file);
}

/* The headers of tables say units, each of its own key. */
static void test_table_units(void **state)
{
    (void)state;
    write_numbers("model_young.csv", "E [MPa]", 16);
    write_numbers("model_thickness.csv", "h [mm]", 16);
    write_numbers("model_density.csv", "rho (g/cm^3)", 16);
    Built b =
        scene_build(mem_text("slender: 1\njob: design\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], "
                             "cells: [4, 2]}\n  thickness: {file: model_thickness.csv}\n"
                             "  density: {file: model_density.csv}\n  young: 1 Pa\n  poisson: 0.3\n"
                             "target: {formula: [x, y, z]}\n"
                             "design: {unknowns: {young: {start: {file: model_young.csv}}}, objectives: "
                             "[{target: 1}]}\n"));
    const Shell *shell = shell_of(&b);
    const double *p = params_of(&b, 0, 0);
    assert_int_equal(shell->mesh->face_count, 16);
    for (int f = 0; f < 16; f++) {
        assert_true(fabs(p[shell->young + f] - 1e6 * (f + 1)) < 1e-6);
        assert_true(fabs(p[shell->face_thickness + f] - 1e-3 * (f + 1)) < 1e-15);
        assert_true(fabs(p[shell->face_density + f] - 1e3 * (f + 1)) < 1e-9);
    }
    clear(&b);
    unlink("model_young.csv");
    unlink("model_thickness.csv");
    unlink("model_density.csv");
}

/* N in all, N/m along the boundary, N/m^2 of rest area. */
static void test_loads(void **state)
{
    (void)state;
    double sum[3];
    Built b = build("equilibrium", "  young: 1 MPa\n",
                    "fix: [{group: root}]\n"
                    "sequence:\n"
                    "  - {loads: [{force: [1, 2, 3], on: tip}]}\n"
                    "  - {loads: [{line: [0, 0, 5 N/m], on: {box: [[0.0399, -1, -1], [1, 1, 1]]}}]}\n"
                    "  - {loads: [{area: [0, 0, 100]}, {force: [1, 0, 0]}], gravity: [0, -10, 0]}\n"
                    "  - {time: 2 s}\n");
    sum_loads(&b, params_of(&b, 0, 0), sum);
    assert_true(fabs(sum[0] - 1) < 1e-14 && fabs(sum[2] - 3) < 1e-14);
    sum_loads(&b, params_of(&b, 0, 1), sum);
    assert_true(sum[0] == 0 && fabs(sum[2] - 5 * 0.02) < 1e-14);
    sum_loads(&b, params_of(&b, 0, 3), sum); /* what a stage does not say stays */
    assert_true(fabs(sum[0] - 1) < 1e-14 && fabs(sum[2] - 100 * 0.04 * 0.02) < 1e-14);
    assert_true(params_of(&b, 0, 3)[shell_of(&b)->gravity + 1] == -10 &&
                params_of(&b, 0, 1)[shell_of(&b)->gravity + 1] == 0);
    assert_true(b.model->cases[0].stages[3].time == 2);
    clear(&b);
}

static void test_motion(void **state)
{
    (void)state;
    Error err;
    Built b = build("equilibrium", "  young: 1 MPa\n",
                    "fix: [{group: root}, {group: tip, axes: xz, move: [\"x - 0.001*t\", \"y\", \"z + "
                    "0.004*t\"]}]\n");
    const Indices *tip = &b.model->motions[0].vertices;
    double *x = mem_copy(b.model->x, (size_t)shell_dof_count(b.model->self), sizeof *x);
    int v = tip->items[0];
    double y = x[3 * v + 1];
    assert_true(model_move(b.model, (HeldWay){NAN, 2, 0, 0.5}, x, &err));
    assert_true(fabs(x[3 * v] - 0.039) < 1e-15 && fabs(x[3 * v + 2] - 0.004) < 1e-15 && x[3 * v + 1] == y);
    assert_true(model_move(b.model, held_way(2), x, &err));
    assert_true(fabs(x[3 * v] - 0.038) < 1e-15 && fabs(x[3 * v + 2] - 0.008) < 1e-15);
    mem_free(x);
    clear(&b);
}

/* Uniform fields go into flux_density; each varying one is switched on in its case only. */
static void test_fields(void **state)
{
    (void)state;
    Built b = build(
        "design", "  young: 1 MPa\n",
        "fix: [{group: root}]\ntime: 0.25 s\nflux_density: [\"0\", \"0\", \"0.02*sin(2*pi*t)\"]\ntarget: "
        "[\"x\", \"y\", \"z\"]\n"
        "cases:\n  - {name: uniform}\n  - {flux_density: {dipole: {at: [0, 0, 1], moment: [0, 0, 2]}}}\n"
        "  - {flux_density: {magnet: {at: [0, 0, 1], remanence: [0, 0, 1.2], volume: 1e-6}}}\n"
        "design: {unknowns: {flux_density: {noise: 1 mT}}, objectives: [{target: 1}]}\n");
    const Shell *shell = b.model->self;
    assert_int_equal(shell->fields.count, 2);
    assert_true(fabs(params_of(&b, 0, 0)[shell->flux.uniform + 2] - 0.02) < 1.01e-3);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 2; k++) assert_true(params_of(&b, c, 0)[shell->flux.scale + k] == (c == k + 1));
    assert_string_equal(b.model->cases[1].name, "case2");
    assert_int_equal(b.model->design.size, 9); /* three numbers for each case */
    clear(&b);
}

/* Fields of time: by formula, and by a table that is linear between its rows. */
static void test_timed(void **state)
{
    (void)state;
    Error err;
    FILE *file = fopen("test_model_field.csv", "w");
    fputs("t, Bx, By, Bz\n0, 0, 0, 0.01\n1, 0.02, 0, 0.03\n3, 0, 0, 0\n", file);
    fclose(file);
    char folder[4096], *lines;
    assert_non_null(getcwd(folder, sizeof folder));
    lines = mem_format("fix: [{group: root}]\ntime: {at: 0.5 s, step: 1 ms, steps: 2}\nflux_density: {file: "
                       "%s/test_model_field.csv}\n",
                       folder);
    Built b = build("simulate", "  young: 1 MPa\n  damping: 1e-4\n  magnetization: [1, 0, 0]\n", lines);
    double *p = b.model->cases[0].stages[0].p, *B = p + shell_of(&b)->flux.uniform;
    assert_true(fabs(B[0] - 0.01) < 1e-16 && fabs(B[2] - 0.02) < 1e-16 && p[shell_of(&b)->damping] == 1e-4);
    const double times[4] = {-1, 1, 2, 9}, exact[4] = {0.01, 0.03, 0.015, 0};
    for (int k = 0; k < 4; k++)
        assert_true(model_load(b.model, times[k], false, p, &err) && fabs(B[2] - exact[k]) < 1e-16);
    assert_int_equal(b.model->report.warning_count, 1);
    assert_string_equal(strrchr(b.model->report.warnings[0], '/') + 1,
                        "test_model_field.csv: t goes from 0 to 3 s, and the motion from 0.5 to 0.502 s "
                        "only: is t in seconds?");
    clear(&b);
    mem_free(lines);
    unlink("test_model_field.csv");
    b = build("simulate", "  young: 1 MPa\n",
              "fix: [{group: root}]\ntime: {step: 1 ms, steps: 2}\nflux_density: [\"0\", \"t\", \"2*t\"]\n");
    p = b.model->cases[0].stages[0].p, B = p + shell_of(&b)->flux.uniform;
    assert_true(B[1] == 0 && model_load(b.model, 0.25, false, p, &err) && B[1] == 0.25 && B[2] == 0.5);
    clear(&b);
}

static void test_unknowns(void **state)
{
    (void)state;
    const char *lines =
        "fix: [{ball: {center: [0, 0, 0], radius: 5 mm}}]\ntarget: [\"x\", \"y\", \"z\"]\n"
        "design:\n  unknowns:\n    magnetization: {noise: 10, start: [0, 0, 5e3], max_magnitude: 1e4}\n"
        "    young: {per: group, bounds: [1e4, 1e7], start: {groups: {hub: 2e5}, other: 1e5}}\n"
        "    fold: {scale: linear, start: 2}\n  objectives: [{target: 1}, {height: 1, of: all}, "
        "{magnetization_smoothness: 1}, {young_smoothness: 1}, {fold_smoothness: 1}]\n";
    char *text = mem_format("slender: 1\njob: design\nshell: {mesh: {shape: hexagram, size: 40 mm, n: 2}, "
                            "thickness: 1 mm, young: 1 MPa, poisson: 0.3}\n%s",
                            lines);
    Built b = scene_build(text);
    const Shell *shell = b.model->self;
    const double *p = params_of(&b, 0, 0);
    const MeshGroup *hub = mesh_group(shell->mesh, "hub", 2);
    assert_true(p[shell->young + hub->members[0]] == 2e5 && p[shell->fold] == 2);
    assert_true(fabs(p[shell->magnetization + 2] - 5e3) <= 10 && p[shell->magnetization + 2] != 5e3);
    assert_int_equal(b.model->design.size, 3 * shell->mesh->face_count + 7 + shell->mesh->edge_count);
    assert_int_equal(b.model->cases[0].objective_count, 5);
    /* p -> u -> p */
    double *u = mem_alloc((size_t)b.model->design.size, sizeof *u),
           *back = mem_copy(p, (size_t)shell->params.size, sizeof *back);
    design_read(&b.model->design, 0, p, u);
    design_apply(&b.model->design, 0, u, back);
    for (int i = 0; i < shell->params.size; i++) assert_true(fabs(back[i] - p[i]) <= 1e-12 * fabs(p[i]));
    mem_free(u);
    mem_free(back);
    clear(&b);
}

/* One value for the whole body, or for chosen groups only: what is in none of them stays as it is. */
static void test_rows_of_unknowns(void **state)
{
    (void)state;
    Built b = scene_build(
        mem_text("slender: 1\njob: design\nshell: {mesh: {shape: hexagram, size: 40 mm, n: 2}, "
                 "thickness: 1 mm, poisson: 0.3, young: {groups: {hub: 3 MPa}, other: 1 MPa}}\n"
                 "fix: [{ball: {center: [0, 0, 0], radius: 5 mm}}]\n"
                 "design:\n  unknowns:\n    magnetization: {groups: [flap3, flap1], per: group, noise: 10}\n"
                 "    young: {groups: [hub], noise: 1}\n    fold: {per: body}\n"
                 "  objectives: [{height: 1}]\n"));
    const Design *design = &b.model->design;
    const Mesh *mesh = b.model->mesh;
    const MeshGroup *hub = mesh_group(mesh, "hub", 2), *flap = mesh_group(mesh, "flap3", 2);
    const double *p = params_of(&b, 0, 0), *M = p + shell_of(&b)->magnetization;
    assert_int_equal(design->unknown_count, 3);
    assert_int_equal(design->unknowns[0].group_count, 2);
    assert_int_equal(design->unknowns[1].group_count, hub->count);
    assert_int_equal(design->size, 2 * 3 + hub->count + 1);
    int moved = 0;
    for (int f = 0; f < mesh->face_count; f++) moved += M[3 * f] != 0;
    assert_int_equal(moved, 2 * flap->count);
    for (int k = 0; k < flap->count; k++) assert_true(M[3 * flap->members[k]] == M[3 * flap->members[0]]);
    double *u = mem_alloc((size_t)design->size, sizeof *u),
           *back = mem_copy(p, (size_t)b.model->params->size, sizeof *back);
    design_read(design, 0, p, u);
    for (int k = 0; k < hub->count; k++) u[6 + k] = log(5e6);
    u[design->size - 1] += 1;
    design_apply(design, 0, u, back);
    int stiff = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        double E = back[shell_of(&b)->young + f];
        stiff += fabs(E - 5e6) < 1;
        assert_true(fabs(E - 5e6) < 1 || E == 1e6);
    }
    assert_int_equal(stiff, hub->count);
    for (int e = 0; e < mesh->edge_count; e++)
        assert_true(back[shell_of(&b)->fold + e] == back[shell_of(&b)->fold]);
    assert_true(back[shell_of(&b)->fold] > 1);
    mem_free(u);
    mem_free(back);
    clear(&b);
}

/* What lies in several groups has the value of the smallest one, in whatever order the scene lists them. */
static void test_nested_groups(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    static const char *const orders[] = {"all: 1 MPa, half: 2 MPa", "half: 2 MPa, all: 1 MPa"};
    for (int k = 0; k < 2; k++) {
        Built b = scene_build(mem_format(
            "slender: 1\njob: evaluate\nshell:\n  mesh: {file: %s/tests/broken/meshes/crease.obj}\n"
            "  thickness: 1 mm\n  poisson: 0.3\n  young: {groups: {%s}}\n",
            SOURCE_DIR, orders[k]));
        const double *young = params_of(&b, 0, 0) + shell_of(&b)->young;
        for (int f = 0; f < 4; f++) assert_true(young[f] == (f < 2 ? 2e6 : 1e6));
        clear(&b);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* Magnetisation as remanence is the same magnetisation. */
static void test_remanence(void **state)
{
    (void)state;
    static const char *const written[] = {
        "[0, 0, 59683.1036594]", "{remanence: [0, 0, 75 mT]}",
        "{groups: {hub: {remanence: [0, 0, 75 mT]}, flap1: [1, 2, 3]}, other: [0, 0, 0]}"};
    for (int k = 0; k < 3; k++) {
        Built b = scene_build(
            mem_format("slender: 1\njob: evaluate\nshell: {mesh: {shape: hexagram, size: 40 mm, n: 1}, "
                       "thickness: 1 mm, young: 1 MPa, poisson: 0.3, magnetization: %s}\n",
                       written[k]));
        const double *M = params_of(&b, 0, 0) + shell_of(&b)->magnetization;
        int hub = mesh_group(b.model->mesh, "hub", 2)->members[0];
        assert_true(fabs(M[3 * hub + 2] / 59683.1036594 - 1) < 1e-10 && M[3 * hub] == 0);
        clear(&b);
    }
}

/* Several targets, of some coordinates or of points that are no vertices: an objective each. */
static void test_targets(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Built b = scene_build(mem_format(
        "slender: 1\njob: design\nshell: {mesh: {shape: strip, size: [40 mm, 10 mm], n: 8}, thickness: 1 mm, "
        "young: 1 MPa, poisson: 0.3}\nfix: [{group: root, clamp: true}]\n"
        "target:\n  - {formula: [\"7\", \"8\", \"0.01\"], axes: z, on: tip, weight: 3}\n"
        "  - {formula: [\"x\", \"y\", \"z\"], axes: xy}\n"
        "  - {cloud: %s/tests/broken/cloud.csv, axes: xz, scale: 2, on: {boundary: true}}\n"
        "design: {unknowns: {young: {}}, objectives: [{target: 2}, {height: 5, at: 2 mm}]}\n",
        SOURCE_DIR));
    const Case *c = &b.model->cases[0];
    assert_int_equal(c->target_count, 3);
    assert_int_equal(c->objective_count, 4);
    double value[4];
    for (int k = 0; k < 4; k++)
        value[k] = c->objectives[k].weight * c->objectives[k].ops->value(c->objectives[k].self,
                                                                         c->objectives[k].weight, b.model->x,
                                                                         NULL, NULL, NULL);
    assert_true(fabs(value[0] - 2 * 3 * 1e-4) < 1e-18 && value[1] == 0);
    assert_true(fabs(value[2] - 2 * (4e-6 + 64e-6)) < 1e-18 && fabs(value[3] - 5 * 4e-6) < 1e-18);
    double(*place)[3] = model_target_places(c, b.model->point_count);
    for (int v = 0; v < b.model->point_count; v++)
        assert_true(place[v][0] == b.model->mesh->rest[v][0] &&
                    isnan(place[v][2]) == isnan(c->targets[0].place[v][2]));
    mem_free(place);
    clear(&b);
    assert_int_equal(mem_live_count(), blocks);
}

/* Poses and targets are files of the same kind as the mesh's, and take its scale or one of their own. */
static void test_scale(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    const char *path = SOURCE_DIR "/tests/broken/meshes/crease.obj";
    for (int own = 0; own < 2; own++) {
        Built b = scene_build(mem_format(
            "slender: 1\njob: design\nshell:\n  mesh: {file: %s, scale: 0.5}\n  pose: {file: %s%s}\n  "
            "thickness: 1 mm\n"
            "  young: 1 MPa\n  poisson: 0.3\nfix: [{vertices: [0, 3], clamp: true}]\ntarget: {file: %s%s}\n"
            "design: {unknowns: {magnetization: {}}, objectives: [{target: 1}]}\n",
            path, path, own ? ", scale: 1" : "", path, own ? ", scale: 1.5" : ""));
        const Mesh *mesh = b.model->mesh;
        for (int i = 0; i < 3 * mesh->vertex_count; i++) {
            double rest = mesh->rest[i / 3][i % 3];
            assert_true(b.model->x[i] == (own ? 2 : 1) * rest);
            assert_true(fabs(b.model->cases[0].targets[0].place[i / 3][i % 3] - (own ? 3 : 1) * rest) <
                        1e-17);
        }
        assert_true(mesh->rest[1][0] == 0.01);
        clear(&b);
    }
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scale),    cmocka_unit_test(test_nested_groups),
        cmocka_unit_test(test_values),   cmocka_unit_test(test_table_units),
        cmocka_unit_test(test_loads),    cmocka_unit_test(test_motion),
        cmocka_unit_test(test_fields),   cmocka_unit_test(test_timed),
        cmocka_unit_test(test_unknowns), cmocka_unit_test(test_rows_of_unknowns),
        cmocka_unit_test(test_targets),  cmocka_unit_test(test_remanence)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
