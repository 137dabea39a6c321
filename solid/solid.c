#include "solid/solid.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "solid/terms.h"
#include "solve/kinetic.h"
#include "solve/lumped.h"
#include "surface/magnetic.h"
#include "surface/rigid.h"
#include <string.h>

/* Of D, for bodies with free rigid motions, as of shells (docs/newton.md). */
static const double BASE_SHIFT = 1e-10;

Solid *solid_create(Tets *tets, const SolidDef *def, const FluxFields *fields)
{
    Solid *solid = mem_alloc(1, sizeof *solid);
    *solid = (Solid){.tets = tets,
                     .material = def->material,
                     .poisson = def->poisson,
                     .density = def->density,
                     .averaging = def->averaging,
                     .skin = def->skin,
                     .film = def->film,
                     .film_poisson = def->film_poisson,
                     .film_material = def->film_material,
                     .magnetization = -1,
                     .skin_young = -1};
    if (fields) solid->fields = *fields;
    int nodes = tets_node_count(tets);
    solid->fixed = mem_alloc(3 * (size_t)nodes, sizeof(bool));
    Params *params = &solid->params;
    bool skin = def->skin > 0;
    solid->young = params_add(params, "young", "Pa", tets->count, 1, false);
    if (skin)
        solid->magnetization =
            params_add(params, "magnetization", "A/m", tets->surface->face_count, 3, false);
    if (def->film)
        solid->skin_young = params_add(params, "skin_young", "Pa", tets->surface->face_count, 1, false);
    solid->volume_magnetization =
        params_add(params, skin ? "volume_magnetization" : "magnetization", "A/m", tets->count, 3, false);
    solid->flux.uniform = params_add(params, "flux_density", "T", 1, 3, true);
    solid->gravity = params_add(params, "gravity", "m/s^2", 1, 3, true);
    solid->load = params_add(params, "load", "N", nodes, 3, true);
    solid->damping = params_add(params, "damping", "N s/m", 1, 1, false);
    solid->flux = flux_blocks_add(params, &solid->fields, solid->flux.uniform);
    return solid;
}

void solid_destroy(Solid *solid)
{
    if (!solid) return;
    world_destroy(solid->world);
    tets_destroy(solid->tets);
    flux_fields_clear(&solid->fields);
    params_clear(&solid->params);
    mem_free(solid->skin_on);
    mem_free(solid->fixed);
    mem_free(solid);
}

WorldBody solid_world_body(const Solid *solid)
{
    const Mesh *skin = solid->tets->skin;
    return (WorldBody){.vertex_count = skin->vertex_count,
                       .edge_count = skin->edge_count,
                       .face_count = skin->face_count,
                       .edges = (const int(*)[2])skin->edges,
                       .faces = (const int(*)[3])skin->faces,
                       .rest = (const double(*)[3])skin->rest,
                       .part = skin->vertex_component,
                       .fixed = solid->fixed,
                       .closed = true,
                       .thickness = mesh_mean_edge(skin) / 5};
}

static void add_kinetic_terms(const Solid *solid, System *sys)
{
    int nodes = tets_node_count(solid->tets);
    system_add(sys, kinetic_inertia_term(solid_masses(solid)));
    system_add(sys, kinetic_damping_term(nodes, NULL, solid->damping));
}

System *solid_system(const Solid *solid, bool motion)
{
    const Mesh *surface = solid->tets->surface;
    int dofs = solid_dof_count(solid);
    DofClass class = {.count = dofs, .size = mesh_diagonal(surface)};
    System *sys = system_create(dofs, &class, 1);
    for (int t = 0; t < solid_term_row_count; t++) system_add(sys, solid_term_rows[t].create(solid));
    if (motion) add_kinetic_terms(solid, sys);
    if (solid->world) world_add_terms(solid->world, sys, motion);
    for (int i = 0; i < dofs; i++)
        if (solid->fixed[i]) system_fix(sys, i);
    if (!motion && rigid_free_count(surface, solid->fixed, NULL)) system_set_base_shift(sys, BASE_SHIFT);
    system_prepare(sys);
    return sys;
}

void solid_default_params(const Solid *solid, double *p)
{
    memset(p, 0, (size_t)solid->params.size * sizeof *p);
    for (int t = 0; t < solid->tets->count; t++) p[solid->young + t] = 1e6;
    for (int f = 0; solid->film && f < solid->tets->surface->face_count; f++) p[solid->skin_young + f] = 1e6;
    flux_blocks_default(&solid->fields, &solid->flux, p);
}

Masses solid_masses(const Solid *solid)
{
    const Tets *tets = solid->tets;
    double corner = tets->order == TET_QUADRATIC ? 1.0 / 36 : 1.0 / 4, middle = 4.0 / 27;
    Masses masses = masses_zero(tets_node_count(tets));
    for (int i = 0; i < tets->count * tets->each; i++)
        masses.fixed[tets->nodes[i]] +=
            (i % tets->each < 4 ? corner : middle) * solid->density * tets->volume[i / tets->each];
    return masses;
}

/* The skin, or of thickness 0 none: quadratic tetrahedra have faces in four parts. */
static FaceLayer skin_of(const Solid *solid, double thickness)
{
    return face_layer(solid->tets->skin, thickness, solid->tets->skin_face, solid->skin_on);
}

Term solid_membrane_term(const Solid *solid)
{
    return membrane_term(skin_of(solid, solid->film ? solid->skin : 0),
                         &(MembraneDef){solid->film_material, solid->film_poisson, solid->skin_young});
}

Term solid_magnetic_term(const Solid *solid)
{
    return magnetic_surface_term(skin_of(solid, solid->skin),
                                 &(MagneticSurfaceDef){.magnetization = solid->magnetization,
                                                       .flux = solid->flux,
                                                       .fields = &solid->fields});
}

Term solid_gravity_term(const Solid *solid)
{
    return lumped_gravity_term(solid_masses(solid), solid->gravity);
}

Term solid_load_term(const Solid *solid)
{
    return lumped_load_term(tets_node_count(solid->tets), solid->load);
}
