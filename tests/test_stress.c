/* What shells, solids and rods bear, against closed forms: stretched, sheared and rolled sheets, a strip with a load at its
 * end, stretched bars and films. */
#include "shell/stress.h"
#include "base/vec3.h"
#include "tests/shell_fixture.h"
#include <math.h>

#define NAME "test_stress"
#include "tests/run_fixture.h"

#define YOUNG 2e5

static bool near(double a, double b, double part)
{
    return fabs(a - b) <= part * fabs(b);
}

/* ---- Shells ---- */

static Body sheet(ShapePattern pattern, MembraneMaterial material, double poisson, BendingModel bending)
{
    Shell *shell = shell_of_sheet((double[]){0.1, 0.1}, (int[]){6, 6}, pattern);
    shell->thickness = 1e-3, shell->poisson = poisson, shell->density = 1000;
    shell->material = material, shell->bending = bending;
    return body_create(shell, shell_system(shell), YOUNG);
}

static FaceStress *stress_of(const Body *b)
{
    Point at = state_point(&b->state, b->p);
    FaceStress *stress = mem_alloc((size_t)b->shell->mesh->face_count, sizeof *stress);
    shell_stress(b->shell, b->sys, &at, stress);
    return stress;
}

/* Stretched by l along x and by m along y, turned by 0.4 about x: of all faces the same. */
static void check_stretched(MembraneMaterial material, double poisson, double l, double m, double von_mises)
{
    Body b = sheet(PATTERN_CROSSED, material, poisson, BENDING_MIDEDGE);
    for (int v = 0; v < b.shell->mesh->vertex_count; v++) {
        double *x = b.state.x + 3 * v, y = m * x[1];
        x[0] *= l, x[1] = y * cos(0.4), x[2] = y * sin(0.4);
    }
    FaceStress *stress = stress_of(&b);
    double G[2] = {(l * l - 1) / 2, (m * m - 1) / 2};
    for (int f = 0; f < b.shell->mesh->face_count; f++) {
        assert_true(fabs(stress[f].strain[0] - fmax(G[0], G[1])) < 1e-12);
        assert_true(fabs(stress[f].strain[1] - fmin(G[0], G[1])) < 1e-12);
        for (int k = STRESS_BOTTOM; k <= STRESS_TOP; k++)
            assert_true(near(stress[f].von_mises[k], von_mises, 1e-10));
        assert_true(fabs(stress[f].curvature[0]) + fabs(stress[f].curvature[1]) < 1e-10);
    }
    mem_free(stress);
    body_clear(&b);
}

/* Pulled along x alone, sigma is all there is. St. Venant-Kirchhoff: S = Y G, and both sides have the stretch
 * sqrt(1 - 2 nu G). Neo-Hookean [Blatz, Ko 1962]: that of the sides is l^-nu, sigma = mu (l^2 - l^(-2 nu))/J. */
static void test_pulled(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        double l = 1.3, nu = (double[]){0, 0.3, 0.45}[k], G = (l * l - 1) / 2, side = sqrt(1 - 2 * nu * G);
        check_stretched(MEMBRANE_ST_VENANT_KIRCHHOFF, nu, l, side, YOUNG * G * l / (side * side));
        side = pow(l, -nu);
        check_stretched(MEMBRANE_NEO_HOOKEAN, nu, l, side,
                        YOUNG / (2 * (1 + nu)) * (l * l - side * side) / (l * side * side));
    }
    /* rubber, as much in both directions: sigma = mu (l^2 - l^-4) each */
    check_stretched(MEMBRANE_NEO_HOOKEAN, 0.5, 1.2, 1.2, YOUNG / 3 * (pow(1.2, 2) - pow(1.2, -4)));
}

