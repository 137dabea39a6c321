/* Hard equilibria: how many Newton iterations and factorisations each takes from the flat state, with both bending models.
 * Stars, bars and Sze's problems are those that the method was measured on (docs/newton.md); strips on edge
 * buckle sideways under their weight; stiff sheets hang from an edge or a corner. */
#include "base/memory.h"
#include "bench/bench.h"
#include "shell/shell.h"
#include "solve/ramp.h"
#include "surface/shapes.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Body {
    Shell *shell;
    System *sys;
    double *p;
    State state;
    double young;
} Body;

static const char *const model_names[] = {[BENDING_MIDEDGE] = "midedge", [BENDING_HINGE] = "hinge"};

static int total_iterations[2], total_factorizations[2]; /* of the 19 problems, by model */

static Body body_create(MeshFile *file, BendingModel bending, double thickness, double poisson, double young)
{
    Error err;
    Mesh *mesh = mesh_create(file, 0, NULL, &err);
    mesh_file_clear(file);
    if (!mesh) abort();
    Body b = {.shell = shell_create(mesh, NULL), .young = young};
    b.shell->thickness = thickness, b.shell->poisson = poisson, b.shell->bending = bending,
    b.shell->density = 1000;
    return b;
}

static Body sheet_body(double length, double width, int cells, int across, BendingModel bending,
                       double thickness, double poisson, double young)
{
    MeshFile file = {0};
    Error err;
    if (!shape_sheet((double[]){length, width}, (int[]){cells, across}, PATTERN_RIGHT, &file, &err)) abort();
    return body_create(&file, bending, thickness, poisson, young);
}

static void body_destroy(Body *b)
{
    system_destroy(b->sys);
    shell_destroy(b->shell);
    mem_free(b->p);
    state_destroy(&b->state);
}

/* Held where x = 0, the slope too. */
static void clamp_root(Body *b)
{
    const Mesh *mesh = b->shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; mesh->rest[v][0] < 1e-9 && i < 3; i++) shell_fix(b->shell, v, i);
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh->rest[mesh->edges[e][0]][0] < 1e-9 && mesh->rest[mesh->edges[e][1]][0] < 1e-9)
            shell_clamp(b->shell, e);
}

/* After fixing: system, parameters and the rest state. */
static void prepare(Body *b)
{
    b->sys = shell_system(b->shell);
    b->p = mem_alloc((size_t)b->shell->params.size, sizeof *b->p);
    b->state = system_state(b->sys);
    shell_default_params(b->shell, b->p);
    shell_rest_state(b->shell, b->state.x);
    for (int f = 0; f < b->shell->mesh->face_count; f++) b->p[b->shell->young + f] = b->young;
}

static void magnetise(Body *b, int face, double x, double y, double z)
{
    double *m = b->p + b->shell->magnetization + 3 * face;
    m[0] = x, m[1] = y, m[2] = z;
}

static void set_field(Body *b, double x, double y, double z)
{
    double *field = b->p + b->shell->flux.uniform;
    field[0] = x, field[1] = y, field[2] = z;
}

static void set_gravity(Body *b, double density, double x, double y, double z)
{
    double *g = b->p + b->shell->gravity, unit = density / b->shell->density;
    g[0] = x * unit, g[1] = y * unit, g[2] = z * unit;
}

typedef struct Count {
    int iterations, factorizations;
    NewtonStatus status;
} Count;

static void solve(Body *b, int steps, const double *from, Count *count)
{
    RampDef def = ramp_default();
    def.steps = steps;
    RampInfo info = ramp_solve(b->sys, &b->shell->params, &def, from, b->p, &b->state);
    count->iterations += info.newton.iterations;
    count->factorizations += info.newton.factorizations;
    if (info.newton.status > count->status) count->status = info.newton.status;
}

static void print_count(const char *name, BendingModel bending, const Count *count, double height)
{
    printf("equilibrium_%s_%s %d iterations (%d factorisations, %s, out of plane %.3g)\n", name,
           model_names[bending], count->iterations, count->factorizations, newton_status_name(count->status),
           height);
    fflush(stdout);
}

