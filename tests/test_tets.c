/* Tetrahedra, their surface and skin. */
#include "base/memory.h"
#include "base/vec3.h"
#include "solid/shapes.h"
#include "solid/tet_patches.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static Tets *box_of(int order)
{
    MeshFile file;
    Error err;
    assert_true(solid_shape_box((double[]){0.03, 0.02, 0.01}, (int[]){3, 2, 1}, &file, &err));
    Tets *tets = tets_create(&file, order, NULL, &err);
    mesh_file_clear(&file);
    assert_non_null(tets);
    return tets;
}

/* Its faces run outwards: they enclose the volume; all edges have two. */
static double enclosed(const Mesh *mesh)
{
    double sum = 0;
    for (int e = 0; e < mesh->edge_count; e++) assert_false(mesh_edge_is_boundary(mesh, e));
    for (int f = 0; f < mesh->face_count; f++) {
        const double *a = mesh->rest[mesh->faces[f][0]], *b = mesh->rest[mesh->faces[f][1]],
                     *c = mesh->rest[mesh->faces[f][2]];
        sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0])) /
               6;
    }
    return sum;
}

static void test_box(void **state)
{
    (void)state;
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        Tets *tets = box_of(order);
        double volume = 0;
        for (int t = 0; t < tets->count; t++) volume += tets->volume[t];
        assert_int_equal(tets->count, 36);
        assert_int_equal(tets_node_count(tets), order == TET_LINEAR ? 4 * 3 * 2 : 7 * 5 * 3);
        assert_int_equal(tets->surface->face_count, 2 * 2 * (3 * 2 + 2 * 1 + 3 * 1));
        assert_int_equal(tets->skin->face_count, (order == TET_LINEAR ? 1 : 4) * tets->surface->face_count);
        assert_true(fabs(volume - 6e-6) < 1e-20 && fabs(enclosed(tets->surface) - 6e-6) < 1e-20);
        assert_true(fabs(enclosed(tets->skin) - 6e-6) < 1e-20);
        assert_int_equal(tets->surface->component_count, 1);
        tets_destroy(tets);
    }
}

/* ---- What other programs write ---- */

/* Without faces and groups. */
static MeshFile box_file(void)
{
    MeshFile file;
    Error err;
    assert_true(solid_shape_box((double[]){2, 1, 1}, (int[]){2, 1, 1}, &file, &err));
    for (int g = 0; g < file.group_count; g++)
        mem_free(file.groups[g].name), mem_free(file.groups[g].members);
    mem_free(file.groups), mem_free(file.faces);
    file.groups = NULL, file.faces = NULL, file.group_count = file.face_count = 0;
    return file;
}

/* Of ten nodes each, as if a file had them. */
static MeshFile quadratic_file(void)
{
    MeshFile file = box_file();
    Tets *tets = tets_create(&file, TET_QUADRATIC, NULL, NULL);
    mesh_file_clear(&file);
    file = (MeshFile){
        .path = mem_text("solid"), .vertex_count = tets_node_count(tets), .cell_count = tets->count};
    file.cell_nodes = 10;
    file.vertices = mem_copy(tets->surface->rest, (size_t)file.vertex_count, sizeof *file.vertices);
    file.cells = mem_copy(tets->nodes, 10 * (size_t)tets->count, sizeof *file.cells);
    tets_destroy(tets);
    return file;
}

static void add_group(MeshFile *file, const char *name, int dim, int count, const int *members)
{
    size_t groups = (size_t)file->group_count++;
    file->groups = mem_resize(file->groups, groups, groups + 1, sizeof *file->groups);
    file->groups[groups] = (MeshGroup){mem_text(name), dim, count,
                                       mem_copy(members, (size_t)count * (dim == 1 ? 2 : 1), sizeof(int))};
}

/* The tetrahedra's own words about the file, which is cleared. */
static Tets *made(MeshFile *file, int order, MeshReport *report)
{
    Error err;
    Tets *tets = tets_create(file, order, report, &err);
    if (!tets) fail_msg("%s", err.text);
    mesh_file_clear(file);
    return tets;
}

