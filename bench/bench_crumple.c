/* A large sheet that is crushed onto itself: pleats, side by side and not quite straight, that are thrown together. */
#include "base/clock.h"
#include "base/memory.h"
#include "base/random.h"
#include "bench/bench.h"
#include "shell/shell.h"
#include "solve/march.h"
#include "surface/shapes.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

enum { STEPS = 3 };

/* m; in parts of a thickness the pitch of the pleats and how far vertices are from straight; 1/s: how fast all draws together. */
static const double CELL = 1e-3, THICKNESS = 1e-3, FLIGHT = 14e-3, PITCH = 1.2, NOISE = 0.03, RATE = 100;
static const double YOUNG = 1e5;

static Mesh *sheet_mesh(int cells)
{
    MeshFile sheet;
    Error err;
    double size = cells * CELL;
    Mesh *mesh = NULL;
    if (shape_sheet((double[]){size, size}, (int[]){cells, cells}, PATTERN_ALTERNATE, &sheet, &err))
        mesh = mesh_create(&sheet, 0, NULL, &err);
    if (!mesh) bench_fail("%s", err.text);
    mesh_file_clear(&sheet);
    return mesh;
}

/* Of arc length s along a row of flights up and down, with half circles between them: x and z. */
static void pleat(double s, double to[2])
{
    double pitch = PITCH * THICKNESS, turn = M_PI * pitch / 2, period = FLIGHT + turn;
    int k = (int)floor(s / period);
    double rest = s - k * period, sign = k % 2 ? -1 : 1, over = fmax(0, rest - FLIGHT),
           angle = over / (pitch / 2);
    double z = fmin(rest, FLIGHT) - FLIGHT / 2 + pitch / 2 * sin(angle);
    to[0] = k * pitch + pitch / 2 * (1 - cos(angle));
    to[1] = sign * z;
}

static void set_state(const Shell *shell, State *state)
{
    Random random = random_seed(1);
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        double *x = state->x + 3 * v, at[2];
        pleat(shell->mesh->rest[v][0], at);
        x[0] = at[0], x[2] = at[1];
        state->v[3 * v] = -RATE * x[0];
        for (int i = 0; i < 3; i++) x[i] += NOISE * THICKNESS * random_signed(&random);
    }
}

static Shell *crumpled_shell(int cells)
{
    Shell *shell = shell_create(sheet_mesh(cells), NULL);
    shell->thickness = THICKNESS, shell->poisson = 0.45, shell->density = 1000,
    shell->bending = BENDING_HINGE;
    WorldBody shown = shell_world_body(shell);
    World *world = shell->world = world_create(&shown, NULL, 0);
    world->self = true, world->distance = THICKNESS;
    world_add_params(world, &shell->params);
    return shell;
}

static void crumple(int cells, int threads)
{
    char name[60], text[100];
    snprintf(name, sizeof name, "crumple_%d_%d_thread%s", 2 * cells * cells, threads, threads > 1 ? "s" : "");
    Shell *shell = crumpled_shell(cells);
    System *sys = shell_dynamic_system(shell);
    Workers *workers = workers_create(threads);
    system_set_workers(sys, workers);
    State state = system_state(sys);
    double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
    shell_default_params(shell, p);
    shell_rest_state(shell, state.x);
    set_state(shell, &state);
    for (int f = 0; f < shell->mesh->face_count; f++) p[shell->young + f] = YOUNG;
    p[shell->world->self_stiffness] = YOUNG * pow(THICKNESS, 3);
    MarchDef def = march_default();
    for (int n = 0; n < STEPS; n++) {
        MarchInfo info;
        WorldSums sums = {0};
        struct rusage usage;
        double start = clock_seconds();
        if (!march_step(sys, &def, 1e-3, p, &state, &info)) bench_fail("%s stops in step %d", name, n + 1);
        double seconds = clock_seconds() - start;
        Point at = state_point(&state, p);
        world_measure(shell->world, &at, &sums);
        getrusage(RUSAGE_SELF, &usage);
        const struct {
            const char *what, *unit;
            double value;
        } rows[] = {{"pairs", "", sums.pairs},
                    {"seconds", "s", seconds},
                    {"newton", "", info.newton.iterations},
                    {"factorizations", "", info.newton.factorizations},
                    {"megabytes", "MB", 1e-3 * (double)usage.ru_maxrss}};
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            snprintf(text, sizeof text, "%s_step_%d_%s", name, n + 1, rows[k].what);
            bench_print(text, rows[k].value, rows[k].unit);
        }
    }
    system_destroy(sys);
    shell_destroy(shell);
    workers_destroy(workers);
    state_destroy(&state);
    mem_free(p);
}

void bench_crumple(void)
{
    const char *cells = getenv("CRUMPLE");
    int most = cells ? atoi(cells) : 30;
    for (int threads = 1; threads <= 2; threads++) crumple(most, threads);
}
