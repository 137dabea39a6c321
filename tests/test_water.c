/* Water on faces and rods: derivatives, closed forms of falling and slowing down, its power, frames of reference, and closed
 * surfaces. */
#include "solve/check.h"
#include "solve/march.h"
#include "tests/shell_fixture.h"
#include "tests/water_fixture.h"
#include <math.h>
#include <string.h>

static const double G = 9.81;

static void set_velocity(Swarm *s, Vec3 v)
{
    for (int i = 0; i < s->vertices; i++) vec3_store(s->state.v + 3 * i, v);
}

static void march(System *sys, double *p, double dt, int steps, State *state)
{
    MarchDef def = march_default();
    def.newton.energy_tol = 1e-14, def.newton.cg_iterations = 0;
    for (int k = 0; k < steps; k++) {
        MarchInfo info;
        assert_true(march_step(sys, &def, dt, p, state, &info));
        assert_int_equal(info.refused, 0);
    }
}

/* ---- A sheet of 3 x 2 cells of 1 mm, 1 mm thick, as heavy as water ---- */

static const double THICKNESS = 1e-3;

typedef struct Sheet {
    Shell *shell;
    Swarm swarm;
} Sheet;

static void turn_over(int *face)
{
    int first = face[0];
    face[0] = face[1], face[1] = first;
}

/* With `outer` every other face has its outside below. */
static Sheet sheet_create(bool outer, const FluxField *flow)
{
    Sheet sheet = {.shell = shell_of_sheet((double[]){3e-3, 2e-3}, (int[]){3, 2}, PATTERN_CROSSED)};
    Mesh *mesh = sheet.shell->mesh;
    double *mass = mem_alloc((size_t)mesh->vertex_count, sizeof *mass),
           *p = mem_alloc((size_t)sheet.shell->params.size, sizeof *p);
    sheet.shell->density = RHO, sheet.shell->thickness = THICKNESS;
    shell_default_params(sheet.shell, p);
    shell_vertex_mass(sheet.shell, p, mass);
    mem_free(p);
    sheet.swarm = swarm_begin(mesh->vertex_count);
    sheet.swarm.water.flow = flow;
    for (int f = 0; outer && f < mesh->face_count; f += 2) turn_over(mesh->faces[f]);
    WaterDef def = {
        .face_count = mesh->face_count, .faces = mesh->faces, .outer = outer, .water = sheet.swarm.water};
    swarm_end(&sheet.swarm, mass, water_term(&def));
    for (int v = 0; v < mesh->vertex_count; v++)
        vec3_store(sheet.swarm.state.x + 3 * v, vec3_load(mesh->rest[v]));
    mem_free(mass);
    return sheet;
}

static void sheet_clear(Sheet *sheet)
{
    swarm_clear(&sheet->swarm);
    shell_destroy(sheet->shell);
}

/* At terminal velocity 2 rho_w A v^2 carries rho_s A h g. */
static void test_falling_plate(void **unused)
{
    (void)unused;
    Sheet sheet = sheet_create(false, NULL);
    Swarm *s = &sheet.swarm;
    s->p[s->gravity + 2] = -G;
    march(s->sys, s->p, 1e-3, 100, &s->state);
    for (int v = 0; v < s->vertices; v++) {
        double speed = -s->state.v[3 * v + 2];
        if (v == 0) print_message("terminal velocity %.12f m/s\n", speed);
        assert_true(fabs(speed - 0.0700357054) < 1e-8 * 0.07);
    }
    sheet_clear(&sheet);
}

/* Broadside at v0 it slows down to v0/(1 + 2 v0 t/h), at any step; from either side, and in a fluid that flows. */
static void test_slowing_plate(void **unused)
{
    (void)unused;
    const double start[] = {0.2, 0.4, 0.6, 1.0}, seen[] = {0.0588, 0.0690, 0.0732, 0.0769};
    FluxField *flow = flow_of("0.3", "-0.2", "0.4");
    for (int k = 0; k < 4; k++)
        for (int kind = 0; kind < 4; kind++) {
            Sheet sheet = sheet_create(false, kind == 3 ? flow : NULL);
            Swarm *s = &sheet.swarm;
            double sign = kind == 1 ? -1 : 1, end = sign * start[k] / (1 + 2 * start[k] * 6e-3 / THICKNESS);
            Vec3 u = kind >= 2 ? vec3(0.3, -0.2, 0.4) : vec3(0, 0, 0);
            if (kind == 2) vec3_store(s->p + s->water.velocity, u);
            set_velocity(s, vec3_add(u, vec3(0, 0, sign * start[k])));
            march(s->sys, s->p, 1e-3, 6, &s->state);
            for (int v = 0; v < s->vertices; v++) {
                Vec3 left = vec3_sub(vec3_load(s->state.v + 3 * v), u);
                assert_true(hypot(left.x, left.y) < 1e-12 && fabs(left.z - end) < 1e-7 * fabs(end));
                assert_true(fabs(fabs(left.z) - seen[k]) < 5e-5);
            }
            sheet_clear(&sheet);
        }
    flux_field_destroy(flow);
}

