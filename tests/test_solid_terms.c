/* A solid's terms: derivatives against each other, closed forms, rigid motions, patch tests, momenta. */
#include "base/vec3.h"
#include "solid/law.h"
#include "solid/terms.h"
#include "solve/check.h"
#include "solve/march.h"
#include "tests/solid_fixture.h"
#include "tests/flux_fixture.h"
#include <stdlib.h>

static const double cube[3] = {0.02, 0.02, 0.02};

/* ---- Derivatives ---- */

static double *make_params(const Solid *solid, Random *random)
{
    double *p = mem_alloc((size_t)solid->params.size, sizeof *p);
    solid_default_params(solid, p);
    for (int t = 0; t < solid->tets->count; t++) {
        p[solid->young + t] = 1e5 * (1 + random_uniform(random));
        for (int i = 0; i < 3; i++) p[solid->volume_magnetization + 3 * t + i] = 5e4 * random_signed(random);
    }
    for (int i = 0; i < 3 * solid->tets->surface->face_count; i++)
        p[solid->magnetization + i] = 5e4 * random_signed(random);
    for (int f = 0; f < solid->tets->surface->face_count; f++)
        p[solid->skin_young + f] = 2e5 * (1 + random_uniform(random));
    disturb_fields(&solid->fields, &solid->flux, 2e-3, random, p);
    if (solid->fields.count) p[solid->flux.scale + 1] = 0; /* off: what it would do is known too */
    p[solid->damping] = 0.02;
    for (int i = 0; i < 3; i++) {
        p[solid->flux.uniform + i] = 0.05 * random_signed(random);
        p[solid->gravity + i] = 10 * random_signed(random);
    }
    for (int i = 0; i < solid_dof_count(solid); i++) p[solid->load + i] = 1e-3 * random_signed(random);
    return p;
}

static FluxFields two_dipoles(void)
{
    FluxFields fields = {0};
    flux_fields_add(&fields, flux_field_dipole((double[]){0.01, 0.02, 0.05}, (double[]){0.1, -0.2, 0.5}));
    flux_fields_add(&fields, flux_field_dipole((double[]){0, 0, -0.06}, (double[]){0.3, 0.1, 0.2}));
    return fields;
}

static void check_rows(SolidMaterial material, int order, double averaging, bool in_fields)
{
    Random random = random_seed(17);
    MembraneMaterial film =
        material == SOLID_ST_VENANT_KIRCHHOFF ? MEMBRANE_ST_VENANT_KIRCHHOFF : MEMBRANE_NEO_HOOKEAN;
    const SolidDef def = {material, 0.4, 1200, averaging, 1e-3, true, 0.3, film};
    MeshFile file = box_mesh(cube, (int[]){2, 2, 2}, 0.2);
    FluxFields fields = in_fields ? two_dipoles() : (FluxFields){0};
    Solid *solid = solid_of_mesh(&file, order, &def, &fields);
    double *p = make_params(solid, &random), dof_size[TERM_MAX_DOF];
    System *sys = solid_system(solid, true);
    State now = system_state(sys);
    for (int i = 0; i < solid_dof_count(solid); i++)
        now.x[i] = 1.1 * solid->tets->surface->rest[i / 3][i % 3] + 5e-4 * random_signed(&random);
    for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = 5e-4;
    Point at = state_point(&now, p);
    at.time = 0.3, at.dt = 0.01;
    for (int t = 0; t < system_term_count(sys); t++) {
        Point own = system_term_point(sys, t, &at);
        const Term *term = system_term(sys, t);
        if (!strcmp(term->ops->name, "mean_dilation") && averaging == 0) continue; /* has no elements */
        TermError error = check_term(term, &solid->params, &own, system_dof_count(sys), dof_size, &random);
        print_message("%-15s gradient %.1e  hessian %.1e  param_forward %.1e  param %.1e\n", term->ops->name,
                      error.gradient, error.hessian, error.forward, error.adjoint);
        assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
    }
    system_destroy(sys);
    state_destroy(&now);
    mem_free(p);
    solid_destroy(solid);
}

static void test_derivatives(void **state)
{
    (void)state;
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        for (int m = SOLID_NEO_HOOKEAN; m <= SOLID_ST_VENANT_KIRCHHOFF; m++)
            check_rows((SolidMaterial)m, order, 0, m == SOLID_NEO_HOOKEAN);
        check_rows(SOLID_NEO_HOOKEAN, order, 0.6, false);
    }
}

/* ---- Closed forms ---- */

