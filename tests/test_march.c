/* Implicit Euler: a linear oscillator's amplitude and phase, the momenta of a free sheet, cut steps. */
#include "base/random.h"
#include "base/vec3.h"
#include "solve/element.h"
#include "solve/kinetic.h"
#include "solve/march.h"
#include "tests/shell_fixture.h"
#include <complex.h>
#include <math.h>
#include <string.h>

/* A spring of stiffness k from the origin to one vertex: E = k/2 |x|^2. */
static int spring_count(const void *self)
{
    return (void)self, 1;
}
static int spring_size(const void *self)
{
    return (void)self, 3;
}

static void spring_dofs(const void *self, int e, int *dof)
{
    (void)self, (void)e;
    for (int i = 0; i < 3; i++) dof[i] = i;
}

static Pack spring_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    (void)pack, (void)at;
    double k = *(const double *)self;
    Pack energy = {0};
    if (H) element_clear(H, 3);
    for (int i = 0; i < 3; i++) {
        energy += k / 2 * x[i] * x[i];
        if (g) g[i] = k * x[i];
        if (H) H[TERM_LOWER(i, i)] = pack_set(k);
    }
    return energy;
}

static void spring_destroy(void *self)
{
    (void)self;
}

static const TermOps spring_ops = {.name = "spring",
                                   .count = spring_count,
                                   .size = spring_size,
                                   .dofs = spring_dofs,
                                   .eval = spring_eval,
                                   .destroy = spring_destroy};

/* x_n = Re(A l^n), l = 1/(1 - i w dt): the amplitude falls by (1 + w^2 dt^2)^(-1/2) and turns by atan(w dt)
 * each step. */
static void test_oscillator(void **state)
{
    (void)state;
    double k = 40, mass = 0.1, dt = 0.01, w = sqrt(k / mass), p[1] = {0}, worst = 0;
    System *sys = system_create(3, &(DofClass){.count = 3, .size = 1}, 1);
    system_add(sys, (Term){&spring_ops, &k});
    system_add(sys, kinetic_inertia_term(masses_fixed(1, &mass)));
    system_prepare(sys);
    MarchDef def = march_default();
    State now = system_state(sys);
    now.x[0] = 1;
    double complex l = 1 / (1 - I * w * dt);
    assert_true(fabs(cabs(l) - 1 / sqrt(1 + w * w * dt * dt)) < 1e-15 &&
                fabs(carg(l) - atan(w * dt)) < 1e-15);
    /* x_0 = 1 and x_-1 = x_0 - dt v_0 = 1: Re A = 1, Re(A/l) = 1 */
    double complex inverse = 1 / l, A = 1 + I * (creal(inverse) - 1) / cimag(inverse);
    for (int n = 1; n <= 100; n++) {
        MarchInfo info;
        assert_true(march_step(sys, &def, dt, p, &now, &info));
        worst = fmax(worst, fabs(now.x[0] - creal(A * cpow(l, n))));
    }
    print_message("oscillator: off by %.1e of the amplitude after 100 steps\n", worst);
    assert_true(worst < 1e-10 && fabs(now.time - 1) < 1e-12);
    state_destroy(&now);
    system_destroy(sys);
}

static Body make_sheet(void)
{
    Shell *shell = shell_of_sheet((double[]){0.04, 0.02}, (int[]){8, 4}, PATTERN_ALTERNATE);
    shell->thickness = 1e-3, shell->poisson = 0.3, shell->density = 1000;
    return body_create(shell, shell_dynamic_system(shell), 1e5);
}

static Vec3 momentum(int vertices, const double *mass, const State *state)
{
    Vec3 sum = vec3(0, 0, 0);
    for (int v = 0; v < vertices; v++) sum = vec3_axpy(mass[v], vec3_load(state->v + 3 * v), sum);
    return sum;
}

static Vec3 angular_momentum(int vertices, const double *mass, const State *state)
{
    Vec3 sum = vec3(0, 0, 0);
    for (int v = 0; v < vertices; v++) {
        Vec3 moment = vec3_cross(vec3_load(state->x + 3 * v), vec3_load(state->v + 3 * v));
        sum = vec3_axpy(mass[v], moment, sum);
    }
    return sum;
}

/* A free sheet, spinning and shaking, keeps its momentum; implicit Euler loses angular momentum by the
 * identity L_n - L_{n-1} = dt sum m v_n x v_{n-1}. */