static void turn(int *cell, int nodes)
{
    static const int pairs[3][2] = {{1, 2}, {4, 6}, {8, 9}};
    for (int k = 0; k < (nodes == 10 ? 3 : 1); k++) {
        int old = cell[pairs[k][0]];
        cell[pairs[k][0]] = cell[pairs[k][1]], cell[pairs[k][1]] = old;
    }
}

/* Where all tetrahedra are of the other hand, they are turned round, with their middle nodes. */
static void test_other_hand(void **state)
{
    (void)state;
    for (int nodes = 4; nodes <= 10; nodes += 6) {
        MeshFile file = nodes == 4 ? box_file() : quadratic_file();
        for (int t = 0; t < file.cell_count; t++) turn(file.cells + nodes * t, nodes);
        MeshReport report;
        Tets *tets = made(&file, TET_QUADRATIC, &report);
        assert_true(fabs(enclosed(tets->skin) - 2) < 1e-14);
        for (int t = 0; t < tets->count; t++) assert_true(fabs(tets->volume[t] - 1. / 6) < 1e-14);
        assert_int_equal(report.warning_count, 0);
        mesh_report_clear(&report);
        tets_destroy(tets);
    }
}

/* Middle nodes off the middle are put there, and the farthest is named, once. */
static void test_curved(void **state)
{
    (void)state;
    MeshFile file = quadratic_file();
    MeshReport report;
    int a = file.cells[0], b = file.cells[1], middle = file.cells[4];
    file.vertices[middle][2] += 0.25, file.vertices[file.cells[5]][2] += 0.01;
    file.vertices[file.cells[6]][2] += 1e-9;
    Tets *tets = made(&file, TET_QUADRATIC, &report);
    const double(*x)[3] = (const double(*)[3])tets->surface->rest;
    for (int i = 0; i < 3; i++) assert_true(x[middle][i] == (x[a][i] + x[b][i]) / 2);
    assert_int_equal(report.warning_count, 1);
    char sentence[200];
    snprintf(sentence, sizeof sentence,
             "solid: 2 middle nodes were put straight, as edges are here; the farthest, node %d, by 0.25 m, "
             "0.25 of its "
             "edge",
             middle);
    assert_string_equal(report.warnings[0], sentence);
    mesh_report_clear(&report);
    tets_destroy(tets);
}

/* order: 1 leaves the middles of a quadratic file out, and says so. */
static void test_order_1(void **state)
{
    (void)state;
    MeshFile file = quadratic_file(), linear = box_file();
    MeshReport report;
    Tets *tets = made(&file, TET_LINEAR, &report);
    assert_int_equal(tets_node_count(tets), linear.vertex_count);
    assert_int_equal(tets->each, 4);
    assert_memory_equal(tets->nodes, linear.cells, 4 * (size_t)tets->count * sizeof(int));
    assert_int_equal(report.warning_count, 1);
    assert_non_null(strstr(report.warnings[0], "middles of edges, which linear tetrahedra have none of"));
    mesh_report_clear(&report);
    mesh_file_clear(&linear);
    tets_destroy(tets);
}

/* ---- Groups ---- */

static void check_group(const Tets *tets, const char *name, int dim, int count)
{
    const MeshGroup *group = NULL;
    for (int g = 0; g < tets->surface->group_count; g++) {
        const MeshGroup *one = &tets->surface->groups[g];
        if (one->dim != dim || strcmp(one->name, name)) continue;
        assert_null(group); /* there is one */
        group = one;
    }
    assert_int_equal(group ? group->count : 0, count);
}

