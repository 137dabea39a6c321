/* Self contact: what it makes of a step of scenes that touch themselves, and a large body with many pairs. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "model/model.h"
#include "shell/shell.h"
#include "solve/march.h"
#include "surface/shapes.h"
#include <math.h>
#include <stdio.h>
#include <sys/resource.h>

static void print(const char *name, const char *what, double value, const char *unit)
{
    char text[80];
    snprintf(text, sizeof text, "contact_%s_%s", name, what);
    bench_print(text, value, unit);
}

/* ---- Scenes ---- */

static void load(void *self, double time, double *p)
{
    Error err;
    if (!model_load(self, time, false, p, &err)) bench_fail("%s", err.text);
}

/* A thread's own milliseconds per step, all steps of the scene; what it does at its end. */
static double scene_ms(const char *name, const char *assignment, WorldSums *sums, NewtonInfo *all)
{
    char path[512];
    Scene scene;
    snprintf(path, sizeof path, "%s/scenes/%s.yaml", SOURCE_DIR, name);
    YamlFile *file = yaml_read(path);
    if (assignment) yaml_override(file, assignment);
    Model *model = yaml_load(file, scene_table(), &scene) ? model_create(&scene, file) : NULL;
    if (!model) bench_fail("%s is refused: %s check says why", path, PROGRAM);
    Case *c = &model->cases[0];
    MarchDef def = march_default();
    def.load = load, def.self = model;
    double start = clock_thread_seconds();
    *all = (NewtonInfo){0};
    for (int n = 0; n < scene.time.steps; n++) {
        MarchInfo info;
        if (!march_step(c->sys, &def, scene.time.step, c->stages[0].p, &c->state, &info))
            bench_fail("%s stops in step %d", name, n + 1);
        newton_add_counts(all, &info.newton);
    }
    double ms = 1e3 * (clock_thread_seconds() - start) / scene.time.steps;
    Point at = state_point(&c->state, c->stages[0].p);
    if (model->world) world_measure(model->world, &at, sums);
    model_destroy(model);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ms;
}

/* Without, it passes through itself: another motion from where it touches on. */
static void scene(const char *name)
{
    WorldSums sums = {0}, none = {0};
    NewtonInfo all, other;
    double with = scene_ms(name, NULL, &sums, &all),
           without = scene_ms(name, "contact.self=false", &none, &other);
    print(name, "ms_per_step", with, "ms");
    print(name, "over_without", with / without, "ratio");
    print(name, "newton_over_without", (double)all.iterations / other.iterations, "ratio");
    print(name, "factorizations_over_without", (double)all.factorizations / other.factorizations, "ratio");
    print(name, "pairs", sums.pairs, "");
}

/* ---- Two sheets that are pressed onto each other ---- */

enum { LAYERS = 2, STEPS = 3 };

static const double CELL = 1e-3, THICKNESS = 1e-3, YOUNG = 1e5;

/* Three quarters of a thickness from each other, turned in their plane. */
static Mesh *stack_mesh(int cells)
{
    double size = cells * CELL;
    MeshFile sheet, all = {.path = mem_text("stack")};
    Error err;
    if (!shape_sheet((double[]){size, size}, (int[]){cells, cells}, PATTERN_ALTERNATE, &sheet, &err))
        bench_fail("%s", err.text);
    int vertices = sheet.vertex_count, faces = sheet.face_count;
    all.vertex_count = LAYERS * vertices, all.face_count = LAYERS * faces;
    all.vertices = mem_alloc((size_t)all.vertex_count, sizeof *all.vertices);
    all.faces = mem_alloc((size_t)all.face_count, sizeof *all.faces);
    for (int v = 0; v < all.vertex_count; v++) {
        int layer = v / vertices;
        double x = sheet.vertices[v % vertices][0] - size / 2, y = sheet.vertices[v % vertices][1] - size / 2,
               angle = 0.3 * layer;
        all.vertices[v][0] = cos(angle) * x - sin(angle) * y,
        all.vertices[v][1] = sin(angle) * x + cos(angle) * y;
        all.vertices[v][2] = 0.75 * THICKNESS * layer;
    }
    for (int f = 0; f < all.face_count; f++)
        for (int i = 0; i < 3; i++) all.faces[f][i] = sheet.faces[f % faces][i] + f / faces * vertices;
    Mesh *mesh = mesh_create(&all, 0, NULL, &err);
    if (!mesh) bench_fail("%s", err.text);
    mesh_file_clear(&sheet);
    mesh_file_clear(&all);
    return mesh;
}

static void stack(int cells, bool self)
{
    char name[40];
    snprintf(name, sizeof name, "stack_%d%s", 4 * cells * cells, self ? "" : "_without");
    Shell *shell = shell_create(stack_mesh(cells), NULL);
    shell->thickness = THICKNESS, shell->poisson = 0.45, shell->density = 1000,
    shell->bending = BENDING_HINGE;
    for (int v = 0; v < shell->mesh->vertex_count / LAYERS; v++)
        shell_fix(shell, v, 2); /* the lower one lies */
    WorldBody shown = shell_world_body(shell);
    World *world = shell->world = world_create(&shown, NULL, 0);
    world->self = self, world->distance = THICKNESS;
    world_add_params(world, &shell->params);
    System *sys = shell_dynamic_system(shell);
    State state = system_state(sys);
    double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
    shell_default_params(shell, p);
    shell_rest_state(shell, state.x);
    for (int f = 0; f < shell->mesh->face_count; f++) p[shell->young + f] = YOUNG;
    if (self) p[world->self_stiffness] = YOUNG * pow(THICKNESS, 3);
    p[shell->gravity + 2] = -5000; /* a press */
    MarchDef def = march_default();
    double spent = 0, pairs = 0;
    int iterations = 0, factorizations = 0;
    for (int n = 0; n < STEPS; n++) {
        MarchInfo info;
        WorldSums sums = {0};
        double start = clock_thread_seconds();
        if (!march_step(sys, &def, 1e-3, p, &state, &info)) bench_fail("%s stops in step %d", name, n + 1);
        spent += clock_thread_seconds() - start;
        iterations += info.newton.iterations, factorizations += info.newton.factorizations;
        Point at = state_point(&state, p);
        world_measure(world, &at, &sums);
        pairs = fmax(pairs, sums.pairs);
    }
    print(name, "ms_per_step", 1e3 * spent / STEPS, "ms");
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    print(name, "newton_per_step", (double)iterations / STEPS, "");
    print(name, "factorizations_per_step", (double)factorizations / STEPS, "");
    print(name, "pairs", pairs, "");
    print(name, "megabytes", 1e-3 * (double)usage.ru_maxrss, "MB");
    system_destroy(sys);
    shell_destroy(shell);
    state_destroy(&state);
    mem_free(p);
}

void bench_contact(void)
{
    for (int cells = 14; cells <= 28; cells *= 2)
        for (int self = 0; self < 2; self++) stack(cells, self);
    scene("fold");
    scene("bud");
    bench_sweeps("octopus_pipe1", (const char *const[]){"time.steps=300", "design.iterations=1"});
}
