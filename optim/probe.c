#include "optim/probe.h"
#include "base/memory.h"
#include <string.h>

Probe probe_center(Masses masses)
{
    int *all = mem_alloc((size_t)masses.count, sizeof *all);
    for (int v = 0; v < masses.count; v++) all[v] = v;
    return (Probe){all, masses};
}

Probe probe_copy(const Probe *probe)
{
    return (Probe){mem_copy(probe->vertices, (size_t)probe->masses.count, sizeof *probe->vertices),
                   masses_copy(&probe->masses)};
}

void probe_clear(Probe *probe)
{
    mem_free(probe->vertices);
    masses_clear(&probe->masses);
    *probe = (Probe){0};
}

bool probe_is_same(const Probe *a, const Probe *b)
{
    size_t count = (size_t)a->masses.count;
    if (a->masses.count != b->masses.count || memcmp(a->vertices, b->vertices, count * sizeof *a->vertices))
        return false;
    const double *m = a->masses.fixed, *other = b->masses.fixed;
    return m && other ? !memcmp(m, other, count * sizeof *m) : m == other;
}

static double whole_mass(const Probe *probe, const double *p)
{
    double sum = 0;
    for (int k = 0; k < probe->masses.count; k++) sum += masses_at(&probe->masses, k, p);
    return sum;
}

Vec3 probe_at(const Probe *probe, const double *x, const double *p)
{
    Vec3 q = vec3(0, 0, 0);
    double whole = whole_mass(probe, p);
    for (int k = 0; k < probe->masses.count; k++)
        q = vec3_axpy(masses_at(&probe->masses, k, p) / whole, vec3_load(x + 3 * probe->vertices[k]), q);
    return q;
}

/* dq = (sum m dx + sum dm (x - q)) / sum m. */
Vec3 probe_change(const Probe *probe, const double *x, const double *p, const double *vx, const double *vp)
{
    Vec3 q = probe_at(probe, x, p), change = probe_at(probe, vx, p);
    double whole = whole_mass(probe, p);
    for (int k = 0; k < probe->masses.count; k++)
        change = vec3_axpy(masses_change(&probe->masses, k, p, vp) / whole,
                           vec3_sub(vec3_load(x + 3 * probe->vertices[k]), q), change);
    return change;
}

void probe_pull(const Probe *probe, const double *x, const double *p, Vec3 force, double *dx, double *dp)
{
    Vec3 q = probe_at(probe, x, p);
    double whole = whole_mass(probe, p);
    for (int k = 0; k < probe->masses.count; k++) {
        int at = 3 * probe->vertices[k];
        Vec3 part = vec3_scale(masses_at(&probe->masses, k, p) / whole, force);
        dx[at] += part.x, dx[at + 1] += part.y, dx[at + 2] += part.z;
        masses_add_param(&probe->masses, k, p, vec3_dot(force, vec3_sub(vec3_load(x + at), q)) / whole, dp);
    }
}