static void test_momenta(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Body s = make_sheet();
    Random random = random_seed(3);
    int vertices = s.shell->mesh->vertex_count;
    double *mass = mem_alloc((size_t)vertices, sizeof *mass);
    shell_vertex_mass(s.shell, s.p, mass);
    for (int v = 0; v < vertices; v++) {
        Vec3 arm = vec3_sub(vec3_load(s.state.x + 3 * v), vec3(0.02, 0.01, 0));
        Vec3 speed = vec3_add(vec3(0.1, 0, 0.05), vec3_cross(vec3(3, 10, 5), arm));
        for (int i = 0; i < 3; i++)
            s.state.v[3 * v + i] = (i == 0   ? speed.x
                                    : i == 1 ? speed.y
                                             : speed.z) +
                                   0.02 * random_signed(&random);
    }
    double *before = mem_alloc(3 * (size_t)vertices, sizeof *before), dt = 2e-3, worst = 0, drift = 0;
    MarchDef def = march_default();
    def.newton.step_tol = 1e-12, def.newton.force_tol = 1e-11;
    Vec3 P = momentum(vertices, mass, &s.state);
    for (int n = 0; n < 20; n++) {
        MarchInfo info;
        Vec3 L = angular_momentum(vertices, mass, &s.state), change = vec3(0, 0, 0);
        memcpy(before, s.state.v, 3 * (size_t)vertices * sizeof *before);
        assert_true(march_step(s.sys, &def, dt, s.p, &s.state, &info));
        for (int v = 0; v < vertices; v++)
            change = vec3_axpy(dt * mass[v],
                               vec3_cross(vec3_load(s.state.v + 3 * v), vec3_load(before + 3 * v)), change);
        Vec3 off = vec3_sub(vec3_sub(angular_momentum(vertices, mass, &s.state), L), change);
        worst = fmax(worst, vec3_length(off) / vec3_length(L));
        drift = fmax(drift, vec3_length(vec3_sub(momentum(vertices, mass, &s.state), P)) / vec3_length(P));
    }
    print_message("free sheet: momentum drifts by %.1e, angular momentum is off its identity by %.1e\n",
                  drift, worst);
    assert_true(drift < 1e-10 && worst < 1e-10);
    mem_free(before);
    mem_free(mass);
    body_clear(&s);
    assert_int_equal(mem_live_count(), blocks);
}

/* No step raises the incremental energy, and one that fails is cut. */
static void count_steps(void *self, const State *state, double dt)
{
    (void)state, (void)dt;
    (*(int *)self)++;
}

static void test_cuts(void **state)
{
    (void)state;
    Body s = make_sheet();
    for (int v = 0; v < s.shell->mesh->vertex_count; v++)
        s.state.v[3 * v + 2] = 40 * sin(80 * s.state.x[3 * v]);
    State start = state_clone(&s.state);
    int stored = 0;
    MarchDef def = march_default();
    def.newton.max_iterations = 12;
    def.stored = count_steps, def.self = &stored;
    MarchInfo info;
    assert_true(march_step(s.sys, &def, 4e-3, s.p, &s.state, &info));
    assert_true(info.refused > 0 && info.steps == stored && stored > 1 && fabs(s.state.time - 4e-3) < 1e-15);
    def.cuts = 0, def.newton.max_iterations = 1;
    assert_false(march_step(s.sys, &def, 4e-3, s.p, &s.state, &info));
    assert_true(fabs(s.state.time - 4e-3) < 1e-15); /* the last state that was reached */
    def = march_default();
    state_copy(&s.state, &start);
    assert_true(march_step(s.sys, &def, 1e-4, s.p, &s.state, &info) && info.steps == 1);
    Point before = state_point(&start, s.p), after = state_point(&s.state, s.p);
    before.x_prev = after.x_prev = start.x, before.v_prev = after.v_prev = start.v;
    before.dt = after.dt = 1e-4;
    assert_true(system_energy(s.sys, &after).energy <= system_energy(s.sys, &before).energy);
    state_destroy(&start);
    body_clear(&s);
}

/* A clamped strip, nu = 0, swinging in its first mode: w = 3.51602 sqrt(EI/(rho A L^4)), seen by implicit
 * Euler as atan(w dt)/dt. */
