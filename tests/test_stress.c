/* What shells, solids and rods bear, against closed forms: stretched, sheared and rolled sheets, a strip with a load at its
 * end, stretched bars and films. */
#include "shell/stress.h"
#include "solid/stress.h"
#include "tests/shell_fixture.h"
#include "tests/solid_fixture.h"
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
    shell_stresses(b->shell, b->sys, &at, stress);
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

/* ---- Solids ---- */

/* Stretched by l along x and m along y and z, and turned by 0.5 about z: Cauchy's stress along the turned axis is sigma, and
 * across it tau. */
static void check_block(int order, SolidMaterial material, double averaging, double nu, double l, double m,
                        double sigma, double tau)
{
    SolidDef def = {.material = material, .poisson = nu, .density = 1000, .averaging = averaging};
    SolidBody b =
        solid_body(solid_box((double[]){0.3, 0.2, 0.1}, (int[]){3, 2, 1}, order, &def), false, YOUNG);
    double c = cos(0.5), s = sin(0.5);
    for (int v = 0; v < tets_node_count(b.solid->tets); v++) {
        double *x = b.state.x + 3 * v, along = l * x[0], across = m * x[1];
        x[0] = c * along - s * across, x[1] = s * along + c * across, x[2] *= m;
    }
    int count = b.solid->tets->count;
    TetStress *stress = mem_alloc((size_t)count, sizeof *stress);
    Point at = state_point(&b.state, b.p);
    solid_stresses(b.solid, b.sys, &at, stress);
    double exact[6] = {c * c * sigma + s * s * tau, s * s * sigma + c * c * tau, tau, c * s * (sigma - tau)};
    for (int t = 0; t < count; t++) {
        for (int k = 0; k < 6; k++) assert_true(fabs(stress[t].cauchy[k] - exact[k]) < 1e-10 * YOUNG);
        assert_true(fabs(stress[t].von_mises - fabs(sigma - tau)) < 1e-10 * YOUNG);
        assert_true(near(stress[t].stretch, fmax(l, m), 1e-7));
    }
    mem_free(stress);
    solid_body_clear(&b);
}

/* St. Venant-Kirchhoff: S = lambda tr E + 2 mu E; neo-Hookean with ln J: sigma_i = (mu (l_i^2 - 1) + lambda ln J)/J; and that
 * of solid.h which is finite at J = 0: (mu l_i^2 + J ((lambda + mu)(J - 1) - mu))/J, whatever part of it is averaged. */
static void test_blocks(void **state)
{
    (void)state;
    for (int order = 1; order <= 2; order++) {
        double l = 1.4, m = 0.9, nu = 0.3, J = l * m * m, mu = YOUNG / (2 * (1 + nu)),
               lambda = YOUNG * nu / ((1 + nu) * (1 - 2 * nu)), E = (l * l - 1) / 2, e = (m * m - 1) / 2,
               sum = E + 2 * e, push[2] = {l * l, m * m};
        check_block(order, SOLID_ST_VENANT_KIRCHHOFF, 0, nu, l, m, push[0] / J * (lambda * sum + 2 * mu * E),
                    push[1] / J * (lambda * sum + 2 * mu * e));
        check_block(order, SOLID_NEO_HOOKEAN_LOG, 0, nu, l, m, (mu * (push[0] - 1) + lambda * log(J)) / J,
                    (mu * (push[1] - 1) + lambda * log(J)) / J);
        for (int k = 0; k < 2; k++) {
            double even = (lambda + mu) * (J - 1) - mu;
            check_block(order, SOLID_NEO_HOOKEAN, 0.5 * k, nu, l, m, mu * push[0] / J + even,
                        mu * push[1] / J + even);
        }
    }
}

/* The mean of a dataset of the only frame over its first rows, and how far rows are from it. */
static double mean_of(Result *result, const char *path, int first, int count, double *off)
{
    Array array = read_all(result, path);
    const double *values = array.data;
    double mean = 0;
    for (int i = first; i < first + count; i++) mean += values[i] / count;
    *off = 0;
    for (int i = first; i < first + count; i++) *off = fmax(*off, fabs(values[i] - mean));
    array_clear(&array);
    return mean;
}

/* A bar that is pulled, as a scene: its stress is the force over the section that is left; a film on it, much softer, is
 * stretched as it is. */
