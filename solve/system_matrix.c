/* The System's matrix: its pattern, where each element's entries go, and what Bulks put into it. */
#include "solve/system_private.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

/* The order among the unknowns; NULL: none given. */
static int *unknown_order(const System *sys)
{
    if (!sys->order) return NULL;
    int *order = mem_alloc((size_t)sys->free_count, sizeof *order), count = 0;
    for (int k = 0; k < sys->dof_count; k++)
        if (sys->unknown[sys->order[k]] >= 0) order[count++] = sys->unknown[sys->order[k]];
    return order;
}

/* Groups of coupled unknowns, of which terms and Bulks append theirs; room is counted before. */
typedef struct Groups {
    const System *sys;
    long *start, count, places; /* start[count + 1] */
    int *dofs;                  /* [places]         */
} Groups;

static Groups groups_create(const System *sys)
{
    long groups = 0, places = 0;
    for (int t = 0; t < sys->term_count; t++) {
        groups += sys->entries[t].count;
        places += (long)sys->entries[t].count * sys->entries[t].size;
    }
    for (int b = 0; b < sys->bulk_count; b++) {
        const BulkCoupling *coupling = &sys->couplings[b];
        groups += coupling->group_count;
        if (coupling->group_count) places += coupling->start[coupling->group_count];
    }
    return (Groups){.sys = sys,
                    .start = mem_alloc((size_t)groups + 1, sizeof(long)),
                    .dofs = mem_alloc((size_t)places, sizeof(int))};
}

static void add_dof(Groups *groups, int dof)
{
    groups->dofs[groups->places++] = groups->sys->unknown[dof];
}

static void end_group(Groups *groups)
{
    groups->start[++groups->count] = groups->places;
}

static void add_term_groups(Groups *groups, const Entry *entry)
{
    for (int e = 0; e < entry->count; e++) {
        for (int d = 0; d < entry->size; d++)
            add_dof(groups, entry->dofs[e / PACK_LANES * entry->size + d][e % PACK_LANES]);
        end_group(groups);
    }
}

static void add_bulk_groups(Groups *groups, const BulkCoupling *coupling)
{
    for (int e = 0; e < coupling->group_count; e++) {
        for (long k = coupling->start[e]; k < coupling->start[e + 1]; k++) add_dof(groups, coupling->dofs[k]);
        end_group(groups);
    }
}

static Sparse *create_matrix(const System *sys)
{
    Groups groups = groups_create(sys);
    for (int t = 0; t < sys->term_count; t++) add_term_groups(&groups, &sys->entries[t]);
    for (int b = 0; b < sys->bulk_count; b++) add_bulk_groups(&groups, &sys->couplings[b]);
    int *order = unknown_order(sys);
    Sparse *matrix = sparse_create(sys->free_count, (int)groups.count, groups.start, groups.dofs,
                                   (SparseDef){order, sys->multiplier_count});
    mem_free(order);
    mem_free(groups.start);
    mem_free(groups.dofs);
    return matrix;
}

static void find_slots(System *sys, Entry *entry)
{
    int bin = sparse_nonzeros(sys->matrix), room = 0;
    entry->slots = mem_alloc((size_t)entry->packs * (size_t)entry->lower, sizeof *entry->slots);
    for (int k = 0; k < entry->packs; k++)
        for (int i = 0; i < entry->size; i++)
            for (int j = 0; j <= i; j++)
                for (int l = 0; l < PACK_LANES; l++) {
                    int *slot = &entry->slots[k * entry->lower + TERM_LOWER(i, j)][l];
                    int a = entry->dofs[k * entry->size + i][l], b = entry->dofs[k * entry->size + j][l];
                    bool used =
                        k * PACK_LANES + l < entry->count && sys->unknown[a] >= 0 && sys->unknown[b] >= 0;
                    *slot = used ? sparse_slot(sys->matrix, sys->unknown[a], sys->unknown[b]) : bin;
                    if (!used || i == j || a != b) continue;
                    if (entry->twice_count == room) {
                        entry->twice =
                            mem_resize(entry->twice, 3 * (size_t)room, 6 * (size_t)room + 24, sizeof(int));
                        room = 2 * room + 8;
                    }
                    int *place = &entry->twice[3 * entry->twice_count++];
                    place[0] = k, place[1] = TERM_LOWER(i, j), place[2] = l;
                }
}

void system_build_matrix(System *sys)
{
    sparse_destroy(sys->matrix);
    sys->matrix = create_matrix(sys);
    sys->factored = false;
    for (int t = 0; t < sys->term_count; t++) {
        Entry *entry = &sys->entries[t];
        mem_free(entry->slots);
        mem_free(entry->twice);
        entry->twice = NULL;
        entry->twice_count = 0;
        find_slots(sys, entry);
    }
}

void system_build(System *sys)
{
    if (!sys->matrix) system_build_matrix(sys);
}

SparseInfo system_cost(const System *sys)
{
    Sparse *matrix = create_matrix(sys);
    SparseInfo info = sparse_info(matrix);
    sparse_destroy(matrix);
    return info;
}

void system_couple(System *sys, const double *x)
{
    bool changed = false;
    for (int b = 0; b < sys->bulk_count; b++)
        changed |= sys->bulks[b].ops->couple(sys->bulks[b].self, x, &sys->couplings[b]);
    if (changed || !sys->matrix) system_build_matrix(sys);
}

static void add_block(void *self, int row, int column, int n, const double *block)
{
    System *sys = self;
    double *values = sparse_values(sys->matrix);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < (row == column ? i + 1 : n); j++) {
            int a = sys->unknown[row + i], b = sys->unknown[column + j];
            if (a >= 0 && b >= 0) values[sparse_slot(sys->matrix, a, b)] += block[i * n + j];
        }
}

void system_evaluate_bulks(System *sys, const Point *at, double *gradient, double *values, Evaluation *result)
{
    BulkMatrix matrix = {add_block, sys};
    double *own = gradient ? sys->bulk_gradient : NULL;
    for (int b = 0; b < sys->bulk_count; b++) {
        if (own) memset(own, 0, (size_t)sys->dof_count * sizeof *own);
        double energy = sys->bulks[b].ops->eval(sys->bulks[b].self, at, own, values ? &matrix : NULL);
        for (int i = 0; own && i < sys->dof_count; i++) {
            gradient[i] += own[i];
            sys->force_sum[i] += fabs(own[i]);
        }
        sys->energies[sys->term_count + b] = energy;
        result->energy += energy;
        result->energy_scale += fabs(energy);
    }
}
