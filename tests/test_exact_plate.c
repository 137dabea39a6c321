/* Closed forms and published numbers: stretching, plate bending, magnetic identities, Sze's cantilever and
 * annulus. */
#include "base/random.h"
#include "base/vec3.h"
#include "solve/newton.h"
#include "tests/shell_fixture.h"
#include <math.h>
#include <string.h>

static Body make_body(Shell *shell, double young)
{
    return body_create(shell, shell_system(shell), young);
}

static Shell *make_sheet(double size, int n, ShapePattern pattern, double thickness, double poisson,
                         BendingModel bending)
{
    Shell *shell = shell_of_sheet((double[]){size, size}, (int[]){n, n}, pattern);
    shell->thickness = thickness, shell->poisson = poisson, shell->density = 1000, shell->bending = bending;
    return shell;
}

/* 0 membrane, 1 bending, 2 magnetic: rows of shell_term_rows. */
static double term_energy(const Body *b, int term)
{
    Point at = state_point(&b->state, b->p);
    return system_term_energy(b->sys, term, &at, NULL);
}

/* E = Y h A g^2/(1 - nu), g = (l^2 - 1)/2. */
static void test_stretch(void **state)
{
    (void)state;
    Body b = make_body(make_sheet(0.1, 6, PATTERN_CROSSED, 1e-3, 0.3, BENDING_MIDEDGE), 1e5);
    for (int i = 0; i < 3 * b.shell->mesh->vertex_count; i++) b.state.x[i] *= 1.2;
    double g = (1.2 * 1.2 - 1) / 2, exact = 1e5 * 1e-3 * 0.01 * g * g / 0.7;
    assert_true(fabs(term_energy(&b, 0) / exact - 1) < 1e-13);
    assert_true(fabs(term_energy(&b, 1)) < 1e-20);
    body_clear(&b);
}

/* Hinges, n x n cells, a turn of pi/n at each cell line: E = (D pi^2/2)(1 - 1/n). */
static void test_rolled(void **state)
{
    (void)state;
    enum { N = 8 };
    Body b = make_body(make_sheet(0.1, N, PATTERN_RIGHT, 1e-3, 0.45, BENDING_HINGE), 1e5);
    double line[N + 1][2] = {{0}};
    for (int k = 1; k <= N; k++) {
        double angle = (k - 1) * M_PI / N, length = 0.1 / N;
        line[k][0] = line[k - 1][0] + length * cos(angle), line[k][1] = line[k - 1][1] + length * sin(angle);
    }
    for (int v = 0; v < b.shell->mesh->vertex_count; v++)
        b.state.x[3 * v] = line[v % (N + 1)][0], b.state.x[3 * v + 2] = line[v % (N + 1)][1];
    system_accept(b.sys, b.state.x, b.state.memory);
    assert_true(fabs(term_energy(&b, 1) / 4.511966484301568e-05 - 1) < 1e-12);
    body_clear(&b);
}

/* Shallow height k1 x^2/2 + k2 y^2/2 with all positions held and the edge angles relaxed: the energy of the
 * inner quarter of the plate. (At the border the relaxed angles let the moment go to zero, as at a free edge,
 * over about a cell.) */
static double bent_energy(ShapePattern pattern, int n, double k1, double k2)
{
    Shell *shell = make_sheet(0.1, n, pattern, 1e-3, 0.3, BENDING_MIDEDGE);
    for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) shell_fix(shell, i / 3, i % 3);
    Body b = make_body(shell, 1e6);
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        double x = b.state.x[3 * v] - 0.05, y = b.state.x[3 * v + 1] - 0.05;
        b.state.x[3 * v + 2] = (k1 * x * x + k2 * y * y) / 2;
    }
    NewtonDef def = newton_default();
    NewtonInfo info = newton_minimize(b.sys, &def, &(Point){.p = b.p}, &b.state, NULL);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    double sum = 0, *energy = mem_alloc((size_t)shell->mesh->face_count, sizeof *energy);
    Point at = state_point(&b.state, b.p);
    assert_int_equal(system_term(b.sys, 1)->ops->count(system_term(b.sys, 1)->self), shell->mesh->face_count);
    system_term_energy(b.sys, 1, &at, energy);
    for (int f = 0; f < shell->mesh->face_count; f++) {
        const int *v = shell->mesh->faces[f];
        Vec3 center =
            vec3_add(vec3_load(shell->mesh->rest[v[0]]),
                     vec3_add(vec3_load(shell->mesh->rest[v[1]]), vec3_load(shell->mesh->rest[v[2]])));
        if (fabs(center.x / 3 - 0.05) < 0.025 && fabs(center.y / 3 - 0.05) < 0.025) sum += energy[f];
    }
    mem_free(energy);
    body_clear(&b);
    return sum;
}