/* Faces, lines and tetrahedra of one name are one group of nodes, those between corners and those within too. */
static void test_groups(void **state)
{
    (void)state;
    static const int cell[4] = {0, 1, 3, 7}; /* of the unit cube, in the box of 2 x 1 x 1: corners 0 1 4 10 */
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        MeshFile file = box_file();
        for (int i = 0; i < 4; i++)
            assert_int_equal(file.cells[i], (cell[i] & 1) + 3 * (cell[i] >> 1 & 1) + 6 * (cell[i] >> 2));
        file.face_count = 2, file.faces = mem_alloc(2, sizeof *file.faces);
        memcpy(file.faces[0], (int[]){0, 1, 4}, 3 * sizeof(int));  /* below, its sense the other one */
        memcpy(file.faces[1], (int[]){0, 4, 10}, 3 * sizeof(int)); /* within */
        add_group(&file, "mixed", 2, 2, (int[]){0, 1});
        add_group(&file, "body", 3, 1, (int[]){0});
        add_group(&file, "mixed", 0, 1, (int[]){11});
        add_group(&file, "within", 2, 1, (int[]){1});
        add_group(&file, "line", 1, 1, (int[]){0, 1});
        Tets *tets = made(&file, order, NULL);
        bool quadratic = order == TET_QUADRATIC;
        check_group(tets, "mixed", 2, 1);
        check_group(tets, "mixed", 0,
                    quadratic ? 5 + 5 : 5); /* corners 0 1 4 10 11; edges 01 14 04 0-10 4-10 */
        check_group(tets, "within", 2, 0);
        check_group(tets, "within", 0, quadratic ? 6 : 3);
        check_group(tets, "line", 1, 1);
        check_group(tets, "line", 0, quadratic ? 3 : 2);
        check_group(tets, "body", 0, quadratic ? 10 : 4);
        assert_int_equal(mesh_group(tets->surface, "body", 3)->count, 1);
        assert_null(mesh_group(tets->surface, "mixed", 3));
        tets_destroy(tets);
    }
}

/* The surface is in the order of the file's triangles if it has all of them; they need not run outwards. */
static void test_listed(void **state)
{
    (void)state;
    MeshFile file = box_file();
    Tets *plain = tets_create(&file, TET_LINEAR, NULL, NULL);
    int count = plain->surface->face_count;
    file.face_count = count, file.faces = mem_alloc((size_t)count, sizeof *file.faces);
    for (int f = 0; f < count; f++) {
        const int *v = plain->surface->faces[count - 1 - f];
        memcpy(file.faces[f], (int[]){v[1], v[0], v[2]}, sizeof *file.faces);
    }
    Tets *tets = made(&file, TET_LINEAR, NULL);
    for (int f = 0; f < count; f++) {
        const int *v = tets->surface->faces[f], *of = plain->surface->faces[count - 1 - f];
        assert_int_equal(v[0] + v[1] + v[2], of[0] + of[1] + of[2]);
    }
    assert_true(fabs(enclosed(tets->surface) - 2) < 1e-14);
    tets_destroy(plain);
    tets_destroy(tets);
}

static void test_two_pieces(void **state)
{
    (void)state;
    MeshFile file = box_file();
    int nodes = file.vertex_count, cells = 4 * file.cell_count;
    file.vertices = mem_resize(file.vertices, (size_t)nodes, 2 * (size_t)nodes, sizeof *file.vertices);
    file.cells = mem_resize(file.cells, (size_t)cells, 2 * (size_t)cells, sizeof *file.cells);
    for (int v = 0; v < nodes; v++)
        vec3_store(file.vertices[nodes + v], vec3_add(vec3_load(file.vertices[v]), vec3(0, 0, 3)));
    for (int k = 0; k < cells; k++) file.cells[cells + k] = file.cells[k] + nodes;
    file.vertex_count *= 2, file.cell_count *= 2;
    Tets *tets = made(&file, TET_QUADRATIC, NULL);
    assert_int_equal(tets->surface->component_count, 2);
    assert_true(fabs(enclosed(tets->skin) - 4) < 1e-14);
    tets_destroy(tets);
}

/* ---- Refused ---- */

