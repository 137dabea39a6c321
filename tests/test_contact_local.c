/* What is not as thick everywhere keeps its own distance at each place: from the ground, and from itself. */
#include "solve/march.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <stdio.h>

static const double G = 9.81, LENGTH = 0.04;

/* Of a strip, or of its copy above it. */
static double thickness_at(double x)
{
    return 4e-4 * (1 - x / 0.05);
}

static NewtonStatus settle(const Built *b)
{
    Case *c = &b->model->cases[0];
    NewtonDef def = newton_default();
    def.step_cap = b->model->step_cap;
    Point at = {.p = c->stages[0].p};
    return newton_minimize(c->sys, &def, &at, &c->state, NULL).status;
}

/* What the floor bears at a rest, over what the body weighs. */
static double borne(const Built *b)
{
    const Case *c = &b->model->cases[0];
    double force[1][3] = {{0}}, sum = 0, *mass = mem_alloc((size_t)b->model->point_count, sizeof *mass);
    WorldSums sums = {.contact = {.force = force}};
    Point at = state_point(&c->state, c->stages[0].p);
    world_measure(b->model->world, &at, &sums);
    model_masses(b->model, c->stages[0].p, mass);
    for (int v = 0; v < b->model->point_count; v++) sum += mass[v];
    mem_free(mass);
    return force[0][2] / (G * sum);
}

/* Strips of 40 x 8 mm above each other, as high as they are to lie, and a little more. */
static void write_strips(const char *path, int along, int strips)
{
    enum { ACROSS = 4 };
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int k = 0; k < strips; k++)
        for (int j = 0; j <= ACROSS; j++)
            for (int i = 0; i <= along; i++) {
                double x = LENGTH * i / along;
                fprintf(file, "v %.17g %.17g %.17g\n", x, 0.008 * j / ACROSS, (k + 0.51) * thickness_at(x));
            }
    for (int k = 0; k < strips; k++)
        for (int j = 0; j < ACROSS; j++)
            for (int i = 0; i < along; i++) {
                int a = 1 + (along + 1) * (j + k * (ACROSS + 1)) + i, b = a + 1, c = a + along + 1, d = c + 1;
                if ((i + j) % 2)
                    fprintf(file, "f %d %d %d\nf %d %d %d\n", a, b, d, a, d, c);
                else
                    fprintf(file, "f %d %d %d\nf %d %d %d\n", a, b, c, b, d, c);
            }
    assert_int_equal(fclose(file), 0);
}

static Built strips_on_floor(int along, int strips, const char *contact)
{
    write_strips("strips.obj", along, strips);
    return scene_build(mem_format("slender: 1\njob: equilibrium\nshell:\n  mesh: strips.obj\n"
                                  "  thickness: \"4.0e-4*(1 - x/0.05)\"\n  young: 10 kPa\n  poisson: 0.3\n"
                                  "  density: 1000\n  gravity: [0, 0, -%g]\n"
                                  "obstacles: [{name: floor, plane: {}}]\n%s",
                                  G, contact));
}

/* How far vertices are from (k + 1/2) thicknesses, in parts of one; but at the ends, where the cells are on one side. */
static double off(const Built *b, int strip, double *lowest)
{
    double worst = 0;
    *lowest = INFINITY;
    for (int v = 0; v < b->model->point_count; v++) {
        const double *rest = b->model->mesh->rest[v], *x = b->model->cases[0].state.x + 3 * v;
        double h = thickness_at(rest[0]);
        if (b->model->mesh->vertex_component[v] != strip || rest[0] < 1e-4 || rest[0] > LENGTH - 1e-4)
            continue;
        worst = fmax(worst, fabs(x[2] / h - strip - 0.5));
        *lowest = fmin(*lowest, x[2]);
    }
    return worst;
}

static void test_strip(void **unused)
{
    (void)unused;
    double lowest;
    Built b = strips_on_floor(20, 1, "");
    assert_int_equal(settle(&b), NEWTON_CONVERGED);
    double worst = off(&b, 0, &lowest), weight = borne(&b);
    print_message(
        "a taper lies within %.2g of its thickness, as low as %.3g mm; force over weight - 1 %.1e\n", worst,
        1e3 * lowest, weight - 1);
    assert_true(worst < 0.01 && fabs(weight - 1) < 1e-6);
    clear(&b);
    b = strips_on_floor(20, 1, "contact: {offset: 0.2 mm}\n"); /* one that is given is so everywhere */
    assert_int_equal(settle(&b), NEWTON_CONVERGED);
    off(&b, 0, &lowest);
    assert_true(fabs(lowest / 2e-4 - 1) < 0.02);
    clear(&b);
}

/* One on the other, which it would slide down; how far off the upper is. */
static double stacked(int along)
{
    double lowest;
    int first = 5 * (along + 1);
    char *contact = mem_format("contact: {self: {stiffness: 1.0e-4}}\n"
                               "fix: [{vertices: [0, %d], axes: xy}, {vertices: [%d, %d], axes: y}]\n",
                               first, along, first + along);
    Built b = strips_on_floor(along, 2, contact);
    assert_int_equal(settle(&b), NEWTON_CONVERGED);
    double under = off(&b, 0, &lowest), above = off(&b, 1, &lowest), weight = borne(&b);
    print_message(
        "of two tapers of %d cells the lower lies within %.2g, the upper within %.2g of a thickness\n", along,
        under, above);
    assert_true(under < 0.01 && fabs(weight - 1) < 1e-6);
    mem_free(contact);
    clear(&b);
    return above;
}

/* A pair's distance is of the face's own thickness, a part of a cell from where it touches. */
static void test_strips(void **unused)
{
    (void)unused;
    double coarse = stacked(20), fine = stacked(40);
    assert_true(coarse < 0.1 && fine < 0.6 * coarse);
}

/* Clamped along the floor, it falls onto it from its radius there. */
static void test_cone(void **unused)
{
    (void)unused;
    enum { ELEMENTS = 40 };
    Built b = scene_build(mem_format(
        "slender: 1\njob: simulate\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.2\n"
        "  radius: \"2.0e-3*(1 - 0.9*s/L)\"\n  elements: %d\n  young: 50 kPa\n  poisson: 0.4\n"
        "  density: 1200\n  damping: 0.2\n  gravity: [0, 0, -%g]\n"
        "obstacles: [{name: floor, plane: {point: [0, 0, -1.975 mm]}}]\ntime: {step: 5 ms, steps: 1}\n",
        ELEMENTS, G));
    Case *c = &b.model->cases[0];
    MarchDef def = march_default();
    for (int n = 0; n < 150; n++) {
        MarchInfo info;
        assert_true(march_step(c->sys, &def, 5e-3, c->stages[0].p, &c->state, &info));
    }
    const World *world = b.model->world;
    double worst = 0;
    for (int v = ELEMENTS / 2; v < ELEMENTS; v++) {
        double radius = 2e-3 * (1 - 0.9 * v / ELEMENTS),
               z = c->state.x[world->body.first + 3 * v + 2] + 1.975e-3;
        worst = fmax(worst, fabs(z / radius - 1));
    }
    print_message("a cone lies within %.2g of its radius\n", worst);
    assert_true(worst < 0.01);
    clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_strip), cmocka_unit_test(test_strips),
                                       cmocka_unit_test(test_cone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