/* Rolled about y by an angle at every line of cells: K is the angle over a cell's length, in the faces of each line. */
static void check_rolled(BendingModel bending, double nu, double fold)
{
    enum { N = 6 };
    Body b = sheet(PATTERN_RIGHT, MEMBRANE_ST_VENANT_KIRCHHOFF, nu, bending);
    const Mesh *mesh = b.shell->mesh;
    double line[N + 1][2] = {{0}}, cell = 0.1 / N, turn = 0.2;
    for (int k = 1; k <= N; k++) {
        line[k][0] = line[k - 1][0] + cell * cos((k - 1) * turn);
        line[k][1] = line[k - 1][1] - cell * sin((k - 1) * turn); /* a ridge, seen from +z */
    }
    for (int v = 0; v < mesh->vertex_count; v++)
        b.state.x[3 * v] = line[v % (N + 1)][0], b.state.x[3 * v + 2] = line[v % (N + 1)][1];
    for (int e = 0; e < mesh->edge_count; e++) b.p[b.shell->fold + e] = fold;
    system_accept(b.sys, b.state.x, b.state.memory);
    FaceStress *stress = stress_of(&b);
    double K = turn / cell, G = fold * K * 1e-3 / 2, plate = YOUNG / (1 - nu * nu);
    int inner = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        double middle = 0;
        for (int i = 0; i < 3; i++) middle += mesh->rest[mesh->faces[f][i]][0] / 3;
        if (middle < cell || middle > 0.1 - cell) continue; /* theirs have an edge without a neighbour */
        inner++;
        assert_true(near(stress[f].curvature[0], K, 1e-9) && fabs(stress[f].curvature[1]) < 1e-9 * K);
        assert_true(fabs(stress[f].von_mises[STRESS_MIDDLE]) < 1e-9 * plate);
        for (int side = -1; side <= 1; side += 2) {
            /* plane strain: S = Y/(1 - nu^2) (G, nu G); l^2 along x, 1 - 2 nu/(1 - nu) G across */
            double l2 = 1 + 2 * side * G, J = sqrt(l2 * (1 - 2 * nu / (1 - nu) * side * G)),
                   s = side * plate * G * l2 / J, t = nu * side * plate * G / J;
            assert_true(near(stress[f].von_mises[1 + side], sqrt(s * s - s * t + t * t), 1e-9));
            /* as plates have it, for small strains: E K h/2/(1 - nu^2) */
            assert_true(
                near(stress[f].von_mises[1 + side], plate * G * sqrt(1 - nu + nu * nu), 3 * G + 1e-9));
        }
    }
    assert_int_equal(inner, 2 * N * (N - 2));
    mem_free(stress);
    body_clear(&b);
}

static void test_rolled(void **state)
{
    (void)state;
    check_rolled(BENDING_HINGE, 0.3, 1);
    check_rolled(BENDING_MIDEDGE, 0.3, 1);
    check_rolled(BENDING_MIDEDGE, 0, 0.5);
}

/* A narrow strip with a load at its end, as a scene: 6 F (L - x)/(w h^2) at both faces, none in the middle. */
static void test_cantilever(void **state)
{
    (void)state;
    Result *result = run_text(
        mem_text("slender: 1\njob: equilibrium\nshell:\n"
                 "  mesh: {shape: strip, size: [100 mm, 10 mm], n: 40, pattern: crossed}\n"
                 "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0\nfix: [{group: root, clamp: true}]\n"
                 "loads: [{line: [0, 0, -1.0e-4 N/m], on: {box: [[0.0999, -1, -1], [1, 1, 1]]}}]\n"
                 "output: {precision: double}\n"));
    Array rest = read_all(result, "slender/rest"), faces = read_all(result, "slender/faces"),
          top = read_all(result, "VTKHDF/CellData/von_mises_top"),
          middle = read_all(result, "VTKHDF/CellData/von_mises"),
          bottom = read_all(result, "VTKHDF/CellData/von_mises_bottom");
    const double(*x)[3] = (const double(*)[3])rest.data, *up = top.data, *down = bottom.data,
          *within = middle.data;
    const int(*face)[3] = (const int(*)[3])faces.data;
    assert_string_equal(top.unit, "Pa");
    double worst = 0, most = 6 * 1e-6 * 0.1 / (0.01 * 1e-6);
    for (int f = 0; f < faces.dims[0]; f++) {
        double along = (x[face[f][0]][0] + x[face[f][1]][0] + x[face[f][2]][0]) / 3,
               exact = most * (1 - along / 0.1);
        if (along < 0.01 || along > 0.09) continue;
        worst = fmax(worst, fmax(fabs(up[f] - exact), fabs(down[f] - exact)) / most);
        assert_true(within[f] < 0.01 * most);
    }
    print_message("stress of a strip with a load at its end: within %.4f of the largest\n", worst);
    assert_true(worst < 0.02);
    array_clear(&rest), array_clear(&faces), array_clear(&top), array_clear(&middle), array_clear(&bottom);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pulled), cmocka_unit_test(test_rolled),
                                       cmocka_unit_test(test_cantilever)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