static void test_strip_frequency(void **state)
{
    (void)state;
    const double L = 0.04, h = 1e-3, young = 6e6, rho = 1000,
                 w = 3.51602 * sqrt(young * h * h / (12 * rho * L * L * L * L));
    MeshFile file;
    Error err;
    assert_true(shape_strip(L, 0.01, 16, PATTERN_ALTERNATE, &file, &err));
    Shell *shell = shell_of_mesh(&file);
    const Mesh *mesh = shell->mesh;
    shell->thickness = h, shell->poisson = 0, shell->density = rho;
    hold_root(shell, true);
    Body s = body_create(shell, shell_dynamic_system(shell), young);
    for (int v = 0; v < mesh->vertex_count; v++) { /* the beam's mode, small */
        double b = 1.8751041 / L, x = mesh->rest[v][0];
        s.state.v[3 * v + 2] = 1e-3 * (cosh(b * x) - cos(b * x) - 0.7340955 * (sinh(b * x) - sin(b * x)));
    }
    const MeshGroup *tip = mesh_group(mesh, "tip", 0);
    double dt = 2 * M_PI / w / 200, before = 0, crossing[2] = {0}, seen = atan(w * dt) / dt;
    int found = 0;
    MarchDef def = march_default();
    for (int n = 0; n < 260 && found < 2; n++) {
        MarchInfo info;
        assert_true(march_step(s.sys, &def, dt, s.p, &s.state, &info));
        double z = s.state.x[3 * tip->members[0] + 2];
        if (n > 0 && z * before < 0) crossing[found++] = s.state.time - dt * z / (z - before);
        before = z;
    }
    assert_int_equal(found, 2);
    double measured = M_PI / (crossing[1] - crossing[0]);
    print_message("strip: %.4f rad/s, exact %.4f (%+.2f %%)\n", measured, seen, 100 * (measured / seen - 1));
    assert_true(fabs(measured / seen - 1) < 0.01);
    body_clear(&s);
}

/* Steps by conjugate gradients with an older factor go where those with a factor each go, and a factor that is made
 * again at its anchor takes the same number of them. */
static void test_older_factor(void **state)
{
    (void)state;
    Body s[3] = {make_sheet(), make_sheet(), make_sheet()};
    int vertices = s[0].shell->mesh->vertex_count, factorizations[3] = {0}, cg[3] = {0};
    size_t dofs = (size_t)shell_dof_count(s[0].shell);
    for (int k = 0; k < 3; k++)
        for (int v = 0; v < vertices; v++) s[k].state.v[3 * v + 2] = 0.5 * sin(80 * s[k].state.x[3 * v]);
    MarchDef def = march_default(), direct = def;
    direct.newton.cg_iterations = 0;
    for (int n = 0; n < 30; n++) {
        MarchInfo info;
        for (int k = 0; k < 3; k++) {
            assert_true(march_step(s[k].sys, k == 1 ? &direct : &def, 1e-4, s[k].p, &s[k].state, &info));
            factorizations[k] += info.newton.factorizations, cg[k] += info.newton.cg_iterations;
        }
        if (n != 14) continue; /* the third begins anew on another system */
        System *other = shell_dynamic_system(s[2].shell);
        double *anchor =
            mem_copy(system_anchor(s[2].sys), (size_t)system_anchor_count(s[2].sys), sizeof *anchor);
        system_destroy(s[2].sys);
        s[2].sys = other;
        system_restore_factor(other, anchor, s[2].p);
        mem_free(anchor);
    }
    double worst = 0;
    for (int i = 0; i < 3 * vertices; i++) worst = fmax(worst, fabs(s[0].state.x[i] - s[1].state.x[i]));
    print_message("30 steps: %d factorisations and %d conjugate gradients, or %d; off by %.1e m\n",
                  factorizations[0], cg[0], factorizations[1], worst);
    assert_true(worst < 1e-9 && factorizations[0] < factorizations[1] / 4 && cg[1] == 0);
    assert_memory_equal(s[0].state.x, s[2].state.x, dofs * sizeof(double));
    assert_int_equal(cg[0], cg[2]);
    for (int k = 0; k < 3; k++) body_clear(&s[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_oscillator), cmocka_unit_test(test_momenta),
                                       cmocka_unit_test(test_strip_frequency), cmocka_unit_test(test_cuts),
                                       cmocka_unit_test(test_older_factor)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
