/* Mesh and table files that are right. Those that are wrong are in tests/broken. */
#include "base/memory.h"
#include "io/mesh_file.h"
#include "io/table.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static MeshFile parse(const char *format, const char *text)
{
    MeshFile mesh;
    Error err;
    if (!mesh_file_parse("test", format, text, (long)strlen(text), &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

/* The unit square in two faces, vertices in order. */
static void check_square(const MeshFile *mesh)
{
    static const double vertices[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
    static const int faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->face_count, 2);
    assert_memory_equal(mesh->vertices, vertices, sizeof vertices);
    assert_memory_equal(mesh->faces, faces, sizeof faces);
}

static void check_group(const MeshFile *mesh, const char *name, int dim, int count, const int *members)
{
    const MeshGroup *group = mesh_file_group(mesh, name, dim);
    if (!group) fail_msg("no group %s", name);
    assert_int_equal(group->count, count);
    assert_memory_equal(group->members, members, (size_t)(count * (dim == 1 ? 2 : 1)) * sizeof(int));
}

static void test_obj(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    MeshFile mesh =
        parse("obj", "# a square\r\nmtllib x.mtl\r\nv 0 0 0\r\nv 1.0 0 0 0.5\r\nv 1 1 0\r\nv 0 1e0 .5 # "
                     "last\r\nvn 0 0 1\r\n"
                     "o sheet\r\ng left hub left\r\nf 1/1/1 2//1 3/2\r\ng\r\nusemtl red\r\nf -4 -2 -1\r\n"
                     "g rim\r\nl 1 2 3\r\ng corner\r\np 4\r\n");
    check_square(&mesh);
    assert_int_equal(mesh.face_line[1], 13);
    check_group(&mesh, "left", 2, 1, (int[]){0});
    check_group(&mesh, "hub", 2, 1, (int[]){0});
    check_group(&mesh, "sheet", 2, 2, (int[]){0, 1});
    check_group(&mesh, "rim", 1, 2, (int[]){0, 1, 1, 2});
    check_group(&mesh, "corner", 0, 1, (int[]){3});
    mesh_file_clear(&mesh);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_ply(void **state)
{
    (void)state;
    MeshFile mesh = parse(
        "ply",
        "ply\nformat ascii 1.0\ncomment of a square\nelement vertex 4\nproperty float z\nproperty float x\n"
        "property uchar red\nproperty double y\nelement face 2\nproperty float quality\n"
        "property list uchar int vertex_index\nelement edge 1\nproperty int a\nend_header\n"
        "0 0 255 0\n0 1 255 0\n0 1 255 1\n0.5 0 255 1\n0.1 3 0 1 2\n0.2 3 0 2 3\n7\n");
    check_square(&mesh);
    mesh_file_clear(&mesh);
}

static void test_msh22(void **state)
{
    (void)state;
    MeshFile mesh =
        parse("msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n0 7 \"corner\"\n1 2 \"my rim\"\n2 9 "
              "\"hub\"\n"
              "$EndPhysicalNames\n$Comments\nanything\n$EndComments\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n5 1 1 0\n"
              "40 0 1 0.5\n$EndNodes\n$Elements\n4\n1 15 2 7 1 40\n2 1 2 2 1 10 20\n3 2 2 9 1 10 20 5\n"
              "4 2 2 3 1 10 5 40\n$EndElements\n");
    check_square(&mesh);
    check_group(&mesh, "corner", 0, 1, (int[]){3});
    check_group(&mesh, "my rim", 1, 1, (int[]){0, 1});
    check_group(&mesh, "hub", 2, 1, (int[]){0});
    check_group(&mesh, "physical_3", 2, 1, (int[]){1});
    mesh_file_clear(&mesh);
}

static void test_msh41(void **state)
{
    (void)state;
    MeshFile mesh = parse(
        "msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 2 \"rim\"\n2 9 "
               "\"hub\"\n$EndPhysicalNames\n"
               "$Entities\n1 1 2 0\n1 0 0 0 0\n3 0 0 0 1 0 0 1 2 2 1 -1\n5 0 0 0 1 1 0 1 9 1 3\n6 0 0 0 1 1 "
               "0 0 1 3\n"
               "$EndEntities\n$Nodes\n2 4 1 9\n2 5 0 3\n1\n2\n9\n0 0 0\n1 0 0\n1 1 0\n2 6 0 1\n4\n0 1 "
               "0.5\n$EndNodes\n"
               "$Elements\n3 3 1 3\n1 3 1 1\n1 1 2\n2 5 2 1\n2 1 2 9\n2 6 2 1\n3 1 9 4\n$EndElements\n");
    check_square(&mesh);
    check_group(&mesh, "rim", 1, 1, (int[]){0, 1});
    check_group(&mesh, "hub", 2, 1, (int[]){0});
    mesh_file_clear(&mesh);
}

/* Names that would be other names, comments or joined lines to a reader of OBJ. */
static void test_write_names(void **state)
{
    (void)state;
    Error err;
    MeshFile mesh = parse("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), again;
    MeshGroup groups[] = {
        {"left half", 2, 1, (int[]){0}}, {"#1", 2, 1, (int[]){0}}, {"a\\", 1, 1, (int[]){0, 1}}};
    mesh.groups = groups, mesh.group_count = 3;
    assert_true(mesh_file_write_obj("test_write_names.obj", &mesh, &err));
    mesh.groups = NULL, mesh.group_count = 0;
    if (!mesh_file_read("test_write_names.obj", &again, &err)) fail_msg("%s", err.text);
    check_group(&again, "left_half", 2, 1, (int[]){0});
    check_group(&again, "_1", 2, 1, (int[]){0});
    check_group(&again, "a_", 1, 1, (int[]){0, 1});
    mesh_file_clear(&again);
    mesh_file_clear(&mesh);
    unlink("test_write_names.obj");
}

/* A byte order mark is no part of the first word. */
static void test_mark(void **state)
{
    (void)state;
    static const char *const texts[][2] = {
        {"obj", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .5\nf 1 2 3\nf 1 3 4\n"},
        {"ply", "\xef\xbb\xbfply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
                "0 0 0\n1 0 0\n1 1 0\n0 1 .5\n3 0 1 2\n3 0 2 3\n"},
        {"msh",
         "\xef\xbb\xbf$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 .5\n"
         "$EndNodes\n$Elements\n2\n1 2 0 1 2 3\n2 2 0 1 3 4\n$EndElements\n"}};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        MeshFile mesh = parse(texts[k][0], texts[k][1]);
        check_square(&mesh);
        mesh_file_clear(&mesh);
    }
    Error err;
    Table table;
    assert_true(table_parse("t.csv",
                            "\xef\xbb\xbf"
                            "1, 2\n3, 4\n",
                            13, "x, y", &table, &err));
    assert_true(table.rows == 2 && table.values[0] == 1);
    table_clear(&table);
    assert_false(table_parse("t.csv",
                             "\xff\xfe"
                             "1\0",
                             4, NULL, &table, &err));
    assert_string_equal(err.text, "t.csv: the file is UTF-16 text; save it as UTF-8");
    assert_false(table_parse("t.csv",
                             "1\0"
                             "2\0",
                             4, NULL, &table, &err));
    assert_string_equal(err.text, "t.csv: the file is UTF-16 text; save it as UTF-8");
    assert_false(table_parse("t.csv",
                             "\xff\xfe\0\0"
                             "1\0\0\0",
                             8, NULL, &table, &err));
    assert_string_equal(err.text, "t.csv: the file is UTF-32 text; save it as UTF-8");
}

/* Every bit, and the groups. */
static void test_write(void **state)
{
    (void)state;
    Error err;
    MeshFile again,
        mesh = parse(
            "obj",
            "v 0.1 -0 1e-300\nv 1.0000000000000002 0 0\nv 0 3 0\nv 1 1 1\ng a\nf 1 2 3\ng a b\nf 2 4 3\n"
            "g rim\nl 1 2\ng tip\np 3\n");
    assert_true(mesh_file_write_obj("test_write.obj", &mesh, &err));
    if (!mesh_file_read("test_write.obj", &again, &err)) fail_msg("%s", err.text);
    assert_memory_equal(mesh.vertices, again.vertices, 4 * sizeof *mesh.vertices);
    assert_memory_equal(mesh.faces, again.faces, 2 * sizeof *mesh.faces);
    check_group(&again, "a", 2, 2, (int[]){0, 1});
    check_group(&again, "b", 2, 1, (int[]){1});
    check_group(&again, "rim", 1, 1, (int[]){0, 1});
    check_group(&again, "tip", 0, 1, (int[]){2});
    mesh_file_clear(&mesh);
    mesh_file_clear(&again);
    unlink("test_write.obj");
}

static bool read_table(const char *text, const char *names, Table *table, Error *err)
{
    FILE *file = fopen("test_table.csv", "w");
    fputs(text, file);
    fclose(file);
    bool ok = table_read("test_table.csv", names, table, err);
    unlink("test_table.csv");
    return ok;
}

static void test_table(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    Table table;
    /* The same rows, split and written in every way. */
    static const char *const same[] = {"x, y, z\n# comment\n1,2,3\r\n\n 4 , 5e-1 ,-6 # end\n7,8,9,\n",
                                       ("\xef\xbb\xbf"
                                        "1;2;3\n# one\n# two\n#\n4;0.5;-6\n7;8;9"),
                                       "A title; of words\n\n1;2;3\n\n4;0,5;-6\n7;8,0;9",
                                       "\"x\"\t\"y\"\t\"z\"\n\n1\t2\t3,0\n\n4\t0,5\t-6\n7\t8\t9",
                                       "x y z\n\n1 2\t 3\n\n 4  .5 -6\n7\t8 9\n"};
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        if (!read_table(same[k], k ? "x, y, z" : NULL, &table, &err)) fail_msg("%s", err.text);
        assert_true(table.rows == 3 && table.columns == 3 && table.line[1] == 5);
        assert_memory_equal(table.values, ((double[]){1, 2, 3, 4, 0.5, -6, 7, 8, 9}), 9 * sizeof(double));
        table_clear(&table);
    }
    double values[4] = {1.0 / 3, -5e-324, 1e308, 0.1};
    assert_true(table_write("test_table.csv", "# bits", values, 2, 2, &err) &&
                table_read("test_table.csv", NULL, &table, &err));
    assert_memory_equal(table.values, values, sizeof values);
    table_clear(&table);
    unlink("test_table.csv");
    assert_int_equal(mem_live_count(), blocks);
}

static void test_broken_table(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    Table table;
    static const struct {
        const char *text;
        const char *names;
        const char *sentence;
    } broken[] = {
        {"1, 2\n3\n", NULL, "test_table.csv:2: 1 number in this row, and 2 are needed"},
        {"1, 2\n", "x, y, z", "test_table.csv:1: 2 numbers in this row, and 3 are needed: x, y, z"},
        {"1\ntwo\n", NULL, "test_table.csv:2: 'two' is no finite number"},
        {"nan\n", NULL, "test_table.csv:1: 'nan' is no finite number"},
        {"1\n-inf\n", NULL, "test_table.csv:2: '-inf' is no finite number"},
        {"1\n1e999\n", NULL, "test_table.csv:2: '1e999' is no finite number"},
        {"1\n0x10\n", NULL, "test_table.csv:2: '0x10' is no finite number"},
        {"# nothing\n", NULL, "test_table.csv: there are no numbers in it"},
        {"header only\n", NULL, "test_table.csv: there are no numbers in it"},
        {"O.0, 0, 1\n1, 0, 0\n", NULL, "test_table.csv:1: 'O.0' is no finite number"},
        {"x, y\nm, m\n1, 2\n", NULL, "test_table.csv:2: 'm' is no finite number"},
        {"x, z, y\n1, 2, 3\n", "x, y, z",
         "test_table.csv:1: column 2 is headed 'z'; the columns must be x, y, z"},
        {"x [mm]; y; z; r\n1; 2; 3; 4\n", "s, x, y, z",
         "test_table.csv:1: column 1 is headed 'x [mm]'; the columns must be s, x, y, z"},
        {"# t, By, Bx\n1,2,4\n", "t, Bx, By",
         "test_table.csv:1: column 2 is headed 'By'; the columns must be t, Bx, By"},
        {"t [mm], v\n1,2\n", "t [s], v", "test_table.csv:1: column 1 is headed 't [mm]'; it must be in s"},
        {"t (fortnights), v\n1,2\n", "t [s], v",
         "test_table.csv:1: column 1 is headed 't (fortnights)'; it must be in s"},
        {"\"(m)1mm\n1,2\n", "t [s], v", "test_table.csv:1: column 1 is headed '(m)1mm'; it must be in s"},
        {"t, v [%]\n1,2\n", "t [s], v",
         "test_table.csv:1: column 2 is headed 'v [%]'; it must be without a unit"},
        {"x, y [mm]\n1,2\n", "x [m], y [m]",
         "test_table.csv:1: column 1, x, is headed without a unit, and others with one"},
        {"1; 2\n1, 2\n", NULL, "test_table.csv:2: '1, 2' is no finite number"},
        {"1; 2\n1,2\n", NULL, "test_table.csv:2: 1 number in this row, and 2 are needed"},
        {"1,5; 2\n1.5; 2\n", NULL,
         "test_table.csv:2: '1.5' is no finite number with a decimal comma, as those before it"},
        {"1.5; 2\n1,5; 2\n", NULL,
         "test_table.csv:2: '1,5' is no finite number with a decimal point, as those before it"},
        {"1.234,5; 2\n", NULL, "test_table.csv:1: '1.234,5' is no finite number"},
        {"1,5 2,5 3,5\n", NULL, "test_table.csv:1: '5 2' is no finite number"},
        {"1,,3\n", NULL, "test_table.csv:1: there is nothing between two separators"},
    };
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        assert_false(read_table(broken[k].text, broken[k].names, &table, &err));
        assert_string_equal(err.text, broken[k].sentence);
    }
    assert_int_equal(mem_live_count(), blocks);
}

static void test_table_units(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    Table table;
    static const char *const field = "t [s], Bx [T], By [T]";
    static const struct {
        const char *text, *names;
        double row[3];
    } scaled[] = {
        {"t [s], Bx (T), By/T\n1,2,4\n", field, {1, 2, 4}},
        {"t [ms], Bx (mT), By/T\n1,2,4\n", field, {1e-3, 2e-3, 4}},
        {"t_ms; Bx mT; \"By_T\"\n1;2;4\n", field, {1e-3, 2e-3, 4}},
        {"t [ms] Bx [T] By [T]\n1 2 4\n", field, {1e-3, 2, 4}},
        {"time (min), field, 2nd\n1,2,4\n", "t [s], v, w", {60, 2, 4}},
        {"s [mm], k1 (1/mm), v [-]\n1,2,4\n", "s [m], k1 [1/m], v", {1e-3, 2e3, 4}},
        {"# made by hand\n# t [ms], Bx [T], By [T]\n\n1,2,4\n", field, {1e-3, 2, 4}},
        {"# t Bx By\n1 2 4\n", field, {1, 2, 4}},
        {"# t, Bx, By in T: of a magnet\n1,2,4\n", field, {1, 2, 4}},
        {"# in [ms]\n1,2,4\n", field, {1, 2, 4}},
    };
    for (size_t k = 0; k < sizeof scaled / sizeof *scaled; k++) {
        if (!read_table(scaled[k].text, scaled[k].names, &table, &err)) fail_msg("%s", err.text);
        for (int i = 0; i < 3; i++) assert_true(fabs(table.values[i] / scaled[k].row[i] - 1) < 1e-15);
        assert_true(table.scaled == (scaled[k].row[0] != 1));
        table_clear(&table);
    }
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_obj),        cmocka_unit_test(test_ply),   cmocka_unit_test(test_msh22),
        cmocka_unit_test(test_msh41),      cmocka_unit_test(test_mark),  cmocka_unit_test(test_write_names),
        cmocka_unit_test(test_write),      cmocka_unit_test(test_table), cmocka_unit_test(test_broken_table),
        cmocka_unit_test(test_table_units)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
