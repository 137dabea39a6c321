/* Every objective: gradient against differences of the value, Gauss-Newton product against differences of the
 * gradient. */
#include "base/memory.h"
#include "base/random.h"
#include "optim/objectives.h"
#include "shell/shapes.h"
#include "shell/smoothness.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static Shell *make_shell(void)
{
    MeshFile file;
    Error err;
    assert_true(shape_hexagram(0.04, 2, &file, &err));
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    return shell_create(mesh);
}

typedef struct Fixture {
    Shell *shell;
    int dofs, params;
    double *x, *p, *vx, *vp, *dx, *dp, *hx, *hp;
} Fixture;

static Fixture make_fixture(void)
{
    Fixture f = {.shell = make_shell()};
    Random random = random_seed(11);
    f.dofs = shell_dof_count(f.shell), f.params = f.shell->params.size;
    double **vectors[] = {&f.x, &f.vx, &f.dx, &f.hx, &f.p, &f.vp, &f.dp, &f.hp};
    for (int k = 0; k < 8; k++) {
        int n = k < 4 ? f.dofs : f.params;
        *vectors[k] = mem_alloc((size_t)n, sizeof(double));
        for (int i = 0; (k % 4 < 2) && i < n; i++) (*vectors[k])[i] = random_signed(&random);
    }
    return f;
}

static void free_fixture(Fixture *f)
{
    double *vectors[] = {f->x, f->vx, f->dx, f->hx, f->p, f->vp, f->dp, f->hp};
    for (int k = 0; k < 8; k++) mem_free(vectors[k]);
    shell_destroy(f->shell);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* Values and gradients at x + s vx, p + s vp; all objectives are at most quadratic, so central differences
 * are exact. */
static double value_at(Fixture *f, Objective objective, double s, double *dx, double *dp)
{
    double *x = mem_copy(f->x, (size_t)f->dofs, sizeof *x), *p = mem_copy(f->p, (size_t)f->params, sizeof *p);
    for (int i = 0; i < f->dofs; i++) x[i] += s * f->vx[i];
    for (int i = 0; i < f->params; i++) p[i] += s * f->vp[i];
    if (dx) memset(dx, 0, (size_t)f->dofs * sizeof *dx);
    if (dp) memset(dp, 0, (size_t)f->params * sizeof *dp);
    double value = objective.ops->value(objective.self, objective.weight, x, p, dx, dp);
    mem_free(x);
    mem_free(p);
    return value;
}

static void check(Fixture *f, Objective objective, bool squares)
{
    double weight = objective.weight,
           slope =
               weight * (value_at(f, objective, 1, NULL, NULL) - value_at(f, objective, -1, NULL, NULL)) / 2;
    value_at(f, objective, 0, f->dx, f->dp);
    double exact = dot(f->dofs, f->dx, f->vx) + dot(f->params, f->dp, f->vp);
    assert_true(fabs(slope - exact) < 1e-12 * (fabs(slope) + 1));
    /* 2 J^T J v is the whole second derivative of a sum of squares of linear residuals. */
    memset(f->hx, 0, (size_t)f->dofs * sizeof *f->hx);
    memset(f->hp, 0, (size_t)f->params * sizeof *f->hp);
    objective.ops->product(objective.self, weight, f->vx, f->vp, f->hx, f->hp);
    double curvature = dot(f->dofs, f->hx, f->vx) + dot(f->params, f->hp, f->vp);
    double second = weight * (value_at(f, objective, 1, NULL, NULL) + value_at(f, objective, -1, NULL, NULL) -
                              2 * value_at(f, objective, 0, NULL, NULL));
    assert_true(squares ? curvature > 0 && fabs(curvature - second) < 1e-11 * curvature : curvature == 0);
    objective_destroy(objective);
}

static void test_rows(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Fixture f = make_fixture();
    int vertices[3] = {0, 4, 7};
    double target[3][3] = {{1, 2, 3}, {-1, 0, 1}, {0.5, 0.5, 0.5}};
    check(&f, objective_target(3, vertices, (const double(*)[3])target, 0.7), true);
    check(&f, objective_height(3, vertices, -2), false);
    check(&f, shell_magnetization_smoothness(f.shell, 1.5), true);
    free_fixture(&f);
    assert_int_equal(mem_live_count(), blocks);
}

/* Closed forms. */
static void test_values(void **state)
{
    (void)state;
    Fixture f = make_fixture();
    int vertices[2] = {1, 2};
    double target[2][3] = {{0}, {0}};
    memset(f.x, 0, (size_t)f.dofs * sizeof *f.x);
    f.x[3] = 3, f.x[4] = 4, f.x[8] = 2;
    Objective objective = objective_target(2, vertices, (const double(*)[3])target, 1);
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 29);
    objective_destroy(objective);
    objective = objective_height(2, vertices, 1);
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 1);
    objective_destroy(objective);
    objective = shell_magnetization_smoothness(f.shell, 1);
    for (int i = 0; i < 3 * f.shell->mesh->face_count; i++) f.p[f.shell->magnetization + i] = 5;
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 0);
    f.p[f.shell->magnetization] = 7; /* one face: 4 for each of its inner edges */
    int inner = 0;
    for (int i = 0; i < 3; i++)
        inner += !mesh_edge_is_boundary(f.shell->mesh, f.shell->mesh->face_edges[0][i]);
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 4 * inner);
    free_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows), cmocka_unit_test(test_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
