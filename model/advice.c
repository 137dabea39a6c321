#include "model/advice.h"
#include "base/vec3.h"
#include "rod/front/rod_model.h"
#include <math.h>

static const double LARGE_BODY = 2;       /* m: most likely a mesh in millimetres          */
static const double CELLS_PER_LENGTH = 3; /* of the magnetic bending length, at least      */
double advice_mean_edge(const Mesh *mesh)
{
    double sum = 0;
    for (int e = 0; e < mesh->edge_count; e++)
        sum += vec3_length(
            vec3_sub(vec3_load(mesh->rest[mesh->edges[e][0]]), vec3_load(mesh->rest[mesh->edges[e][1]])));
    return sum / mesh->edge_count;
}

/* Of a case, over the whole time of a motion; of an unknown field its bounds. */
static double largest_field(const Model *model, const Scene *scene, const double *p)
{
    const FluxUnknown *unknown = scene->design ? scene->design->unknowns.flux_density : NULL;
    double largest = vec3_length(vec3_load(p + model->shell->flux_density));
    if (unknown && !isnan(unknown->bounds[0]))
        largest = fmax(largest, fmax(fabs(unknown->bounds[0]), fabs(unknown->bounds[1])));
    double now[3] = {0};
    for (int n = 0; timed_flux_is_given(&model->flux_of_time) && n <= scene->time.steps; n++)
        if (timed_flux_eval(&model->flux_of_time, scene->time.at + n * scene->time.step, now, NULL))
            largest = fmax(largest, vec3_length(vec3_load(now)));
    return largest;
}

/* Over a length h sqrt(Y/(12 M B)) a field bends the sheet by about a radian: cells must be smaller. */
double advice_bending_length(const Model *model, const Scene *scene)
{
    const Shell *shell = model->shell;
    double largest = 0, young = INFINITY, M_max = 0;
    for (int c = 0; c < model->case_count; c++)
        for (int s = 0; s < model->cases[c].stage_count; s++) {
            const double *p = model->cases[c].stages[s].p;
            double B = largest_field(model, scene, p);
            for (int f = 0; f < shell->mesh->face_count; f++) {
                M_max = fmax(M_max, vec3_length(vec3_load(p + shell->magnetization + 3 * f)));
                young = fmin(young, p[shell->young + f]);
            }
            if (scene->design && scene->design->unknowns.magnetization)
                M_max = fmax(M_max, scene->design->unknowns.magnetization->scale);
            largest = fmax(largest, M_max * B);
        }
    return largest > 0 ? shell->thickness * sqrt(young / (12 * largest)) : INFINITY;
}

static void advise_shell(Model *model, const Scene *scene)
{
    const Shell *shell = model->shell;
    double size = mesh_diagonal(shell->mesh);
    if (size > LARGE_BODY)
        mesh_warn(&model->report,
                  "the body is %.3g m long; if its file is in millimetres, give the mesh `scale: 1.0e-3`",
                  size);
    if (shell->thickness > size / 5)
        mesh_warn(&model->report,
                  "the thickness, %.3g m, is more than a fifth of the body's size, %.3g m: no thin shell",
                  shell->thickness, size);
    if (advice_bending_length(model, scene) < CELLS_PER_LENGTH * advice_mean_edge(shell->mesh))
        mesh_warn(
            &model->report,
            "fewer than %g cells over the magnetic bending length: the mesh is too coarse for this field",
            CELLS_PER_LENGTH);
}

static void advise_rod(Model *model)
{
    double longest = rod_model_longest(model->rod);
    if (longest > LARGE_BODY)
        mesh_warn(&model->report,
                  "a rod is %.3g m long; if its file is in millimetres, give the curve `scale: 1.0e-3`",
                  longest);
    if (model->rod->section.reach > longest / 5 && longest > 0)
        mesh_warn(&model->report, "the section, %.3g m, is more than a fifth of the length: no thin rod",
                  model->rod->section.reach);
}

void advise(Model *model, const Scene *scene)
{
    if (model->shell) advise_shell(model, scene);
    if (model->rod) advise_rod(model);
}
