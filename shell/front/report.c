/* What `slender check` says of a shell, and what is doubtful about it. */
#include "base/memory.h"
#include "base/vec3.h"
#include "model/advise.h"
#include "model/coercivity.h"
#include "shell/front/front.h"
#include <math.h>
#include <string.h>

static const double LARGE_BODY = 2;       /* m: most likely a mesh in millimetres          */
static const double NEARLY_CRUSHED = 0.2; /* of a face's area, where no next state was found */
static const double CELLS_PER_LENGTH = 3; /* of the magnetic bending length, at least      */

/* Over a length h sqrt(Y/(12 M B)) a field bends the sheet by about a radian: cells must be smaller. */
static double bending_length(const Model *model, const Scene *scene)
{
    const Shell *shell = model->self;
    double largest = 0, stiffness = INFINITY, M_max = 0; /* of Y h^2 the smallest */
    for (int c = 0; c < model->case_count; c++)
        for (int s = 0; s < model->cases[c].stage_count; s++) {
            const double *p = model->cases[c].stages[s].p;
            double B = advise_largest_flux(model, scene, &model->cases[c], p);
            for (int f = 0; f < shell->mesh->face_count; f++) {
                M_max = fmax(M_max, vec3_length(vec3_load(p + shell->magnetization + 3 * f)));
                stiffness = fmin(stiffness, p[shell->young + f] * pow(p[shell->face_thickness + f], 2));
            }
            if (scene->design && scene->design->unknowns.magnetization)
                M_max = fmax(M_max, scene->design->unknowns.magnetization->scale);
            largest = fmax(largest, M_max * B);
        }
    return largest > 0 ? sqrt(stiffness / (12 * largest)) : INFINITY;
}

static MagnetPart magnet_of(const Shell *shell)
{
    return (MagnetPart){.noun = "face",
                        .coercivity = shell->coercivity,
                        .count = shell->mesh->face_count,
                        .corners = 3,
                        .each = 3,
                        .points = shell->mesh->faces[0],
                        .magnetization = shell->magnetization};
}

static void advise_thickness(Model *model, const char *name, double value, double size)
{
    if (value > size / 5)
        mesh_warn(&model->report,
                  "%s, %.3g m, is more than a fifth of the body's size, %.3g m: no thin shell", name, value,
                  size);
}

void shell_advise(Model *model, const Scene *scene)
{
    const NumberUnknown *thickness = scene->design ? scene->design->unknowns.thickness : NULL;
    const Shell *shell = model->self;
    double size = mesh_diagonal(shell->mesh);
    if (size > LARGE_BODY)
        mesh_warn(&model->report,
                  "the body is %.3g m long; if its file is in millimetres, give the mesh `scale: 1.0e-3`",
                  size);
    advise_thickness(model, "the thickness", shell->thickness, size);
    if (thickness && !isnan(thickness->bounds[0]))
        advise_thickness(model, "the upper bound of the unknown thickness", thickness->bounds[1], size);
    if (bending_length(model, scene) < CELLS_PER_LENGTH * mesh_mean_edge(shell->mesh))
        mesh_warn(
            &model->report,
            "fewer than %g cells over the magnetic bending length: the mesh is too coarse for this field",
            CELLS_PER_LENGTH);
    coercivity_advise(model, scene, magnet_of(shell));
}

char *shell_doubt(const Model *model, const Snapshot *shot)
{
    return coercivity_doubt(model, magnet_of(model->self), shot);
}

char *shell_describe(const Model *model, const Scene *scene)
{
    const Shell *shell = model->self;
    const Mesh *mesh = shell->mesh;
    int held = 0;
    for (int i = 0; i < 3 * mesh->vertex_count; i++) held += shell->fixed[i];
    char *text = mem_format("%d vertices, %d faces, %d edges, %d part%s; %d load case%s; %d unknowns of "
                            "motion, %d coordinates held\n",
                            mesh->vertex_count, mesh->face_count, mesh->edge_count, mesh->component_count,
                            mesh->component_count == 1 ? "" : "s", model->case_count,
                            model->case_count == 1 ? "" : "s", system_free_count(model->cases[0].sys), held);
    if (system_base_shift(model->cases[0].sys) > 0)
        text = mem_join(text, "the body has free rigid motions\n", "");
    double length = bending_length(model, scene);
    if (!isfinite(length)) return text;
    char *line =
        mem_format("magnetic bending length: %.3g m, %.3g cells\n", length, length / mesh_mean_edge(mesh));
    text = mem_join(text, line, "");
    mem_free(line);
    return text;
}

/* Of its area at rest. */
static double area_ratio(const Mesh *mesh, const double *x, int face)
{
    const int *v = mesh->faces[face];
    Vec3 a = vec3_load(x + 3 * v[0]), b = vec3_sub(vec3_load(x + 3 * v[1]), a),
         c = vec3_sub(vec3_load(x + 3 * v[2]), a);
    return vec3_length(vec3_cross(b, c)) / (2 * mesh->rest_area[face]);
}

static char *strength(const Shell *shell, const Snapshot *shot, int face)
{
    double M = vec3_length(vec3_load(shot->p + shell->magnetization + 3 * face)),
           B = vec3_length(vec3_load(shot->p + shell->flux.uniform)), Y = shot->p[shell->young + face];
    if (M * B == 0) return mem_format("is too strong for its Young's modulus of %.3g Pa", Y);
    return mem_format("(a magnetisation of %.3g A/m in a field of %.3g T is %.3g Pa) is too strong for its "
                      "Young's modulus of %.3g Pa",
                      M, B, M * B, Y);
}

/* St. Venant-Kirchhoff stretching resists being crushed less and less: halved steps lead only near it. Of neo-Hookean, which
 * resists it more and more, a state with small faces is one like others. */
char *shell_crushed(const Model *model, const Snapshot *shot, bool failed)
{
    const Shell *shell = model->self;
    const Mesh *mesh = shell->mesh;
    int least = 0;
    for (int f = 1; f < mesh->face_count; f++)
        if (area_ratio(mesh, shot->at.x, f) < area_ratio(mesh, shot->at.x, least)) least = f;
    double ratio = area_ratio(mesh, shot->at.x, least);
    bool next = failed && (ratio < NEARLY_CRUSHED || shot->status == NEWTON_TANGLED);
    if (!next && !membrane_is_crushed(shell->material, ratio)) return NULL;
    char *what = mem_format(ratio < NEARLY_CRUSHED
                                ? "face %d is crushed to %.2g of its area"
                                : "next, a face would be crushed; face %d has the least of its area, %.2g",
                            least, ratio);
    char *why = strength(shell, shot, least), *text = mem_join(what, ": what acts on it ", why);
    mem_free(why);
    return text;
}

/* An edge's length, or a radian. */
void shell_dof_sizes(const Model *model, double *size)
{
    const Shell *shell = model->self;
    double edge = mesh_mean_edge(shell->mesh);
    for (int i = 0; i < shell_dof_count(shell); i++) size[i] = i < 3 * model->point_count ? edge : 1;
}
