/* How stiff bending elements are: a bar and Cook's membrane, against fine meshes. With an argument it prints whole tables, in
 * minutes. */
#include "surface/loads.h"
#include "tests/solid_fixture.h"
#include <stdio.h>

/* Solves under a traction in N/m^2 on the side at that x; its mean displacement from that y on, m. */
static double pull_side(Solid *solid, double x, double y, const double traction[3], int axis)
{
    SolidBody b = solid_body(solid, false, 1e5);
    const Tets *tets = solid->tets;
    int nodes = tets_node_count(tets), count = 0;
    int *side = mem_alloc((size_t)nodes, sizeof *side);
    for (int v = 0; v < nodes; v++)
        if (fabs(tets->surface->rest[v][0] - x) < 1e-9) side[count++] = v;
    assert_true(loads_on_faces(tets->skin, &(Indices){.count = count, .items = side}, traction,
                               b.p + solid->load) > 0);
    NewtonDef newton = newton_default();
    assert_int_equal(solid_solve(&b, &newton).status, NEWTON_CONVERGED);
    assert_true(solid_least_jacobian(solid, b.state.x, NULL) > 0);
    double sum = 0;
    int seen = 0;
    for (int k = 0; k < count; k++) {
        if (tets->surface->rest[side[k]][1] < y) continue;
        seen++;
        int dof = 3 * side[k] + axis;
        sum += b.state.x[dof] - tets->surface->rest[side[k]][axis];
    }
    mem_free(side);
    solid_body_clear(&b);
    return sum / seen;
}

typedef struct Element {
    const char *name;
    int order;
    double averaging;
} Element;

static SolidDef def_of(Element element, double poisson)
{
    return (SolidDef){.poisson = poisson, .density = 1000, .averaging = element.averaging};
}

/* 60 x 6 x 6 mm, 10 n x n x n cells, clamped on the left, 6 mN on the right: the deflection there, mm. */
static double bar(Element element, int n, double poisson)
{
    const double size[3] = {0.06, 0.006, 0.006};
    SolidDef def = def_of(element, poisson);
    Solid *solid = solid_box(size, (int[]){10 * n, n, n}, element.order, &def);
    for (int k = 0; k < 3; k++) solid_hold_side(solid, 0, 0, k);
    return 1e3 * pull_side(solid, size[0], 0, (double[]){0, 0, 6e-3 / (size[1] * size[2])}, 2);
}

/* Cook's membrane, plane strain, n x n x 1 cells, 4 mm thick: 48 mm long, 44 mm high where it is clamped, 16 mm where it is sheared by
 * 2600 Pa: the upper corner's deflection, mm. */
static double cook(Element element, int n, double poisson)
{
    SolidDef def = def_of(element, poisson);
    MeshFile file = box_mesh((double[]){1, 1, 0.004}, (int[]){n, n, 1}, 0);
    for (int v = 0; v < file.vertex_count; v++) {
        double *x = file.vertices[v];
        x[1] = 0.044 * x[0] + (0.044 - 0.028 * x[0]) * x[1];
        x[0] *= 0.048;
    }
    Solid *solid = solid_of_mesh(&file, element.order, &def, NULL);
    for (int k = 0; k < 2; k++) solid_hold_side(solid, 0, 0, k);
    for (int v = 0; v < tets_node_count(solid->tets); v++) solid->fixed[3 * v + 2] = true;
    return 1e3 * pull_side(solid, 0.048, 0.06 - 1e-9, (double[]){0, 2600, 0}, 1);
}

static const Element elements[] = {{"linear", TET_LINEAR, 0},
                                   {"linear, patches", TET_LINEAR, 1},
                                   {"quadratic", TET_QUADRATIC, 0},
                                   {"quadratic, 0.6", TET_QUADRATIC, 0.6},
                                   {"quadratic, 1", TET_QUADRATIC, 1}};

enum { LINEAR, PATCHES, WHOLE, PART, MEAN, ELEMENTS };

