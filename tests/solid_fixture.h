/* solid_fixture.h - solids of generated boxes, and what is solved with them, for tests. */
#pragma once
#include "base/memory.h"
#include "base/random.h"
#include "solid/shapes.h"
#include "solid/solid.h"
#include "solve/newton.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

/* Of a mesh, which is cleared; takes the fields (NULL: none). */
static inline Solid *solid_of_mesh(MeshFile *file, int order, const SolidDef *def, const FluxFields *fields)
{
    Error err;
    Tets *tets = tets_create(file, order, NULL, &err);
    if (!tets) fail_msg("%s", err.text);
    mesh_file_clear(file);
    return solid_create(tets, def, fields);
}

/* A box whose inner vertices are moved at random by up to that part of a cell. */
static inline MeshFile box_mesh(const double size[3], const int cells[3], double irregular)
{
    MeshFile file;
    Error err;
    if (!solid_shape_box(size, cells, &file, &err)) fail_msg("%s", err.text);
    Random random = random_seed(7);
    for (int v = 0; v < file.vertex_count; v++) {
        double *x = file.vertices[v];
        bool inside = true;
        for (int i = 0; i < 3; i++) inside &= x[i] > 1e-9 && x[i] < size[i] - 1e-9;
        for (int i = 0; inside && i < 3; i++) x[i] += irregular * size[i] / cells[i] * random_signed(&random);
    }
    return file;
}

static inline Solid *solid_box(const double size[3], const int cells[3], int order, const SolidDef *def)
{
    MeshFile file = box_mesh(size, cells, 0);
    return solid_of_mesh(&file, order, def, NULL);
}

/* Holds coordinate axis of the nodes at that place along it. */
static inline void solid_hold_side(Solid *solid, int axis, double at, int coordinate)
{
    for (int v = 0; v < tets_node_count(solid->tets); v++)
        if (fabs(solid->tets->surface->rest[v][axis] - at) < 1e-9) solid->fixed[3 * v + coordinate] = true;
}

/* A solid at rest; owns all of it. */
typedef struct SolidBody {
    Solid *solid;
    System *sys;
    double *p;
    State state;
} SolidBody;

static inline SolidBody solid_body(Solid *solid, bool motion, double young)
{
    SolidBody b = {.solid = solid, .sys = solid_system(solid, motion)};
    b.state = system_state(b.sys);
    b.p = mem_alloc((size_t)solid->params.size, sizeof *b.p);
    solid_default_params(solid, b.p);
    for (int t = 0; t < solid->tets->count; t++) b.p[solid->young + t] = young;
    memcpy(b.state.x, solid->tets->surface->rest, (size_t)solid_dof_count(solid) * sizeof *b.state.x);
    return b;
}

static inline void solid_body_clear(SolidBody *b)
{
    system_destroy(b->sys);
    state_destroy(&b->state);
    mem_free(b->p);
    solid_destroy(b->solid);
}

static inline NewtonInfo solid_solve(SolidBody *b, const NewtonDef *def)
{
    Point at = state_point(&b->state, b->p);
    return newton_minimize(b->sys, def, &at, &b->state, NULL);
}

/* x = A X at every node. */
static inline void solid_map(SolidBody *b, const double A[3][3])
{
    double(*rest)[3] = b->solid->tets->surface->rest;
    for (int i = 0; i < solid_dof_count(b->solid); i++) {
        const double *X = rest[i / 3], *row = A[i % 3];
        b->state.x[i] = row[0] * X[0] + row[1] * X[1] + row[2] * X[2];
    }
}

/* Derivatives of psi to the principal stretches, of Young's modulus 1, from the definitions. */
static inline double solid_stress(SolidMaterial material, double poisson, const double s[3], int i)
{
    double mu = 0.5 / (1 + poisson), lambda = poisson / (1 + poisson) / (1 - 2 * poisson);
    double J = s[0] * s[1] * s[2], trace = 0.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] - 3);
    if (material == SOLID_ST_VENANT_KIRCHHOFF) return s[i] * (lambda * trace + mu * (s[i] * s[i] - 1));
    double slope = material == SOLID_NEO_HOOKEAN ? (lambda + mu) * (J - 1) - mu : (lambda * log(J) - mu) / J;
    return mu * s[i] + slope * J / s[i];
}

/* The stretch of the free sides, at which they bear nothing; loaded: how many axes are pulled. */
static inline void solid_free_stretch(SolidMaterial material, double poisson, int loaded, double s[3])
{
    double low = 0.5, high = 1.5;
    for (int k = 0; k < 100; k++) {
        for (int i = loaded; i < 3; i++) s[i] = 0.5 * (low + high);
        if (solid_stress(material, poisson, s, 2) > 0)
            high = s[2];
        else
            low = s[2];
    }
}
