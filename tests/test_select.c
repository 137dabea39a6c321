/* Selections of vertices and edges on a small sheet, and what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "base/memory.h"
#include "surface/select.h"
#include "surface/shapes.h"

/* 4 x 2 cells of 10 mm; vertices 5 j + i. To the groups of a sheet come `top` (faces of the cell at the
 * origin) and `side` (edges of y = 0 from x = 10 to 30 mm). */
static int make_sheet(void **state)
{
    MeshFile file;
    Error err;
    if (!shape_sheet((double[]){0.04, 0.02}, (int[]){4, 2}, PATTERN_RIGHT, &file, &err)) return 1;
    MeshGroup groups[4] = {
        file.groups[0], file.groups[1], {"top", 2, 2, (int[]){1, 0}}, {"side", 1, 2, (int[]){2, 3, 1, 2}}};
    MeshFile more = file;
    more.groups = groups, more.group_count = 4;
    *state = mesh_create(&more, 0, NULL, &err);
    mesh_file_clear(&file);
    return *state ? 0 : 1;
}

/* And nothing may be left. */
static int destroy_sheet(void **state)
{
    mesh_destroy(*state);
    return mem_live_count() == 0 ? 0 : 1;
}

static void assert_selects(const Mesh *mesh, Selection selection, const int *expected, int count)
{
    Indices found;
    Error err = {0};
    if (!select_vertices(mesh, &selection, &found, &err)) fail_msg("%s", err.text);
    assert_int_equal(found.count, count);
    assert_memory_equal(found.items, expected, (size_t)count * sizeof(int));
    mem_free(found.items);
}

static void assert_refuses(const Mesh *mesh, Selection selection, const char *sentence)
{
    Indices found;
    Error err = {0};
    long live = mem_live_count();
    assert_false(select_vertices(mesh, &selection, &found, &err));
    assert_string_equal(err.text, sentence);
    assert_null(found.items);
    assert_int_equal(mem_live_count(), live);
}

static void each_condition(void **state)
{
    const Mesh *mesh = *state;
    assert_selects(mesh, (Selection){.vertices = {4, (int[]){7, 0, 14, 7}}}, (int[]){0, 7, 14}, 3);
    assert_selects(mesh, (Selection){.has_box = true, .box = {{0.03, 0.01, 0}, {0.04, 0.02, 0}}},
                   (int[]){8, 9, 13, 14}, 4);
    assert_selects(mesh, (Selection){.has_ball = true, .center = {0.01, 0.01, 0}, .radius = 0.01},
                   (int[]){1, 5, 6, 7, 11}, 5);
    assert_selects(mesh, (Selection){.group = "root"}, (int[]){0, 5, 10}, 3);
    assert_selects(mesh, (Selection){.group = "tip"}, (int[]){9}, 1);
    assert_selects(mesh, (Selection){.group = "top"}, (int[]){0, 1, 5, 6}, 4);
    assert_selects(mesh, (Selection){.group = "side"}, (int[]){1, 2, 3}, 3);
    assert_selects(mesh, (Selection){.boundary = true}, (int[]){0, 1, 2, 3, 4, 5, 9, 10, 11, 12, 13, 14}, 12);
}

/* Vertices on the border belong to a box and a ball, rounding aside: 1e-9 of the diagonal of 45 mm. */
static void rounding_takes_nothing_off(void **state)
{
    const Mesh *mesh = *state;
    assert_selects(mesh,
                   (Selection){.has_box = true, .box = {{0.03 + 4e-11, 0.01, 4e-11}, {1, 0.02 - 4e-11, 1}}},
                   (int[]){8, 9, 13, 14}, 4);
    assert_selects(mesh, (Selection){.has_box = true, .box = {{0.03 + 5e-11, 0.01, 0}, {1, 0.02, 0}}},
                   (int[]){9, 14}, 2);
    Selection ball = {.has_ball = true, .center = {0.01, 0.01, 0}, .radius = 0.01 - 4e-11};
    assert_selects(mesh, ball, (int[]){1, 5, 6, 7, 11}, 5);
    ball.radius = 0.01 - 5e-11;
    assert_selects(mesh, ball, (int[]){6}, 1);
}

/* A name stands for a surface, a curve and points at once; a line across a face is none of the mesh's edges.
 */
static void groups_of_one_name(void **state)
{
    (void)state;
    MeshGroup groups[] = {{"tip", 1, 2, (int[]){0, 1, 3, 1}},
                          {"other", 0, 1, (int[]){2}},
                          {"tip", 2, 1, (int[]){1}},
                          {"tip", 0, 1, (int[]){4}}};
    MeshFile file = {.path = "m.obj",
                     .vertex_count = 5,
                     .face_count = 3,
                     .vertices = (double[][3]){{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}},
                     .faces = (int[][3]){{0, 1, 2}, {0, 2, 3}, {1, 4, 2}},
                     .groups = groups,
                     .group_count = 4};
    MeshReport report;
    Error err;
    Mesh *mesh = mesh_create(&file, 0, &report, &err);
    assert_non_null(mesh);
    assert_int_equal(report.warning_count, 1);
    assert_string_equal(
        report.warnings[0],
        "m.obj: 1 line of the group 'tip' is no edge of the mesh; the first is from vertex 3 to 1");
    for (int dim = 0; dim <= 2; dim++) assert_int_equal(mesh_group(mesh, "tip", dim)->dim, dim);
    assert_null(mesh_group(mesh, "other", 1));
    assert_selects(mesh, (Selection){.group = "other"}, (int[]){2}, 1);
    assert_selects(mesh, (Selection){.group = "tip"}, (int[]){0, 1, 2, 3, 4}, 5);
    mesh_report_clear(&report);
    mesh_destroy(mesh);
}