/* D k^2 A/2, D k^2 (1 + nu) A, D k^2 (1 - nu) A: cylinder, sphere, saddle, on every triangulation. */
static void test_plate_energies(void **state)
{
    (void)state;
    const double k = 0.02, D = 1e6 * 1e-9 / (12 * (1 - 0.09)), unit = D * k * k * 0.01 / 4;
    const struct {
        const char *name;
        double k1, k2, exact;
    } forms[] = {{"cylinder", k, 0, unit / 2}, {"sphere", k, k, 1.3 * unit}, {"saddle", k, -k, 0.7 * unit}};
    for (ShapePattern pattern = PATTERN_RIGHT; pattern <= PATTERN_CROSSED; pattern++)
        for (int form = 0; form < 3; form++) {
            double coarse = bent_energy(pattern, 12, forms[form].k1, forms[form].k2) / forms[form].exact - 1;
            double fine = bent_energy(pattern, 24, forms[form].k1, forms[form].k2) / forms[form].exact - 1;
            print_message("pattern %d, %s: %.2e at 12 cells, %.2e at 24\n", (int)pattern, forms[form].name,
                          coarse, fine);
            assert_true(fabs(fine) < 1e-5 && fabs(fine) < 0.1 * fabs(coarse));
        }
}

static void randomise(Body *b, Random *random)
{
    for (int i = 0; i < shell_dof_count(b->shell); i++)
        b->state.x[i] += (i < 3 * b->shell->mesh->vertex_count ? 2e-3 : 0.1) * random_signed(random);
}

/* Uniform in-plane M and uniform B: the energy is linear in x. Gradient 0 inside, h (M.nu) B length/2 at
 * boundary edges' ends; Hessian 0. */
static void test_linear_magnetic(void **state)
{
    (void)state;
    Random random = random_seed(2);
    Body b = make_body(make_sheet(0.1, 5, PATTERN_ALTERNATE, 1e-3, 0.3, BENDING_MIDEDGE), 1e6);
    const Mesh *mesh = b.shell->mesh;
    int dofs = shell_dof_count(b.shell);
    double M[3] = {3e4, -2e4, 0}, B[3] = {0.01, 0.02, -0.05}, *load = mem_alloc((size_t)dofs, sizeof *load);
    double *gradient = mem_alloc((size_t)dofs, sizeof *gradient);
    for (int f = 0; f < mesh->face_count; f++)
        for (int i = 0; i < 3; i++)
            b.p[b.shell->magnetization + 3 * f + i] = M[i], b.p[b.shell->young + f] = 0;
    for (int i = 0; i < 3; i++) b.p[b.shell->flux.uniform + i] = B[i];
    for (int e = 0; e < mesh->edge_count; e++) {
        if (!mesh_edge_is_boundary(mesh, e)) continue;
        const int *v = mesh->edges[e];
        Vec3 along = vec3_sub(vec3_load(mesh->rest[v[1]]), vec3_load(mesh->rest[v[0]]));
        if (mesh->edge_faces[e][0] < 0) along = vec3_scale(-1, along);
        double flux = along.y * M[0] - along.x * M[1]; /* (M.nu) length, nu to the right of the edge */
        for (int i = 0; i < 6; i++) load[3 * v[i / 3] + i % 3] -= 1e-3 * flux * B[i % 3] / 2;
    }
    randomise(&b, &random);
    Point at = state_point(&b.state, b.p);
    system_hessian(b.sys, &at, gradient);
    double largest = 0, worst = 0, stiffness = 0;
    const double *scale = system_scale(b.sys);
    for (int i = 0; i < 3 * mesh->vertex_count; i++) {
        largest = fmax(largest, fabs(load[i]));
        worst = fmax(worst, fabs(gradient[i] - load[i]));
        stiffness = fmax(stiffness, scale[i]);
    }
    print_message("linear magnetic energy: forces off by %.1e of the largest, stiffness %.1e N/m\n",
                  worst / largest, stiffness);
    assert_true(worst < 1e-12 * largest && stiffness < 1e-12);
    mem_free(load);
    mem_free(gradient);
    body_clear(&b);
}

