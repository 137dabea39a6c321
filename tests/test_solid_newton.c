/* Equilibria of solids that are hard to find: a bar of 40 x 10 x 10 mm, 12 x 3 x 3 cells, twisted, crushed, stretched, thrown
 * together. Iterations are those of docs/newton.md, and a third more. All
 * but the last one end with det F > 0. */
#include "tests/solid_fixture.h"

static const double size[3] = {0.04, 0.01, 0.01};

typedef void Start(const double X[3], bool fixed, double x[3], Random *random);

typedef struct Problem {
    const char *name;
    int order;
    SolidMaterial material;
    double poisson;
    bool both; /* ends are held; else the left one */
    Start *start;
    double magnetization, gravity; /* A/m, of the skin, along the bar; m/s^2 */
    double least, energy;          /* det F is more at the end; J; 0: at rest, -1: of several  */
    int iterations;
} Problem;

static void twist(const double X[3], double angle, double x[3])
{
    double y = X[1] - 0.005, z = X[2] - 0.005;
    x[1] = 0.005 + cos(angle) * y - sin(angle) * z;
    x[2] = 0.005 + sin(angle) * y + cos(angle) * z;
}
static void twist_360(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)fixed, (void)random;
    twist(X, 2 * M_PI * X[0] / size[0], x);
}
static void twist_180_ends(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)random;
    if (fixed && X[0] > 0.02) twist(X, M_PI, x);
}
static void crush(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)fixed, (void)random;
    x[0] = 0.4 * X[0];
}
static void crush_end(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)random;
    if (fixed) x[0] = 0.4 * X[0];
}
static void stretch(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)fixed, (void)random;
    x[0] = 3 * X[0];
}
static void scatter(const double X[3], bool fixed, double x[3], Random *random)
{
    for (int i = 0; !fixed && i < 3; i++) x[i] = X[i] + 4e-3 * random_signed(random);
}
static void mirror(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)random;
    if (!fixed) x[1] = size[1] - X[1];
}
static void rest(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)X, (void)fixed, (void)x, (void)random;
}
static void aside(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)random;
    if (fixed && X[0] > 0.02) x[2] = X[2] + 0.02;
}
static void point(const double X[3], bool fixed, double x[3], Random *random)
{
    (void)X, (void)random;
    for (int i = 0; !fixed && i < 3; i++) x[i] = 0.01;
}

static SolidBody make_body(const Problem *p)
{
    const SolidDef def = {.material = p->material,
                          .poisson = p->poisson,
                          .density = 1000,
                          .skin = p->magnetization > 0 ? 1e-3 : 0};
    Solid *solid = solid_box(size, (int[]){12, 3, 3}, p->order, &def);
    for (int k = 0; k < 3; k++) solid_hold_side(solid, 0, 0, k);
    for (int k = 0; p->both && k < 3; k++) solid_hold_side(solid, 0, size[0], k);
    SolidBody b = solid_body(solid, false, 1e5);
    for (int f = 0; p->magnetization > 0 && f < solid->tets->surface->face_count; f++)
        b.p[solid->magnetization + 3 * f] = p->magnetization;
    b.p[solid->flux.uniform] = -0.05, b.p[solid->flux.uniform + 2] = 1e-3;
    b.p[solid->gravity + 2] = -p->gravity;
    Random random = random_seed(3);
    for (int v = 0; v < tets_node_count(solid->tets); v++)
        p->start(solid->tets->surface->rest[v], solid->fixed[3 * v], b.state.x + 3 * v, &random);
    return b;
}

static void check(const Problem *p)
{
    SolidBody b = make_body(p);
    NewtonDef newton = newton_default();
    double start = solid_least_jacobian(b.solid, b.state.x, NULL);
    NewtonInfo info = solid_solve(&b, &newton);
    double least = solid_least_jacobian(b.solid, b.state.x, NULL);
    print_message("%-24s det F %5.2f, then %5.2f  %-10s %3d iterations, %3d factorisations, %.4g mJ\n",
                  p->name, start, least, newton_status_name(info.status), info.iterations,
                  info.factorizations, 1e3 * info.energy);
    assert_int_equal(info.status, p->least < 0 ? NEWTON_TANGLED : NEWTON_CONVERGED);
    assert_true(least > p->least && (least > 0) == (info.status == NEWTON_CONVERGED));
    if (p->energy >= 0) assert_true(fabs(info.energy - p->energy) <= 1e-3 * p->energy + 1e-15);
    assert_true(info.iterations <= p->iterations * 4 / 3);
    solid_body_clear(&b);
}

