/* Tetrahedra in Gmsh's .msh: of 4 and 10 nodes, with their triangles and groups of every dimension. */
#include "base/memory.h"
#include "io/mesh_file.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define FORMAT_22 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define FORMAT_41 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"

static MeshFile parse(const char *text)
{
    MeshFile mesh;
    Error err;
    if (!mesh_file_parse("test", "msh", text, (long)strlen(text), &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

static void check_refused(const char *text, const char *sentence)
{
    MeshFile mesh;
    Error err;
    long blocks = mem_live_count();
    assert_false(mesh_file_parse("test", "msh", text, (long)strlen(text), &mesh, &err));
    assert_string_equal(err.text, sentence);
    assert_int_equal(mem_live_count(), blocks);
}

static void check_group(const MeshFile *mesh, const char *name, int dim, int count, const int *members)
{
    const MeshGroup *found = mesh_file_group(mesh, name, dim);
    if (!found) fail_msg("no group %s of dimension %d", name, dim);
    assert_int_equal(found->count, count);
    assert_memory_equal(found->members, members, (size_t)(count * (dim == 1 ? 2 : 1)) * sizeof(int));
}

/* Two tetrahedra; the second one and the first triangle are in two groups each, written once for each of them. */
static void test_linear(void **state)
{
    (void)state;
    MeshFile mesh = parse(
        FORMAT_22 "$PhysicalNames\n6\n0 1 \"tip\"\n1 2 \"rim\"\n2 3 \"skin\"\n3 4 \"all\"\n3 5 \"half\"\n2 6 "
                  "\"half\"\n"
                  "$EndPhysicalNames\n$Nodes\n5\n7 0 0 0\n100 1 0 0\n3 0 1 0\n50 0 0 1\n9 1 1 1\n$EndNodes\n"
                  "$Elements\n9\n1 15 2 1 1 9\n2 1 2 2 1 7 100\n3 2 2 3 1 7 3 100\n4 2 2 6 1 7 3 100\n"
                  "5 2 2 3 1 7 100 50\n10 4 2 4 1 7 100 3 50\n11 4 2 4 1 100 3 50 9\n12 4 2 5 1 100 3 50 9\n"
                  "13 4 2 5 2 7 100 3 50\n$EndElements\n");
    assert_int_equal(mesh.vertex_count, 5);
    assert_int_equal(mesh.face_count, 2);
    assert_int_equal(mesh.cell_count, 3); /* of another entity: another one */
    assert_int_equal(mesh.cell_nodes, 4);
    assert_memory_equal(mesh.cells, ((int[]){0, 1, 2, 3, 1, 2, 3, 4, 0, 1, 2, 3}), 12 * sizeof(int));
    assert_int_equal(mesh.cell_line[1], 29);
    check_group(&mesh, "tip", 0, 1, (int[]){4});
    check_group(&mesh, "rim", 1, 1, (int[]){0, 1});
    check_group(&mesh, "skin", 2, 2, (int[]){0, 1});
    check_group(&mesh, "half", 2, 1, (int[]){0});
    check_group(&mesh, "all", 3, 2, (int[]){0, 1});
    check_group(&mesh, "half", 3, 2, (int[]){1, 2});
    mesh_file_clear(&mesh);
}

#define NODES_10                                                                                             \
    "$Nodes\n1 10 1 90\n3 1 0 10\n1\n2\n3\n4\n50\n60\n70\n80\n85\n90\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n1 0 0\n"   \
    "1 1 0\n0 1 0\n0 0 1\n0 1 1\n1 0 1\n$EndNodes\n"

/* Lines and triangles of second order are those of their corners; numbers with gaps. */
static void test_quadratic(void **state)
{
    (void)state;
    MeshFile mesh =
        parse(FORMAT_41 "$PhysicalNames\n3\n1 7 \"edge\"\n2 8 \"floor\"\n3 9 \"body\"\n$EndPhysicalNames\n"
                        "$Entities\n0 1 1 1\n1 0 0 0 1 1 1 1 7 0\n1 0 0 0 1 1 1 1 8 0\n1 0 0 0 1 1 1 1 9 0\n"
                        "$EndEntities\n" NODES_10 "$Elements\n3 3 1 99\n1 1 8 1\n1 1 2 50\n"
                        "2 1 9 1\n40 1 3 2 70 60 50\n3 1 11 1\n99 1 2 3 4 50 60 70 80 85 90\n$EndElements\n");
    assert_int_equal(mesh.vertex_count, 10);
    assert_int_equal(mesh.cell_nodes, 10);
    assert_memory_equal(mesh.cells, ((int[]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), 10 * sizeof(int));
    assert_memory_equal(mesh.faces, ((int[]){0, 2, 1}), 3 * sizeof(int));
    check_group(&mesh, "edge", 1, 1, (int[]){0, 1});
    check_group(&mesh, "floor", 2, 1, (int[]){0});
    check_group(&mesh, "body", 3, 1, (int[]){0});
    Error err;
    assert_false(mesh_file_check_triangles(&mesh, &err));
    mesh_file_clear(&mesh);
}

/* A file may have tetrahedra alone. */
static void test_cells_alone(void **state)
{
    (void)state;
    MeshFile mesh =
        parse(FORMAT_41 NODES_10 "$Elements\n1 1 1 1\n3 1 11 1\n1 1 2 3 4 50 60 70 80 85 90\n$EndElements\n");
    assert_int_equal(mesh.face_count, 0);
    assert_int_equal(mesh.cell_count, 1);
    mesh_file_clear(&mesh);
}

static void test_refused(void **state)
{
    (void)state;
    check_refused(FORMAT_41 NODES_10 "$Elements\n2 2 1 2\n3 1 11 1\n1 1 2 3 4 50 60 70 80 85 90\n"
                                     "3 1 4 1\n2 1 2 3 4\n$EndElements\n",
                  "test:33: a tetrahedron of 4 nodes after one of 10: all of a mesh have as many");
    check_refused(FORMAT_41 NODES_10 "$Elements\n1 1 1 1\n3 1 11 1\n1 1 2 3 4 50 60 70 80 85 91\n"
                                     "$EndElements\n",
                  "test:31: node 91 does not exist");
    check_refused(FORMAT_41 NODES_10 "$Elements\n1 1 1 1\n3 1 11 1\n1 1 2 3 4 50 60 70 80 85\n"
                                     "$EndElements\n",
                  "test:31: a node is missing");
    check_refused(FORMAT_41 NODES_10 "$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4 50\n$EndElements\n",
                  "test:31:11: '50' is more than belongs here");
    check_refused(
        FORMAT_41 NODES_10 "$Elements\n1 1 1 1\n3 1 5 1\n1 1 2 3 4 50 60 70 80\n$EndElements\n",
        "test:30: elements of Gmsh's type 5 (hexahedra): what is read are triangles and quadrilaterals with "
        "straight edges (types 2 and 3), tetrahedra of 4 or 10 nodes (4 and 11) with their "
        "triangles (2 and 9), and lines and points in groups; mesh it anew, or save only their "
        "physical groups");
    check_refused(FORMAT_41 NODES_10
                  "$Elements\n2 2 1 2\n2 1 2 1\n1 1 2 3\n1 1 8 1\n2 1 2 50\n$EndElements\n",
                  "test:33: elements of Gmsh's type 8, of second order, in a file without tetrahedra: a mesh "
                  "of triangles has straight edges; mesh it with Mesh.ElementOrder = 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_linear), cmocka_unit_test(test_quadratic),
                                       cmocka_unit_test(test_cells_alone), cmocka_unit_test(test_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
