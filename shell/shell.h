/* shell.h - the thin shell: geometry at rest, material constants, parameter layout and what is held.
 *
 * Dofs: 3*vertex_count positions (m), then one angle per edge (rad): the turn of the edge's normal about v0 -> v1
 * away from the mean of its two faces' normals (the director of the mid-edge model; zero in the hinge model).
 * Energies follow [Chen, Ni, Zhu, Wang, Chen 2022, eqs. 18-25] with the corrections in docs/theory.md. */
#pragma once
#include "solve/masses.h"
#include "solve/params.h"
#include "solve/system.h"
#include "field/flux.h"
#include "surface/membrane.h"
#include "surface/mesh.h"
#include "world/world.h"

typedef enum BendingModel {
    BENDING_MIDEDGE, /* one angle per edge: converges on any mesh  [Grinspun et al. 2006] */
    BENDING_HINGE, /* vertices only  [Gingold et al. 2004]: plates sag by up to 48 % too little on crossed and unstructured meshes */
} BendingModel;

typedef struct Shell {
    Mesh *mesh; /* owned                                                          */
    /* m: the largest; kg/m^3; both the default of all faces. */
    double thickness, density;
    double poisson;
    double coercivity;         /* A/m, of what it is magnetised with; NAN: not known             */
    MembraneMaterial material; /* of the stretching; bending is of small strains                 */
    BendingModel bending;
    FluxFields fields; /* parts of the flux density that vary in space; owned                          */
    double *
        outsides; /* [face] m, half of each thickness as the world is to meet it; owned; NULL: that of `thickness` */
    double *rest_angle; /* [edge] dihedral angle of the rest shape, rad; 0 on the boundary; owned         */
    bool *fixed;        /* [3*vertex_count] coordinates that are held; owned                              */
    bool *clamped;      /* [edge] the slope is held as at rest; owned                                     */
    World *world;       /* what it meets; owned; NULL: nothing                                             */

    Params params;      /* blocks and their first entries in p: */
    int young;          /* [face] Pa                                                            */
    int fold;           /* [edge] factor on the edge's curvature                                */
    int magnetization;  /* [face][3] A/m, in material space                                     */
    FluxBlocks flux;    /* flux_density [3] T, the uniform part, and those of fields */
    int gravity;        /* [3] m/s^2                                                            */
    int load;           /* [vertex][3] N, dead                                                  */
    int damping;        /* [1] N s/m at every vertex, in steps of time                          */
    int face_thickness; /* [face] m, about the middle surface: the block `thickness`            */
    int face_density;   /* [face] kg/m^3: the block `density`                                   */
} Shell;

/* Takes the mesh and the fields (NULL: none). Sets up the blocks of parameters, rest angles and nothing held. */
Shell *shell_create(Mesh *mesh, const FluxFields *fields);
void shell_destroy(Shell *shell);

static inline int shell_dof_count(const Shell *shell)
{
    return 3 * shell->mesh->vertex_count + shell->mesh->edge_count;
}
static inline int shell_angle_dof(const Shell *shell, int edge)
{
    return 3 * shell->mesh->vertex_count + edge;
}

/* What it shows to the world; borrowed from the shell. */
WorldBody shell_world_body(const Shell *shell);

/* Holds one coordinate (axis 0, 1, 2) of a vertex; holds the slope of an edge. */
void shell_fix(Shell *shell, int vertex, int axis);
void shell_clamp(Shell *shell, int edge);

/* Whether all three vertices and all three slopes of the face are held: it is rigid and carries no bending. */
bool shell_face_is_rigid(const Shell *shell, int face);

/* All terms over the shell's dofs, prepared. Thin call after fixing; the shell must outlive the system. */
System *shell_system(const Shell *shell);

/* The same with inertia and damping, for steps of time (march.h). */
System *shell_dynamic_system(const Shell *shell);

/* Default values of every block: young 1e6, fold 1, thickness and density those of the struct, scales and strengths of
 * fields 1, the rest 0. p[params.size]. */
void shell_default_params(const Shell *shell, double *p);

/* x[dof_count] at rest: rest positions, angles 0. */
void shell_rest_state(const Shell *shell, double *x);

/* Lumped mass of each vertex, a third of its faces, kg: as what terms take, the caller's; at p, mass[vertex_count]. */
Masses shell_masses(const Shell *shell);
void shell_vertex_mass(const Shell *shell, const double *p, double *mass);
