/* The System's matrix: its pattern, where each element's entries go, and what Bulks put into it. */
#include "base/memory.h"
#include "solve/system_private.h"
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

/* Groups of coupled unknowns in the making. */
typedef struct GroupList {
    const System *sys;
    int count, room;
    long *start; /* [room + 1] */
    long places, place_room;
    int *unknowns;
} GroupList;

static void add_dof(GroupList *list, int dof)
{
    if (list->places == list->place_room) {
        long room = 2 * list->place_room + 1024;
        list->unknowns =
            mem_resize(list->unknowns, (size_t)list->place_room, (size_t)room, sizeof *list->unknowns);
        list->place_room = room;
    }
    list->unknowns[list->places++] = list->sys->unknown[dof];
}

static void end_group(GroupList *list)
{
    if (list->count == list->room) {
        int room = 2 * list->room + 256;
        list->start = mem_resize(list->start, (size_t)list->room + 1, (size_t)room + 1, sizeof *list->start);
        list->room = room;
    }
    list->start[++list->count] = list->places;
}

static void add_term_groups(GroupList *list, const Entry *entry)
{
    for (int e = 0; e < entry->count; e++) {
        for (int d = 0; d < entry->size; d++)
            add_dof(list, entry->dofs[e / PACK_LANES * entry->size + d][e % PACK_LANES]);
        end_group(list);
    }
}

static void add_bulk_groups(GroupList *list, const BulkCoupling *coupling)
{
    for (int e = 0; e < coupling->group_count; e++) {
        for (long k = coupling->start[e]; k < coupling->start[e + 1]; k++) add_dof(list, coupling->dofs[k]);
        end_group(list);
    }
}

/* Of the terms whose elements last, or change. */
static GroupList list_groups(const System *sys, bool changes)
{
    GroupList list = {.sys = sys, .start = mem_alloc(1, sizeof *list.start)};
    for (int t = 0; t < sys->term_count; t++)
        if (sys->entries[t].changes == changes) add_term_groups(&list, &sys->entries[t]);
    return list;
}

static Groups groups_of(const GroupList *list)
{
    return (Groups){list->count, list->start, list->unknowns};
}

static void group_list_clear(GroupList *list)
{
    mem_free(list->start);
    mem_free(list->unknowns);
}

static Sparse *create_matrix(const System *sys)
{
    GroupList list = list_groups(sys, false);
    int *order = unknown_order(sys);
    SparseDef def = {order, sys->multiplier_count, sys->direct};
    Sparse *matrix = sparse_create(sys->free_count, groups_of(&list), def);
    sparse_set_workers(matrix, sys->workers);
    mem_free(order);
    group_list_clear(&list);
    return matrix;
}

void system_build(System *sys)
{
    if (sys->matrix) return;
    sys->matrix = create_matrix(sys);
    patches_create(&sys->patches, sys->entries, sys->term_count, sys->matrix, sys->dof_count, sys->unknown);
}

void system_update(System *sys, const Point *at)
{
    bool changed = false;
    for (int t = 0; t < sys->term_count; t++) {
        Entry *entry = &sys->entries[t];
        if (!entry->changes) continue;
        Point own = system_term_point(sys, t, at);
        if (!entry->term.ops->update(entry->term.self, &own)) continue;
        system_list_elements(entry);
        changed = true;
    }
    if (!changed) return;
    system_build(sys);
    patches_change(&sys->patches, sys->entries, sys->term_count, sys->dof_count);
    sys->uncoupled = true;
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
    bool changed = sys->uncoupled;
    for (int b = 0; b < sys->bulk_count; b++)
        changed |= sys->bulks[b].ops->couple(sys->bulks[b].self, x, &sys->couplings[b]);
    if (!changed) return;
    GroupList list = list_groups(sys, true);
    for (int b = 0; b < sys->bulk_count; b++) add_bulk_groups(&list, &sys->couplings[b]);
    sparse_couple(sys->matrix, groups_of(&list));
    group_list_clear(&list);
    patches_place(&sys->patches, sys->entries, sys->term_count, sys->matrix, sys->unknown);
    sys->uncoupled = false;
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