/* Within a fiftieth of what an independent program found on the same cells. */
static void test_bar(void **state)
{
    (void)state;
    static const struct {
        int element, n;
        double poisson, expected;
    } rows[] = {{LINEAR, 1, 0.45, 4.38},   {LINEAR, 2, 0.45, 11.67},  {LINEAR, 2, 0.49, 4.19},
                {PATCHES, 2, 0.45, 21.53}, {PATCHES, 2, 0.49, 21.36}, {WHOLE, 1, 0.45, 28.21},
                {WHOLE, 1, 0.49, 27.16},   {WHOLE, 2, 0.45, 29.27},   {PART, 1, 0.45, 29.10},
                {PART, 1, 0.49, 27.70},    {MEAN, 1, 0.45, 31.93}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double found = bar(elements[rows[k].element], rows[k].n, rows[k].poisson);
        print_message("%-15s n %d, nu %.2f: %.2f mm\n", elements[rows[k].element].name, rows[k].n,
                      rows[k].poisson, found);
        assert_true(fabs(found - rows[k].expected) < 0.02 * rows[k].expected);
    }
    assert_true(fabs(bar(elements[WHOLE], 2, 0.45) - 29.60) < 0.015 * 29.60); /* fine meshes */
}

static void test_cook(void **state)
{
    (void)state;
    static const struct {
        int element, n;
        double poisson, expected;
    } rows[] = {{LINEAR, 16, 0.45, 5.86}, {PATCHES, 16, 0.45, 6.79}, {PATCHES, 16, 0.499, 6.51},
                {WHOLE, 4, 0.3, 7.57},    {WHOLE, 8, 0.45, 7.05},    {WHOLE, 4, 0.499, 5.71},
                {PART, 4, 0.49, 6.33},    {MEAN, 4, 0.49, 6.85},     {MEAN, 8, 0.45, 7.18}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double found = cook(elements[rows[k].element], rows[k].n, rows[k].poisson);
        print_message("%-15s n %2d, nu %.3f: %.3f mm\n", elements[rows[k].element].name, rows[k].n,
                      rows[k].poisson, found);
        assert_true(fabs(found - rows[k].expected) < 0.02 * rows[k].expected);
    }
}

/* A block of 30 x 10 x 10 mm, 6 x 2 x 2 cells, pressed to 70 % between held ends: energies in mJ of an independent program.
 * Quadratic tetrahedra give way to it inside out where they keep only their mean volumes; with part of them they do not. */
static void test_press(void **state)
{
    (void)state;
    static const double size[3] = {0.03, 0.01, 0.01}, expected[ELEMENTS] = {20.4, 19.0, 18.2, 18.0};
    for (int k = 0; k < ELEMENTS; k++) {
        SolidDef def = def_of(elements[k], 0.45);
        Solid *solid = solid_box(size, (int[]){6, 2, 2}, elements[k].order, &def);
        for (int i = 0; i < 6; i++) solid_hold_side(solid, 0, i / 3 * size[0], i % 3);
        SolidBody b = solid_body(solid, false, 1e5);
        for (int v = 0; v < tets_node_count(solid->tets); v++) b.state.x[3 * v] *= 0.7;
        NewtonDef newton = newton_default();
        NewtonInfo info = solid_solve(&b, &newton);
        double J = solid_least_jacobian(solid, b.state.x, NULL);
        print_message("%-15s %-9s %.2f mJ, det F %.2f\n", elements[k].name, newton_status_name(info.status),
                      1e3 * info.energy, J);
        if (k == MEAN)
            assert_true(J < 0.1 && 1e3 * info.energy < 0.8 * expected[WHOLE]);
        else
            assert_true(J > 0.4 && fabs(1e3 * info.energy - expected[k]) < 0.02 * expected[k]);
        solid_body_clear(&b);
    }
}

static void print_tables(void)
{
    static const int bars[2][4] = {{1, 2, 4, 6}, {1, 2, 3, 0}}, cooks[2][3] = {{16, 32, 0}, {4, 8, 16}};
    for (int k = 0; k < ELEMENTS; k++) {
        const Element *e = &elements[k];
        for (int i = 0, n; i < 4; i++)
            if ((n = bars[e->order - 1][i]) > 0)
                printf("bar  %-15s n %2d  %6.2f %6.2f\n", e->name, n, bar(*e, n, 0.45), bar(*e, n, 0.49));
        for (int i = 0, n; i < 3; i++)
            if ((n = cooks[e->order - 1][i]) > 0)
                printf("cook %-15s n %2d  %6.3f %6.3f %6.3f %6.3f\n", e->name, n, cook(*e, n, 0.3),
                       cook(*e, n, 0.45), cook(*e, n, 0.49), cook(*e, n, 0.499));
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bar), cmocka_unit_test(test_cook),
                                       cmocka_unit_test(test_press)};
    (void)argv;
    if (argc > 1) return print_tables(), 0;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
