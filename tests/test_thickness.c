/* Shells whose thickness and density differ from face to face, against stepped beams; and thicknesses that are found again. */
#include "base/memory.h"
#include "shell/stress.h"
#include "solve/eigen.h"
#include "solve/newton.h"
#include "tests/shell_fixture.h"
#include <math.h>
#include <stdio.h>

#define NAME "test_thickness"
#include "tests/run_fixture.h"

static const double LENGTH = 0.1, WIDTH = 0.01, STEP = 0.04, YOUNG = 1e6, FORCE = 1e-7;
static const double height[2] = {1e-3, 5e-4}, density[2] = {1000, 2500}; /* before the step, and beyond */

static double middle_of(const Mesh *mesh, int face)
{
    double x = 0;
    for (int i = 0; i < 3; i++) x += mesh->rest[mesh->faces[face][i]][0] / 3;
    return x;
}

/* A strip along x, clamped at x = 0, thick and light up to the step, thin and heavy beyond. */
static Body stepped_strip(ShapePattern pattern, int cells, BendingModel bending)
{
    Shell *shell = shell_of_sheet((double[]){LENGTH, WIDTH}, (int[]){cells, cells / 10}, pattern);
    shell->thickness = height[0], shell->poisson = 0, shell->bending = bending;
    hold_root(shell, true);
    Body s = body_create(shell, shell_system(shell), YOUNG);
    for (int f = 0; f < shell->mesh->face_count; f++) {
        int side = middle_of(shell->mesh, f) > STEP;
        s.p[shell->face_thickness + f] = height[side], s.p[shell->face_density + f] = density[side];
    }
    return s;
}

/* A force at the end x = L, shared as a line load is: half as much at its corners. */
static void pull_end(Body *s, int axis, double force)
{
    const Mesh *mesh = s->shell->mesh;
    int count = 0;
    for (int v = 0; v < mesh->vertex_count; v++) count += mesh->rest[v][0] > LENGTH - 1e-9;
    for (int v = 0; v < mesh->vertex_count; v++) {
        double y = mesh->rest[v][1];
        bool corner = y < 1e-9 || y > WIDTH - 1e-9;
        if (mesh->rest[v][0] > LENGTH - 1e-9)
            s->p[s->shell->load + 3 * v + axis] = force / (count - 1) / (corner ? 2 : 1);
    }
}

/* The end's mean displacement in equilibrium. */
static double end_moves(Body *s, int axis)
{
    const Mesh *mesh = s->shell->mesh;
    NewtonDef def = newton_default();
    NewtonInfo info = newton_minimize(s->sys, &def, &(Point){.p = s->p}, &s->state, NULL);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    double sum = 0;
    int count = 0;
    for (int v = 0; v < mesh->vertex_count; v++)
        if (mesh->rest[v][0] > LENGTH - 1e-9) sum += s->state.x[3 * v + axis] - mesh->rest[v][axis], count++;
    return sum / count;
}

/* int F (L - x)^2/(Y I) dx over both parts. */
static double beam_end(void)
{
    double rest = pow(LENGTH - STEP, 3), inertia[2];
    for (int k = 0; k < 2; k++) inertia[k] = WIDTH * pow(height[k], 3) / 12;
    return FORCE / (3 * YOUNG) * ((pow(LENGTH, 3) - rest) / inertia[0] + rest / inertia[1]);
}

static double bending_error(ShapePattern pattern, int cells, BendingModel bending)
{
    Body s = stepped_strip(pattern, cells, bending);
    pull_end(&s, 2, FORCE);
    double off = end_moves(&s, 2) / beam_end() - 1;
    print_message("pattern %d, %s, %d cells: end off by %.2e\n", pattern,
                  bending == BENDING_HINGE ? "hinge" : "midedge", cells, off);
    body_clear(&s);
    return fabs(off);
}

/* A bend at the step's own edge is of both faces, each with its own stiffness: with edge angles that costs nothing, hinges are off by
 * a part of a cell. */
