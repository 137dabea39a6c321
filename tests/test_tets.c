/* Tetrahedra, their surface and skin. */
#include "base/memory.h"
#include "solid/shapes.h"
#include "solid/tet_patches.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

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
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_box), cmocka_unit_test(test_patches)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