static void check_stretch(SolidMaterial material, int order, int loaded, double stretch)
{
    const SolidDef def = {.material = material, .poisson = 0.4, .density = 1000};
    MeshFile file = box_mesh(cube, (int[]){2, 2, 2}, 0.2);
    Solid *solid = solid_of_mesh(&file, order, &def, NULL);
    for (int i = 0; i < 3; i++) solid_hold_side(solid, i, 0, i);
    for (int i = 0; i < loaded; i++) solid_hold_side(solid, i, cube[i], i);
    double young = 2e5, s[3] = {stretch, stretch, stretch};
    SolidBody b = solid_body(solid, false, young);
    double(*rest)[3] = solid->tets->surface->rest;
    for (int v = 0; v < tets_node_count(solid->tets); v++)
        for (int i = 0; i < loaded; i++) b.state.x[3 * v + i] *= stretch;
    NewtonDef newton = newton_default();
    newton.step_tol = 1e-12;
    assert_int_equal(solid_solve(&b, &newton).status, NEWTON_CONVERGED);
    solid_free_stretch(material, def.poisson, loaded, s);
    double *gradient = mem_alloc((size_t)solid_dof_count(solid), sizeof *gradient), pull = 0;
    Point at = state_point(&b.state, b.p);
    system_gradient(b.sys, &at, gradient);
    for (int v = 0; v < tets_node_count(solid->tets); v++) {
        for (int i = 0; i < 3; i++)
            assert_true(fabs(b.state.x[3 * v + i] - s[i] * rest[v][i]) < 1e-11 * cube[0]);
        if (rest[v][0] > cube[0] - 1e-9) pull += gradient[3 * v];
    }
    double expected = young * solid_stress(material, def.poisson, s, 0) * cube[1] * cube[2];
    assert_true(fabs(pull - expected) < 1e-9 * fabs(expected));
    mem_free(gradient);
    solid_body_clear(&b);
}

static void test_stretch(void **state)
{
    (void)state;
    static const double stretches[] = {0.9, 1.2};
    for (int k = 0; k < 2 * 3 * 2 * 2; k++)
        check_stretch((SolidMaterial)(k % 3), 1 + k / 3 % 2, 1 + k / 6 % 2, stretches[k / 12]);
}

/* ---- Rigid motions ---- */

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Eigenvalues of a symmetric a[n][n], ascending, by rotations [Jacobi 1846]; a is lost. */
static void eigenvalues(int n, double *a, double *values)
{
    for (int sweep = 0; sweep < 30; sweep++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < i; j++) {
                double angle = 0.5 * atan2(2 * a[i * n + j], a[j * n + j] - a[i * n + i]);
                double c = cos(angle), s = sin(angle);
                for (int k = 0; k < n; k++) {
                    double x = a[j * n + k], y = a[i * n + k];
                    a[j * n + k] = c * x + s * y, a[i * n + k] = c * y - s * x;
                }
                for (int k = 0; k < n; k++) {
                    double x = a[k * n + j], y = a[k * n + i];
                    a[k * n + j] = c * x + s * y, a[k * n + i] = c * y - s * x;
                }
            }
    for (int i = 0; i < n; i++) values[i] = a[i * n + i];
    qsort(values, (size_t)n, sizeof *values, compare_numbers);
}

static MeshFile one_tet(void)
{
    static const double places[4][3] = {
        {0, 0, 0}, {0.012, 0.001, 0}, {0.002, 0.01, 0}, {0.003, 0.002, 0.011}};
    MeshFile file = {.path = mem_text("tet"), .vertex_count = 4, .cell_count = 1, .cell_nodes = 4};
    file.vertices = mem_copy(places, 4, sizeof *places);
    file.cells = mem_copy((int[]){0, 1, 2, 3}, 4, sizeof *file.cells);
    return file;
}

static void check_modes(MeshFile file, SolidMaterial material, int order, double averaging)
{
    const SolidDef def = {.material = material, .poisson = 0.45, .density = 1000, .averaging = averaging};
    SolidBody b = solid_body(solid_of_mesh(&file, order, &def, NULL), false, 1e5);
    int n = solid_dof_count(b.solid);
    double *H = mem_alloc((size_t)n * (size_t)n, sizeof *H), *v = mem_alloc(2 * (size_t)n, sizeof *v);
    Point at = state_point(&b.state, b.p);
    Evaluation rest = system_hessian(b.sys, &at, v);
    assert_true(fabs(rest.energy) < 1e-25);
    for (int i = 0; i < n; i++) {
        memset(v, 0, (size_t)n * sizeof *v);
        v[i] = 1;
        system_multiply(b.sys, v, H + i * n);
    }
    eigenvalues(n, H, v);
    for (int i = 0; i < 6; i++) assert_true(fabs(v[i]) < 1e-13 * v[n - 1]);
    assert_true(v[6] > 1e-3 * v[n - 1]);
    mem_free(H), mem_free(v);
    solid_body_clear(&b);
}

