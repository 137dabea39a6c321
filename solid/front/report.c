/* What `slender check` says of a solid, and what is doubtful about it. */
#include "base/memory.h"
#include "base/vec3.h"
#include "model/advise.h"
#include "model/coercivity.h"
#include "solid/front/front.h"
#include <math.h>

static const double LARGE_BODY = 2; /* m: most likely a mesh in millimetres                              */
static const double LOCKED_FROM =
    0.47; /* Poisson's ratio from which plain quadratic tetrahedra are too stiff */

/* Its tetrahedra (0), its skin (1): of none, without a skin. */
static MagnetPart magnet_of(const Solid *solid, int which)
{
    const Tets *tets = solid->tets;
    const MagnetPart parts[] = {{.noun = "tetrahedron",
                                 .count = tets->count,
                                 .corners = 4,
                                 .each = tets->each,
                                 .points = tets->nodes,
                                 .magnetization = solid->volume_magnetization},
                                {.noun = "face",
                                 .count = solid->magnetization < 0 ? 0 : tets->surface->face_count,
                                 .corners = 3,
                                 .each = 3,
                                 .points = tets->surface->faces[0],
                                 .magnetization = solid->magnetization}};
    MagnetPart part = parts[which];
    part.coercivity = solid->coercivity;
    return part;
}

/* A group that is given a value of the skin, and has none of it. */
static void advise_group(Model *model, const char *key, const char *name)
{
    const Solid *solid = model->self;
    const MeshGroup *group = mesh_group(model->mesh, name, 2);
    bool any = !solid->skin_on;
    for (int k = 0; !any && k < group->count; k++) any = solid->skin_on[group->members[k]];
    if (!any)
        mesh_warn(&model->report, "solid.skin.%s.groups.%s is without effect: `solid.skin.on` leaves it out",
                  key, name);
}

static void advise_skin(Model *model, const SkinScene *skin, double size)
{
    if (!skin) return;
    if (skin->thickness > size / 5)
        mesh_warn(
            &model->report,
            "the skin's thickness, %.3g m, is more than a fifth of the body's size, %.3g m: no thin skin",
            skin->thickness, size);
    for (int k = 0; k < skin->magnetization.groups_count; k++)
        advise_group(model, "magnetization", skin->magnetization.groups[k].group);
    for (int k = 0; skin->young && k < skin->young->groups_count; k++)
        advise_group(model, "young", skin->young->groups[k].group);
}

void solid_advise(Model *model, const Scene *scene)
{
    const Solid *solid = model->self;
    double size = mesh_diagonal(model->mesh);
    if (size > LARGE_BODY)
        mesh_warn(&model->report,
                  "the body is %.3g m long; if its file is in millimetres, give the mesh `scale: 1.0e-3`",
                  size);
    advise_value(model, "density", "kg/m^3", solid->density);
    advise_skin(model, solid_scene(scene)->skin, size);
    if (solid->tets->order == TET_LINEAR && solid->averaging == 0)
        mesh_warn(&model->report,
                  "linear tetrahedra are far too stiff in bending: `order: 2`, or `averaging: 1`");
    if (solid->tets->order == TET_QUADRATIC && solid->poisson > LOCKED_FROM && solid->averaging == 0)
        mesh_warn(
            &model->report,
            "with a Poisson's ratio of %.6g quadratic tetrahedra are some per cent too stiff in bending: "
            "more of them through the thickness are less so, and `averaging: 0.6` is a little",
            solid->poisson);
    for (int k = 0; k < 2; k++) coercivity_advise(model, scene, magnet_of(solid, k));
}

char *solid_doubt(const Model *model, const Snapshot *shot)
{
    char *doubt = coercivity_doubt(model, magnet_of(model->self, 0), shot);
    return doubt ? doubt : coercivity_doubt(model, magnet_of(model->self, 1), shot);
}

char *solid_describe(const Model *model, const Scene *scene)
{
    const Solid *solid = model->self;
    const Tets *tets = solid->tets;
    int held = 0;
    (void)scene;
    for (int i = 0; i < solid_dof_count(solid); i++) held += solid->fixed[i];
    char *text = mem_format("%d %s tetrahedra, %d nodes, %d faces on the surface, %d part%s; %d load case%s; "
                            "%d unknowns of motion, "
                            "%d coordinates held\n",
                            tets->count, tets->order == TET_QUADRATIC ? "quadratic" : "linear",
                            tets_node_count(tets), tets->surface->face_count, tets->surface->component_count,
                            tets->surface->component_count == 1 ? "" : "s", model->case_count,
                            model->case_count == 1 ? "" : "s", system_free_count(model->cases[0].sys), held);
    if (system_base_shift(model->cases[0].sys) > 0)
        text = mem_join(text, "the body has free rigid motions\n", "");
    return text;
}

static const char *weakness(const Solid *solid)
{
    return solid->material == SOLID_ST_VENANT_KIRCHHOFF
               ? "; st_venant_kirchhoff resists less and less as it is pressed, neo_hookean more and more"
               : "";
}

char *solid_crushed(const Model *model, const Snapshot *shot, bool failed)
{
    const Solid *solid = model->self;
    int tet;
    double least = solid_least_jacobian(solid, shot->at.x, &tet);
    double young = shot->p[solid->young + tet];
    bool tangled = solid_is_tangled(least);
    if (failed && !tangled && shot->status == NEWTON_TANGLED)
        return mem_format(
            "next, something would be turned inside out or flattened; tetrahedron %d is pressed most (det F "
            "is %.2g there): what acts on it is too strong for its Young's modulus of %.3g Pa%s",
            tet, least, young, weakness(solid));
    if (!tangled) return NULL;
    return mem_format("tetrahedron %d is %s (det F is %.2g there): what acts on it is too strong for its "
                      "Young's modulus of %.3g Pa, or it started so%s",
                      tet, least > 0 ? "flattened to nothing" : "turned inside out", least, young,
                      weakness(solid));
}

/* An edge's length. */
void solid_dof_sizes(const Model *model, double *size)
{
    double edge = mesh_mean_edge(((const Solid *)model->self)->tets->skin);
    for (int i = 0; i < solid_dof_count(model->self); i++) size[i] = edge;
}
