/* Generated meshes: exact counts and positions, areas, orientation, groups, and refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "base/memory.h"
#include "base/vec3.h"
#include "surface/mesh.h"
#include "surface/shapes.h"

static const double pi = 3.14159265358979323846;

/* A flat, connected, simply connected mesh of that many vertices and faces, counter-clockwise, of that area.
 */
static Mesh *assert_flat_disc(const MeshFile *file, int vertex_count, int face_count, double area)
{
    Error err = {0};
    MeshReport report;
    Mesh *m = mesh_create(file, 0, &report, &err);
    if (!m) fail_msg("%s", err.text);
    assert_int_equal(report.warning_count, 0);
    assert_int_equal(m->vertex_count, vertex_count);
    assert_int_equal(m->face_count, face_count);
    assert_int_equal(m->vertex_count - m->edge_count + m->face_count, 1);
    assert_int_equal(m->component_count, 1);
    double sum = 0;
    for (int f = 0; f < m->face_count; f++) {
        const int *v = m->faces[f];
        Vec3 x0 = vec3_load(m->rest[v[0]]);
        Vec3 n = vec3_cross(vec3_sub(vec3_load(m->rest[v[1]]), x0), vec3_sub(vec3_load(m->rest[v[2]]), x0));
        assert_true(n.x == 0 && n.y == 0 && n.z > 0);
        sum += m->rest_area[f];
    }
    assert_true(fabs(sum - area) <= 1e-12 * area);
    return m;
}

static void assert_vertex(const MeshFile *file, int v, double x, double y)
{
    double scale = fabs(x) + fabs(y);
    assert_true(fabs(file->vertices[v][0] - x) <= 1e-15 * scale &&
                fabs(file->vertices[v][1] - y) <= 1e-15 * scale);
    assert_true(file->vertices[v][2] == 0);
}

static const MeshGroup *group_of(const MeshFile *file, const char *name, int dim, int count)
{
    for (int g = 0; g < file->group_count; g++)
        if (strcmp(file->groups[g].name, name) == 0) {
            assert_int_equal(file->groups[g].dim, dim);
            assert_int_equal(file->groups[g].count, count);
            return &file->groups[g];
        }
    fail_msg("no group %s", name);
    return NULL;
}

static void sheets(void **state)
{
    (void)state;
    const double size[2] = {0.03, 0.01};
    const int cells[2] = {24, 8};
    const int vertex_counts[3] = {225, 225, 417}, face_counts[3] = {384, 384, 768};
    for (ShapePattern pattern = PATTERN_RIGHT; pattern <= PATTERN_CROSSED; pattern++) {
        MeshFile file;
        Error err;
        assert_true(shape_sheet(size, cells, pattern, &file, &err));
        mesh_destroy(assert_flat_disc(&file, vertex_counts[pattern], face_counts[pattern], 3e-4));
        assert_string_equal(file.path, "sheet");
        for (int j = 0; j <= 8; j++)
            for (int i = 0; i <= 24; i++) assert_vertex(&file, j * 25 + i, i * 0.03 / 24, j * 0.01 / 8);
        assert_true(file.vertices[24][0] == 0.03 &&
                    file.vertices[8 * 25][1] == 0.01); /* exactly on the edge */
        if (pattern == PATTERN_CROSSED)
            assert_vertex(&file, 225 + 3 * 24 + 2, 2.5 * 0.03 / 24, 3.5 * 0.01 / 8);
        const MeshGroup *root = group_of(&file, "root", 0, 9), *tip = group_of(&file, "tip", 0, 1);
        for (int j = 0; j <= 8; j++) assert_int_equal(root->members[j], 25 * j);
        assert_int_equal(tip->members[0], 4 * 25 + 24);
        assert_int_equal(file.group_count, 2);
        mesh_file_clear(&file);
    }
}

static void diagonals(void **state)
{
    (void)state;
    const double size[2] = {2, 1};
    const int cells[2] = {2, 1};
    const int faces[3][8][3] = {
        {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}},
        {{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4}},
        {{0, 1, 6}, {1, 4, 6}, {4, 3, 6}, {3, 0, 6}, {1, 2, 7}, {2, 5, 7}, {5, 4, 7}, {4, 1, 7}}};
    for (ShapePattern pattern = PATTERN_RIGHT; pattern <= PATTERN_CROSSED; pattern++) {
        MeshFile file;
        assert_true(shape_sheet(size, cells, pattern, &file, NULL));
        assert_memory_equal(file.faces, faces[pattern], (size_t)file.face_count * sizeof *file.faces);
        assert_int_equal(group_of(&file, "tip", 0, 1)->members[0], 2);
        mesh_file_clear(&file);
    }
}

