/* self_fixture.h - shells that touch themselves, for tests: a folding strip, a closing star, sheets that fly at each other. */
#pragma once
#include "shell/terms.h"
#include "solve/kinetic.h"
#include "tests/shell_fixture.h"
#include "world/crossings.h"
#include <math.h>
#include <string.h>

typedef struct SelfBody {
    Body body;
    SelfContactDef def;
    int contact, friction; /* terms of the system; -1: not there */
} SelfBody;

/* Blocks for the stiffness and the coefficient; before the first vector. */
static inline SelfContactDef self_def(Shell *shell, double distance)
{
    const Mesh *mesh = shell->mesh;
    return (SelfContactDef){.vertex_count = mesh->vertex_count,
                            .face_count = mesh->face_count,
                            .edge_count = mesh->edge_count,
                            .faces = (const int(*)[3])mesh->faces,
                            .edges = (const int(*)[2])mesh->edges,
                            .rest = (const double(*)[3])mesh->rest,
                            .part = mesh->vertex_component,
                            .fixed = shell->fixed,
                            .distance = distance,
                            .stiffness = params_add(&shell->params, "self_stiffness", "J", 1, 1, false),
                            .friction = params_add(&shell->params, "self_friction", "", 1, 1, false),
                            .slip_speed = 1e-3};
}

/* As shell_system and shell_dynamic_system, with what touches. */
static inline System *self_system(const Shell *shell, const SelfContactDef *def, bool dynamic, bool contact,
                                  bool friction)
{
    const Mesh *mesh = shell->mesh;
    int positions = 3 * mesh->vertex_count;
    DofClass classes[] = {{.count = positions, .size = mesh_diagonal(mesh)},
                          {.first = positions, .count = mesh->edge_count, .size = 1}};
    System *sys = system_create(shell_dof_count(shell), classes, 2);
    for (int t = 0; t < shell_term_row_count; t++) system_add(sys, shell_term_rows[t].create(shell));
    if (dynamic) {
        system_add(sys, kinetic_inertia_term(shell_masses(shell)));
        system_add(sys, kinetic_damping_term(mesh->vertex_count, NULL, shell->damping));
    }
    if (contact) system_add(sys, self_contact_term(def));
    if (friction) system_add(sys, self_friction_term(def));
    for (int i = 0; i < positions; i++)
        if (shell->fixed[i]) system_fix(sys, i);
    for (int e = 0; e < mesh->edge_count; e++)
        if (shell->clamped[e] || shell->bending == BENDING_HINGE) system_fix(sys, shell_angle_dof(shell, e));
    system_prepare(sys);
    return sys;
}

static inline SelfBody self_body(Shell *shell, SelfContactDef def, bool contact, double mu, double young)
{
    SelfBody b = {.def = def, .contact = -1, .friction = -1};
    System *sys = self_system(shell, &def, true, contact, contact && mu > 0);
    b.body = body_create(shell, sys, young);
    double h = shell->thickness;
    b.body.p[def.stiffness] = young * h * h * h;
    b.body.p[def.friction] = mu;
    if (contact) b.contact = shell_term_row_count + 2;
    if (contact && mu > 0) b.friction = b.contact + 1;
    return b;
}

static inline int self_crossings(const SelfBody *b)
{
    return self_contact_crossings(&b->def, b->body.state.x, NULL, 0);
}

static inline SelfContactFigures self_figures(const SelfBody *b)
{
    return self_contact_figures(system_term(b->body.sys, b->contact), b->body.state.x,
                                b->body.p[b->def.stiffness]);
}

static const double SELF_YOUNG = 1e5;

/* A strip of 40 x 8 mm whose halves are magnetised to fold onto each other about its middle, which is held. */
static inline SelfBody folding_strip(const int cells[2], bool contact, double mu, double margin)
{
    Shell *shell = shell_of_sheet((double[]){0.04, 0.008}, cells, PATTERN_ALTERNATE);
    const Mesh *mesh = shell->mesh;
    shell->thickness = 1e-3, shell->poisson = 0.5, shell->density = 1000, shell->bending = BENDING_HINGE;
    double middle = 0.02, half = 0.55 * 0.04 / cells[0];
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; fabs(mesh->rest[v][0] - middle) < half && i < 3; i++) shell_fix(shell, v, i);
    SelfContactDef def = self_def(shell, 1e-3);
    def.margin = margin;
    SelfBody b = self_body(shell, def, contact, mu, SELF_YOUNG);
    for (int f = 0; f < mesh->face_count; f++) {
        double x = 0;
        for (int i = 0; i < 3; i++) x += mesh->rest[mesh->faces[f][i]][0] / 3;
        b.body.p[shell->magnetization + 3 * f] = x > middle ? 3.5e4 : -3.5e4;
        b.body.p[shell->magnetization + 3 * f + 2] = -3.5e4;
    }
    return b;
}

