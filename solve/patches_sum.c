#include "solve/patches.h"
#include <string.h>

enum { MAX_LOWER = TERM_LOWER(TERM_MAX_DOF, 0) };

typedef struct Work {
    Patches *patches;
    const Entry *entries;
    int term_count;
    const Point *points;
    Sums sums;
} Work;

static void add(Number (*numbers)[PACK_LANES], int count, const Pack *from, double *to)
{
    for (int k = 0; k < count; k++)
        for (int l = 0; l < PACK_LANES; l++) to[numbers[k][l]] += from[k][l];
}

static void add_hessian(const Entry *entry, int pack, const Pack *H, double *to)
{
    Number(*numbers)[PACK_LANES] = &entry->entry_numbers[(long)pack * entry->lower];
    add(numbers, entry->lower, H, to);
    for (int m = entry->twice_start[pack]; m < entry->twice_start[pack + 1]; m++) {
        int k = entry->twice[m] / PACK_LANES, l = entry->twice[m] % PACK_LANES;
        to[numbers[k][l]] += H[k][l];
    }
}

/* What a pack gives. */
typedef struct Given {
    Pack g[TERM_MAX_DOF], forces[TERM_MAX_DOF], H[MAX_LOWER];
} Given;

static double evaluate_pack(const Work *w, int t, int pack, const Pack *x, Given *given)
{
    const Entry *entry = &w->entries[t];
    int left = entry->count - pack * PACK_LANES, lanes = left < PACK_LANES ? left : PACK_LANES;
    Pack energy = entry->term.ops->eval(entry->term.self, pack, &w->points[t], x,
                                        w->sums.gradient ? given->g : NULL, w->sums.values ? given->H : NULL);
    for (int i = 0; w->sums.gradient && i < entry->size; i++) given->forces[i] = pack_abs(given->g[i]);
    return pack_sum(energy, lanes);
}

static void add_given(const Work *w, const Entry *entry, const Given *from, Given *to)
{
    for (int i = 0; w->sums.gradient && i < entry->size; i++) {
        to->g[i] += from->g[i];
        to->forces[i] += from->forces[i];
    }
    for (int k = 0; w->sums.values && k < entry->lower; k++) to->H[k] += from->H[k];
}

static void store(const Work *w, const Patch *patch, const Entry *entry, int pack, const Given *given)
{
    const Patches *patches = w->patches;
    if (!w->sums.gradient) return;
    Number(*numbers)[PACK_LANES] = &entry->dof_numbers[pack * entry->size];
    add(numbers, entry->size, given->g, patches->dofs.values + patch->dofs);
    add(numbers, entry->size, given->forces, patches->forces + patch->dofs);
    if (w->sums.values) add_hessian(entry, pack, given->H, patches->entries.values + patch->entries);
}

/* Adds the energies of a pack and of those that ride with it; what else is wanted goes to the patch's places. */
static void take_pack(const Work *w, const Patch *patch, int host, int pack, double *energies)
{
    const Entry *entry = &w->entries[host];
    Pack x[TERM_MAX_DOF];
    Given given, rider;
    for (int i = 0; i < entry->size; i++)
        for (int l = 0; l < PACK_LANES; l++)
            x[i][l] = w->points[host].x[entry->dofs[pack * entry->size + i][l]];
    double energy = evaluate_pack(w, host, pack, x, &given);
    if (entry->changes && entry->term.ops->idles && energy == 0) return; /* as most pairs of a list do */
    energies[host] += energy;
    for (int t = 0; t < w->term_count; t++)
        if (t != host && w->entries[t].host == host) {
            energies[t] += evaluate_pack(w, t, pack, x, &rider);
            add_given(w, &w->entries[t], &rider, &given);
        }
    store(w, patch, entry, pack, &given);
}

static void clear_places(double *values, int first, int count)
{
    memset(values + first, 0, (size_t)count * sizeof *values);
}

static void patch_task(void *self, int p)
{
    const Work *w = self;
    Patches *patches = w->patches;
    const Patch *patch = &patches->list[p];
    if (w->sums.gradient) {
        clear_places(patches->dofs.values, patch->dofs, patch->dof_count);
        clear_places(patches->forces, patch->dofs, patch->dof_count);
    }
    if (w->sums.values) clear_places(patches->entries.values, patch->entries, patch->entry_count);
    double *energies = patches->energies + (size_t)p * SYSTEM_MAX_TERMS;
    memset(energies, 0, SYSTEM_MAX_TERMS * sizeof *energies);
    for (int t = 0; t < w->term_count; t++)
        for (int k = patch->first[t]; k < patch->end[t] && w->entries[t].host == t; k++)
            take_pack(w, patch, t, k, energies);
}

static void pull_task(void *self, int k)
{
    const Work *w = self;
    const Places *dofs = &w->patches->dofs, *entries = &w->patches->entries;
    if (k < dofs->pull.ranges) {
        pull_sum(&dofs->pull, k, dofs->values, NULL, w->sums.gradient);
        pull_sum(&dofs->pull, k, w->patches->forces, NULL, w->sums.forces);
    } else {
        pull_sum(&entries->pull, k - dofs->pull.ranges, entries->values, w->sums.where, w->sums.values);
    }
}

/* Adds what stands in the places that do not last. */
static void add_changing(const Places *places, const double *values, double *sums)
{
    for (int k = places->lasting; k < places->count; k++)
        if (places->target[k] >= 0) sums[places->target[k]] += values[k];
}

static void pull_all(const Work *w, Workers *workers)
{
    const Patches *patches = w->patches;
    const Sums *sums = &w->sums;
    int ranges = patches->dofs.pull.ranges + (sums->values ? patches->entries.pull.ranges : 0);
    if (sums->values && sums->where) memset(sums->values, 0, (size_t)sums->nonzeros * sizeof *sums->values);
    workers_run(workers, ranges, pull_task, (void *)w);
    add_changing(&patches->dofs, patches->dofs.values, sums->gradient);
    add_changing(&patches->dofs, patches->forces, sums->forces);
    if (sums->values) add_changing(&patches->entries, patches->entries.values, sums->values);
}

void patches_sum(Patches *patches, const Entry *entries, int term_count, const Point *points,
                 Workers *workers, Sums sums)
{
    Work work = {patches, entries, term_count, points, sums};
    workers_run(workers, patches->count, patch_task, &work);
    for (int t = 0; t < term_count; t++) {
        sums.energies[t] = 0;
        for (int p = 0; p < patches->count; p++)
            sums.energies[t] += patches->energies[p * SYSTEM_MAX_TERMS + t];
    }
    if (sums.gradient) pull_all(&work, workers);
}