/* Largest way out of the plane, over the body's diagonal. */
static double out_of_plane(const Body *b)
{
    double most = 0;
    for (int v = 0; v < b->shell->mesh->vertex_count; v++) most = fmax(most, fabs(b->state.x[3 * v + 2]));
    return most / mesh_diagonal(b->shell->mesh);
}

static void add_to_sums(BendingModel bending, const Count *count)
{
    total_iterations[bending] += count->iterations;
    total_factorizations[bending] += count->factorizations;
}

/* ---- Stars: 40 mm, the middle held, radial magnetisation, a field across ---- */

static Body star(BendingModel bending, double thickness)
{
    MeshFile file = {0};
    Error err;
    if (!shape_hexagram(0.04, 13, &file, &err)) abort();
    Body b = body_create(&file, bending, thickness, 0.5, 1e5);
    const Mesh *mesh = b.shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; hypot(mesh->rest[v][0], mesh->rest[v][1]) < 4e-3 && i < 3; i++)
            shell_fix(b.shell, v, i);
    prepare(&b);
    return b;
}

typedef enum StarKind { ROLLED, REVERSED, ANTIPARALLEL } StarKind;

static void star_problem(const char *name, BendingModel bending, double thickness, double m, StarKind kind)
{
    Body b = star(bending, thickness);
    const Mesh *mesh = b.shell->mesh;
    for (int f = 0; f < mesh->face_count; f++) {
        double x = 0, y = 0;
        for (int i = 0; i < 3; i++)
            x += mesh->rest[mesh->faces[f][i]][0], y += mesh->rest[mesh->faces[f][i]][1];
        double r = hypot(x, y);
        if (kind == ANTIPARALLEL)
            magnetise(&b, f, 0, 0, -m);
        else
            magnetise(&b, f, m * x / r, m * y / r, 0);
    }
    Count count = {0};
    set_field(&b, 0, 0, 0.05);
    solve(&b, 1, NULL, &count);
    if (kind == REVERSED) {
        set_field(&b, 0, 0, -0.05);
        solve(&b, 1, NULL, &count);
    }
    print_count(name, bending, &count, out_of_plane(&b));
    add_to_sums(bending, &count);
    body_destroy(&b);
}

static void stars(BendingModel bending)
{
    star_problem("star_1mm_20kA", bending, 1e-3, 2e4, ROLLED);
    star_problem("star_1mm_60kA", bending, 1e-3, 6e4, ROLLED);
    star_problem("star_200um_800A", bending, 2e-4, 800, ROLLED);
    star_problem("star_100um_200A", bending, 1e-4, 200, ROLLED);
    star_problem("star_200um_20kA", bending, 2e-4, 2e4, ROLLED);
    star_problem("star_1mm_reversed", bending, 1e-3, 2e4, REVERSED);
    star_problem("star_200um_reversed", bending, 2e-4, 800, REVERSED);
    star_problem("star_1mm_antiparallel", bending, 1e-3, 2e4, ANTIPARALLEL);
    star_problem("star_200um_antiparallel", bending, 2e-4, 800, ANTIPARALLEL);
}

/* ---- Bars: 40 x 5 mm, clamped at one end ---- */

static void bar_problem(const char *name, BendingModel bending, double thickness, double m, double from,
                        const double direction[2])
{
    Body b = sheet_body(0.04, 0.005, 48, 6, bending, thickness, 0.5, 1e5);
    const Mesh *mesh = b.shell->mesh;
    clamp_root(&b);
    prepare(&b);
    for (int f = 0; f < mesh->face_count; f++)
        if (mesh->rest[mesh->faces[f][0]][0] >= from) magnetise(&b, f, m, 0, 0);
    set_field(&b, 0.05 * direction[0], 0, 0.05 * direction[1]);
    Count count = {0};
    solve(&b, 1, NULL, &count);
    print_count(name, bending, &count, out_of_plane(&b));
    add_to_sums(bending, &count);
    body_destroy(&b);
}

