/* A magnetic skin on a bare mesh: the term knows no shell, and its vertices are some of a body's. */
#include "base/memory.h"
#include "base/quat.h"
#include "solve/check.h"
#include "solve/params.h"
#include "solve/system.h"
#include "surface/magnetic.h"
#include "tests/flux_fixture.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

enum { VERTICES = 7, DOFS = 3 * VERTICES, FACES = 2 };

static const double SIDE = 0.02;

/* A square of four of the vertices; its faces are not of the same thickness, nor the same way round. */
typedef struct Skin {
    double rest[VERTICES][3], volume[FACES];
    int faces[FACES][3];
    FluxFields fields;
    Params params;
    int magnetization;
    FluxBlocks flux;
    double *p;
    System *sys;
} Skin;

static FluxField *linear_field(void)
{
    static const char *const expressions[] = {"2*x-y", "3*z-x", "0.5*y-2*z"};
    static const char *const variables[] = {"x", "y", "z", "r", "t", NULL};
    return flux_field_formula(formula_create(expressions, 3, NULL, 0, variables, NULL), SIDE);
}

static Vec3 linear_at(Vec3 x)
{
    return vec3(2 * x.x - x.y, 3 * x.z - x.x, 0.5 * x.y - 2 * x.z);
}

static void lay_out(Skin *s, Random *random)
{
    flux_fields_add(&s->fields, linear_field());
    flux_fields_add(&s->fields, flux_field_dipole((double[]){0, 0, -0.05}, (double[]){0.3, 0.1, 0.2}));
    s->magnetization = params_add(&s->params, "magnetization", "A/m", FACES, 3, false);
    s->flux.uniform = params_add(&s->params, "flux_density", "T", 1, 3, true);
    s->flux = flux_blocks_add(&s->params, &s->fields, s->flux.uniform);
    s->p = params_vector(&s->params);
    flux_blocks_default(&s->fields, &s->flux, s->p);
    s->p[s->flux.scale + 1] = 0;
    for (int i = 0; i < 3 * FACES; i++) s->p[s->magnetization + i] = 5e4 * random_signed(random);
    for (int i = 0; i < 3; i++) s->p[s->flux.uniform + i] = 0.05 * random_signed(random);
}

static void make(Skin *s, Random *random)
{
    static const int faces[FACES][3] = {{5, 1, 6}, {6, 5, 3}};
    static const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, thickness[FACES] = {1e-3, 3e-3};
    *s = (Skin){.volume = {0}};
    for (int i = 0; i < DOFS; i++) s->rest[i / 3][i % 3] = random_signed(random);
    for (int k = 0; k < 4; k++)
        vec3_store(s->rest[(int[]){5, 1, 6, 3}[k]], vec3(SIDE * corners[k][0], SIDE * corners[k][1], 0));
    memcpy(s->faces, faces, sizeof faces);
    for (int f = 0; f < FACES; f++) s->volume[f] = SIDE * SIDE / 2 * thickness[f];
    lay_out(s, random);
    s->sys = system_create(DOFS, &(DofClass){.count = DOFS, .size = SIDE}, 1);
    FaceLayer layer = {.count = FACES,
                       .faces = mem_copy(faces, FACES, sizeof *faces),
                       .rows = mem_copy((int[]){0, 1}, FACES, sizeof(int)),
                       .volume = mem_copy(s->volume, FACES, sizeof(double)),
                       .thickness = -1,
                       .rest = s->rest};
    system_add(s->sys, magnetic_surface_term(layer, &(MagneticSurfaceDef){.magnetization = s->magnetization,
                                                                          .flux = s->flux,
                                                                          .fields = &s->fields}));
    system_prepare(s->sys);
}

static void clear(Skin *s)
{
    system_destroy(s->sys);
    flux_fields_clear(&s->fields);
    params_clear(&s->params);
    mem_free(s->p);
}

/* -sum_f V_f (R M_f).B(x_f), B at the face's barycentre, of the skin turned by R and moved. */
static double closed_form(const Skin *s, Quat turn, const double *x)
{
    double energy = 0;
    for (int f = 0; f < FACES; f++) {
        Vec3 middle = vec3(0, 0, 0), B = vec3_load(s->p + s->flux.uniform),
             M = quat_rotate(turn, vec3_load(s->p + s->magnetization + 3 * f));
        for (int i = 0; i < 3; i++) middle = vec3_axpy(1.0 / 3, vec3_load(x + 3 * s->faces[f][i]), middle);
        B = vec3_axpy(s->p[s->flux.scale], linear_at(middle), B);
        energy -= s->volume[f] * vec3_dot(M, B);
    }
    return energy;
}

/* In a uniform field, and in one that varies too; vertices that are not of the skin feel nothing. */
static void test_tilted(void **unused)
{
    (void)unused;
    long blocks = mem_live_count();
    Random random = random_seed(6);
    Skin s;
    make(&s, &random);
    State state = system_state(s.sys);
    double g[DOFS];
    Quat turn = quat_exp(vec3(0.7, -0.4, 1.1));
    for (int v = 0; v < VERTICES; v++)
        vec3_store(state.x + 3 * v,
                   vec3_add(vec3(0.01, 0.02, -0.01), quat_rotate(turn, vec3_load(s.rest[v]))));
    for (int varies = 0; varies < 2; varies++) {
        s.p[s.flux.scale] = 0.8 * varies;
        Point at = state_point(&state, s.p);
        double energy = system_gradient(s.sys, &at, g).energy, expected = closed_form(&s, turn, state.x);
        print_message("%s field: %.3g J, %.1e of it off\n", varies ? "varying" : "uniform", expected,
                      fabs(energy / expected - 1));
        assert_true(fabs(energy - expected) <= 1e-13 * fabs(expected));
        for (int i = 0; i < DOFS; i++) assert_true(i / 3 == 6 || i / 3 % 2 || g[i] == 0);
    }
    state_destroy(&state);
    clear(&s);
    assert_int_equal(mem_live_count(), blocks);
}

/* Of any shape, with one field on and one off, of which the term is to know what it would do. */
static void test_derivatives(void **unused)
{
    (void)unused;
    Random random = random_seed(8);
    Skin s;
    make(&s, &random);
    State state = system_state(s.sys);
    double dof_size[9];
    for (int i = 0; i < 9; i++) dof_size[i] = SIDE / 10;
    for (int i = 0; i < DOFS; i++) state.x[i] = s.rest[i / 3][i % 3] + SIDE / 10 * random_signed(&random);
    for (int on = 0; on < 2; on++) {
        disturb_fields(&s.fields, &s.flux, 2e-3, &random, s.p);
        s.p[s.flux.scale + on] = 1, s.p[s.flux.scale + 1 - on] = 0;
        Point at = state_point(&state, s.p);
        TermError error = check_term(system_term(s.sys, 0), &s.params, &at, DOFS, dof_size, &random);
        print_message("gradient %.1e  hessian %.1e  param_forward %.1e  param %.1e\n", error.gradient,
                      error.hessian, error.forward, error.adjoint);
        assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
    }
    state_destroy(&state);
    clear(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_tilted), cmocka_unit_test(test_derivatives)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