static void all_conditions_must_hold(void **state)
{
    const Mesh *mesh = *state;
    Selection corner = {.vertices = {3, (int[]){0, 6, 5}},
                        .has_box = true,
                        .box = {{0, 0.005, -1}, {1, 1, 1}},
                        .has_ball = true,
                        .center = {0, 0.01, 0},
                        .radius = 0.015,
                        .group = "top",
                        .boundary = true};
    assert_selects(mesh, corner, (int[]){5}, 1);
    corner.boundary = false;
    assert_selects(mesh, corner, (int[]){5, 6}, 2);
}

static void refuses_what_catches_nothing(void **state)
{
    const Mesh *mesh = *state;
    const char *span = "; the mesh spans x 0..0.04, y 0..0.02, z 0..0 m";
    char *sentence = mem_format("no vertex is in box [[0.05, -1, -1], [1, 1, 1]]%s", span);
    assert_refuses(mesh, (Selection){.has_box = true, .box = {{0.05, -1, -1}, {1, 1, 1}}}, sentence);
    mem_free(sentence);
    sentence =
        mem_format("no vertex is in group 'tip' and the ball of radius 0.001 around [0, 0, 0]%s", span);
    assert_refuses(mesh, (Selection){.group = "tip", .has_ball = true, .radius = 0.001}, sentence);
    mem_free(sentence);
    sentence = mem_format("no vertex is in the listed vertices and the boundary%s", span);
    assert_refuses(mesh, (Selection){.vertices = {1, (int[]){6}}, .boundary = true}, sentence);
    mem_free(sentence);
}

static void refuses_what_makes_no_sense(void **state)
{
    const Mesh *mesh = *state;
    assert_refuses(mesh, (Selection){0},
                   "no vertices are named: give vertices, box, ball, group or boundary: true");
    assert_refuses(mesh, (Selection){.has_box = true, .box = {{0, 2, 0}, {1, 1, 1}}},
                   "box: its first corner must not exceed its second, but y is 2 and 1");
    assert_refuses(mesh, (Selection){.has_ball = true}, "ball: its radius must be positive, not 0");
    assert_refuses(mesh, (Selection){.group = "tail"},
                   "there is no group 'tail'; the mesh has root, tip, top, side");
    assert_refuses(mesh, (Selection){.vertices = {2, (int[]){3, 15}}},
                   "vertices[1]: there is no vertex 15; the mesh has vertices 0 to 14");
}

/* A scene's numbers are the file's, also after a vertex was removed. */
static void lists_are_in_the_files_numbering(void **state)
{
    (void)state;
    MeshFile file = {.path = "m.obj",
                     .vertex_count = 4,
                     .face_count = 1,
                     .vertices = (double[4][3]){{5, 5, 5}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                     .faces = (int[1][3]){{1, 2, 3}}};
    Mesh *mesh = mesh_create(&file, 0, NULL, NULL);
    assert_selects(mesh, (Selection){.vertices = {2, (int[]){3, 1}}}, (int[]){0, 2}, 2);
    assert_refuses(mesh, (Selection){.vertices = {1, (int[]){0}}},
                   "vertices[0]: vertex 0 is in no face and was removed");
    assert_refuses(mesh, (Selection){.group = "tail"}, "there is no group 'tail'; the mesh has none");
    mesh_destroy(mesh);
}

static void edges_of_a_selection(void **state)
{
    const Mesh *mesh = *state;
    Indices block = {4, (int[]){0, 1, 5, 6}}; /* a corner cell: its four sides and the diagonal 0-6 */
    Indices all = select_edges(mesh, &block), outer = select_boundary_edges(mesh, &block);
    const int inside[5][2] = {{0, 1}, {0, 5}, {0, 6}, {1, 6}, {5, 6}};
    assert_int_equal(all.count, 5);
    for (int i = 0; i < 5; i++) assert_memory_equal(mesh->edges[all.items[i]], inside[i], sizeof inside[i]);
    assert_int_equal(outer.count, 2);
    for (int i = 0; i < 2; i++) assert_memory_equal(mesh->edges[outer.items[i]], inside[i], sizeof inside[i]);
    mem_free(all.items);
    mem_free(outer.items);

    Indices apart = {2, (int[]){0, 7}};
    Indices none = select_edges(mesh, &apart);
    assert_int_equal(none.count, 0);
    mem_free(none.items);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_condition),
                                       cmocka_unit_test(rounding_takes_nothing_off),
                                       cmocka_unit_test(groups_of_one_name),
                                       cmocka_unit_test(all_conditions_must_hold),
                                       cmocka_unit_test(refuses_what_catches_nothing),
                                       cmocka_unit_test(refuses_what_makes_no_sense),
                                       cmocka_unit_test(lists_are_in_the_files_numbering),
                                       cmocka_unit_test(edges_of_a_selection)};
    return cmocka_run_group_tests(tests, make_sheet, destroy_sheet);
}
