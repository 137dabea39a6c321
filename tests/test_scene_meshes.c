/* The meshes of the scenes (scenes/make_meshes.py): accepted without a warning, of the size that they should have, manifold,
 * and facing the way that their scenes take for granted. */
#include "base/vec3.h"
#include "io/table.h"
#include "surface/mesh.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

typedef struct Expected {
    const char *name;
    int vertices, faces, edges, boundary, components; /* boundary: its edges */
    const char *groups[9];
    int sizes[9];
} Expected;

static const Expected all[] = {
    {"reptile", 326, 496, 821, 154, 1, {"body", "leg1l", "leg7l", "leg4r"}, {272, 16, 16, 16}},
    {"octopus_0", 313, 492, 804, 132, 1, {"head", "tentacle1", "tentacle6"}, {168, 54, 54}},
    {"octopus_10", 313, 492, 804, 132, 1, {"head", "tentacle1", "tentacle6"}, {168, 54, 54}},
    {"octopus_30", 313, 492, 804, 132, 1, {"head", "tentacle1", "tentacle6"}, {168, 54, 54}},
    {"gripper", 541, 900, 1440, 180, 1, {"palm", "arm1", "arm4"}, {100, 200, 200}},
    {"ball", 162, 320, 480, 0, 1, {"ball"}, {320}},
    {"gripper_ball", 703, 1220, 1920, 180, 2, {"palm", "arm3", "ball"}, {100, 200, 320}},
};

static Table table_of(const char *name, const char *columns)
{
    char path[512];
    Table table;
    Error err;
    snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s.csv", name);
    if (!table_read(path, columns, &table, &err)) fail_msg("%s", err.text);
    return table;
}

static Mesh *mesh_of(const char *name)
{
    char path[512];
    MeshFile file;
    MeshReport report = {0};
    Error err;
    snprintf(path, sizeof path, SOURCE_DIR "/scenes/meshes/%s.obj", name);
    if (!mesh_file_read(path, &file, &err)) fail_msg("%s", err.text);
    Mesh *mesh = mesh_create(&file, 0, &report, &err);
    if (!mesh) fail_msg("%s", err.text);
    if (report.warning_count) fail_msg("%s", report.warnings[0]);
    mesh_report_clear(&report);
    mesh_file_clear(&file);
    return mesh;
}

static void test_counts(void **unused)
{
    (void)unused;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const Expected *e = &all[k];
        Mesh *mesh = mesh_of(e->name);
        int boundary = 0;
        for (int i = 0; i < mesh->edge_count; i++) boundary += mesh_edge_is_boundary(mesh, i);
        print_message("%s: %d vertices, %d faces, %d edges, %d of them boundary\n", e->name,
                      mesh->vertex_count, mesh->face_count, mesh->edge_count, boundary);
        assert_int_equal(mesh->vertex_count, e->vertices);
        assert_int_equal(mesh->face_count, e->faces);
        assert_int_equal(mesh->edge_count, e->edges);
        assert_int_equal(boundary, e->boundary);
        assert_int_equal(mesh->component_count, e->components);
        for (int g = 0; e->groups[g]; g++) {
            const MeshGroup *group = mesh_group(mesh, e->groups[g], 2);
            assert_non_null(group);
            assert_int_equal(group->count, e->sizes[g]);
        }
        mesh_destroy(mesh);
    }
}

/* Of a face: twice its area's vector, and its first vertex. */
static Vec3 normal_of(const Mesh *mesh, int face, Vec3 *at)
{
    Vec3 x[3];
    for (int i = 0; i < 3; i++) x[i] = vec3_load(mesh->rest[mesh->faces[face][i]]);
    *at = x[0];
    return vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0]));
}

/* Sheets look up; the octopus and the ball outwards, from their axis and their centre. */
static void test_sides(void **unused)
{
    (void)unused;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        Mesh *mesh = mesh_of(all[k].name);
        bool octopus = strstr(all[k].name, "octopus");
        for (int f = 0; f < mesh->face_count; f++) {
            Vec3 at, n = normal_of(mesh, f, &at);
            if (octopus)
                assert_true(vec3_dot(n, vec3(at.x > 0 ? at.x : 0, at.y, at.z)) > 0);
            else if (strcmp(all[k].name, "ball") && at.z > -1e-9)
                assert_true(n.z > 0 && n.x == 0 && n.y == 0);
            else
                assert_true(vec3_dot(n, vec3_sub(at, vec3(0, 0, strcmp(all[k].name, "ball") ? -5e-3 : 0))) >
                            0);
        }
        mesh_destroy(mesh);
    }
}

