/* A solid's skin: its magnetisation, its film, and derivatives of equilibria with both. */
#include "base/vec3.h"
#include "optim/implicit.h"
#include "solid/terms.h"
#include "surface/face.h"
#include "tests/solid_fixture.h"

static const double cube[3] = {0.02, 0.02, 0.02};

static int term_of(const SolidBody *b, const char *name)
{
    for (int t = 0; t < system_term_count(b->sys); t++)
        if (!strcmp(system_term(b->sys, t)->ops->name, name)) return t;
    fail_msg("there is no term %s", name);
    return -1;
}

/* ---- Magnetised ---- */

/* -A h (F0 M).B of a face under a linear map, F0 M = map (M - (N.M) N) + (N.M) n. */
static double face_energy(const Solid *solid, int face, const double map[3][3], const double *p)
{
    const Mesh *mesh = solid->tets->surface;
    const double *M = p + solid->magnetization + 3 * face, *B = p + solid->flux.uniform;
    Vec3 x[3], X[3];
    for (int i = 0; i < 3; i++) {
        X[i] = vec3_load(mesh->rest[mesh->faces[face][i]]);
        x[i] = vec3(vec3_dot(vec3_load(map[0]), X[i]), vec3_dot(vec3_load(map[1]), X[i]),
                    vec3_dot(vec3_load(map[2]), X[i]));
    }
    Vec3 N = vec3_cross(vec3_sub(X[1], X[0]), vec3_sub(X[2], X[0])),
         n = vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0]));
    double area = 0.5 * vec3_length(N), up;
    N = vec3_scale(0.5 / area, N), n = vec3_scale(1 / vec3_length(n), n);
    up = vec3_dot(N, vec3_load(M));
    Vec3 flat = vec3_sub(vec3_load(M), vec3_scale(up, N));
    Vec3 Q = vec3(vec3_dot(vec3_load(map[0]), flat), vec3_dot(vec3_load(map[1]), flat),
                  vec3_dot(vec3_load(map[2]), flat));
    return -area * solid->skin * vec3_dot(vec3_add(Q, vec3_scale(up, n)), vec3_load(B));
}

/* Every face bears its own magnetisation, in one or in four; or none. */
static void check_skin(int order, bool part)
{
    static const double map[3][3] = {{0.9, 0.3, -0.1}, {-0.2, 1.1, 0.2}, {0.1, -0.3, 1.05}};
    const SolidDef def = {.poisson = 0.4, .density = 1000, .skin = 1e-3};
    Solid *solid = solid_box(cube, (int[]){2, 1, 1}, order, &def);
    int faces = solid->tets->surface->face_count;
    if (part) solid->skin_on = mem_alloc((size_t)faces, sizeof(bool));
    for (int f = 0; part && f < faces; f++) solid->skin_on[f] = f % 3 == 0;
    SolidBody b = solid_body(solid, false, 1e5);
    Random random = random_seed(9);
    for (int i = 0; i < 3 * faces; i++) b.p[solid->magnetization + i] = 1e5 * random_signed(&random);
    for (int i = 0; i < 3; i++) b.p[solid->flux.uniform + i] = 0.05 * random_signed(&random);
    solid_map(&b, map);
    Point at = state_point(&b.state, b.p);
    double expected = 0, energy = system_term_energy(b.sys, term_of(&b, "magnetic"), &at, NULL);
    for (int f = 0; f < faces; f++)
        if (!part || f % 3 == 0) expected += face_energy(solid, f, map, b.p);
    assert_true(fabs(expected) > 1e-8 && fabs(energy - expected) < 1e-12 * fabs(expected));
    solid_body_clear(&b);
}

static void test_skin(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) check_skin(1 + k % 2, k / 2);
}

/* ---- Film ---- */

/* The axis that a face of a box is across. */
static int face_axis(const Mesh *surface, int face)
{
    FaceFrame frame = face_frame(surface->rest, surface->faces[face]);
    int axis = 0;
    while (fabs(frame.normal[axis]) < 0.5) axis++;
    return axis;
}

/* A box pulled along x, with a film on the four sides along it whose Poisson's ratio is just what the box becomes narrower by:
 * the film pulls along x only, and the box stays a box. Sides across y and across z have moduli of their own. */
