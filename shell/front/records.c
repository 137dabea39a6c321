/* Shells in the journal. */
#include "base/memory.h"
#include "job/run.h"
#include "shell/front/front.h"
#include "shell/stress.h"
#include <stddef.h>
#include <string.h>

/* Edges are named as scenes and their tables name them: by the vertices of the file. Where some of these were
 * removed or joined, file_vertex says which one each vertex of the result is. */
static void add_edges(const Mesh *mesh, Arrays *list)
{
    int *edges = arrays_keep(list, mem_alloc(2 * (size_t)mesh->edge_count, sizeof *edges));
    for (int i = 0; i < 2 * mesh->edge_count; i++) edges[i] = mesh->file_vertex[mesh->edges[i / 2][i % 2]];
    arrays_add(list, array_int("edges", edges, 2, mesh->edge_count, 2));
    if (mesh->vertex_count != mesh->file_vertex_count)
        arrays_add(list, array_int("file_vertex", mesh->file_vertex, 1, mesh->vertex_count, 0));
}

void shell_add_static(const Model *model, Arrays *list)
{
    const Mesh *mesh = model->mesh;
    arrays_add(list, array_float("rest", "m", mesh->rest[0], 2, mesh->vertex_count, 3));
    arrays_add(list, array_int("faces", mesh->faces[0], 2, mesh->face_count, 3));
    add_edges(mesh, list);
}

/* Does it differ from face to face, or from one design to the next? */
static bool matters(const Model *model, const ParamBlock *block, const double *p)
{
    bool is = false;
    for (int k = 0; k < model->design.unknown_count; k++) is |= model->design.unknowns[k].block == block;
    for (int f = 1; f < block->count; f++) is |= p[block->offset + f] != p[block->offset];
    return is;
}

void shell_add_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list)
{
    const Shell *shell = model->self;
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    for (int t = 0; t < system_term_count(sys); t++) {
        const Term *term = system_term(sys, t);
        int count = term->ops->count(term->self);
        if (count != shell->mesh->face_count) continue;
        double *energy = arrays_numbers(list, (size_t)count);
        system_term_energy(sys, t, &at, energy);
        char *name = arrays_keep(list, mem_format("cell/energy_%s", term->ops->name));
        arrays_add(list, array_float(name, "J", energy, 1, count, 0));
    }
    if (!whole) return;
    arrays_add(list, run_block("cell/magnetization", params_find(&shell->params, "magnetization"), shot->p));
    arrays_add(list, run_block("cell/young", params_find(&shell->params, "young"), shot->p));
    for (int k = 0; k < 2; k++) {
        const ParamBlock *block = params_find(&shell->params, k ? "density" : "thickness");
        char *name = arrays_keep(list, mem_format("cell/%s", block->name));
        if (matters(model, block, shot->p)) arrays_add(list, run_block(name, block, shot->p));
    }
}

void shell_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list)
{
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    double *gradient = arrays_numbers(list, (size_t)system_dof_count(sys));
    system_gradient(sys, &at, gradient);
    char *name = arrays_keep(list, mem_format("%s/gradient", prefix));
    arrays_add(list, array_float(name, "N", gradient, 2, model->point_count, 3));
}

/* Numbers of FaceStress that a frame shows. */
static const struct {
    const char *name, *unit;
    size_t offset;
} shown[] = {
    {"cell/strain_1", "", offsetof(FaceStress, strain[0])},
    {"cell/strain_2", "", offsetof(FaceStress, strain[1])},
    {"cell/curvature_1", "1/m", offsetof(FaceStress, curvature[0])},
    {"cell/curvature_2", "1/m", offsetof(FaceStress, curvature[1])},
    {"cell/von_mises", "Pa", offsetof(FaceStress, von_mises[STRESS_MIDDLE])},
    {"cell/von_mises_top", "Pa", offsetof(FaceStress, von_mises[STRESS_TOP])},
    {"cell/von_mises_bottom", "Pa", offsetof(FaceStress, von_mises[STRESS_BOTTOM])},
};

void shell_add_stress(const Model *model, const Snapshot *shot, Arrays *list)
{
    const Shell *shell = model->self;
    int count = shell->mesh->face_count;
    Point at = state_point(&shot->at, shot->p);
    FaceStress *stress = mem_alloc((size_t)count, sizeof *stress);
    shell_stresses(shell, shot->load_case->sys, &at, stress);
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++) {
        double *values = arrays_numbers(list, (size_t)count);
        for (int f = 0; f < count; f++)
            values[f] = *(const double *)((const char *)&stress[f] + shown[k].offset);
        arrays_add(list, array_float(shown[k].name, shown[k].unit, values, 1, count, 0));
    }
    mem_free(stress);
}