static void check_box(const char *name, const double low[3], const double high[3])
{
    double a[3], b[3];
    Mesh *mesh = mesh_of(name);
    mesh_bounding_box(mesh, a, b);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(a[i] - low[i]) < 1e-8 && fabs(b[i] - high[i]) < 1e-8))
            fail_msg("%s along %c: %.9g to %.9g", name, 'x' + i, a[i], b[i]);
    }
    mesh_destroy(mesh);
}

static void test_places(void **unused)
{
    (void)unused;
    check_box("reptile", (double[]){0, -6e-3, 0}, (double[]){17e-3, 6e-3, 0});
    check_box("octopus_0", (double[]){-18e-3, -6e-3, -6e-3}, (double[]){6e-3, 6e-3, 6e-3});
    check_box("gripper", (double[]){-22.5e-3, -22.5e-3, 0}, (double[]){22.5e-3, 22.5e-3, 0});
}

/* The pose of the octopus in a pipe is the flared one's, bent at the rim and nowhere else: its tentacles are as long and as
 * wide. */
static void test_flare(void **unused)
{
    (void)unused;
    Mesh *closed = mesh_of("octopus_0"), *open = mesh_of("octopus_30");
    double worst = 0, head = 0;
    for (int f = 0; f < closed->face_count; f++) {
        double off = fabs(open->rest_area[f] / closed->rest_area[f] - 1);
        if (f < 168)
            head = fmax(head, off);
        else
            worst = fmax(worst, off);
    }
    print_message("faces of tentacles differ by up to %.3f\n", worst);
    assert_true(head < 1e-6 && worst < 0.2);
    mesh_destroy(closed);
    mesh_destroy(open);
}

/* 2 kA/m in the plane of each face of a tentacle, away from the head; none in it. */
static void test_magnetization(void **unused)
{
    (void)unused;
    const char *const names[] = {"octopus_10", "octopus_30"}, *const tables[] = {"octopus_10_magnetization",
                                                                                 "octopus_30_magnetization"};
    for (int k = 0; k < 2; k++) {
        Mesh *mesh = mesh_of(names[k]);
        Table table = table_of(tables[k], "Mx [A/m], My, Mz");
        assert_int_equal(table.rows, mesh->face_count);
        for (int f = 0; f < table.rows; f++) {
            Vec3 M = vec3_load(table.values + 3 * f), at, n = normal_of(mesh, f, &at);
            bool head = f < mesh_group(mesh, "head", 2)->count;
            assert_true(fabs(vec3_length(M) - (head ? 0 : 2e3)) < 0.01);
            assert_true(fabs(vec3_dot(M, vec3_unit(n))) < 0.02 && M.x <= 0);
        }
        table_clear(&table);
        mesh_destroy(mesh);
    }
}

/* As many rows as their motions have steps or knots, within 50 mT. */
static void test_starts(void **unused)
{
    (void)unused;
    const char *const names[] = {"octopus_start_open", "octopus_start_pipe1", "octopus_start_pipe2",
                                 "octopus_start_tunnel"};
    const int rows[] = {500, 61, 41, 41};
    for (int k = 0; k < 4; k++) {
        Table table = table_of(names[k], "Bx [T], By, Bz");
        double largest = 0;
        assert_int_equal(table.rows, rows[k]);
        for (int i = 0; i < 3 * table.rows; i++) largest = fmax(largest, fabs(table.values[i]));
        assert_true(largest > 0.039 && largest <= 0.05);
        table_clear(&table);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_counts),        cmocka_unit_test(test_sides),
                                       cmocka_unit_test(test_places),        cmocka_unit_test(test_flare),
                                       cmocka_unit_test(test_magnetization), cmocka_unit_test(test_starts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