static void shake_fluid(Swarm *s, Random *random)
{
    s->p[s->water.viscosity] = 0.02;
    for (int k = 0; k < 3; k++) s->p[s->water.velocity + k] = 0.05 * random_signed(random);
}

static void check(Swarm *s, const char *name, double dof_size, Random *random)
{
    Point at = state_point(&s->state, s->p);
    at.dt = 0.01, at.time = 0.3;
    double sizes[9];
    for (int i = 0; i < 9; i++) sizes[i] = dof_size;
    TermError error = check_term(s->term, &s->params, &at, 3 * s->vertices, sizes, random);
    print_message("%-12s differences %.1e, products %.1e\n", name, check_differences(error),
                  check_products(error));
    assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
}

static void test_derivatives(void **unused)
{
    (void)unused;
    Random random = random_seed(3);
    FluxField *flow = shear_flow();
    for (int k = 0; k < 4; k++) {
        Sheet sheet = sheet_create(k & 1, k & 2 ? flow : NULL);
        shake(&sheet.swarm, &random, 3e-4, 0);
        shake_fluid(&sheet.swarm, &random);
        /* Differences must not straddle q = 0, where the force's derivative changes within eps: all is in a fast stream, which
         * every other face meets. */
        if (k & 1) sheet.swarm.p[sheet.swarm.water.velocity + 2] = 1.5;
        check(&sheet.swarm, k & 1 ? "outer" : "two", 1e-3, &random);
        sheet_clear(&sheet);
    }
    flux_field_destroy(flow);
}

/* The water takes what the forces of a step say that goes on as it was; at rest it never gives anything. */
static void check_power(Swarm *s)
{
    int dofs = 3 * s->vertices;
    double *x = mem_copy(s->state.x, (size_t)dofs, sizeof *x), *g = mem_alloc((size_t)dofs, sizeof *g);
    double dt = 1e-3, taken = 0;
    for (int i = 0; i < dofs; i++) x[i] += dt * s->state.v[i];
    Point at = {
        .x = x, .p = s->p, .time = s->state.time, .x_prev = s->state.x, .v_prev = s->state.v, .dt = dt};
    system_gradient(s->sys, &at, g); /* of inertia nothing, and there is no weight */
    for (int i = 0; i < dofs; i++) taken += g[i] * s->state.v[i];
    double power = water_power(s->term, &s->state, s->p);
    assert_true(power != 0 && fabs(power - taken) < 1e-9 * fabs(power));
    mem_free(x);
    mem_free(g);
}

static void test_power(void **unused)
{
    (void)unused;
    Random random = random_seed(4);
    for (int k = 0; k < 40; k++) {
        Sheet sheet = sheet_create(k & 1, NULL);
        shake(&sheet.swarm, &random, 3e-4, 0.1);
        assert_true(water_power(sheet.swarm.term, &sheet.swarm.state, sheet.swarm.p) > 0);
        shake_fluid(&sheet.swarm, &random);
        check_power(&sheet.swarm);
        sheet_clear(&sheet);
    }
}

/* In statics there is no water; without a face's area nothing either, and nothing that is not finite. */
static void test_nothing(void **unused)
{
    (void)unused;
    Sheet sheet = sheet_create(false, NULL);
    Swarm *s = &sheet.swarm;
    int faces = sheet.shell->mesh->face_count, dofs = 3 * s->vertices;
    double *energy = mem_alloc((size_t)faces, sizeof *energy), *g = mem_alloc(5 * (size_t)dofs, sizeof *g);
    double *w = g + dofs, *dx = w + dofs, *dv = dx + dofs, *r = dv + dofs;
    Point at = state_point(&s->state, s->p);
    assert_true(system_term_energy(s->sys, 0, &at, energy) == 0);
    for (int i = 0; i < 3; i++) s->state.x[3 * sheet.shell->mesh->faces[0][i]] = 1e-3;
    for (int i = 0; i < 3; i++) s->state.x[3 * sheet.shell->mesh->faces[0][i] + 1] = 1e-3;
    set_velocity(s, vec3(0.1, 0.2, -0.3));
    for (int i = 0; i < dofs; i++) w[i] = 1;
    at = (Point){.x = s->state.x, .p = s->p, .x_prev = s->state.x, .v_prev = s->state.v, .dt = 1e-3};
    shake_fluid(s, &(Random){7});
    assert_true(system_term_energy(s->sys, 0, &at, energy) > 0 && energy[0] == 0);
    assert_true(system_hessian(s->sys, &at, g).finite);
    system_prev(s->sys, &at, w, dx, dv);
    system_prev_forward(s->sys, &at, w, w, r);
    for (int i = 0; i < 5 * dofs; i++) assert_true(isfinite(g[i]));
    mem_free(energy);
    mem_free(g);
    sheet_clear(&sheet);
}

/* ---- A closed surface: an octahedron ---- */