static void test_bar(void **state)
{
    (void)state;
    Result *result = run_text(mem_text(
        "slender: 1\njob: equilibrium\nsolid:\n  mesh: {shape: box, size: [3, 2, 1], cells: [2, 2, 1]}\n"
        "  young: 1 MPa\n  poisson: 0.3\n"
        "  skin: {thickness: 1 mm, young: 1 Pa, poisson: 0.3, material: neo_hookean, on: {group: top}}\n"
        "fix:\n  - {group: left, axes: x}\n  - {group: front, axes: y}\n  - {group: bottom, axes: z}\n"
        "loads: [{area: [400 kPa, 0, 0], on: {group: right}}]\noutput: {precision: double}\n"));
    Array x = read_all(result, "slender/state/x"), cells = read_all(result, "slender/cells"),
          all = read_all(result, "VTKHDF/CellData/von_mises");
    const double *place = x.data, *values = all.data;
    double stretch[3] = {0}, off;
    for (int i = 0; i < 3 * x.dims[0]; i++) stretch[i % 3] = fmax(stretch[i % 3], place[i] / (3 - i % 3));
    int tets = cells.dims[0], films = 0;
    double sigma = mean_of(result, "VTKHDF/CellData/von_mises", 0, tets, &off);
    assert_true(near(sigma, 4e5 / (stretch[1] * stretch[2]), 1e-6) && off < 1e-6 * sigma);
    double longest = mean_of(result, "VTKHDF/CellData/stretch", 0, tets, &off);
    assert_true(near(longest, stretch[0], 1e-6) && off < 1e-6);
    PlaneTensor strain = {.xx = (stretch[0] * stretch[0] - 1) / 2, .yy = (stretch[1] * stretch[1] - 1) / 2};
    double film = membrane_von_mises(MEMBRANE_NEO_HOOKEAN, 0.3, strain);
    for (int i = tets; i < all.dims[0]; i++)
        if (!isnan(values[i])) films++, assert_true(near(values[i], film, 1e-5));
    assert_true(films > 0 && films < all.dims[0] - tets);
    array_clear(&x), array_clear(&cells), array_clear(&all);
    result_close(result);
}

/* ---- Rods ---- */

/* Section pi/4 r^4: GJ = Y/(2 (1 + nu)) pi/2 r^4. */
static char *rod(const char *loads, const char *rest)
{
    return mem_format("slender: 1\njob: equilibrium\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.2\n"
                      "  elements: 20\n  radius: 1 mm\n  young: 100 MPa\n  poisson: 0.25\n  density: 1000\n"
                      "%s%soutput: {precision: double}\n",
                      loads, rest);
}

static void check_rows(Result *result, const char *path, int count, const double row[3], double within)
{
    Array array = read_all(result, path);
    const double(*values)[3] = (const double(*)[3])array.data;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < 3; i++)
            if (!(fabs(values[k][i] - row[i]) <= within))
                fail_msg("%s, row %d: %.12g, %.12g, %.12g", path, k, values[k][0], values[k][1],
                         values[k][2]);
    array_clear(&array);
}

/* A couple about the rod twists it by M/GJ, and nothing else. */
static void test_twisted(void **state)
{
    (void)state;
    double GJ = 1e8 / 2.5 * M_PI / 2 * 1e-12, M = 3e-6;
    Result *result =
        run_text(rod("  gravity: [0, 0, 0]\n  loads: [{point: end, couple: [3.0e-6, 0, 0]}]\n", ""));
    check_rows(result, "VTKHDF/PointData/moment", 21, (double[]){M, 0, 0}, 1e-8 * M);
    check_rows(result, "VTKHDF/PointData/strain", 21, (double[]){M / GJ, 0, 0}, 1e-8 * M / GJ);
    check_rows(result, "slender/final/strain", 20, (double[]){M / GJ, 0, 0}, 1e-8 * M / GJ);
    check_rows(result, "slender/final/force", 20, (double[]){0, 0, 0}, 1e-12);
    result_close(result);
}

/* A load at the end of a rod that hangs in its weight, with positions as dofs (a potential that is 0) and without: each
 * element bears the load and the weight beyond it; the moment at the clamp is theirs. */
static void test_hanging(void **state)
{
    (void)state;
    static const char *const more[] = {"", "    - {potential: \"0*x\"}\n"};
    double weight = 1000 * M_PI * 1e-6 * 0.2 * 9.81, load = 1e-4;
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(
            rod("  gravity: [0, 0, -9.81]\n  loads:\n    - {point: end, force: [0, 0, -1.0e-4]}\n", more[k]));
        Array force = read_all(result, "slender/final/force"), place = read_all(result, "slender/state/x"),
              moment = read_all(result, "VTKHDF/PointData/moment");
        const double *F = force.data, *x = place.data, *m = moment.data;
        double turning = 0;
        for (int e = 0; e < 20; e++) {
            double exact = -load - weight * (20 - e - 0.5) / 20;
            assert_true(near(F[3 * e + 2], exact, 1e-7) && fabs(F[3 * e]) < 1e-9 &&
                        fabs(F[3 * e + 1]) < 1e-9);
        }
        for (int i = 1; i <= 20; i++)
            turning += (x[3 * i] - x[0]) * (weight / 20 * (i == 20 ? 0.5 : 1) + (i == 20 ? load : 0));
        print_message("at the clamp %.6e N m, of the loads %.6e\n", m[1], turning);
        assert_true(near(m[1], turning, 0.01));
        array_clear(&force), array_clear(&place), array_clear(&moment);
        result_close(result);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pulled),  cmocka_unit_test(test_rolled), cmocka_unit_test(test_cantilever),
        cmocka_unit_test(test_blocks),  cmocka_unit_test(test_bar),    cmocka_unit_test(test_twisted),
        cmocka_unit_test(test_hanging),
    };
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
