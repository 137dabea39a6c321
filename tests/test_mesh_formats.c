/* What mesh files of other programs look like: quadrilaterals, STL, binary PLY, joined lines, groups of one
 * name. */
#include "base/memory.h"
#include "io/mesh_file.h"
#include "io/polygon.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static MeshFile parse_bytes(const char *format, const char *text, size_t length)
{
    MeshFile mesh;
    Error err;
    if (!mesh_file_parse("test", format, text, (long)length, &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

static MeshFile parse(const char *format, const char *text)
{
    return parse_bytes(format, text, strlen(text));
}

static void check_faces(const MeshFile *mesh, int count, int (*faces)[3])
{
    assert_int_equal(mesh->face_count, count);
    assert_memory_equal(mesh->faces, faces, (size_t)count * sizeof *faces);
}

static void check_group(const MeshFile *mesh, const char *name, int dim, int count, const int *members)
{
    const MeshGroup *found = mesh_file_group(mesh, name, dim);
    if (!found) fail_msg("no group %s of dimension %d", name, dim);
    assert_int_equal(found->count, count);
    assert_memory_equal(found->members, members, (size_t)(count * (dim == 1 ? 2 : 1)) * sizeof(int));
}

/* A backslash joins lines; comments end with theirs, and begin with a word. */
static void test_obj_lines(void **state)
{
    (void)state;
    MeshFile mesh = parse(
        "obj", "# C:\\models\\\nv 0 0 0\r\nv 1 0 \\\r\n0\r\nv 1 1 0\nv 0 1 \\\n\\\n 0.5\nf 1/1 \\\n2/2 3/3\n"
               "g a#1 b\\\n c\nf 1 3 4\n");
    check_faces(&mesh, 2, (int[][3]){{0, 1, 2}, {0, 2, 3}});
    assert_true(mesh.vertex_count == 4 && mesh.vertices[3][2] == 0.5);
    assert_int_equal(mesh.face_line[0], 9);
    assert_int_equal(mesh.face_line[1], 13);
    check_group(&mesh, "a#1", 2, 1, (int[]){1});
    check_group(&mesh, "b", 2, 1, (int[]){1});
    check_group(&mesh, "c", 2, 1, (int[]){1});
    mesh_file_clear(&mesh);
}

/* One name for faces and lines; an object with the name of its group, and one with a blank. */
static void test_obj_groups(void **state)
{
    (void)state;
    MeshFile mesh = parse("obj", "o Cloth\nv 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nf 1 2 3\n");
    check_group(&mesh, "Cloth", 1, 1, (int[]){0, 1});
    check_group(&mesh, "Cloth", 2, 1, (int[]){0});
    mesh_file_clear(&mesh);
    mesh = parse("obj",
                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no big sail\ng big\nf 1 2 3 4\no big\ng big\nf 1 4 2\n");
    check_group(&mesh, "big sail", 2, 2, (int[]){0, 1});
    check_group(&mesh, "big", 2, 3, (int[]){0, 1, 2});
    mesh_file_clear(&mesh);
}

/* The fan where it is right, even where vertices come after the face; ears where it is not. */
static void test_polygons(void **state)
{
    (void)state;
    MeshFile mesh = parse(
        "obj", "f 1 2 3 4\nf 5 6 7 8\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
               "v 3 1 0\nv 2 2 0\nv 3 0 0\nv 4 2 0\n"); /* an arrowhead, its notch first, and upside down */
    check_faces(&mesh, 4, (int[][3]){{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
    mesh_file_clear(&mesh);
    mesh = parse("obj", "v 2 2 0\nv 3 0 0\nv 4 2 0\nv 3 1 0\nf 1 2 3 4\n"); /* the same from its wing */
    check_faces(&mesh, 2, (int[][3]){{1, 2, 3}, {0, 1, 3}});
    mesh_file_clear(&mesh);
}

static double area(const double (*x)[3], const int *face)
{
    const double *a = x[face[0]], *b = x[face[1]], *c = x[face[2]];
    return ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
}

/* A comb with teeth, and a square with a vertex in the middle of each side: all triangles turn as the outline
 * does, and have its area together. */
static void test_ears(void **state)
{
    (void)state;
    static const double comb[][3] = {{0, 0, 0}, {6, 0, 0}, {6, 3, 0}, {5, 1, 0}, {4, 3, 0},
                                     {3, 1, 0}, {2, 3, 0}, {1, 1, 0}, {0, 3, 0}};
    static const double square[][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                       {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    static const struct {
        const double (*points)[3];
        int count;
        double area;
    } outlines[] = {{comb, 9, 12}, {square, 8, 4}};
    for (size_t k = 0; k < sizeof outlines / sizeof *outlines; k++)
        for (int turn = 0; turn < outlines[k].count; turn++) {
            int corners[9], faces[7][3];
            double sum = 0;
            for (int i = 0; i < outlines[k].count; i++) corners[i] = (i + turn) % outlines[k].count;
            assert_true(polygon_split(outlines[k].points, corners, outlines[k].count, faces));
            for (int f = 0; f < outlines[k].count - 2; f++) {
                assert_true(area(outlines[k].points, faces[f]) > 0);
                sum += area(outlines[k].points, faces[f]);
            }
            assert_float_equal(sum, outlines[k].area, 1e-12);
        }
}

static void test_stl(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    MeshFile mesh = parse("stl", "solid left half\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   "
                                 "vertex 1 0 0\n   vertex 1 1 0\n"
                                 "  endloop\n endfacet\nendsolid left half\nSOLID right\nFACET NORMAL 0 0 "
                                 "1\nOUTER LOOP\nVERTEX 0 -0 0\n"
                                 "VERTEX 1.0 1 0\nVERTEX 0 1 5e-1\nENDLOOP\nENDFACET\nENDSOLID\n");
    assert_int_equal(mesh.vertex_count, 4);
    check_faces(&mesh, 2, (int[][3]){{0, 1, 2}, {0, 2, 3}});
    assert_memory_equal(mesh.vertices[3], ((double[]){0, 1, 0.5}), 3 * sizeof(double));
    assert_int_equal(mesh.vertex_line[3], 15);
    check_group(&mesh, "left half", 2, 1, (int[]){0});
    check_group(&mesh, "right", 2, 1, (int[]){1});
    mesh_file_clear(&mesh);
    assert_int_equal(mem_live_count(), blocks);
}

static size_t put(unsigned char *bytes, size_t at, const void *value, size_t size, bool big)
{
    for (size_t k = 0; k < size; k++) bytes[at + k] = ((const unsigned char *)value)[big ? size - 1 - k : k];
    return at + size;
}

/* Binary, with a header that begins as an ASCII file would. */
static void test_binary_stl(void **state)
{
    (void)state;
    static const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0.1f}};
    unsigned char bytes[184] = "solid made by a program\nfacet";
    uint32_t count = 2;
    put(bytes, 80, &count, 4, false);
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < 9; i++) put(bytes, (size_t)(84 + 50 * f + 12 + 4 * i), &corners[f][i], 4, false);
    MeshFile mesh = parse_bytes("stl", (const char *)bytes, sizeof bytes);
    assert_int_equal(mesh.vertex_count, 4);
    check_faces(&mesh, 2, (int[][3]){{0, 1, 2}, {0, 2, 3}});
    assert_true(mesh.vertices[3][2] == (double)0.1f && !mesh.face_line);
    mesh_file_clear(&mesh);
}

/* Both byte orders: a list and colours to pass over, a quadrilateral, and as large an index type as there is.
 */
static void test_binary_ply(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++) {
        unsigned char bytes[600];
        size_t length = (size_t)snprintf(
            (char *)bytes, sizeof bytes,
            "ply\r\nformat binary_%s_endian 1.0\r\ncomment '#' is no comment # here\r\n"
            "element vertex 4\r\nproperty double x\r\nproperty float y\r\nproperty short z\r\n"
            "property uchar red\r\nelement face 2\r\nproperty list uchar float uv\r\n"
            "property list ushort uint vertex_index\r\nend_header\r\n",
            big ? "big" : "little");
        static const double x[4] = {0, 0.1, 1, 0};
        static const float y[4] = {0, 0, 1, 1};
        for (int v = 0; v < 4; v++) {
            int16_t z = (int16_t)(v == 3 ? -300 : 0);
            length = put(bytes, length, &x[v], 8, big);
            length = put(bytes, length, &y[v], 4, big);
            length = put(bytes, length, &z, 2, big);
            bytes[length++] = 255;
        }
        for (int f = 0; f < 2; f++) {
            bytes[length++] = 1;
            length = put(bytes, length, &y[2], 4, big);
            uint16_t count = f ? 3 : 4;
            length = put(bytes, length, &count, 2, big);
            for (uint32_t i = 0; i < count; i++) length = put(bytes, length, &i, 4, big);
        }
        MeshFile mesh = parse_bytes("ply", (const char *)bytes, length);
        check_faces(&mesh, 3, (int[][3]){{0, 1, 2}, {0, 2, 3}, {0, 1, 2}});
        assert_memory_equal(mesh.vertices[3], ((double[]){0, 1, -300}), 3 * sizeof(double));
        assert_true(mesh.vertices[1][0] == 0.1);
        mesh_file_clear(&mesh);
    }
}

/* 2.2 writes an element once for each of its groups; groups of one name and other dimensions are other
 * groups; names have blanks and quotes. */
static void test_msh_groups(void **state)
{
    (void)state;
    MeshFile mesh =
        parse("msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 3 \"tip\"\n2 2 \"tip\"\n"
              "2 1 \"all of \"it\"\"\n2 9 \"none\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n"
              "4 0 1 0\n$EndNodes\n$Elements\n5\n1 1 2 3 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 2 1 1 2 3\n"
              "4 2 2 1 1 1 3 4\n5 2 2 2 1 1 3 4\n$EndElements\n");
    check_faces(&mesh, 2, (int[][3]){{0, 1, 2}, {0, 2, 3}});
    check_group(&mesh, "tip", 1, 1, (int[]){0, 1});
    check_group(&mesh, "tip", 2, 2, (int[]){0, 1});
    check_group(&mesh, "all of \"it\"", 2, 2, (int[]){0, 1});
    assert_int_equal(mesh.group_count, 3);
    mesh_file_clear(&mesh);
}

/* Quadrilaterals, parametric nodes, and an entity in two groups. */
static void test_msh_quads(void **state)
{
    (void)state;
    MeshFile mesh = parse(
        "msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"a\"\n2 2 \"b\"\n"
               "$EndPhysicalNames\n$Entities\n0 0 1 0\n7 0 0 0 1 1 0 2 1 2 0\n$EndEntities\n$Nodes\n1 4 1 4\n"
               "2 7 1 4\n1\n2\n3\n4\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n$EndNodes\n"
               "$Elements\n1 1 1 1\n2 7 3 1\n1 1 2 3 4\n$EndElements\n");
    check_faces(&mesh, 2, (int[][3]){{0, 1, 2}, {0, 2, 3}});
    check_group(&mesh, "a", 2, 2, (int[]){0, 1});
    check_group(&mesh, "b", 2, 2, (int[]){0, 1});
    mesh_file_clear(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_obj_lines),  cmocka_unit_test(test_obj_groups),
                                       cmocka_unit_test(test_polygons),   cmocka_unit_test(test_ears),
                                       cmocka_unit_test(test_stl),        cmocka_unit_test(test_binary_stl),
                                       cmocka_unit_test(test_binary_ply), cmocka_unit_test(test_msh_groups),
                                       cmocka_unit_test(test_msh_quads)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