static void test_zero_modes(void **state)
{
    (void)state;
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        for (int m = SOLID_NEO_HOOKEAN; m <= SOLID_ST_VENANT_KIRCHHOFF; m++) {
            check_modes(one_tet(), (SolidMaterial)m, order, 0);
            check_modes(box_mesh(cube, (int[]){1, 1, 1}, 0), (SolidMaterial)m, order, 0);
        }
        check_modes(one_tet(), SOLID_NEO_HOOKEAN, order, 1);
        check_modes(box_mesh(cube, (int[]){1, 1, 1}, 0), SOLID_NEO_HOOKEAN, order, 1);
    }
}

/* ---- Stiffness without negative parts ---- */

/* The law's Hessian in F: with the axes for gradients. */
static void law_hessian(SolidMaterial material, const double F[3][3], bool clamped, double A[81])
{
    const Law *law = law_of(material);
    Lame lame = lame_of(0.45);
    LawPoint at = {.weight = pack_set(1)};
    Pack3 *rows[3] = {&at.F.r0, &at.F.r1, &at.F.r2};
    for (int i = 0; i < 3; i++) {
        *rows[i] = pack3(pack_set(F[i][0]), pack_set(F[i][1]), pack_set(F[i][2]));
        at.gradient[i] = pack3(pack_set(i == 0), pack_set(i == 1), pack_set(i == 2));
    }
    at.cofactor = tet_cofactor(&at.F);
    at.J = pack3_dot(at.F.r0, at.cofactor.r0);
    Pack H[TERM_LOWER(9, 0)] = {{0}};
    if (clamped)
        law_clamped_stiffness(law, lame, &at, 1, 3, H);
    else
        law->stiffness(lame, &at, 1, 3, H);
    for (int i = 0; i < 9; i++)
        for (int j = 0; j <= i; j++) A[9 * i + j] = A[9 * j + i] = H[TERM_LOWER(i, j)][3];
}

/* Of all matrices that are >= A and >= 0, A's part without negative eigenvalues is the one with the least trace. */
static void check_clamped(SolidMaterial material, const double F[3][3])
{
    double A[81], clamped[81], difference[81], values[9], trace = 0, positive = 0;
    law_hessian(material, F, false, A);
    law_hessian(material, F, true, clamped);
    for (int i = 0; i < 81; i++) difference[i] = clamped[i] - A[i];
    for (int i = 0; i < 9; i++) trace += clamped[10 * i];
    eigenvalues(9, A, values);
    for (int i = 0; i < 9; i++) positive += fmax(values[i], 0);
    double tiny = 1e-12 * (fabs(values[0]) + fabs(values[8]));
    assert_true(fabs(trace - positive) < tiny);
    eigenvalues(9, clamped, values);
    assert_true(values[0] > -tiny);
    eigenvalues(9, difference, values);
    assert_true(values[0] > -tiny);
}

static void test_clamped(void **state)
{
    (void)state;
    static const double special[][3][3] = {
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},   {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
        {{1, 2, 0}, {0, 0, 0}, {0.5, 1, 3}}, {{1, 2, 3}, {2, 4, 6}, {0, 0, 0}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},   {{0, 2, 0}, {2, 0, 0}, {0, 0, 2}}};
    Random random = random_seed(11);
    int turned = 0;
    for (int m = SOLID_NEO_HOOKEAN; m <= SOLID_ST_VENANT_KIRCHHOFF; m++)
        for (int k = 0; k < 200; k++) {
            double F[3][3];
            for (int i = 0; i < 9; i++) F[i / 3][i % 3] = 1.5 * random_signed(&random);
            if (k < 6) memcpy(F, special[k], sizeof F);
            double J = F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) -
                       F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
                       F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
            if (m == SOLID_NEO_HOOKEAN_LOG && !(J > 0.01)) continue;
            turned += J <= 0;
            check_clamped((SolidMaterial)m, (const double(*)[3])F);
        }
    assert_true(turned > 100);
}

/* ---- Patch test ---- */

