/* shell_fixture.h - shells of generated meshes, and what is solved with them, for tests. */
#pragma once
#include "base/memory.h"
#include "shell/shell.h"
#include "surface/shapes.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Of a mesh, which is cleared; takes the fields (NULL: none). */
static inline Shell *shell_in_fields(MeshFile *file, const FluxFields *fields)
{
    Error err;
    Mesh *mesh = mesh_create(file, 0, NULL, &err);
    if (!mesh) fail_msg("%s", err.text);
    mesh_file_clear(file);
    return shell_create(mesh, fields);
}

static inline Shell *shell_of_mesh(MeshFile *file)
{
    return shell_in_fields(file, NULL);
}

static inline Shell *shell_of_sheet(const double size[2], const int cells[2], ShapePattern pattern)
{
    MeshFile file = {0};
    Error err;
    if (!shape_sheet(size, cells, pattern, &file, &err)) fail_msg("%s", err.text);
    return shell_of_mesh(&file);
}

/* Where x = 0; clamp: the slope too. */
static inline void hold_root(Shell *shell, bool clamp)
{
    const Mesh *mesh = shell->mesh;
    for (int i = 0; i < 3 * mesh->vertex_count; i++)
        if (mesh->rest[i / 3][0] < 1e-9) shell_fix(shell, i / 3, i % 3);
    for (int e = 0; clamp && e < mesh->edge_count; e++)
        if (mesh->rest[mesh->edges[e][0]][0] < 1e-9 && mesh->rest[mesh->edges[e][1]][0] < 1e-9)
            shell_clamp(shell, e);
}

/* A shell at rest; owns all of it. */
typedef struct Body {
    Shell *shell;
    System *sys;
    double *p;
    State state;
} Body;

static inline Body body_create(Shell *shell, System *sys, double young)
{
    Body b = {.shell = shell, .sys = sys, .state = system_state(sys)};
    b.p = mem_alloc((size_t)shell->params.size, sizeof *b.p);
    shell_default_params(shell, b.p);
    shell_rest_state(shell, b.state.x);
    for (int f = 0; f < shell->mesh->face_count; f++) b.p[shell->young + f] = young;
    return b;
}

static inline void body_clear(Body *b)
{
    system_destroy(b->sys);
    shell_destroy(b->shell);
    mem_free(b->p);
    state_destroy(&b->state);
}
