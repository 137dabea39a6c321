/* What `slender check` says of a rod, and what is doubtful about it. */
#include "base/memory.h"
#include "model/advise.h"
#include "model/coercivity.h"
#include "rod/front/front.h"

static const double LARGE_BODY = 2; /* m: most likely a curve in millimetres */

/* The elements as magnets; the caller frees points. */
static MagnetPart magnets_of(const RodModel *rm, int **points)
{
    const Rod *rod = rm->rod;
    *points = mem_alloc(2 * (size_t)rod->elements, sizeof **points);
    for (int e = 0; e < rod->elements; e++)
        for (int k = 0; k < 2; k++) (*points)[2 * e + k] = rod_element_node(&rm->layout, e) + k;
    return (MagnetPart){.noun = "element",
                        .coercivity = rm->coercivity,
                        .count = rod->elements,
                        .corners = 2,
                        .each = 2,
                        .points = *points,
                        .magnetization = rod->magnetization};
}

char *rod_doubt_magnets(const Model *model, const Snapshot *shot)
{
    int *points;
    MagnetPart part = magnets_of(model->self, &points);
    char *doubt = coercivity_doubt(model, part, shot);
    mem_free(points);
    return doubt;
}

void rod_advise(Model *model, const Scene *scene)
{
    const RodModel *rm = model->self;
    double longest = rod_model_longest(rm);
    const RodCurveScene *curve = rod_scene(scene)->curve;
    if (longest > LARGE_BODY)
        mesh_warn(&model->report, "a rod is %.3g m long; %s", longest,
                  curve && curve->file ? "if its file is in millimetres, give the curve `scale: 1.0e-3`"
                                       : "numbers without a unit are in metres");
    if (rm->section.reach > longest / 5 && longest > 0)
        mesh_warn(&model->report, "the section, %.3g m, is more than a fifth of the length: no thin rod",
                  rm->section.reach);
    advise_value(model, "density", "kg/m^3", rod_scene(scene)->density);
    if (!model->case_count) advise_value(model, "young", "Pa", rm->young); /* else it is in p */
    if (!rm->rod || !model->case_count) return;
    int *points;
    coercivity_advise(model, scene, magnets_of(rm, &points));
    mem_free(points);
}

char *rod_describe(const Model *model, const Scene *scene)
{
    const RodModel *rm = model->self;
    int rods = rm->strand_count > 1 ? rm->strand_count : 1;
    char *text = mem_format("%d rod%s of %d elements, up to %.4g m long\n", rods, rods == 1 ? "" : "s",
                            rod_scene(scene)->elements, rod_model_longest(rm));
    if (!model->case_count) return text;
    char *line = mem_format("%d load case%s; %d unknowns of motion\n", model->case_count,
                            model->case_count == 1 ? "" : "s", system_free_count(model->cases[0].sys));
    text = mem_join(text, line, "");
    mem_free(line);
    return text;
}

/* An element's length, a radian, of multipliers a force; 0 for the references of turns. */
void rod_dof_sizes(const Model *model, double *size)
{
    const RodModel *rm = model->self;
    const RodLayout *layout = &rm->layout;
    for (int i = 0; i < layout->dofs; i++)
        size[i] = i >= layout->reference                               ? 0
                  : layout->position >= 0 && i < layout->turn          ? rod_element_length(rm->rod, 0)
                  : layout->multiplier >= 0 && i >= layout->multiplier ? rm->unit.mass * rod_length(rm->rod)
                                                                       : 1;
}
