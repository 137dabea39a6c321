/* Scenes of solids whose figures are known: a block under a uniform load, a bar, Cook's membrane, a plate as a volume and as a
 * shell ([Chen 2022] fig. 12), hearts. With an argument the table of the plate in full, in a minute. */
#include "io/result.h"
#include "slender.h"
#include "solid/solid.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

#define NAME "test_solid_scenes"

static Built read_scene(const char *name, const char *const *settings, int count)
{
    char *path = mem_format(SOURCE_DIR "/scenes/%s.yaml", name);
    Built b = {.file = yaml_read(path)};
    mem_free(path);
    for (int k = 0; k < count; k++) yaml_override(b.file, settings[k]);
    b.model = yaml_load(b.file, scene_table(), &b.scene) ? model_create(&b.scene, b.file) : NULL;
    if (!b.model) fail_msg("%s", yaml_report(b.file));
    return b;
}

/* The equilibrium of the first case: positions of all nodes, [3 node_count]; the model's. */
static const double *equilibrium(const Built *b)
{
    Case *c = &b->model->cases[0];
    NewtonDef def = newton_default();
    Point at = state_point(&c->state, c->stages[0].p);
    assert_int_equal(newton_minimize(c->sys, &def, &at, &c->state, NULL).status, NEWTON_CONVERGED);
    return c->state.x;
}

/* The mean change of a coordinate over the nodes in the group whose y is at least that, mm. */
static double deflection(const Built *b, const double *x, double least, int axis)
{
    const Mesh *mesh = b->model->mesh;
    const MeshGroup *group = mesh_group(mesh, "right", 0);
    double sum = 0;
    int count = 0;
    for (int k = 0; k < group->count; k++) {
        int v = group->members[k];
        if (mesh->rest[v][1] < least) continue;
        sum += x[3 * v + axis] - mesh->rest[v][axis];
        count++;
    }
    return 1e3 * sum / count;
}

/* ---- Elements ---- */

static Built pulled_cube(int order, double young, double poisson, double pull)
{
    return scene_build(mem_format(
        "slender: 1\njob: equilibrium\nsolid:\n  mesh: {shape: box, size: [0.01, 0.01, 0.01], cells: [2, 2, "
        "2]}\n"
        "  order: %d\n  young: %.17g\n  poisson: %.17g\n  material: st_venant_kirchhoff\nfix:\n"
        "  - {group: left, axes: x}\n  - {group: front, axes: y}\n  - {group: bottom, axes: z}\nloads:\n"
        "  - {area: [%.17g, 0, 0], on: {group: right}}\n  - {area: [0, %.17g, 0], on: {group: back}}\n",
        order, young, poisson, pull, pull));
}

/* A cube of St. Venant-Kirchhoff pulled along two sides has no thickness from E1 + E2 = (1 - nu)/(2 nu) on. Below it has that
 * of plane stress, c^2 = 1 - 2 nu/(1 - nu) (E1 + E2); beyond, its state of rest is none of a body. */
static void test_flattened(void **state)
{
    (void)state;
    const double young = 1e5, poisson = 0.3, limit = (1 - poisson) / (4 * poisson);
    for (int k = 0; k < 4; k++) {
        bool beyond = k >= 2;
        double E = limit * (beyond ? 1.01 : 0.99), pull = young / (1 - poisson) * E * sqrt(1 + 2 * E);
        Built b = pulled_cube(1 + k % 2, young, poisson, pull);
        Case *c = &b.model->cases[0];
        const Solid *solid = b.model->self;
        NewtonDef def = newton_default();
        Point at = state_point(&c->state, c->stages[0].p);
        NewtonStatus status = newton_minimize(c->sys, &def, &at, &c->state, NULL).status;
        double least = solid_least_jacobian(solid, c->state.x, NULL),
               thickness = sqrt(1 - 4 * poisson / (1 - poisson) * E);
        print_message("pulled to %.2f of its limit: %s, det F %.2g\n", E / limit, newton_status_name(status),
                      least);
        assert_int_equal(status, beyond ? NEWTON_TANGLED : NEWTON_CONVERGED);
        if (!beyond) assert_true(fabs(least - (1 + 2 * E) * thickness) < 1e-7);
        clear(&b);
    }
}