static void no_cells(MeshFile *f)
{
    f->cell_count = 0;
}
static void flat(MeshFile *f)
{
    memcpy(f->vertices[f->cells[3]], f->vertices[f->cells[0]], sizeof *f->vertices);
}
static void not_a_number(MeshFile *f)
{
    f->vertices[3][1] = NAN;
}
static void far_away(MeshFile *f)
{
    f->vertices[3][1] = 2e6;
}
static void one_turned(MeshFile *f)
{
    turn(f->cells + 4 * 5, 4);
}
static void all_but_one_turned(MeshFile *f)
{
    for (int t = 0; t < f->cell_count; t++)
        if (t != 5) turn(f->cells + 4 * t, 4);
}
static void corner_twice(MeshFile *f)
{
    f->cells[8] = f->cells[9];
}
static void no_such_node(MeshFile *f)
{
    f->cells[9] = f->vertex_count;
}
static void below_zero(MeshFile *f)
{
    f->cells[9] = -1;
}
static void isolated(MeshFile *f)
{
    size_t n = (size_t)f->vertex_count++;
    f->vertices = mem_resize(f->vertices, n, n + 1, sizeof *f->vertices);
}
static void with_lines(MeshFile *f)
{
    f->cell_line = mem_alloc((size_t)f->cell_count, sizeof *f->cell_line);
    f->cell_line[5] = 77;
    one_turned(f);
}
/* One more tetrahedron, on three corners of the first and that node. */
static void add_cell(MeshFile *f, int a, int b, int c, int d)
{
    size_t n = 4 * (size_t)f->cell_count++;
    f->cells = mem_resize(f->cells, n, n + 4, sizeof *f->cells);
    memcpy(f->cells + n, (int[]){a, b, c, d}, 4 * sizeof(int));
}
static void doubled(MeshFile *f)
{
    add_cell(f, f->cells[0], f->cells[1], f->cells[2], f->cells[3]);
}
static void overlapping(MeshFile *f)
{
    isolated(f); /* above the corner of the bottom that a side of tetrahedron 0 is on */
    vec3_store(f->vertices[f->vertex_count - 1], vec3(0.9, 0.4, 0.5));
    add_cell(f, 0, 1, 4, f->vertex_count - 1);
}
static void edge_to_edge(MeshFile *f)
{
    isolated(f), isolated(f);
    vec3_store(f->vertices[f->vertex_count - 2], vec3(-1, -0.2, 0.5));
    vec3_store(f->vertices[f->vertex_count - 1], vec3(-0.2, -1, 0.5));
    add_cell(f, 0, 6, f->vertex_count - 2, f->vertex_count - 1);
}
static void face_group(MeshFile *f)
{
    add_group(f, "skin", 2, 1, (int[]){0});
}
static void cell_group(MeshFile *f)
{
    add_group(f, "body", 3, 1, &f->cell_count);
}

static const struct {
    void (*spoil)(MeshFile *file);
    const char *sentence;
} broken[] = {
    {no_cells, "solid: there are no tetrahedra in it; a solid is made of them"},
    {flat, "solid: tetrahedron 0 (corners 0, 1, 4, 10) is flat: it has no volume"},
    {not_a_number, "solid: vertex 3 has y = nan; coordinates are finite and within 1e+06 m"},
    {far_away, "solid: vertex 3 has y = 2e+06; coordinates are finite and within 1e+06 m"},
    {one_turned,
     "solid: tetrahedron 5 (corners 0, 10, 6, 9) is inside out against the others, as are 1 of 12: the mesh "
     "has folded over there, or two of its corners are to be swapped"},
    {all_but_one_turned,
     "solid: tetrahedron 5 (corners 0, 6, 10, 9) is inside out against the others, as are 1 of 12"},
    {with_lines, "solid:77: tetrahedron 5 (corners "},
    {corner_twice, "solid: tetrahedron 2 (corners 6, 6, 7, 10) has one of its corners twice"},
    {no_such_node, "solid: tetrahedron 2 names vertex 12; the vertices are 0 to 11"},
    {below_zero, "solid: tetrahedron 2 names vertex -1; the vertices are 0 to 11"},
    {isolated,
     "solid: node 12 is in no tetrahedron: take it out (in Gmsh: make the volume a physical group, so that "
     "only what belongs to it is saved)"},
    {doubled,
     "solid: tetrahedron 12 (corners 0, 1, 4, 10) lies in tetrahedron 0: on the same side of a side of both"},
    {overlapping,
     "solid: tetrahedron 12 (corners 0, 1, 4, 12) lies in tetrahedron 0: on the same side of a side of both"},
    {edge_to_edge, "share the edge between vertices 0 and 6"},
    {face_group, "solid: group 'skin' names face 0; the last one is -1"},
    {cell_group, "solid: group 'body' names tetrahedron 12; the last one is 11"},
};