static void bars(BendingModel bending)
{
    const double across[2] = {0, 1}, against[2] = {-1, 0}, turned[2] = {cos(0.75 * M_PI), sin(0.75 * M_PI)};
    bar_problem("bar_1mm_across", bending, 1e-3, 5e4, 0, across);
    bar_problem("bar_200um_across", bending, 2e-4, 2e3, 0, across);
    bar_problem("tip_1mm_135deg", bending, 1e-3, 5e4, 0.03, turned);
    bar_problem("tip_200um_135deg", bending, 2e-4, 2e3, 0.03, turned);
    bar_problem("bar_1mm_against", bending, 1e-3, 1e4, 0, against);
    bar_problem("bar_200um_against", bending, 2e-4, 400, 0, against);
}

/* ---- Sze, Liu, Lo 2004, problems 3.1 and 3.3 ---- */

static void load_rows(Body *b, int first, int stride, int count, double force)
{
    for (int k = 0; k < count; k++)
        b->p[b->shell->load + 3 * (first + k * stride) + 2] =
            force / (count - 1) * (k == 0 || k == count - 1 ? 0.5 : 1);
}

static void cantilever(const char *name, BendingModel bending, double thickness)
{
    enum { CELLS = 48, ACROSS = 5 };
    Body b = sheet_body(10, 1, CELLS, ACROSS, bending, thickness, 0, 1.2e6);
    clamp_root(&b);
    prepare(&b);
    load_rows(&b, CELLS, CELLS + 1, ACROSS + 1, 4 * pow(thickness / 0.1, 3));
    Count count = {0};
    solve(&b, 1, NULL, &count);
    print_count(name, bending, &count, out_of_plane(&b));
    add_to_sums(bending, &count);
    body_destroy(&b);
}

enum { RADIAL = 8, AROUND = 72 };

static MeshFile annulus_mesh(void)
{
    MeshFile file = {.vertex_count = (RADIAL + 1) * (AROUND + 1), .face_count = 2 * RADIAL * AROUND};
    file.vertices = mem_alloc((size_t)file.vertex_count, sizeof *file.vertices);
    file.faces = mem_alloc((size_t)file.face_count, sizeof *file.faces);
    for (int v = 0; v < file.vertex_count; v++) {
        double r = 6 + 4.0 * (v % (RADIAL + 1)) / RADIAL, angle = 2 * M_PI * (v / (RADIAL + 1)) / AROUND;
        file.vertices[v][0] = r * cos(angle), file.vertices[v][1] = r * sin(angle);
    }
    for (int c = 0; c < RADIAL * AROUND; c++) {
        int v = c / RADIAL * (RADIAL + 1) + c % RADIAL, w = v + RADIAL + 1;
        int faces[2][3] = {{v, v + 1, w + 1}, {v, w + 1, w}};
        memcpy(file.faces[2 * c], faces, sizeof faces);
    }
    return file;
}

static void annulus(const char *name, BendingModel bending, int steps)
{
    MeshFile file = annulus_mesh();
    Body b = body_create(&file, bending, 0.03, 0, 21e6);
    for (int i = 0; i <= RADIAL; i++) {
        for (int k = 0; k < 3; k++) shell_fix(b.shell, i, k);
        if (i > 0) shell_clamp(b.shell, mesh_edge(b.shell->mesh, i - 1, i));
    }
    prepare(&b);
    load_rows(&b, AROUND * (RADIAL + 1), 1, RADIAL + 1, 0.8 * 4);
    Count count = {0};
    solve(&b, steps, NULL, &count);
    print_count(name, bending, &count, out_of_plane(&b));
    add_to_sums(bending, &count);
    body_destroy(&b);
}

static void published(BendingModel bending)
{
    annulus("annulus_1_step", bending, 1);
    annulus("annulus_4_steps", bending, 4);
    cantilever("cantilever_h_0.01L", bending, 0.1);
    cantilever("cantilever_h_0.001L", bending, 0.01);
}

/* ---- Strips on edge, 200 x 10 mm: load = rho g h L^3/D, lateral buckling at 18.17 ---- */

