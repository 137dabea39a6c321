#include "solve/masses.h"
#include "base/memory.h"

Masses masses_zero(int count)
{
    return (Masses){.count = count, .fixed = mem_alloc((size_t)count, sizeof(double))};
}

Masses masses_fixed(int count, const double *mass)
{
    return (Masses){.count = count, .fixed = mem_copy(mass, (size_t)count, sizeof *mass)};
}

Masses masses_of_faces(int count, int face_count, const int (*faces)[3], const double *area, int density,
                       int thickness)
{
    Masses masses = {.count = count,
                     .first = mem_alloc((size_t)count + 2, sizeof(int)),
                     .parts = mem_alloc(3 * (size_t)face_count, sizeof(MassPart))};
    int *next =
        masses.first + 1; /* where a point's next part goes: in the end where the following one's begin */
    for (int i = 0; i < 3 * face_count; i++) masses.first[faces[i / 3][i % 3] + 2]++;
    for (int v = 0; v < count; v++) masses.first[v + 2] += masses.first[v + 1];
    for (int i = 0; i < 3 * face_count; i++)
        masses.parts[next[faces[i / 3][i % 3]]++] =
            (MassPart){density + i / 3, thickness + i / 3, area[i / 3]};
    return masses;
}

Masses masses_copy(const Masses *masses)
{
    int count = masses->count;
    if (masses->fixed) return masses_fixed(count, masses->fixed);
    return (Masses){.count = count,
                    .first = mem_copy(masses->first, (size_t)count + 1, sizeof *masses->first),
                    .parts = mem_copy(masses->parts, (size_t)masses->first[count], sizeof *masses->parts)};
}

void masses_clear(Masses *masses)
{
    mem_free(masses->fixed);
    mem_free(masses->first);
    mem_free(masses->parts);
    *masses = (Masses){0};
}

void masses_all(const Masses *masses, const double *p, double *mass)
{
    for (int k = 0; k < masses->count; k++) mass[k] = masses_at(masses, k, p);
}

double masses_at(const Masses *masses, int point, const double *p)
{
    if (masses->fixed) return masses->fixed[point];
    double mass = 0;
    for (int k = masses->first[point]; k < masses->first[point + 1]; k++) {
        MassPart part = masses->parts[k];
        mass += p[part.density] * p[part.thickness] * part.area / 3;
    }
    return mass;
}

double masses_change(const Masses *masses, int point, const double *p, const double *dp)
{
    if (masses->fixed) return 0;
    double change = 0;
    for (int k = masses->first[point]; k < masses->first[point + 1]; k++) {
        MassPart part = masses->parts[k];
        change +=
            (dp[part.density] * p[part.thickness] + p[part.density] * dp[part.thickness]) * part.area / 3;
    }
    return change;
}

void masses_add_param(const Masses *masses, int point, const double *p, double amount, double *dp)
{
    if (masses->fixed) return;
    for (int k = masses->first[point]; k < masses->first[point + 1]; k++) {
        MassPart part = masses->parts[k];
        dp[part.density] += amount * p[part.thickness] * part.area / 3;
        dp[part.thickness] += amount * p[part.density] * part.area / 3;
    }
}