/* A star of 40 mm whose arms are magnetised inwards and down, its middle held. */
static inline SelfBody closing_star(int n, bool contact, double margin)
{
    MeshFile file = {0};
    Error err;
    assert_true(shape_hexagram(0.04, n, &file, &err));
    Shell *shell = shell_of_mesh(&file);
    const Mesh *mesh = shell->mesh;
    shell->thickness = 1e-3, shell->poisson = 0.5, shell->density = 1000, shell->bending = BENDING_HINGE;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; hypot(mesh->rest[v][0], mesh->rest[v][1]) < 0.004 && i < 3; i++)
            shell_fix(shell, v, i);
    SelfContactDef def = self_def(shell, 1e-3);
    def.margin = margin;
    SelfBody b = self_body(shell, def, contact, 0, SELF_YOUNG);
    for (int f = 0; f < mesh->face_count; f++) {
        double x[3] = {0};
        for (int i = 0; i < 9; i++) x[i % 3] += mesh->rest[mesh->faces[f][i / 3]][i % 3] / 3;
        double r = hypot(x[0], x[1]);
        for (int i = 0; i < 3; i++)
            b.body.p[shell->magnetization + 3 * f + i] = i < 2 ? -3.5e4 * x[i] / r : -3.5e4;
    }
    return b;
}

/* Two sheets of 12 mm, 6 mm from each other, turned and shifted a little; the second stands on edge, or lies above the other. */
static inline MeshFile two_sheets(int cells, bool on_edge)
{
    MeshFile file = {0}, both = {0};
    Error err;
    assert_true(shape_sheet((double[]){0.012, 0.012}, (int[]){cells, cells}, PATTERN_ALTERNATE, &file, &err));
    both.path = mem_text("sheets");
    both.vertex_count = 2 * file.vertex_count, both.face_count = 2 * file.face_count;
    both.vertices = mem_alloc((size_t)both.vertex_count, sizeof *both.vertices);
    both.faces = mem_alloc((size_t)both.face_count, sizeof *both.faces);
    for (int v = 0; v < both.vertex_count; v++) {
        const double *x = file.vertices[v % file.vertex_count];
        bool second = v >= file.vertex_count;
        double c = cos(0.3), s = sin(0.3), tilt = 0.15;
        both.vertices[v][0] = second ? c * x[0] - s * x[1] + 0.003 : x[0];
        both.vertices[v][1] = second ? s * x[0] + c * x[1] + 0.001 : x[1];
        both.vertices[v][2] = second ? 0.006 + tilt * x[0] : 0;
        if (!second || !on_edge) continue;
        both.vertices[v][0] = c * x[0] + 0.002;
        both.vertices[v][1] = s * x[0] + 0.004;
        both.vertices[v][2] = 0.006 + x[1];
    }
    for (int f = 0; f < both.face_count; f++)
        for (int i = 0; i < 3; i++)
            both.faces[f][i] =
                file.faces[f % file.face_count][i] + (f >= file.face_count ? file.vertex_count : 0);
    mesh_file_clear(&file);
    return both;
}

/* Which fly at each other. */
static inline SelfBody flying_sheets(int cells, bool on_edge, double speed, double mu)
{
    MeshFile both = two_sheets(cells, on_edge);
    Shell *shell = shell_of_mesh(&both);
    shell->thickness = 5e-4, shell->poisson = 0.4, shell->density = 1000, shell->bending = BENDING_HINGE;
    SelfContactDef def = self_def(shell, 5e-4);
    SelfBody b = self_body(shell, def, true, mu, SELF_YOUNG);
    for (int v = 0; v < shell->mesh->vertex_count; v++)
        b.body.state.v[3 * v + 2] = shell->mesh->vertex_component[v] ? -speed / 2 : speed / 2;
    return b;
}

/* The field grows to 50 mT over 0.2 s. */
typedef struct SelfField {
    int flux_density;
    double rise; /* s */
} SelfField;

static inline void self_load(void *self, double time, double *p)
{
    const SelfField *field = self;
    p[field->flux_density + 2] = 0.05 * fmin(time / field->rise, 1);
}