/* What is linear on the surface is so within. */
static void check_patch(SolidMaterial material, int order, double averaging)
{
    static const double map[3][3] = {{1.1, 0.05, -0.02}, {0.03, 0.95, 0.04}, {-0.01, 0.02, 1.05}};
    const SolidDef def = {.material = material, .poisson = 0.4, .density = 1000, .averaging = averaging};
    MeshFile file = box_mesh(cube, (int[]){3, 3, 3}, 0.3);
    Solid *solid = solid_of_mesh(&file, order, &def, NULL);
    for (int k = 0; k < 18; k++) solid_hold_side(solid, k / 6, k % 2 * cube[0], k / 2 % 3);
    SolidBody b = solid_body(solid, false, 1e5), moved = b;
    moved.state = system_state(b.sys);
    solid_map(&moved, map);
    int inside = 0;
    for (int i = 0; i < solid_dof_count(solid); i++) {
        if (solid->fixed[i]) b.state.x[i] = moved.state.x[i];
        inside += !solid->fixed[i];
    }
    assert_true(inside >= 24);
    NewtonDef newton = newton_default();
    newton.step_tol = 1e-12;
    assert_int_equal(solid_solve(&b, &newton).status, NEWTON_CONVERGED);
    for (int i = 0; i < solid_dof_count(solid); i++)
        assert_true(fabs(b.state.x[i] - moved.state.x[i]) < 1e-12 * cube[0]);
    state_destroy(&moved.state);
    solid_body_clear(&b);
}

static void test_patch(void **state)
{
    (void)state;
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        for (int m = SOLID_NEO_HOOKEAN; m <= SOLID_ST_VENANT_KIRCHHOFF; m++)
            check_patch((SolidMaterial)m, order, 0);
        check_patch(SOLID_NEO_HOOKEAN, order, 0.6);
    }
}

/* ---- Masses, momenta ---- */

static void check_flight(int order)
{
    const SolidDef def = {.poisson = 0.4, .density = 1100};
    SolidBody b = solid_body(solid_box(cube, (int[]){2, 2, 2}, order, &def), true, 1e5);
    int nodes = tets_node_count(b.solid->tets);
    Masses masses = solid_masses(b.solid);
    double *mass = masses.fixed, total = 0, before[3] = {0}, size = 0;
    Random random = random_seed(5);
    for (int i = 0; i < 3 * nodes; i++) {
        total += mass[i / 3] / 3;
        b.state.v[i] = 0.2 + 0.5 * random_signed(&random);
        before[i % 3] += mass[i / 3] * b.state.v[i];
        size += mass[i / 3] * fabs(b.state.v[i]);
    }
    double expected = def.density * cube[0] * cube[1] * cube[2];
    assert_true(fabs(total - expected) < 1e-12 * expected);
    MarchDef march = march_default();
    march.newton.step_tol = 1e-12;
    MarchInfo info = {0};
    for (int step = 0; step < 20; step++) assert_true(march_step(b.sys, &march, 1e-3, b.p, &b.state, &info));
    for (int i = 0; i < 3 * nodes; i++) before[i % 3] -= mass[i / 3] * b.state.v[i];
    for (int i = 0; i < 3; i++) assert_true(fabs(before[i]) < 1e-11 * size);
    masses_clear(&masses);
    solid_body_clear(&b);
}

static void test_flight(void **state)
{
    (void)state;
    check_flight(TET_LINEAR);
    check_flight(TET_QUADRATIC);
}

/* ---- Inside out ---- */

static void test_least_jacobian(void **state)
{
    (void)state;
    const SolidDef def = {.poisson = 0.4, .density = 1000};
    static const double map[3][3] = {{1.2, 0.3, 0}, {0, -1.1, 0}, {0.2, 0, 0.9}};
    for (int order = TET_LINEAR; order <= TET_QUADRATIC; order++) {
        SolidBody b = solid_body(solid_box(cube, (int[]){2, 2, 2}, order, &def), false, 1e5);
        assert_true(fabs(solid_least_jacobian(b.solid, b.state.x, NULL) - 1) < 1e-13);
        solid_map(&b, map);
        assert_true(fabs(solid_least_jacobian(b.solid, b.state.x, NULL) + 1.2 * 1.1 * 0.9) < 1e-13);
        solid_body_clear(&b);
    }
    /* a middle node at a fifth of its edge: dx/ds = 4/5 - 1 at the start, in parts of the edge */
    MeshFile file = one_tet();
    SolidBody b = solid_body(solid_of_mesh(&file, TET_QUADRATIC, &def, NULL), false, 1e5);
    double *x = b.state.x;
    int middle = b.solid->tets->nodes[4], from = b.solid->tets->nodes[0], to = b.solid->tets->nodes[1],
        tet = -1;
    for (int i = 0; i < 3; i++) x[3 * middle + i] = 0.8 * x[3 * from + i] + 0.2 * x[3 * to + i];
    assert_true(fabs(solid_least_jacobian(b.solid, x, &tet) + 0.2) < 1e-13);
    assert_int_equal(tet, 0);
    solid_body_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivatives),    cmocka_unit_test(test_stretch),
        cmocka_unit_test(test_zero_modes),     cmocka_unit_test(test_clamped),
        cmocka_unit_test(test_patch),          cmocka_unit_test(test_flight),

        cmocka_unit_test(test_least_jacobian),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
