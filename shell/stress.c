#include "shell/stress.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "shell/terms.h"
#include <string.h>

/* K of the turns q: the conormals t_i, as long as their edges a_i, are 2 A times the gradients of the hat functions. */
static PlaneTensor curvature(const Mesh *mesh, int face, const double q[3])
{
    double b[3][2];
    PlaneTensor K = {0};
    face_gradients(mesh->rest, mesh->faces[face], b);
    for (int i = 0; i < 3; i++) {
        const int *v = mesh->edges[mesh->face_edges[face][i]];
        double length = vec3_length(vec3_sub(vec3_load(mesh->rest[v[1]]), vec3_load(mesh->rest[v[0]]))),
               part = q[i] * 2 * mesh->rest_area[face] / length;
        K.xx += part * b[i][0] * b[i][0], K.xy += part * b[i][0] * b[i][1], K.yy += part * b[i][1] * b[i][1];
    }
    return K;
}

static PlaneTensor strain_at(PlaneTensor G, double z, PlaneTensor K)
{
    return (PlaneTensor){G.xx + z * K.xx, G.xy + z * K.xy, G.yy + z * K.yy};
}

static void put_turns(const System *sys, const Point *at, double (*turn)[3])
{
    int t = 0;
    while (strcmp(system_term(sys, t)->ops->name, "bending") != 0) t++;
    Point own = system_term_point(sys, t, at);
    shell_bending_turns(system_term(sys, t), &own, turn);
}

void shell_stresses(const Shell *shell, const System *sys, const Point *at, FaceStress *stress)
{
    const Mesh *mesh = shell->mesh;
    double(*turn)[3] = mem_alloc((size_t)mesh->face_count, sizeof *turn);
    put_turns(sys, at, turn);
    for (int f = 0; f < mesh->face_count; f++) {
        PlaneTensor G = membrane_strain(mesh->rest, at->x, mesh->faces[f]);
        plane_principal(G, stress[f].strain);
        plane_principal(curvature(mesh, f, turn[f]), stress[f].curvature);
        for (int i = 0; i < 3; i++) turn[f][i] *= at->p[shell->fold + mesh->face_edges[f][i]];
        PlaneTensor K = curvature(mesh, f, turn[f]);
        for (int k = STRESS_BOTTOM; k <= STRESS_TOP; k++)
            stress[f].von_mises[k] =
                at->p[shell->young + f] *
                membrane_von_mises(shell->material, shell->poisson,
                                   strain_at(G, (k - 1) * at->p[shell->face_thickness + f] / 2, K));
    }
    mem_free(turn);
}