static void strip_on_edge(BendingModel bending, double thickness, double part, double poisson)
{
    const double young = 3e9, length = 0.2;
    Body b = sheet_body(length, 0.01, 80, 4, bending, thickness, poisson, young);
    clamp_root(&b);
    prepare(&b);
    double rigidity = young * pow(thickness, 3) / (12 * (1 - poisson * poisson));
    double density = part * 18.17 * rigidity / (9.81 * thickness * pow(length, 3));
    set_gravity(&b, density, 0, -9.81, 0);
    Count count = {0};
    solve(&b, 1, NULL, &count);
    char name[80];
    snprintf(name, sizeof name, "strip_on_edge_h_L/%.0f_load_%.2f", length / thickness, part);
    print_count(name, bending, &count, out_of_plane(&b));
    body_destroy(&b);
}

static void strips(BendingModel bending)
{
    const double thickness[] = {1e-3, 4e-4, 2e-4, 1e-4, 4e-5}, parts[] = {0.5, 0.95, 1.05, 1.5, 3, 11};
    for (size_t i = 0; i < sizeof thickness / sizeof *thickness; i++)
        for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
            strip_on_edge(bending, thickness[i], parts[k], 0);
}

/* ---- Sheets of real stiffness, 100 x 25 mm, hung from an edge or a corner ---- */

static void hanging(const char *name, BendingModel bending, double thickness, double young, double density,
                    bool corner)
{
    Body b = sheet_body(0.1, 0.025, 16, 4, bending, thickness, 0.3, young);
    const Mesh *mesh = b.shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; (corner ? v == 0 : mesh->rest[v][0] < 1e-9) && i < 3; i++) shell_fix(b.shell, v, i);
    prepare(&b);
    if (density > 0)
        set_gravity(&b, density, 0, 0, -9.81);
    else
        set_field(&b, 0, 0, 0.01);
    for (int f = 0; density == 0 && f < mesh->face_count; f++) magnetise(&b, f, 1e5, 0, 0);
    Count count = {0};
    solve(&b, 1, NULL, &count);
    print_count(name, bending, &count, out_of_plane(&b));
    body_destroy(&b);
}

/* A soft strip with a hard magnetic chip at its end, turned by 135 degrees. */
static void chip(const char *name, BendingModel bending, double thickness, double field)
{
    const double young = 1e6;
    Body b = sheet_body(0.03, 0.003, 60, 6, bending, thickness, 0.45, young);
    const Mesh *mesh = b.shell->mesh;
    clamp_root(&b);
    prepare(&b);
    for (int f = 0; f < mesh->face_count; f++)
        if (mesh->rest[mesh->faces[f][0]][0] >= 0.027)
            magnetise(&b, f, 6e5, 0, 0), b.p[b.shell->young + f] = 1e5 * young;
    set_field(&b, field * cos(0.75 * M_PI), 0, field * sin(0.75 * M_PI));
    Count count = {0};
    solve(&b, 1, NULL, &count);
    print_count(name, bending, &count, out_of_plane(&b));
    body_destroy(&b);
}

static void stiff_sheets(BendingModel bending)
{
    hanging("hung_rubber", bending, 1e-3, 1e6, 1100, false);
    hanging("hung_pet", bending, 5e-5, 3e9, 1400, false);
    hanging("hung_aluminium_foil", bending, 1.6e-5, 7e10, 2700, false);
    hanging("hung_steel", bending, 1e-3, 2e11, 7800, false);
    hanging("hung_paper_by_corner", bending, 1e-4, 3e9, 800, true);
    hanging("hinged_magnet", bending, 1e-4, 1e11, 0, false);
    chip("chip_1mm_20mT", bending, 1e-3, 0.02);
    chip("chip_300um_20mT", bending, 3e-4, 0.02);
    chip("chip_100um_1mT", bending, 1e-4, 1e-3);
}

void bench_equilibria(void)
{
    for (BendingModel bending = BENDING_MIDEDGE; bending <= BENDING_HINGE; bending++) {
        stars(bending);
        bars(bending);
        published(bending);
        printf("equilibria_19_problems_%s %d iterations (%d factorisations)\n", model_names[bending],
               total_iterations[bending], total_factorizations[bending]);
        strips(bending);
        stiff_sheets(bending);
    }
}