static void test_stepped_beam(void **state)
{
    (void)state;
    static const ShapePattern patterns[] = {PATTERN_RIGHT, PATTERN_ALTERNATE, PATTERN_CROSSED};
    for (int k = 0; k < 3; k++) {
        double coarse = bending_error(patterns[k], 20, BENDING_MIDEDGE),
               fine = bending_error(patterns[k], 40, BENDING_MIDEDGE);
        assert_true(fine < 2e-3 && fine < coarse / 2);
    }
    double coarse = bending_error(PATTERN_RIGHT, 20, BENDING_HINGE),
           fine = bending_error(PATTERN_RIGHT, 40, BENDING_HINGE);
    assert_true(fine < 0.03 && fine < 0.6 * coarse);
}

/* Von Mises' stress at the sides, 6 F (L - x)/(w h^2). */
static void test_stress(void **state)
{
    (void)state;
    Body s = stepped_strip(PATTERN_ALTERNATE, 40, BENDING_MIDEDGE);
    const Mesh *mesh = s.shell->mesh;
    double most = 6 * FORCE * (LENGTH - STEP) / (WIDTH * height[1] * height[1]), worst = 0;
    FaceStress *stress = mem_alloc((size_t)mesh->face_count, sizeof *stress);
    pull_end(&s, 2, FORCE);
    end_moves(&s, 2);
    Point at = state_point(&s.state, s.p);
    shell_stresses(s.shell, s.sys, &at, stress);
    for (int f = 0; f < mesh->face_count; f++) {
        double x = middle_of(mesh, f), h = height[x > STEP],
               exact = 6 * FORCE * (LENGTH - x) / (WIDTH * h * h);
        worst = fmax(worst, fabs(stress[f].von_mises[STRESS_TOP] - exact) / most);
    }
    print_message("stress at the side off by %.2e of the largest\n", worst);
    assert_true(worst < 0.03);
    mem_free(stress);
    body_clear(&s);
}

/* F/(Y w) (a/h_1 + (L - a)/h_2), by the membrane alone. */
static void test_stretched(void **state)
{
    (void)state;
    Body s = stepped_strip(PATTERN_RIGHT, 20, BENDING_MIDEDGE);
    for (int v = 0; v < s.shell->mesh->vertex_count; v++) system_fix(s.sys, 3 * v + 2);
    pull_end(&s, 0, 1e-6);
    double exact = 1e-6 / (YOUNG * WIDTH) * (STEP / height[0] + (LENGTH - STEP) / height[1]);
    double off = end_moves(&s, 0) / exact - 1;
    print_message("stretched: off by %.2e\n", off);
    assert_true(fabs(off) < 1e-4);
    body_clear(&s);
}

/* ---- Mass ---- */

/* What weight pulls, and what resists being moved. */
static void test_mass(void **state)
{
    (void)state;
    Body s = stepped_strip(PATTERN_CROSSED, 20, BENDING_MIDEDGE);
    const Mesh *mesh = s.shell->mesh;
    double exact = WIDTH * (density[0] * height[0] * STEP + density[1] * height[1] * (LENGTH - STEP)),
           sum = 0, weight = 0;
    double *mass = mem_alloc((size_t)mesh->vertex_count, sizeof *mass),
           *g = mem_alloc((size_t)shell_dof_count(s.shell), sizeof *g);
    shell_vertex_mass(s.shell, s.p, mass);
    s.p[s.shell->gravity + 2] = -10;
    Point at = state_point(&s.state, s.p);
    system_gradient(s.sys, &at, g);
    for (int v = 0; v < mesh->vertex_count; v++) sum += mass[v], weight += g[3 * v + 2];
    assert_true(fabs(sum / exact - 1) < 1e-12 && fabs(weight / (10 * exact) - 1) < 1e-9);
    mem_free(mass);
    mem_free(g);
    body_clear(&s);
}

