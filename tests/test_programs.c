/* Meshes that Gmsh and TetGen themselves make. What is not installed is skipped, and said so; test_fill and test_mesh_msh know
 * their formats without them. */
#include "base/memory.h"
#include "base/vec3.h"
#include "leaks.h"
#include "solid/fill.h"
#include "solid/shapes.h"
#include "solid/tets.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Skips the test where the program is not there. */
static void need(const char *program)
{
    char command[100];
    snprintf(command, sizeof command, "command -v %s > /dev/null", program);
    if (system(command) == 0) return;
    print_message("%s is not installed\n", program);
    skip();
}

static double area_of(const Mesh *mesh, int face)
{
    const int *v = mesh->faces[face];
    Vec3 a = vec3_load(mesh->rest[v[0]]);
    return 0.5 * vec3_length(vec3_cross(vec3_sub(vec3_load(mesh->rest[v[1]]), a),
                                        vec3_sub(vec3_load(mesh->rest[v[2]]), a)));
}

static double group_area(const Mesh *mesh, const char *name)
{
    double area = 0;
    const MeshGroup *group = mesh_group(mesh, name, 2);
    for (int k = 0; group && k < group->count; k++) area += area_of(mesh, group->members[k]);
    return area;
}

static double surface_area(const Mesh *mesh)
{
    double area = 0;
    for (int f = 0; f < mesh->face_count; f++) area += area_of(mesh, f);
    return area;
}

static double volume_of(const Tets *tets)
{
    double volume = 0;
    for (int t = 0; t < tets->count; t++) volume += tets->volume[t];
    return volume;
}

static const char *const block = "SetFactory(\"OpenCASCADE\");\n"
                                 "Box(1) = {0, 0, 0, 30, 20, 10};\n"
                                 "Physical Surface(\"left\") = {1};\n"
                                 "Physical Surface(\"sides\") = {1, 2, 3, 4};\n"
                                 "Physical Curve(\"edge\") = {1};\n"
                                 "Physical Volume(\"core\") = {1};\n"
                                 "Mesh.CharacteristicLengthMin = 6;\n"
                                 "Mesh.CharacteristicLengthMax = 6;\n";

/* Of that format and order, as it comes from Gmsh. */
static Tets *gmsh_mesh(const char *format, int order, MeshReport *report)
{
    char command[200];
    Error err;
    MeshFile file;
    snprintf(command, sizeof command,
             "gmsh -3 -v 1 -format %s -order %d test_programs.geo -o test_programs.msh", format, order);
    if (system(command)) fail_msg("%s", command);
    if (!mesh_file_read("test_programs.msh", &file, &err)) fail_msg("%s", err.text);
    assert_int_equal(file.cell_nodes, order == 1 ? 4 : 10);
    Tets *tets = tets_create(&file, TET_QUADRATIC, report, &err);
    if (!tets) fail_msg("%s", err.text);
    mesh_file_clear(&file);
    return tets;
}

/* All of the block, with its groups, and the same from both formats and orders: middle nodes of Gmsh are those that are made
 * of linear tetrahedra. */
static void test_gmsh(void **state)
{
    (void)state;
    need("gmsh");
    FILE *out = fopen("test_programs.geo", "w");
    fputs(block, out);
    fclose(out);
    int count = 0, nodes = 0;
    for (int k = 0; k < 4; k++) {
        MeshReport report;
        Tets *tets = gmsh_mesh(k / 2 ? "msh41" : "msh22", 1 + k % 2, &report);
        const Mesh *surface = tets->surface;
        if (report.warning_count) fail_msg("%s", report.warnings[0]);
        assert_true(fabs(volume_of(tets) - 6000) < 1e-9 && fabs(surface_area(surface) - 2200) < 1e-9);
        assert_true(fabs(group_area(surface, "left") - 200) < 1e-9);
        assert_true(fabs(group_area(surface, "sides") - 1000) < 1e-9);
        assert_int_equal(mesh_group(surface, "core", 3)->count, tets->count);
        assert_int_equal(mesh_group(surface, "core", 0)->count, tets_node_count(tets));
        assert_non_null(mesh_group(surface, "edge", 1));
        if (k == 0) count = tets->count, nodes = tets_node_count(tets);
        assert_int_equal(tets->count, count);
        assert_int_equal(tets_node_count(tets), nodes);
        mesh_report_clear(&report);
        tets_destroy(tets);
    }
    print_message("%d tetrahedra, %d nodes\n", count, nodes);
    unlink("test_programs.geo");
    unlink("test_programs.msh");
}

/* A surface alone: tetrahedra and their groups are let go. */
static Mesh *surface_of(MeshFile *file)
{
    Error err;
    file->cell_count = 0;
    for (int g = 0; g < file->group_count; g++)
        if (file->groups[g].dim == 3) {
            mem_free(file->groups[g].name);
            mem_free(file->groups[g].members);
            file->groups[g--] = file->groups[--file->group_count];
        }
    Mesh *surface = mesh_create(file, 0, NULL, &err);
    if (!surface) fail_msg("%s", err.text);
    return surface;
}

static bool has_corner(const int *face, int vertex)
{
    return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

/* The surface of a hand, filled: as large as the hand, its faces, vertices and groups kept, and without slivers, which TetGen
 * makes unless it is told of quality. */
static void test_tetgen(void **state)
{
    (void)state;
    need("tetgen");
    Error err;
    MeshFile file, filled;
    assert_true(
        solid_shape_hand((SolidShapeDef){.size = 0.08, .thickness = NAN, .n = 1, .layers = 1}, &file, &err));
    Tets *hand = tets_create(&file, TET_LINEAR, NULL, &err);
    Mesh *surface = surface_of(&file);
    if (!solid_fill(surface, 0.004, &filled, &err)) fail_msg("%s", err.text);
    Tets *tets = tets_create(&filled, TET_LINEAR, NULL, &err);
    if (!tets) fail_msg("%s", err.text);
    assert_true(fabs(volume_of(tets) / volume_of(hand) - 1) < 1e-12);
    assert_int_equal(tets->surface->face_count, surface->face_count);
    for (int f = 0; f < surface->face_count; f++)
        for (int i = 0; i < 3; i++) assert_true(has_corner(tets->surface->faces[f], surface->faces[f][i]));
    assert_memory_equal(tets->surface->rest, surface->rest,
                        (size_t)surface->vertex_count * sizeof *surface->rest);
    assert_true(fabs(group_area(tets->surface, "wrist") - group_area(surface, "wrist")) < 1e-15);
    print_message("%d tetrahedra, %d nodes\n", tets->count, tets_node_count(tets));
    tets_destroy(tets);
    tets_destroy(hand);
    mesh_file_clear(&filled);
    mesh_file_clear(&file);
    mesh_destroy(surface);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gmsh), cmocka_unit_test(test_tetgen)};
    return cmocka_run_group_tests(tests, NULL, nothing_leaks);
}