static int octahedron[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                               {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

/* Moving along z it is the upper half that meets the water; the lower one feels it only where sides count as two. Turned inside
 * out it is the other half. */
static void test_outer(void **unused)
{
    (void)unused;
    int inside_out[8][3];
    for (int f = 0; f < 8; f++)
        for (int i = 0; i < 3; i++) inside_out[f][i] = octahedron[f][2 - i];
    for (int kind = 0; kind < 3; kind++) {
        const double mass[6] = {1, 1, 1, 1, 1, 1};
        double energy[8], drag = 0;
        Swarm s = swarm_begin(6);
        WaterDef def = {.face_count = 8,
                        .faces = kind == 2 ? inside_out : octahedron,
                        .outer = kind > 0,
                        .water = s.water};
        swarm_end(&s, mass, water_term(&def));
        for (int v = 0; v < 6; v++) s.state.x[3 * v + v / 2] = v % 2 ? -1e-3 : 1e-3;
        set_velocity(&s, vec3(0, 0, 0.1));
        Point at = {.x = s.state.x, .p = s.p, .x_prev = s.state.x, .v_prev = s.state.v, .dt = 1};
        at.v_prev = s.state.v;
        double x[18];
        for (int i = 0; i < 18; i++) x[i] = s.state.x[i] + s.state.v[i];
        at.x = x;
        drag = system_term_energy(s.sys, 0, &at, energy);
        for (int f = 0; f < 8; f++) {
            bool meets = kind == 0 || (f < 4) == (kind == 1);
            assert_true(meets ? energy[f] > 1e-3 * drag : energy[f] == 0);
        }
        swarm_clear(&s);
    }
}

/* Weight per length is carried by c_t v along, and across by c_n v + rho C_d r v^2. */
static void test_falling_rod(void **unused)
{
    (void)unused;
    double weight = ROD_DENSITY * M_PI * RADIUS * RADIUS * G, mu = 0.05, ln = log(LENGTH / RADIUS);
    double along = 2 * M_PI * mu / (ln - 0.5), across = 4 * M_PI * mu / (ln + 0.5);
    for (int kind = 0; kind < 3; kind++) {
        Swarm s = rod_create(NULL);
        double rho = kind == 2 ? RHO : 0, square = 1.1 * rho * RADIUS;
        double expected = kind == 0   ? weight / along
                          : kind == 1 ? weight / across
                                      : (sqrt(across * across + 4 * square * weight) - across) / (2 * square);
        s.p[s.water.density] = rho, s.p[s.water.viscosity] = mu;
        s.p[s.gravity + (kind == 0 ? 0 : 2)] = -G;
        march(s.sys, s.p, 1e-3, 400, &s.state);
        double speed = -s.state.v[kind == 0 ? 0 : 2];
        print_message("rod %s: %.9f m/s, closed form %.9f\n", kind ? "across" : "along", speed, expected);
        for (int i = 0; i < NODES; i++)
            assert_true(fabs(-s.state.v[3 * i + (kind ? 2 : 0)] - expected) < 1e-7 * expected);
        swarm_clear(&s);
    }
}

/* Each element has the drag of its own radius: the power of the water on a rod that moves as one is the sum of theirs. */
static void test_tapered_rod(void **unused)
{
    (void)unused;
    double radii[NODES - 1], mu = 0.05, v = 0.2, expected = 0;
    for (int e = 0; e < NODES - 1; e++) {
        radii[e] = RADIUS * (1 - 0.03 * e);
        double across = 4 * M_PI * mu / (log(LENGTH / radii[e]) + 0.5);
        expected += LENGTH / (NODES - 1) * (across + 1.1 * RHO * radii[e] * v) * v * v;
    }
    Swarm s = rod_create_of(radii, NULL);
    s.p[s.water.density] = RHO, s.p[s.water.viscosity] = mu;
    for (int i = 0; i < NODES; i++) s.state.v[3 * i + 2] = v;
    double power = water_power(s.term, &s.state, s.p);
    print_message("tapered rod: %.9e W, closed form %.9e\n", power, expected);
    assert_true(fabs(power - expected) < 1e-9 * expected);
    swarm_clear(&s);
}

static void test_rod(void **unused)
{
    (void)unused;
    Random random = random_seed(6);
    FluxField *flow = shear_flow();
    for (int k = 0; k < 2; k++) {
        Swarm s = rod_create(k ? flow : NULL);
        shake(&s, &random, 1e-3, 0.1);
        s.p[s.water.viscosity] = 0.02;
        assert_true(k || water_power(s.term, &s.state, s.p) > 0);
        shake_fluid(&s, &random);
        check_power(&s);
        check(&s, "rod", 1e-3, &random);
        vec3_store(s.state.x, vec3_load(s.state.x + 3)); /* an element without a direction */
        Point at = state_point(&s.state, s.p);
        at.x_prev = at.x, at.v_prev = s.state.v, at.dt = 1e-3;
        assert_true(system_energy(s.sys, &at).finite);
        swarm_clear(&s);
    }
    flux_field_destroy(flow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_falling_plate), cmocka_unit_test(test_slowing_plate),
        cmocka_unit_test(test_derivatives),   cmocka_unit_test(test_power),
        cmocka_unit_test(test_nothing),       cmocka_unit_test(test_outer),
        cmocka_unit_test(test_falling_rod),   cmocka_unit_test(test_tapered_rod),
        cmocka_unit_test(test_rod),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
