/* Generated solids: counts, groups, what they enclose. */
#include "base/memory.h"
#include "base/vec3.h"
#include "solid/shapes.h"
#include "solid/tets.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static Tets *fill(MeshFile *file, bool made, const Error *err)
{
    Error refused;
    MeshReport report;
    if (!made) fail_msg("%s", err->text);
    Tets *tets = tets_create(file, TET_LINEAR, &report, &refused);
    if (!tets) fail_msg("%s", refused.text);
    assert_int_equal(report.warning_count, 0);
    mesh_report_clear(&report);
    /* the faces of the file are all of the surface, outwards, in that order */
    assert_int_equal(tets->surface->face_count, file->face_count);
    for (int f = 0; f < file->face_count; f++) {
        const int *a = file->faces[f], *b = tets->surface->faces[f];
        assert_true((a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) ||
                    (a[0] == b[1] && a[1] == b[2] && a[2] == b[0]) ||
                    (a[0] == b[2] && a[1] == b[0] && a[2] == b[1]));
    }
    mesh_file_clear(file);
    return tets;
}

static void check_counts(const Tets *tets, int nodes, int faces, int count)
{
    assert_int_equal(tets_node_count(tets), nodes);
    assert_int_equal(tets->surface->face_count, faces);
    assert_int_equal(tets->count, count);
    assert_int_equal(tets->surface->component_count, 1);
    for (int e = 0; e < tets->surface->edge_count; e++) assert_false(mesh_edge_is_boundary(tets->surface, e));
}

static const MeshGroup *group(const Tets *tets, const char *name, int dim)
{
    for (int g = 0; g < tets->surface->group_count; g++)
        if (tets->surface->groups[g].dim == dim && !strcmp(tets->surface->groups[g].name, name))
            return &tets->surface->groups[g];
    return NULL;
}

static void check_group(const Tets *tets, const char *name, int dim, int count)
{
    const MeshGroup *of = dim == 3 ? mesh_group(tets->surface, name, 3) : group(tets, name, dim);
    if (!of || of->count != count)
        fail_msg("%s of dimension %d has %d members", name, dim, of ? of->count : -1);
}

static double volume(const Tets *tets)
{
    double sum = 0;
    for (int t = 0; t < tets->count; t++) sum += tets->volume[t];
    return sum;
}

/* Least and mean mean ratio: 1 for a regular tetrahedron, 12 (3 V)^(2/3) / sum of squared edges. */
static double least_quality(const Tets *tets)
{
    double least = 1;
    for (int t = 0; t < tets->count; t++) {
        const int *v = tets->nodes + 4 * t;
        double sum = 0;
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++) {
                Vec3 d = vec3_sub(vec3_load(tets->surface->rest[v[i]]), vec3_load(tets->surface->rest[v[j]]));
                sum += vec3_dot(d, d);
            }
        least = fmin(least, 12 * pow(3 * tets->volume[t], 2. / 3) / sum);
    }
    return least;
}

static void test_box(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    bool made = solid_shape_box((double[]){3, 2, 1}, (int[]){3, 2, 2}, &file, &err);
    Tets *tets = fill(&file, made, &err);
    check_counts(tets, 4 * 3 * 3, 2 * 2 * (3 * 2 + 2 * 2 + 3 * 2), 6 * 12);
    assert_true(fabs(volume(tets) - 6) < 1e-14);
    static const char *const names[] = {"left", "right", "front", "back", "bottom", "top"};
    for (int i = 0; i < 6; i++) { /* each where it should be, with all nodes and faces of that side */
        const int cells[3] = {3, 2, 2};
        int axis = i / 2, a = cells[(axis + 1) % 3], b = cells[(axis + 2) % 3];
        check_group(tets, names[i], 2, 2 * a * b);
        check_group(tets, names[i], 0, (a + 1) * (b + 1));
        const MeshGroup *of = group(tets, names[i], 0);
        for (int k = 0; k < of->count; k++)
            assert_true(tets->surface->rest[of->members[k]][axis] == (i % 2 ? 3 - axis : 0));
    }
    tets_destroy(tets);
}