static void other_middle(MeshFile *f)
{
    f->cells[14] = f->cells[5];
}
static void corner_as_middle(MeshFile *f)
{
    int old = f->cells[4];
    for (int k = 0; k < 10 * f->cell_count; k++)
        if (f->cells[k] == old) f->cells[k] = f->cells[0];
}
static void middle_of_two(MeshFile *f)
{
    int old = f->cells[4];
    for (int k = 0; k < 10 * f->cell_count; k++)
        if (f->cells[k] == old) f->cells[k] = f->cells[5];
}

static void check_broken(MeshFile file, void (*spoil)(MeshFile *), const char *sentence)
{
    Error err = {""};
    spoil(&file);
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        long blocks = mem_live_count();
        assert_null(tets_create(&file, order, NULL, &err));
        assert_int_equal(mem_live_count(), blocks);
        if (!strstr(err.text, sentence)) fail_msg("%s\nlacks\n%s", err.text, sentence);
    }
    mesh_file_clear(&file);
}

static void leave(MeshFile *file)
{
    (void)file;
}

static void test_broken(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++)
        check_broken(box_file(), broken[k].spoil, broken[k].sentence);
    check_broken(
        quadratic_file(), other_middle,
        "solid: tetrahedron 1 (corners 0, 1, 10, 7) has node 20 in the middle of its edge from 0 to 1, and "
        "tetrahedron 0 node 12");
    check_broken(quadratic_file(), corner_as_middle, ": it is a corner, too");
    check_broken(quadratic_file(), middle_of_two, ": it is that of another edge, too");
    MeshFile file = box_file(); /* a third one at a side */
    file.vertices = mem_resize(file.vertices, 12, 13, sizeof *file.vertices);
    file.vertex_count = 13;
    vec3_store(file.vertices[12], vec3(0.3, 0.6, 0.4));
    add_cell(&file, 0, 10, 4, 12);
    check_broken(file, leave,
                 "solid: tetrahedron 12 (corners 0, 10, 4, 12) has a side that the tetrahedra 0 and");
}

/* Every tetrahedron is in one patch; those of a cell are one; the faces of neighbours are both's. */
static void test_patches(void **state)
{
    (void)state;
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        Tets *tets = box_of(order);
        int count, across = 0;
        TetPatch *patches = tet_patches(tets, &count);
        assert_int_equal(count, order == TET_LINEAR ? 6 : 36);
        for (int k = 0; k < count; k++) {
            assert_int_equal(patches[k].tet_count, order == TET_LINEAR ? 6 : 1);
            assert_int_equal(patches[k].node_count, order == TET_LINEAR ? 8 : 10);
            for (int i = 0; i < patches[k].tet_count; i++)
                assert_int_equal(patches[k].tets[i] / 6, order == TET_LINEAR ? k : k / 6);
        }
        for (int k = 0; k < 4 * tets->count; k++) across += tets->across[k] >= 0;
        assert_int_equal(across, 4 * tets->count - tets->surface->face_count);
        mem_free(patches);
        tets_destroy(tets);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),    cmocka_unit_test(test_patches),    cmocka_unit_test(test_other_hand),
        cmocka_unit_test(test_curved), cmocka_unit_test(test_order_1),    cmocka_unit_test(test_groups),
        cmocka_unit_test(test_listed), cmocka_unit_test(test_two_pieces), cmocka_unit_test(test_broken)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