static void check_film(int order)
{
    double s[3] = {1.15}, young = 1e5, film[3] = {1e9, 2e6, 5e6};
    solid_free_stretch(SOLID_NEO_HOOKEAN, 0.4, 1, s);
    const SolidDef def = {.poisson = 0.4,
                          .density = 1000,
                          .skin = 5e-4,
                          .film = true,
                          .film_poisson = (1 - s[1] * s[1]) / (s[0] * s[0] - 1)};
    Solid *solid = solid_box(cube, (int[]){2, 2, 2}, order, &def);
    const Mesh *surface = solid->tets->surface;
    solid->skin_on = mem_alloc((size_t)surface->face_count, sizeof(bool));
    for (int i = 0; i < 3; i++) solid_hold_side(solid, i, 0, i);
    solid_hold_side(solid, 0, cube[0], 0);
    for (int f = 0; f < surface->face_count; f++) solid->skin_on[f] = face_axis(surface, f) != 0;
    SolidBody b = solid_body(solid, false, young);
    for (int f = 0; f < surface->face_count; f++) b.p[solid->skin_young + f] = film[face_axis(surface, f)];
    for (int v = 0; v < tets_node_count(solid->tets); v++) b.state.x[3 * v] *= s[0];
    NewtonDef newton = newton_default();
    newton.step_tol = 1e-12;
    assert_int_equal(solid_solve(&b, &newton).status, NEWTON_CONVERGED);
    double *gradient = mem_alloc((size_t)solid_dof_count(solid), sizeof *gradient), pull = 0;
    Point at = state_point(&b.state, b.p);
    system_gradient(b.sys, &at, gradient);
    for (int v = 0; v < tets_node_count(solid->tets); v++) {
        const double *X = surface->rest[v];
        for (int i = 0; i < 3; i++) assert_true(fabs(b.state.x[3 * v + i] - s[i] * X[i]) < 1e-11 * cube[0]);
        if (X[0] > cube[0] - 1e-9) pull += gradient[3 * v];
    }
    double strain = (s[0] * s[0] - 1) / 2, side = cube[0],
           expected = young * solid_stress(SOLID_NEO_HOOKEAN, 0.4, s, 0) * side * side,
           of_film = 2 * side * solid->skin * (film[1] + film[2]) * strain * s[0],
           energy = side * side * solid->skin * (film[1] + film[2]) * strain * strain;
    assert_true(of_film > 0.5 * expected && fabs(pull - expected - of_film) < 1e-9 * expected);
    assert_true(fabs(system_term_energy(b.sys, term_of(&b, "membrane"), &at, NULL) - energy) < 1e-9 * energy);
    mem_free(gradient);
    solid_body_clear(&b);
}

static void test_film(void **state)
{
    (void)state;
    check_film(TET_LINEAR);
    check_film(TET_QUADRATIC);
}

/* ---- Derivatives of an equilibrium ---- */

/* A block held on one side, pulled and bent by loads and fields, with all that may enter. */
static SolidBody pulled(int order, Random *random)
{
    const SolidDef def = {.poisson = 0.45,
                          .density = 1000,
                          .skin = 1e-3,
                          .film = true,
                          .film_poisson = 0.3,
                          .averaging = 0.5,
                          .film_material =
                              order == TET_LINEAR ? MEMBRANE_ST_VENANT_KIRCHHOFF : MEMBRANE_NEO_HOOKEAN};
    Solid *solid = solid_box((double[]){0.04, 0.01, 0.01}, (int[]){4, 1, 1}, order, &def);
    for (int i = 0; i < 3; i++) solid_hold_side(solid, 0, 0, i);
    SolidBody b = solid_body(solid, false, 1e5);
    for (int t = 0; t < solid->tets->count; t++) {
        b.p[solid->young + t] *= 1 + random_uniform(random);
        for (int i = 0; i < 3; i++)
            b.p[solid->volume_magnetization + 3 * t + i] = 1e4 * random_signed(random);
    }
    for (int f = 0; f < solid->tets->surface->face_count; f++) {
        b.p[solid->skin_young + f] = 1e5 * (1 + random_uniform(random));
        for (int i = 0; i < 3; i++) b.p[solid->magnetization + 3 * f + i] = 1e5 * random_signed(random);
    }
    for (int i = 0; i < solid_dof_count(solid); i++) b.p[solid->load + i] = 1e-3 * random_signed(random);
    b.p[solid->flux.uniform + 2] = 0.03, b.p[solid->gravity + 1] = -9.81;
    return b;
}

/* Of a random objective g.x: its slope along each block of parameters, back by one solve and forth by another. */
static void check_adjoint(int order)
{
    Random random = random_seed(12);
    SolidBody b = pulled(order, &random);
    NewtonDef newton = newton_default();
    newton.step_tol = 1e-12;
    assert_int_equal(solid_solve(&b, &newton).status, NEWTON_CONVERGED);
    int dofs = solid_dof_count(b.solid), size = b.solid->params.size;
    double *g = mem_alloc(3 * (size_t)dofs, sizeof *g), *w = g + dofs, *dx = w + dofs,
           *back = mem_alloc(2 * (size_t)size, sizeof *back), *dp = back + size;
    Point at = state_point(&b.state, b.p);
    system_hessian(b.sys, &at, w);
    assert_true(system_factor(b.sys, 0));
    for (int i = 0; i < dofs; i++) w[i] = g[i] = random_signed(&random);
    implicit_adjoint(b.sys, &at, w, back);
    for (int k = 0; k < b.solid->params.block_count; k++) {
        const ParamBlock *block = &b.solid->params.blocks[k];
        double forth = 0, product = 0, sum = 0;
        memset(dp, 0, (size_t)size * sizeof *dp);
        for (int i = block->offset; i < block->offset + block->count * block->width; i++) {
            dp[i] = random_signed(&random);
            product += back[i] * dp[i], sum += fabs(back[i] * dp[i]);
        }
        implicit_tangent(b.sys, &at, dp, dx);
        for (int i = 0; i < dofs; i++) forth += g[i] * dx[i];
        print_message("%-20s %.3e  off by %.1e of its terms\n", block->name, forth,
                      sum > 0 ? fabs(forth - product) / sum : 0);
        assert_true(fabs(forth - product) <= 1e-11 * sum);
        assert_true(sum > 0 || !strcmp(block->name, "damping") || block->count == 0);
    }
    mem_free(g), mem_free(back);
    solid_body_clear(&b);
}

static void test_adjoint(void **state)
{
    (void)state;
    check_adjoint(TET_LINEAR);
    check_adjoint(TET_QUADRATIC);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_skin), cmocka_unit_test(test_film),
                                       cmocka_unit_test(test_adjoint)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