static void test_plate(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    bool made = solid_shape_plate((double[]){4, 2, 0.5}, (int[]){4, 2, 3}, PATTERN_CROSSED, &file, &err);
    Tets *tets = fill(&file, made, &err);
    check_counts(tets, 4 * (15 + 8), 2 * 32 + 2 * 3 * 12, 3 * 32 * 3);
    assert_true(fabs(volume(tets) - 4) < 1e-13);
    tets_destroy(tets);
}

/* The counts of docs and of the prototype; five fingers with three stations each, below and above. */
static void test_hand(void **state)
{
    (void)state;
    static const int counts[2][3] = {{558, 1112, 1248}, {1946, 3888, 4992}};
    for (int n = 1; n <= 2; n++) {
        MeshFile file;
        Error err;
        bool made = solid_shape_hand((SolidShapeDef){0.08, NAN, n, 1}, &file, &err);
        Tets *tets = fill(&file, made, &err);
        check_counts(tets, counts[n - 1][0], counts[n - 1][1], counts[n - 1][2]);
        assert_true(fabs(volume(tets) - 832 * 0.004 * 0.004 * 0.004) < 1e-12);
        check_group(tets, "anchors", 0, 30);
        check_group(tets, "wrist", 0, 2 * (11 * n + 1));
        check_group(tets, "wrist", 2, 2 * 11 * n);
        check_group(tets, "palm", 3, 6 * 110 * n * n);
        check_group(tets, "thumb", 3, 6 * 16 * n * n);
        check_group(tets, "index", 2, 2 * 2 * 20 * n * n + 2 * (2 * 10 + 2) * n);
        const MeshGroup *anchors = group(tets, "anchors", 0);
        double top[3] = {0};
        for (int k = 0; k < 30; k++)
            for (int i = 0; i < 3; i++) top[i] = fmax(top[i], tets->surface->rest[anchors->members[k]][i]);
        assert_true(fabs(top[0] - 0.144) < 1e-12 && fabs(top[1] - 0.16) < 1e-12 && top[2] == 0.004);
        tets_destroy(tets);
    }
}

static void test_heart(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    bool made = solid_shape_heart((SolidShapeDef){0.04, NAN, 0, 1}, &file, &err);
    Tets *tets = fill(&file, made, &err);
    double full = acos(-1) * 2 / 3;
    check_counts(tets, 662, 1320, 1800);
    check_group(tets, "rim", 0, 120);
    check_group(tets, "lower", 2, 468);
    check_group(tets, "ribbon", 2, 234);
    assert_true(fabs(volume(tets) / (full * (0.02 * 0.02 * 0.03 - 0.017 * 0.017 * 0.027)) - 1) < 0.03);
    for (int v = 0; v < 662; v++) {
        const double *x = tets->surface->rest[v], in = v < 331 ? 0 : 0.003;
        double r = hypot(x[0], x[1]) / (0.02 - in), z = x[2] / (0.03 - in);
        assert_true(fabs(r * r + z * z - 1) < 1e-14);
    }
    tets_destroy(tets);
}

static void test_starfish(void **state)
{
    (void)state;
    static const int counts[2][4] = {{3, 262, 520, 585}, {5, 692, 1380, 1725}};
    for (int k = 0; k < 2; k++) {
        MeshFile file;
        Error err;
        bool made = solid_shape_starfish((SolidShapeDef){0.05, NAN, counts[k][0], 1}, &file, &err);
        Tets *tets = fill(&file, made, &err);
        check_counts(tets, counts[k][1], counts[k][2], counts[k][3]);
        double half = acos(-1) / 5, x = 0.01 * cos(half), y = 0.01 * sin(half);
        assert_true(fabs(volume(tets) - 0.003 * 5 * (x * y + (y + 0.002) * (0.025 - x))) < 1e-18);
        for (int arm = 0; arm < 5; arm++) {
            char name[] = "arm1";
            name[3] = (char)('1' + arm);
            check_group(tets, name, 3, counts[k][3] / 5);
            const MeshGroup *of = group(tets, name, 0);
            double far = 0, turn = 4 * half * arm / 2;
            for (int i = 0; i < of->count; i++) {
                const double *at = tets->surface->rest[of->members[i]];
                far = fmax(far, at[0] * cos(turn) + at[1] * sin(turn));
            }
            assert_true(fabs(far - 0.025) < 1e-15);
        }
        check_group(tets, "centre", 0, 2);
        check_group(tets, "top", 2, counts[k][3] / 3);
        assert_true(least_quality(tets) > 0.3);
        tets_destroy(tets);
    }
}