/* A uniform load makes a uniform stretch, exactly: what it does to the nodes is the integral of their shape functions. */
static void test_uniform_load(void **state)
{
    (void)state;
    for (int order = 1; order <= 2; order++) {
        Built b = scene_build(mem_format(
            "slender: 1\njob: equilibrium\nsolid:\n  mesh: {shape: box, size: [3, 2, 1], cells: [2, 2, 1]}\n"
            "  order: %d\n  young: 1 MPa\n  poisson: 0.3\nfix:\n  - {group: left, axes: x}\n"
            "  - {group: front, axes: y}\n  - {group: bottom, axes: z}\n"
            "loads: [{area: [400 kPa, 0, 0], on: {group: right}}]\n",
            order));
        const double *x = equilibrium(&b);
        const Mesh *mesh = b.model->mesh;
        double stretch[3] = {0}, worst = 0;
        for (int v = 0; v < mesh->vertex_count; v++)
            for (int i = 0; i < 3; i++)
                if (mesh->rest[v][i] == 3 - i) stretch[i] = x[3 * v + i] / (3 - i);
        for (int v = 0; v < mesh->vertex_count; v++)
            for (int i = 0; i < 3; i++)
                worst = fmax(worst, fabs(x[3 * v + i] - stretch[i] * mesh->rest[v][i]));
        print_message("order %d: stretched by %.6f, %.6f, %.6f, all nodes within %.1e\n", order, stretch[0],
                      stretch[1], stretch[2], worst);
        assert_true(stretch[0] > 1.3 && stretch[1] < 0.95 && fabs(stretch[1] - stretch[2]) < 1e-9);
        assert_true(worst < 1e-9);
        clear(&b);
    }
}

/* What an independent program finds on these cells, to its last digit; fine meshes give 29.60 and 7.21 mm. */
static void test_bending(void **state)
{
    (void)state;
    Built bar = read_scene("solid_cantilever", NULL, 0), cook = read_scene("cook", NULL, 0);
    double down = deflection(&bar, equilibrium(&bar), -INFINITY, 2),
           up = deflection(&cook, equilibrium(&cook), 0.06 - 1e-9, 1);
    print_message("bar %.3f mm, Cook's membrane %.4f mm\n", down, up);
    assert_true(fabs(down - 29.27) < 0.01 && fabs(up - 7.05) < 0.005);
    clear(&bar);
    clear(&cook);
}

/* ---- A plate as a volume and as a shell ---- */

typedef struct Plate {
    int cells[2], layers;
    bool twisted;
    double angle; /* rad */
} Plate;

/* The energies of a term in a scene of the plate, [element]; the caller's. */
static double *plate_energies(const char *scene, const char *body, const Plate *plate, const char *term)
{
    bool solid = !strcmp(body, "solid");
    char *settings[] = {mem_format(solid ? "solid.mesh.cells=[%d,%d,%d]" : "shell.mesh.cells=[%d,%d]",
                                   plate->cells[0], plate->cells[1], plate->layers),
                        mem_format("%s.pose.where.angle=\"%.17g\"", body, plate->angle),
                        mem_format("%s.pose.where.twisted=\"%d\"", body, plate->twisted)};
    Built b = read_scene(scene, (const char *const *)settings, 3);
    Case *c = &b.model->cases[0];
    Point at = state_point(&c->state, c->stages[0].p);
    double *energy = NULL;
    for (int t = 0; t < system_term_count(c->sys); t++) {
        const Term *of = system_term(c->sys, t);
        if (strcmp(of->ops->name, term)) continue;
        energy = mem_alloc((size_t)of->ops->count(of->self), sizeof *energy);
        system_term_energy(c->sys, t, &at, energy);
    }
    assert_non_null(energy);
    for (int k = 0; k < 3; k++) mem_free(settings[k]);
    clear(&b);
    return energy;
}

typedef struct Difference {
    double of_total,
        of_sizes; /* sum over cells |E_volume - E_shell| over |sum E_volume| and over sum |E_volume| */
} Difference;

/* A cell is two faces of the shell; over each are three tetrahedra in each layer, one layer after the other. */
static Difference compare_plate(const Plate *plate)
{
    double *volume = plate_energies("plate_layers", "solid", plate, "volume_magnetic"),
           *shell = plate_energies("plate_shell", "shell", plate, "magnetic");
    int cells = plate->cells[0] * plate->cells[1];
    double apart = 0, total = 0, sizes = 0;
    for (int c = 0; c < cells; c++) {
        double in_cell = 0;
        for (int l = 0; l < plate->layers; l++)
            for (int k = 0; k < 6; k++) in_cell += volume[6 * (l * cells + c) + k];
        apart += fabs(in_cell - shell[2 * c] - shell[2 * c + 1]);
        total += in_cell, sizes += fabs(in_cell);
    }
    mem_free(volume);
    mem_free(shell);
    return (Difference){apart / fabs(total), apart / sizes};
}

static const double angles[] = {0.5, 1.5, 3, 6};

