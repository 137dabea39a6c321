#include "surface/rigid.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <string.h>

/* LAPACK: eigenvalues of a symmetric matrix, ascending. */
void dsyev_(const char *jobz, const char *uplo, const int *n, double *a, const int *lda, double *w,
            double *work, const int *lwork, int *info, size_t jobz_length, size_t uplo_length);

static const double RANK_TOL = 1e-10; /* of the largest eigenvalue: a motion that is held           */
static const double FORCE_TOL = 1e-9; /* of the sum of absolute forces: a part's forces are in balance */

/* Adds row row^T to the part's 6x6 matrix: a rigid motion (t, w) is held where row.(t, w) is not 0. */
static void hold(double *gram, Vec3 translation, Vec3 rotation)
{
    double row[6];
    vec3_store(row, translation);
    vec3_store(row + 3, rotation);
    for (int i = 0; i < 36; i++) gram[i] += row[i / 6] * row[i % 6];
}

static int free_motions(double *gram)
{
    double w[6], work[64];
    int n = 6, lwork = 64, info, count = 0;
    dsyev_("N", "U", &n, gram, &n, w, work, &lwork, &info, 1, 1);
    for (int i = 0; i < 6; i++) count += !(w[i] > RANK_TOL * w[5]);
    return count;
}

int rigid_free_count(const Mesh *mesh, const bool *fixed, const bool *clamped)
{
    double(*gram)[36] = mem_alloc((size_t)mesh->component_count, sizeof *gram);
    double scale = 1 / mesh_diagonal(mesh);
    for (int i = 0; i < 3 * mesh->vertex_count; i++) {
        if (!fixed[i]) continue;
        Vec3 axis = vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);
        Vec3 arm = vec3_scale(scale, vec3_sub(vec3_load(mesh->rest[i / 3]), vec3_load(mesh->rest[0])));
        hold(gram[mesh->vertex_component[i / 3]], axis, vec3_cross(arm, axis));
    }
    for (int e = 0; clamped && e < mesh->edge_count; e++) {
        if (!clamped[e]) continue;
        const int *v = mesh->edges[e];
        Vec3 along = vec3_unit(vec3_sub(vec3_load(mesh->rest[v[1]]), vec3_load(mesh->rest[v[0]])));
        hold(gram[mesh->vertex_component[v[0]]], vec3(0, 0, 0), along);
    }
    int count = 0;
    for (int c = 0; c < mesh->component_count; c++) count += free_motions(gram[c]);
    mem_free(gram);
    return count;
}

bool rigid_check_force(const Mesh *mesh, const bool *fixed, const double *mass, const double *gravity,
                       const double *load, Error *err)
{
    size_t parts = 3 * (size_t)mesh->component_count;
    double *net = mem_alloc(parts, sizeof *net), *size = mem_alloc(parts, sizeof *size);
    bool *held = mem_alloc(parts, sizeof *held), ok = true;
    for (int i = 0; i < 3 * mesh->vertex_count; i++) {
        int part = 3 * mesh->vertex_component[i / 3] + i % 3;
        double force = mass[i / 3] * gravity[i % 3] + load[i];
        net[part] += force;
        size[part] += fabs(force);
        held[part] |= fixed[i];
    }
    for (size_t part = 0; ok && part < parts; part++)
        if (!held[part] && fabs(net[part]) > FORCE_TOL * size[part])
            ok = error_set(
                err,
                "a net force of %.3g N along %c acts on a body that nothing holds along %c: it has no "
                "equilibrium; fix a vertex, or take the force away",
                net[part], "xyz"[part % 3], "xyz"[part % 3]);
    mem_free(net);
    mem_free(size);
    mem_free(held);
    return ok;
}