static double determinant(double a[4][4])
{
    double det = 1;
    for (int k = 0; k < 4; k++) {
        int pivot = k;
        for (int i = k + 1; i < 4; i++)
            if (fabs(a[i][k]) > fabs(a[pivot][k])) pivot = i;
        for (int j = 0; j < 4; j++) {
            double other = a[k][j];
            a[k][j] = a[pivot][j], a[pivot][j] = other;
        }
        det *= pivot == k ? a[k][k] : -a[k][k];
        for (int i = k + 1; i < 4; i++)
            for (int j = 3; j >= k; j--) a[i][j] -= a[i][k] / a[k][k] * a[k][j];
    }
    return det;
}

/* Of a stepped beam: A (cosh - cos) + B (sinh - sin) from the clamp, C (cosh + cos) + D (sinh + sin) from the free end; where
 * they meet, w, w', Y I w'' and Y I w''' are the same. 0 at a frequency. */
static double misfit(double omega)
{
    double a[4][4];
    for (int side = 0; side < 2; side++) {
        double h = height[side], length = side ? LENGTH - STEP : STEP, sign = side ? 1 : -1;
        double b = sqrt(omega * sqrt(12 * density[side] / (YOUNG * h * h))), u = b * length;
        double even[4] = {cosh(u) + sign * cos(u), sinh(u) - sign * sin(u), cosh(u) - sign * cos(u),
                          sinh(u) + sign * sin(u)};
        double odd[4] = {sinh(u) + sign * sin(u), cosh(u) + sign * cos(u), sinh(u) - sign * sin(u),
                         cosh(u) - sign * cos(u)};
        for (int d = 0; d < 4; d++) {
            double factor = pow(b * LENGTH, d) * (d > 1 ? pow(h / height[0], 3) : 1);
            double turned = side && d % 2 ? -1 : 1, to = side ? -1 : 1;
            a[d][2 * side] = to * turned * factor * even[d];
            a[d][2 * side + 1] = to * turned * factor * odd[d];
        }
    }
    return determinant(a);
}

static double beam_frequency(void)
{
    double low = 1, high = 1;
    while (misfit(low) * misfit(high) > 0) low = high, high *= 1.1;
    for (int k = 0; k < 60; k++) {
        double middle = (low + high) / 2;
        if (misfit(low) * misfit(middle) > 0)
            low = middle;
        else
            high = middle;
    }
    return low / (2 * M_PI);
}

static void test_frequency(void **state)
{
    (void)state;
    Body s = stepped_strip(PATTERN_RIGHT, 40, BENDING_MIDEDGE);
    int vertices = s.shell->mesh->vertex_count;
    double *mass = mem_alloc((size_t)vertices, sizeof *mass), *M = mem_alloc(3 * (size_t)vertices, sizeof *M),
           square;
    shell_vertex_mass(s.shell, s.p, mass);
    for (int i = 0; i < 3 * vertices; i++) M[i] = mass[i / 3];
    Point at = state_point(&s.state, s.p);
    assert_true(eigen_lowest(s.sys, &at, M, 1, &square, NULL));
    double hz = sqrt(square) / (2 * M_PI), exact = beam_frequency();
    print_message("%.5f Hz, of the stepped beam %.5f Hz\n", hz, exact);
    assert_true(fabs(hz / exact - 1) < 2e-3);
    mem_free(mass);
    mem_free(M);
    body_clear(&s);
}

/* ---- Whole runs ---- */

/* What a result shows as places of a case, as a mesh file. */
static void write_places(Result *result, const char *path)
{
    Array x = read_all(result, "slender/cases/case1/x"), faces = read_all(result, "slender/faces");
    const double *place = x.data;
    const int *v = faces.data;
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int k = 0; k < x.dims[0]; k++)
        fprintf(file, "v %.17g %.17g %.17g\n", place[3 * k], place[3 * k + 1], place[3 * k + 2]);
    for (int f = 0; f < faces.dims[0]; f++)
        fprintf(file, "f %d %d %d\n", v[3 * f] + 1, v[3 * f + 1] + 1, v[3 * f + 2] + 1);
    fclose(file);
    array_clear(&x);
    array_clear(&faces);
}