/* The plate of the scenes, in two layers; docs/theory.md has the table. */
static void test_plate(void **state)
{
    (void)state;
    for (int twisted = 0; twisted < 2; twisted++)
        for (int k = 0; k < 4; k++) {
            Plate plate = {{96, 64}, 2, twisted, angles[k]};
            Difference d = compare_plate(&plate);
            print_message("%s by %.1f: %.2e of the total, %.2e of the sizes\n", twisted ? "twisted" : "bent",
                          angles[k], d.of_total, d.of_sizes);
            assert_true(d.of_total < (angles[k] == 0.5 ? 1e-5 : 2e-3) && d.of_sizes <= d.of_total);
        }
}

static void print_plate(void)
{
    for (int twisted = 0; twisted < 2; twisted++)
        for (int layers = 2; layers <= 6; layers += 2)
            for (int k = 0; k < 4; k++) {
                Plate plate = {{96, 64}, layers, twisted, angles[k]};
                Difference d = compare_plate(&plate);
                printf("%s %d layers %.1f rad: %.2e %.2e\n", twisted ? "twist" : "bend ", layers, angles[k],
                       d.of_total, d.of_sizes);
            }
}

/* ---- Hearts ---- */

static const char *const skins[] = {"solid.skin.on=ribbon", "solid.skin.on=lower"}, *const hearts[] = {
                                                                                        "heart_band",
                                                                                        "heart_lower"};

/* Their targets are where heart_known.yaml rests, to the single precision of their files. */
static void test_known(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        Built known = read_scene("heart_known", &skins[k], 1), heart = read_scene(hearts[k], NULL, 0);
        const double *x = equilibrium(&known), *target = heart.model->cases[0].targets[0].place[0];
        const Solid *solid = heart.model->self;
        int faces = 0;
        for (int f = 0; f < solid->tets->surface->face_count; f++) faces += solid->skin_on[f];
        assert_int_equal(heart.model->design.size, 3 * faces); /* the others have no unknowns */
        double worst = 0;
        for (int i = 0; i < 3 * heart.model->point_count; i++) worst = fmax(worst, fabs(x[i] - target[i]));
        print_message("%s: the target within %.1e m\n", hearts[k], worst);
        assert_true(worst < 5e-9);
        clear(&known);
        clear(&heart);
    }
}

static void write_places(const char *path, const Built *b, const double *x)
{
    const Mesh *mesh = b->model->mesh;
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int v = 0; v < mesh->vertex_count; v++)
        fprintf(file, "v %.17g %.17g %.17g\n", x[3 * v], x[3 * v + 1], x[3 * v + 2]);
    fprintf(file, "f 1 2 3\n");
    assert_int_equal(fclose(file), 0);
}

/* Runs the scene with these settings; the least objective over the first one. */
static double run_design(const char *name, const char *const *settings, int count)
{
    SlenderError err;
    Error unread;
    Array F;
    char *path = mem_format(SOURCE_DIR "/scenes/%s.yaml", name);
    SlenderScene *scene = slender_scene_read(path, settings, count, &err);
    if (!scene) fail_msg("%s", err.text);
    mem_free(path);
    SlenderRun def = {.output = NAME, .threads = 1, .force = 1};
    if (slender_run(scene, &def, &err) != SLENDER_DONE) fail_msg("%s", err.text);
    slender_scene_destroy(scene);
    Result *result = result_open(NAME ".vtkhdf", &unread);
    if (!result || !result_read(result, "slender/history/objective", &F, &unread))
        fail_msg("%s", unread.text);
    const double *values = F.data;
    double least = values[0], first = values[0];
    for (int k = 0; k < F.dims[0]; k++) least = fmin(least, values[k]);
    array_clear(&F);
    result_close(result);
    return least / first;
}

/* What a known magnetisation does, a design finds; of hearts of fewer rings, for the time it takes. */
static void test_hearts(void **state)
{
    (void)state;
    char folder[4096];
    assert_non_null(getcwd(folder, sizeof folder));
    for (int k = 0; k < 2; k++) {
        const char *const coarse[] = {"solid.mesh.n=5", skins[k]};
        Built known = read_scene("heart_known", coarse, 2);
        write_places(NAME ".obj", &known, equilibrium(&known));
        clear(&known);
        char *target = mem_format("cases[0].target.file=%s/" NAME ".obj", folder);
        double least = run_design(hearts[k], (const char *const[]){coarse[0], target}, 2);
        print_message("%s: F/F0 %.1e\n", hearts[k], least);
        assert_true(least < 1e-6);
        mem_free(target);
    }
}

int main(int argc, char **argv)
{
    (void)argv;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_flattened), cmocka_unit_test(test_uniform_load),
                                       cmocka_unit_test(test_bending),   cmocka_unit_test(test_plate),
                                       cmocka_unit_test(test_known),     cmocka_unit_test(test_hearts)};
    if (argc > 1) return print_plate(), 0;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
