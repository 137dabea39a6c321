#include "shell/shell.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "shell/hinge.h"
#include "surface/rigid.h"
#include "shell/terms.h"
#include "solve/kinetic.h"
#include "solve/lumped.h"
#include "surface/magnetic.h"

/* Of D, for bodies with free rigid motions: decides nothing physical, drifts less than 1e-7 of the size
 * (docs/newton.md). */
static const double BASE_SHIFT = 1e-10;

static Pack3 spread(const double *x)
{
    return pack3(pack_set(x[0]), pack_set(x[1]), pack_set(x[2]));
}

static double rest_angle(const Mesh *mesh, int edge)
{
    int left = mesh->edge_faces[edge][0], right = mesh->edge_faces[edge][1];
    if (left < 0 || right < 0) return 0;
    int o = mesh->faces[left][mesh_corner(mesh, left, edge)],
        y = mesh->faces[right][mesh_corner(mesh, right, edge)];
    int a = mesh->edges[edge][0], b = mesh->edges[edge][1];
    return dihedral_angle(spread(mesh->rest[a]), spread(mesh->rest[b]), spread(mesh->rest[o]),
                          spread(mesh->rest[y]))
        .angle[0];
}

Shell *shell_create(Mesh *mesh, const FluxFields *fields)
{
    Shell *shell = mem_alloc(1, sizeof *shell);
    shell->mesh = mesh;
    if (fields) shell->fields = *fields;
    shell->rest_angle = mem_alloc((size_t)mesh->edge_count, sizeof(double));
    for (int e = 0; e < mesh->edge_count; e++) shell->rest_angle[e] = rest_angle(mesh, e);
    shell->fixed = mem_alloc(3 * (size_t)mesh->vertex_count, sizeof(bool));
    shell->clamped = mem_alloc((size_t)mesh->edge_count, sizeof(bool));
    Params *params = &shell->params;
    shell->young = params_add(params, "young", "Pa", mesh->face_count, 1, false);
    shell->fold = params_add(params, "fold", "", mesh->edge_count, 1, false);
    shell->magnetization = params_add(params, "magnetization", "A/m", mesh->face_count, 3, false);
    shell->flux.uniform = params_add(params, "flux_density", "T", 1, 3, true);
    shell->gravity = params_add(params, "gravity", "m/s^2", 1, 3, true);
    shell->load = params_add(params, "load", "N", mesh->vertex_count, 3, true);
    shell->damping = params_add(params, "damping", "N s/m", 1, 1, false);
    shell->face_thickness = params_add(params, "thickness", "m", mesh->face_count, 1, false);
    shell->face_density = params_add(params, "density", "kg/m^3", mesh->face_count, 1, false);
    shell->flux = flux_blocks_add(params, &shell->fields, shell->flux.uniform);
    return shell;
}

void shell_destroy(Shell *shell)
{
    if (!shell) return;
    world_destroy(shell->world);
    mesh_destroy(shell->mesh);
    flux_fields_clear(&shell->fields);
    params_clear(&shell->params);
    mem_free(shell->outsides);
    mem_free(shell->rest_angle);
    mem_free(shell->fixed);
    mem_free(shell->clamped);
    mem_free(shell);
}

WorldBody shell_world_body(const Shell *shell)
{
    const Mesh *mesh = shell->mesh;
    return (WorldBody){.vertex_count = mesh->vertex_count,
                       .edge_count = mesh->edge_count,
                       .face_count = mesh->face_count,
                       .edges = (const int(*)[2])mesh->edges,
                       .faces = (const int(*)[3])mesh->faces,
                       .rest = (const double(*)[3])mesh->rest,
                       .part = mesh->vertex_component,
                       .fixed = shell->fixed,
                       .thickness = shell->thickness,
                       .outside = shell->thickness / 2,
                       .outsides = shell->outsides,
                       .doubled = shell->face_thickness};
}

void shell_fix(Shell *shell, int vertex, int axis)
{
    shell->fixed[3 * vertex + axis] = true;
}

void shell_clamp(Shell *shell, int edge)
{
    shell->clamped[edge] = true;
}