static const char flower[] =
    "slender: 1\njob: %s\nshell:\n  mesh: {shape: hexagram, size: 40 mm, n: 3}\n  young: 0.1 MPa\n  poisson: "
    "0.4\n"
    "  thickness: %s\n  density: 1200\n  magnetization: [\"3e4*x/r\", \"3e4*y/r\", 0]\n  gravity: [0, 0, "
    "-9.81]\n"
    "fix: [{ball: {center: [0, 0, 0], radius: 9 mm}}]\nflux_density: [0, 0, 3 mT]\n%s";

#define KNOWN                                                                                                \
    "{groups: {flap1: 0.7 mm, flap2: 1.3 mm, flap3: 0.9 mm, flap4: 1.1 mm, flap5: 0.8 mm, flap6: 1.2 mm}, "  \
    "other: 1 mm}"

/* Each group's thickness from the places that it makes; what is in none stays. */
static void test_found(void **state)
{
    (void)state;
    Result *result = run_text(mem_format(flower, "equilibrium", KNOWN, ""));
    write_places(result, NAME ".obj");
    assert_true(result_has(result, "VTKHDF/CellData/thickness"));
    assert_false(result_has(result, "VTKHDF/CellData/density"));
    Array known = read_all(result, "slender/design/thickness");
    result_close(result);
    result = run_text(
        mem_format(flower, "design", "1 mm",
                   "target: {file: " NAME
                   ".obj}\ndesign:\n  optimizer: gauss_newton\n  iterations: 30\n  tolerance: 1.0e-9\n"
                   "  unknowns: {thickness: {per: group, groups: [flap1, flap2, flap3, flap4, flap5, flap6], "
                   "bounds: [0.2 mm, 3 mm], start: 1 mm}}\n  objectives: [{target: 1}, "
                   "{thickness_smoothness: 1.0e-20}]\n"));
    Array found = read_all(result, "slender/design/thickness");
    double worst = 0;
    for (int f = 0; f < known.dims[0]; f++)
        worst = fmax(worst, fabs(((double *)found.data)[f] / ((double *)known.data)[f] - 1));
    print_message("thicknesses found within %.1e\n", worst);
    assert_true(worst < 1e-4);
    assert_true(result_has(result, "VTKHDF/CellData/thickness"));
    assert_true(result_has(result, "slender/design/gradient/thickness"));
    array_clear(&found);
    array_clear(&known);
    result_close(result);
}

/* The scene's design is as thick as a beam that bends to a circle is, of the width's mean. */
static void test_taper(void **state)
{
    (void)state;
    enum { COLUMNS = 16 };
    const char *const settings[] = {"shell.mesh.n=24"};
    Result *result = run_file(SOURCE_DIR "/scenes/strip_taper.yaml", settings, 1, false);
    Array rest = read_all(result, "slender/rest"), faces = read_all(result, "slender/faces"),
          thickness = read_all(result, "slender/design/thickness");
    double sum[COLUMNS] = {0}, wanted[COLUMNS] = {0}, count[COLUMNS] = {0}, worst = 0;
    for (int f = 0; f < faces.dims[0]; f++) {
        double x = 0;
        for (int i = 0; i < 3; i++) x += ((double *)rest.data)[3 * ((int *)faces.data)[3 * f + i]] / 3;
        int k = (int)(x / 0.04 * COLUMNS);
        sum[k] += ((double *)thickness.data)[f], wanted[k] += 1e-3 * sqrt(1 - sin(M_PI / 2 * x / 0.04)),
            count[k]++;
    }
    for (int k = 0; k < COLUMNS - 2; k++) worst = fmax(worst, fabs(sum[k] - wanted[k]) / count[k]);
    print_message("tapered within %.1e m\n", worst);
    assert_true(worst < 2e-5);
    array_clear(&rest);
    array_clear(&faces);
    array_clear(&thickness);
    result_close(result);
}

#define FALL                                                                                                 \
    "slender: 1\njob: %s\nshell:\n  mesh: {shape: strip, size: [40 mm, 10 mm], n: 8}\n  thickness: %s\n"     \
    "  young: 0.1 MPa\n  poisson: 0.3\n  gravity: [0, 0, -9.81]\n  damping: 1.0e-4\n"                        \
    "fix: [{group: root, clamp: true}]\ntime: {step: 2 ms, steps: 12}\noutput: {precision: double}\n%s"