static void strips(void **state)
{
    (void)state;
    MeshFile file;
    assert_true(shape_strip(0.04, 0.005, 64, PATTERN_CROSSED, &file, NULL)); /* the paper's plate */
    mesh_destroy(assert_flat_disc(&file, 1097, 2048, 2e-4));
    assert_string_equal(file.path, "strip");
    group_of(&file, "root", 0, 9);
    mesh_file_clear(&file);
    assert_true(shape_strip(1, 0.01, 10, PATTERN_RIGHT, &file, NULL)); /* at least one cell wide */
    mesh_destroy(assert_flat_disc(&file, 22, 20, 0.01));
    mesh_file_clear(&file);
    assert_true(shape_strip(1, 10, 3, PATTERN_ALTERNATE, &file, NULL));
    mesh_destroy(assert_flat_disc(&file, 4 * 31, 180, 10));
    mesh_file_clear(&file);
}

/* Every edge has the length side/n, so that every face is equilateral. */
static void assert_equilateral(const Mesh *m, double length)
{
    for (int e = 0; e < m->edge_count; e++) {
        Vec3 d = vec3_sub(vec3_load(m->rest[m->edges[e][1]]), vec3_load(m->rest[m->edges[e][0]]));
        assert_true(fabs(vec3_length(d) - length) < 1e-12 * length * m->face_count);
    }
}

/* The image of the mesh under (x, y) -> (c x - s y, s x + c y) is itself. */
static void assert_symmetric(const Mesh *m, double c, double s, double mirror)
{
    for (int v = 0; v < m->vertex_count; v++) {
        double x = c * m->rest[v][0] - s * m->rest[v][1],
               y = mirror * (s * m->rest[v][0] + c * m->rest[v][1]);
        bool found = false;
        for (int u = 0; u < m->vertex_count && !found; u++)
            found = hypot(m->rest[u][0] - x, m->rest[u][1] - y) < 1e-15;
        assert_true(found);
    }
}

static void hexagram(void **state)
{
    (void)state;
    MeshFile file;
    assert_true(shape_hexagram(0.04, 13, &file, NULL));
    double side = 0.04 / (2 * sqrt(3));
    Mesh *m = assert_flat_disc(&file, 1093, 2028, 12 * sqrt(3) / 4 * side * side);
    assert_equilateral(m, side / 13);
    assert_symmetric(m, 0.5, sqrt(3) / 2, 1);
    assert_symmetric(m, 1, 0, -1);
    int boundary_count, *boundary = mesh_boundary(m, &boundary_count);
    assert_int_equal(boundary_count, 12 * 13);
    mem_free(boundary);
    double low[3], high[3];
    mesh_bounding_box(m, low, high);
    assert_true(fabs(high[0] - 0.02) < 1e-16 && fabs(low[0] + 0.02) < 1e-16);
    assert_vertex(&file, 0, 0, 0);

    const MeshGroup *hub = group_of(&file, "hub", 2, 6 * 169);
    for (int i = 0; i < hub->count; i++) assert_int_equal(hub->members[i], i);
    for (int flap = 0; flap < 6; flap++) {
        const MeshGroup *group = group_of(&file, (char[]){'f', 'l', 'a', 'p', (char)('1' + flap), 0}, 2, 169);
        double x = 0, y = 0;
        for (int i = 0; i < 169; i++)
            for (int k = 0; k < 3; k++) {
                const double *p = m->rest[m->faces[group->members[i]][k]];
                x += p[0] / 507, y += p[1] / 507;
            }
        double reach = side * 2 / sqrt(3); /* of a flap's barycentre */
        assert_true(hypot(x - reach * cos(flap * pi / 3), y - reach * sin(flap * pi / 3)) < 1e-14);
    }
    assert_int_equal(file.group_count, 7);
    mesh_destroy(m);
    mesh_file_clear(&file);
}

static void hexagrams_of_other_sizes(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) {
        MeshFile file;
        assert_true(shape_hexagram(2 * sqrt(3), n, &file, NULL));
        Mesh *m = assert_flat_disc(&file, 1 + 6 * n * (n + 1), 12 * n * n, 3 * sqrt(3));
        assert_equilateral(m, 1.0 / n);
        mesh_destroy(m);
        mesh_file_clear(&file);
    }
}

/* The paper's counts; squares that meet in corners only. */
static void kirigami(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    assert_true(shape_kirigami(0.044, 11, &file, NULL));
    Mesh *m = mesh_create(&file, 0, NULL, NULL);
    assert_non_null(m);
    assert_int_equal(m->vertex_count, 205);
    assert_int_equal(m->face_count, 244);
    double area = 0;
    for (int f = 0; f < m->face_count; f++) area += m->rest_area[f];
    assert_true(fabs(area - 61 * 16e-6) < 1e-15);
    int inner = 0;
    for (int e = 0; e < m->edge_count; e++) inner += !mesh_edge_is_boundary(m, e);
    assert_int_equal(inner, 4 * 61); /* no square shares an edge with another */
    const MeshGroup *centre = mesh_group(m, "centre", 0), *rim = mesh_group(m, "rim", 0);
    assert_int_equal(rim->count, 44);
    assert_true(hypot(m->rest[centre->members[0]][0], m->rest[centre->members[0]][1]) < 1e-16);
    for (int k = 0; k < rim->count; k++) {
        const double *x = m->rest[rim->members[k]];
        assert_true(fabs(fmax(fabs(x[0]), fabs(x[1])) - 0.022) < 1e-15);
    }
    mesh_destroy(m);
    mesh_file_clear(&file);
    assert_false(shape_kirigami(0.044, 10, &file, &err));
    assert_string_equal(err.text, "kirigami: n must be odd, so that all corners are squares, not 10");
}