/* A free body: forces add up to 0, and their torque is that of the field on the moments: sum x x f + sum m x
 * B = 0. */
static void test_balance(void **state)
{
    (void)state;
    Random random = random_seed(8);
    Body b = make_body(make_sheet(0.05, 4, PATTERN_CROSSED, 1e-3, 0.3, BENDING_MIDEDGE), 1e5);
    const Shell *shell = b.shell;
    double *gradient = mem_alloc((size_t)shell_dof_count(shell), sizeof *gradient),
           *with_B = mem_alloc((size_t)shell_dof_count(shell), sizeof *with_B);
    for (int i = 0; i < 3 * shell->mesh->face_count; i++)
        b.p[shell->magnetization + i] = 5e4 * random_signed(&random);
    randomise(&b, &random);
    double B[3] = {0.02, -0.03, 0.05}, moment[3];
    for (int i = 0; i < 3; i++) { /* E_magnetic = -m.B: m from three unit fields */
        b.p[shell->flux.uniform + i] = 1;
        moment[i] = -term_energy(&b, 2);
        b.p[shell->flux.uniform + i] = 0;
    }
    for (int i = 0; i < 3; i++) b.p[shell->flux.uniform + i] = B[i];
    /* Edge angles must be relaxed for a balance of positions alone: a rigid turn does not change them, so it
     * holds for any. */
    Point at = state_point(&b.state, b.p);
    system_gradient(b.sys, &at, gradient);
    Vec3 force = vec3(0, 0, 0), torque = vec3_cross(vec3_load(moment), vec3_load(B));
    double size = 0;
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        Vec3 f = vec3_scale(-1, vec3_load(gradient + 3 * v));
        force = vec3_add(force, f);
        torque = vec3_sub(torque, vec3_cross(vec3_load(b.state.x + 3 * v), f));
        size += vec3_length(f);
    }
    print_message("free body: net force %.1e, torque %.1e of the forces\n", vec3_length(force) / size,
                  vec3_length(torque) / size / 0.05);
    assert_true(vec3_length(force) < 1e-12 * size && vec3_length(torque) < 1e-12 * size * 0.05);
    mem_free(gradient);
    mem_free(with_B);
    body_clear(&b);
}

/* Loads per length along the edge between the vertices in order. */
static void load_edge(Body *b, const int *vertices, int count, double per_length)
{
    for (int k = 0; k + 1 < count; k++) {
        double length = vec3_length(vec3_sub(vec3_load(b->shell->mesh->rest[vertices[k]]),
                                             vec3_load(b->shell->mesh->rest[vertices[k + 1]])));
        b->p[b->shell->load + 3 * vertices[k] + 2] += per_length * length / 2;
        b->p[b->shell->load + 3 * vertices[k + 1] + 2] += per_length * length / 2;
    }
}

static void scale_loads(Body *b, double factor)
{
    for (int i = 0; i < 3 * b->shell->mesh->vertex_count; i++) b->p[b->shell->load + i] *= factor;
}

/* Sze, Liu, Lo 2004, problem 3.1: U and W of the end, exact elastica. */
static void test_sze_cantilever(void **state)
{
    (void)state;
    static const double exact[4][2] = {
        {.5643323628, 3.0172077}, {1.6064172, 4.9345748}, {2.5442018, 6.0325344}, {3.2894124, 6.6996418}};
    enum { N = 40, ACROSS = 4 };
    Shell *shell = shell_of_sheet((double[]){10, 1}, (int[]){N, ACROSS}, PATTERN_ALTERNATE);
    shell->thickness = 0.1, shell->poisson = 0, shell->density = 1000, shell->bending = BENDING_MIDEDGE;
    hold_root(shell, true);
    Body b = make_body(shell, 1.2e6);
    int end[ACROSS + 1];
    for (int j = 0; j <= ACROSS; j++) end[j] = j * (N + 1) + N;
    NewtonDef def = newton_default();
    for (int step = 0; step < 4; step++) {
        for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) b.p[shell->load + i] = 0;
        load_edge(&b, end, ACROSS + 1, step + 1);
        NewtonInfo info = newton_minimize(b.sys, &def, &(Point){.p = b.p}, &b.state, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        int tip = end[ACROSS / 2];
        double U = 10 - b.state.x[3 * tip], W = b.state.x[3 * tip + 2];
        print_message("cantilever at %.2f: U %.4f (%+.2f %%), W %.4f (%+.2f %%)\n", 0.25 * (step + 1), U,
                      100 * (U / exact[step][0] - 1), W, 100 * (W / exact[step][1] - 1));
        assert_true(fabs(U / exact[step][0] - 1) < 0.005 && fabs(W / exact[step][1] - 1) < 0.005);
    }
    body_clear(&b);
}