bool shell_face_is_rigid(const Shell *shell, int face)
{
    for (int i = 0; i < 3; i++) {
        const bool *fixed = &shell->fixed[3 * shell->mesh->faces[face][i]];
        if (!fixed[0] || !fixed[1] || !fixed[2] || !shell->clamped[shell->mesh->face_edges[face][i]])
            return false;
    }
    return true;
}

static void add_kinetic_terms(const Shell *shell, System *sys)
{
    system_add(sys, kinetic_inertia_term(shell_masses(shell)));
    system_add(sys, kinetic_damping_term(shell->mesh->vertex_count, NULL, shell->damping));
}

static System *make_system(const Shell *shell, bool dynamic)
{
    const Mesh *mesh = shell->mesh;
    int positions = 3 * mesh->vertex_count;
    DofClass classes[] = {{.count = positions, .size = mesh_diagonal(mesh)},
                          {.first = positions, .count = mesh->edge_count, .size = 1}};
    System *sys = system_create(shell_dof_count(shell), classes, 2);
    for (int t = 0; t < shell_term_row_count; t++) system_add(sys, shell_term_rows[t].create(shell));
    if (dynamic) add_kinetic_terms(shell, sys);
    if (shell->world) world_add_terms(shell->world, sys, dynamic);
    for (int i = 0; i < positions; i++)
        if (shell->fixed[i]) system_fix(sys, i);
    for (int e = 0; e < mesh->edge_count; e++)
        if (shell->clamped[e] || shell->bending == BENDING_HINGE) system_fix(sys, shell_angle_dof(shell, e));
    if (!dynamic && rigid_free_count(shell->mesh, shell->fixed, shell->clamped))
        system_set_base_shift(sys, BASE_SHIFT);
    system_prepare(sys);
    return sys;
}

System *shell_system(const Shell *shell)
{
    return make_system(shell, false);
}

System *shell_dynamic_system(const Shell *shell)
{
    return make_system(shell, true);
}

void shell_default_params(const Shell *shell, double *p)
{
    for (int i = 0; i < shell->params.size; i++) p[i] = 0;
    for (int f = 0; f < shell->mesh->face_count; f++) {
        p[shell->young + f] = 1e6;
        p[shell->face_thickness + f] = shell->thickness;
        p[shell->face_density + f] = shell->density;
    }
    for (int e = 0; e < shell->mesh->edge_count; e++) p[shell->fold + e] = 1;
    flux_blocks_default(&shell->fields, &shell->flux, p);
}

void shell_rest_state(const Shell *shell, double *x)
{
    const Mesh *mesh = shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++) vec3_store(x + 3 * v, vec3_load(mesh->rest[v]));
    for (int e = 0; e < mesh->edge_count; e++) x[shell_angle_dof(shell, e)] = 0;
}

Masses shell_masses(const Shell *shell)
{
    const Mesh *mesh = shell->mesh;
    return masses_of_faces(mesh->vertex_count, mesh->face_count, (const int(*)[3])mesh->faces,
                           mesh->rest_area, shell->face_density, shell->face_thickness);
}

void shell_vertex_mass(const Shell *shell, const double *p, double *mass)
{
    Masses masses = shell_masses(shell);
    masses_all(&masses, p, mass);
    masses_clear(&masses);
}

/* All faces, each with its own parameters. */
static FaceLayer layer_of(const Shell *shell)
{
    FaceLayer layer = face_layer(shell->mesh, 1, NULL, NULL);
    layer.thickness = shell->face_thickness;
    return layer;
}

Term shell_membrane_term(const Shell *shell)
{
    return membrane_term(layer_of(shell), &(MembraneDef){shell->material, shell->poisson, shell->young});
}

Term shell_magnetic_term(const Shell *shell)
{
    return magnetic_surface_term(layer_of(shell), &(MagneticSurfaceDef){.magnetization = shell->magnetization,
                                                                        .flux = shell->flux,
                                                                        .fields = &shell->fields});
}

Term shell_gravity_term(const Shell *shell)
{
    return lumped_gravity_term(shell_masses(shell), shell->gravity);
}

Term shell_load_term(const Shell *shell)
{
    return lumped_load_term(shell->mesh->vertex_count, shell->load);
}