static double smallest_angle(const Mesh *m)
{
    double smallest = pi;
    for (int f = 0; f < m->face_count; f++)
        for (int i = 0; i < 3; i++) {
            Vec3 x = vec3_load(m->rest[m->faces[f][i]]);
            Vec3 a = vec3_sub(vec3_load(m->rest[m->faces[f][(i + 1) % 3]]), x);
            Vec3 b = vec3_sub(vec3_load(m->rest[m->faces[f][(i + 2) % 3]]), x);
            smallest = fmin(smallest, atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)));
        }
    return smallest;
}

static void disc(void **state)
{
    (void)state;
    const int rings[4] = {1, 2, 7, 40};
    for (int r = 0; r < 4; r++) {
        int n = rings[r];
        MeshFile file;
        assert_true(shape_disc(0.5, n, &file, NULL));
        double area = 6 * n * 0.5 * 0.25 * 0.25 * sin(pi / (3 * n)); /* of the rim's polygon */
        Mesh *m = assert_flat_disc(&file, 1 + 3 * n * (n + 1), 6 * n * n, area);
        assert_true(smallest_angle(m) > 40 * pi / 180);
        assert_vertex(&file, 0, 0, 0);
        assert_int_equal(group_of(&file, "centre", 0, 1)->members[0], 0);
        const MeshGroup *rim = group_of(&file, "rim", 0, 6 * n);
        int count, *boundary = mesh_boundary(m, &count);
        assert_int_equal(count, rim->count);
        assert_memory_equal(boundary, rim->members, (size_t)count * sizeof(int));
        assert_vertex(&file, rim->members[0], 0.25, 0);
        for (int i = 0; i < count; i++)
            assert_true(fabs(vec3_length(vec3_load(m->rest[boundary[i]])) - 0.25) < 1e-15);
        mem_free(boundary);
        mesh_destroy(m);
        mesh_file_clear(&file);
    }
}

static void refuses_bad_arguments(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    const double good[2] = {1, 1};
    assert_false(shape_sheet((double[]){1, 0}, (int[]){1, 1}, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text, "sheet: size[1] must be a positive length, not 0 m");
    assert_null(file.vertices);
    assert_false(shape_sheet((double[]){NAN, 1}, (int[]){1, 1}, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text, "sheet: size[0] must be a positive length, not nan m");
    assert_false(shape_sheet(good, (int[]){4, 0}, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text, "sheet: cells[1] must be at least 1, not 0");
    assert_false(shape_sheet(good, (int[]){2147483647, 2147483647}, PATTERN_CROSSED, &file, &err));
    assert_string_equal(
        err.text, "sheet: 18446744056529682432 faces are too many; a generated mesh has at most 20000000");
    assert_false(shape_sheet(good, (int[]){10001, 1000}, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text,
                        "sheet: 20002000 faces are too many; a generated mesh has at most 20000000");
    assert_false(shape_strip(1, -2, 3, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text, "strip: width must be a positive length, not -2 m");
    assert_false(shape_strip(1e-300, 1e300, 3, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text,
                        "strip: 120000000 faces are too many; a generated mesh has at most 20000000");
    assert_false(shape_strip(1, 1, 0, PATTERN_RIGHT, &file, &err));
    assert_string_equal(err.text, "strip: n must be at least 1, not 0");
    assert_false(shape_hexagram(INFINITY, 3, &file, &err));
    assert_string_equal(err.text, "hexagram: size must be a positive length, not inf m");
    assert_false(shape_hexagram(1, -1, &file, &err));
    assert_string_equal(err.text, "hexagram: n must be at least 1, not -1");
    assert_false(shape_hexagram(1, 1291, &file, &err));
    assert_string_equal(err.text,
                        "hexagram: 20000172 faces are too many; a generated mesh has at most 20000000");
    assert_false(shape_disc(1, 0, &file, &err));
    assert_string_equal(err.text, "disc: n must be at least 1, not 0");
    assert_false(shape_disc(1, 2147483647, &file, NULL));
}

static void nothing_is_left(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sheets),
                                       cmocka_unit_test(diagonals),
                                       cmocka_unit_test(strips),
                                       cmocka_unit_test(hexagram),
                                       cmocka_unit_test(hexagrams_of_other_sizes),
                                       cmocka_unit_test(kirigami),
                                       cmocka_unit_test(disc),
                                       cmocka_unit_test(refuses_bad_arguments),
                                       cmocka_unit_test(nothing_is_left)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