enum { RADIAL = 16, AROUND = 144 };

/* Rings from 6 to 10, slit at angle 0: the first ray and the last one have vertices of their own. */
static Shell *make_annulus(void)
{
    MeshFile file = {.vertex_count = (RADIAL + 1) * (AROUND + 1), .face_count = 2 * RADIAL * AROUND};
    file.vertices = mem_alloc((size_t)file.vertex_count, sizeof *file.vertices);
    file.faces = mem_alloc((size_t)file.face_count, sizeof *file.faces);
    for (int v = 0; v < file.vertex_count; v++) {
        double r = 6 + 4.0 * (v % (RADIAL + 1)) / RADIAL, angle = 2 * M_PI * (v / (RADIAL + 1)) / AROUND;
        file.vertices[v][0] = r * cos(angle), file.vertices[v][1] = r * sin(angle);
    }
    for (int c = 0; c < RADIAL * AROUND; c++) {
        int i = c % RADIAL, j = c / RADIAL, v = j * (RADIAL + 1) + i, w = v + RADIAL + 1;
        bool turned = (i + j) % 2;
        int faces[2][3] = {{v, v + 1, turned ? w : w + 1}, {turned ? v + 1 : v, w + 1, w}};
        memcpy(file.faces[2 * c], faces, sizeof faces);
    }
    Shell *shell = shell_of_mesh(&file);
    shell->thickness = 0.03, shell->poisson = 0, shell->density = 1000, shell->bending = BENDING_MIDEDGE;
    return shell;
}

/* Sze, Liu, Lo 2004, problem 3.3: the slit annulus, lifted at one side of the slit, held at the other. */
static void test_sze_annulus(void **state)
{
    (void)state;
    static const double part[4] = {.1, .25, .5, 1},
                        published[4][2] = {
                            {4.277, 5.876}, {7.602, 10.288}, {10.468, 13.768}, {13.891, 17.528}};
    Shell *shell = make_annulus();
    int end[RADIAL + 1];
    for (int i = 0; i <= RADIAL; i++) {
        end[i] = AROUND * (RADIAL + 1) + i;
        for (int k = 0; k < 3; k++) shell_fix(shell, i, k);
        if (i > 0) shell_clamp(shell, mesh_edge(shell->mesh, i - 1, i));
    }
    Body b = make_body(shell, 21e6);
    NewtonDef def = newton_default();
    for (int step = 0; step < 4; step++) {
        for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) b.p[shell->load + i] = 0;
        load_edge(&b, end, RADIAL + 1, 0.8);
        scale_loads(&b, part[step]);
        NewtonInfo info = newton_minimize(b.sys, &def, &(Point){.p = b.p}, &b.state, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        double A = b.state.x[3 * end[0] + 2], B = b.state.x[3 * end[RADIAL] + 2];
        print_message("annulus at %.2f: A %.3f (%+.2f %%), B %.3f (%+.2f %%), %d iterations\n", part[step], A,
                      100 * (A / published[step][0] - 1), B, 100 * (B / published[step][1] - 1),
                      info.iterations);
        assert_true(fabs(A / published[step][0] - 1) < 0.01 && fabs(B / published[step][1] - 1) < 0.01);
    }
    body_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stretch),        cmocka_unit_test(test_rolled),
        cmocka_unit_test(test_plate_energies), cmocka_unit_test(test_linear_magnetic),
        cmocka_unit_test(test_balance),        cmocka_unit_test(test_sze_cantilever),
        cmocka_unit_test(test_sze_annulus)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