/* A curved sheet with a hole, in layers, along its normals; what it is called stays. */
static void test_extrude(void **state)
{
    (void)state;
    MeshFile sheet, file;
    Error err;
    assert_true(shape_hexagram(0.1, 3, &sheet, &err));
    for (int v = 0; v < sheet.vertex_count; v++) sheet.vertices[v][2] = 2 * pow(sheet.vertices[v][0], 2);
    Mesh *base = mesh_create(&sheet, 0, NULL, &err);
    bool made = solid_shape_extrude(base, 0.002, 3, &file, &err);
    Tets *tets = fill(&file, made, &err);
    check_group(tets, "flap2", 3, 9 * 3 * 3);
    check_group(tets, "flap2", 2, 2 * 9 + 6 * 2 * 3);
    double area = 0, flat = 0;
    for (int f = 0; f < base->face_count; f++) area += base->rest_area[f], flat += tets->volume[9 * f] * 3;
    assert_true(fabs(volume(tets) / (area * 0.002) - 1) < 0.05 && flat > 0);
    tets_destroy(tets);
    assert_false(solid_shape_extrude(base, 0, 1, &file, &err));
    assert_string_equal(err.text, "a solid has a thickness above 0, not 0 m");
    assert_false(solid_shape_extrude(base, 1, 0, &file, &err));
    assert_string_equal(err.text, "a solid has at least one layer, not 0");
    assert_false(solid_shape_extrude(base, 1, 20000000, &file, &err));
    assert_non_null(strstr(err.text, "tetrahedra are too many"));
    mem_free(base->groups[0].name);
    base->groups[0].name = mem_text("top");
    assert_false(solid_shape_extrude(base, 1, 1, &file, &err));
    assert_non_null(strstr(err.text, "the sheet has a group 'top'"));
    mesh_destroy(base);
    mesh_file_clear(&sheet);
}

/* Nothing is left of a shape that is refused. */
static void test_refused(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    long blocks = mem_live_count();
    assert_false(solid_shape_hand((SolidShapeDef){0, NAN, 1, 1}, &file, &err));
    assert_string_equal(err.text, "a solid has a size above 0, not 0 m");
    assert_false(solid_shape_hand((SolidShapeDef){1, NAN, 1, 0}, &file, &err));
    assert_false(solid_shape_starfish((SolidShapeDef){1, -1, 1, 1}, &file, &err));
    assert_false(solid_shape_starfish((SolidShapeDef){1, 1, 201, 1}, &file, &err));
    assert_string_equal(err.text, "a solid has 1 to 200 divisions, not 201");
    assert_false(solid_shape_heart((SolidShapeDef){1, 0.5, 1, 1}, &file, &err));
    assert_false(solid_shape_box((double[]){1, 1, 0}, (int[]){1, 1, 1}, &file, &err));
    assert_false(solid_shape_box((double[]){1, 1, 1}, (int[]){1, 0, 1}, &file, &err));
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_box),      cmocka_unit_test(test_plate),
                                       cmocka_unit_test(test_hand),     cmocka_unit_test(test_heart),
                                       cmocka_unit_test(test_starfish), cmocka_unit_test(test_extrude),
                                       cmocka_unit_test(test_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