/* One thickness of the whole body from where its tip is at the end of a motion: damping makes it tell. */
static void test_found_in_motion(void **state)
{
    (void)state;
    Result *result = run_text(mem_format(FALL, "simulate", "0.8 mm", ""));
    assert_false(result_has(result, "VTKHDF/CellData/thickness"));
    Array x = read_all(result, "slender/cases/case1/x");
    const double *last = (double *)x.data + 3 * (x.dims[0] - 1);
    char *waypoint = mem_format("design:\n  optimizer: gauss_newton\n  iterations: 30\n  tolerance: 1.0e-9\n"
                                "  unknowns: {thickness: {per: body}}\n"
                                "  objectives: [{waypoint: {vertex: %d, at: [%.17g, %.17g, %.17g]}}]\n",
                                x.dims[0] - 1, last[0], last[1], last[2]);
    result_close(result);
    result = run_text(mem_format(FALL, "trajectory", "1 mm", waypoint));
    Array found = read_all(result, "slender/design/thickness");
    print_message("in motion %.8g m\n", *(double *)found.data);
    assert_true(fabs(*(double *)found.data / 8e-4 - 1) < 1e-5);
    mem_free(waypoint);
    array_clear(&x);
    array_clear(&found);
    result_close(result);
}

/* The centre of mass of a beam that is made thicker where that brings it where it is to be: its probe goes with it. */
static void test_center(void **state)
{
    (void)state;
    Result *result =
        run_text(mem_format(FALL, "trajectory", "1 mm",
                            "probes: {centre: {mass_center: true}}\ndesign:\n  iterations: 12\n"
                            "  optimizer: gauss_newton\n"
                            "  unknowns: {thickness: {bounds: [0.5 mm, 2 mm]}}\n"
                            "  objectives: [{waypoint: {mass_center: true, at: [16 mm, 5 mm, 0]}}]\n"));
    Array rest = read_all(result, "slender/rest"), faces = read_all(result, "slender/faces"),
          x = read_all(result, "slender/cases/case1/x"), centre = read_all(result, "slender/probes/centre"),
          thickness = read_all(result, "slender/design/thickness");
    const double *at = rest.data, *end = (double *)x.data + 3 * (x.dims[0] - rest.dims[0]),
                 *seen = (double *)centre.data + 3 * (centre.dims[0] - 1);
    double sum[3] = {0}, whole = 0, even = 0, area = 0;
    for (int f = 0; f < faces.dims[0]; f++) {
        const int *v = (int *)faces.data + 3 * f;
        const double *a = at + 3 * v[0], *b = at + 3 * v[1], *c = at + 3 * v[2];
        double twice = fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])),
               mass = ((double *)thickness.data)[f] * twice;
        whole += mass, area += twice, even += twice * (a[0] + b[0] + c[0]) / 3;
        for (int i = 0; i < 9; i++) sum[i % 3] += mass * end[3 * v[i / 3] + i % 3] / 3;
    }
    print_message("centre of mass at %.2f mm of the beam, %.2f mm were it even\n", 1e3 * seen[0],
                  1e3 * even / area);
    for (int i = 0; i < 3; i++) assert_true(fabs(sum[i] / whole - seen[i]) < 1e-14);
    assert_true(even / area - seen[0] > 1e-3);
    Array *all[] = {&rest, &faces, &x, &centre, &thickness};
    for (int k = 0; k < 5; k++) array_clear(all[k]);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stepped_beam), cmocka_unit_test(test_stress),
        cmocka_unit_test(test_stretched),    cmocka_unit_test(test_mass),
        cmocka_unit_test(test_frequency),    cmocka_unit_test(test_found),
        cmocka_unit_test(test_taper),        cmocka_unit_test(test_found_in_motion),
        cmocka_unit_test(test_center),
    };
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