static void test_hard(void **state)
{
    (void)state;
    const SolidMaterial stable = SOLID_NEO_HOOKEAN, ln = SOLID_NEO_HOOKEAN_LOG;
    const Problem problems[] = {
        {"1 twisted once", 1, stable, .45, true, twist_360, 0, 0, 0, 42.5e-3, 6},
        {"2 end turned half", 1, stable, .45, true, twist_180_ends, 0, 0, 0, 10.12e-3, 44},
        {"3 twisted once, T10", 2, stable, .45, true, twist_360, 0, 0, 0, 25.36e-3, 5},
        {"4 crushed to 40 %", 1, stable, .45, true, crush, 0, 0, 0, -1, 35},
        {"4 the same, ln", 1, ln, .45, true, crush, 0, 0, 0, 65.8e-3, 40},
        {"5 end moved there", 1, stable, .45, true, crush_end, 0, 0, 0, -1, 41},
        {"6 stretched to 300 %", 1, stable, .45, true, stretch, 0, 0, 0, 503e-3, 23},
        {"7 scattered", 1, stable, .45, false, scatter, 0, 0, 0, 0, 22},
        {"8 mirrored", 1, stable, .45, false, mirror, 0, 0, 0, -1, 50},
        {"9 skin against B, T10", 2, stable, .45, false, rest, 2e5, 0, 0, 5.541e-3, 28},
        {"10 sags under 6 g", 1, stable, .45, false, rest, 0, 60, 0, 0.5998e-3, 10},
        {"11 end moved aside", 1, stable, .49, true, aside, 0, 0, 0, 9.524e-3, 13},
        {"12 in one point, skin", 1, stable, .45, false, point, 1, 0, -1, -1, 100},
    };
    for (size_t k = 0; k < sizeof problems / sizeof *problems; k++) check(&problems[k]);
}

/* A factor of a clamped Hessian is known by its anchor as others are. */
static void test_anchor(void **state)
{
    (void)state;
    const Problem problem = {.order = 2, .poisson = .45, .start = mirror};
    SolidBody b = make_body(&problem), other = make_body(&problem);
    int n = solid_dof_count(b.solid);
    double *work = mem_alloc(4 * (size_t)n, sizeof *work), *gradient = work, *plain = work + n,
           *first = work + 2 * n, *second = work + 3 * n;
    Point at = state_point(&b.state, b.p);
    system_hessian(b.sys, &at, gradient);
    assert_true(system_tangles(b.sys, &at) && !system_factor(b.sys, 0.01));
    system_multiply(b.sys, gradient, plain);
    at.tangled = true;
    system_hessian(b.sys, &at, gradient);
    assert_true(system_factor(b.sys, 0.01));
    system_multiply(b.sys, gradient, first);
    assert_true(memcmp(plain, first, (size_t)n * sizeof *plain) != 0);
    system_build(other.sys);
    system_restore_factor(other.sys, system_anchor(b.sys), other.p);
    system_solve(b.sys, gradient, first);
    system_solve(other.sys, gradient, second);
    assert_memory_equal(first, second, (size_t)n * sizeof *first);
    mem_free(work);
    solid_body_clear(&b);
    solid_body_clear(&other);
}

/* A last step that no rounding lets be so small: the end is as good as it can be, soon, and converged. */
static void test_rounding(void **state)
{
    (void)state;
    const Problem problem = {.order = 1, .poisson = .45, .start = rest, .gravity = 60};
    double last[2];
    for (int k = 0; k < 2; k++) {
        SolidBody b = make_body(&problem);
        NewtonDef newton = newton_default();
        if (k) newton.step_tol = 1e-20;
        NewtonInfo info = solid_solve(&b, &newton);
        last[k] = info.step;
        print_message("step tolerance %.0e: %s, %d iterations, last step %.1e\n", newton.step_tol,
                      newton_status_name(info.status), info.iterations, info.step);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        assert_true(info.iterations < 20);
        solid_body_clear(&b);
    }
    assert_true(last[1] < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard), cmocka_unit_test(test_anchor),
                                       cmocka_unit_test(test_rounding)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
