#include "base/memory.h"
#include "solve/system_private.h"
#include <assert.h>
#include <math.h>
#include <string.h>

static const double GAP_LEAST = 1e-10; /* of the body's size: what counts as closed */

System *system_create(int dof_count, const DofClass *classes, int class_count)
{
    assert(class_count <= SYSTEM_MAX_CLASSES);
    System *sys = mem_alloc(1, sizeof *sys);
    size_t n = (size_t)dof_count;
    sys->dof_count = dof_count;
    sys->class_count = class_count;
    memcpy(sys->classes, classes, (size_t)class_count * sizeof *classes);
    sys->fixed = mem_alloc(n, sizeof(bool));
    sys->unknown = mem_alloc(n, sizeof(int));
    sys->scale = mem_alloc(n, sizeof(double));
    sys->compliance = mem_alloc(n, sizeof(double));
    sys->force_sum = mem_alloc(n, sizeof(double));
    return sys;
}

void system_destroy(System *sys)
{
    if (!sys) return;
    for (int t = 0; t < sys->term_count; t++) {
        Entry *entry = &sys->entries[t];
        entry->term.ops->destroy(entry->term.self);
        mem_free(entry->dofs);
        entry_clear(entry);
    }
    for (int b = 0; b < sys->bulk_count; b++) sys->bulks[b].ops->destroy(sys->bulks[b].self);
    patches_destroy(&sys->patches);
    sparse_destroy(sys->matrix);
    mem_free(sys->bulk_gradient);
    mem_free(sys->order);
    mem_free(sys->fixed);
    mem_free(sys->unknown);
    mem_free(sys->scale);
    mem_free(sys->compliance);
    mem_free(sys->force_sum);
    mem_free(sys->linearised);
    mem_free(sys->anchor);
    mem_free(sys->work);
    mem_free(sys->diag);
    mem_free(sys);
}

void system_list_elements(Entry *entry)
{
    const TermOps *ops = entry->term.ops;
    entry->count = ops->count(entry->term.self);
    entry->packs = pack_count(entry->count);
    mem_free(entry->dofs);
    entry->dofs = mem_alloc((size_t)entry->packs * (size_t)entry->size, sizeof *entry->dofs);
    for (int k = 0; k < entry->packs; k++)
        for (int l = 0; l < PACK_LANES; l++) {
            int e = k * PACK_LANES + l, dof[TERM_MAX_DOF];
            ops->dofs(entry->term.self, e < entry->count ? e : entry->count - 1, dof);
            for (int i = 0; i < entry->size; i++) entry->dofs[k * entry->size + i][l] = dof[i];
        }
}

void system_add(System *sys, Term term)
{
    assert(sys->term_count < SYSTEM_MAX_TERMS && !sys->prepared);
    Entry *entry = &sys->entries[sys->term_count++];
    *entry = (Entry){.term = term, .changes = term.ops->update != NULL, .size = term.ops->size(term.self)};
    assert(entry->size <= TERM_MAX_DOF);
    entry->lower = TERM_LOWER(entry->size, 0);
    system_list_elements(entry);
    entry->memory = sys->memory_count;
    if (term.ops->memory) sys->memory_count += term.ops->memory(term.self, NULL);
}

void system_add_bulk(System *sys, Bulk bulk)
{
    assert(sys->bulk_count < SYSTEM_MAX_BULKS && !sys->prepared);
    sys->bulks[sys->bulk_count++] = bulk;
    if (!sys->bulk_gradient) sys->bulk_gradient = mem_alloc((size_t)sys->dof_count, sizeof(double));
}

void system_set_workers(System *sys, Workers *workers)
{
    sys->workers = workers;
    if (sys->matrix) sparse_set_workers(sys->matrix, workers);
}

void system_fix(System *sys, int dof)
{
    sys->fixed[dof] = true;
}

void system_set_base_shift(System *sys, double base)
{
    sys->base = base;
}

void system_set_direct(System *sys, DirectKind direct)
{
    assert(!sys->matrix);
    sys->direct = direct;
}

void system_set_order(System *sys, const int *order)
{
    mem_free(sys->order);
    sys->order = mem_copy(order, (size_t)sys->dof_count, sizeof *order);
}

void system_prepare(System *sys)
{
    assert(!sys->prepared);
    for (int i = 0; i < sys->dof_count; i++) sys->unknown[i] = sys->fixed[i] ? -1 : sys->free_count++;
    for (int c = 0; c < sys->class_count; c++)
        for (int i = 0; sys->classes[c].multipliers && i < sys->classes[c].count; i++)
            sys->multiplier_count += !sys->fixed[sys->classes[c].first + i];
    sys->prepared = true;
    sys->work = mem_alloc((size_t)sys->free_count, sizeof(double));
    sys->diag = mem_alloc((size_t)sys->free_count, sizeof(double));
    sys->linearised = mem_alloc((size_t)system_anchor_count(sys), sizeof(double));
    sys->anchor = mem_alloc((size_t)system_anchor_count(sys), sizeof(double));
}

int system_dof_count(const System *sys)
{
    return sys->dof_count;
}
int system_free_count(const System *sys)
{
    return sys->free_count;
}
int system_multiplier_count(const System *sys)
{
    return sys->multiplier_count;
}
bool system_is_fixed(const System *sys, int dof)
{
    return sys->fixed[dof];
}
double system_base_shift(const System *sys)
{
    return sys->base;
}

bool system_is_multiplier(const System *sys, int dof)
{
    for (int c = 0; c < sys->class_count; c++) {
        const DofClass *class = &sys->classes[c];
        if (dof >= class->first && dof < class->first + class->count) return class->multipliers;
    }
    return false;
}

int system_term_count(const System *sys)
{
    return sys->term_count;
}
const Term *system_term(const System *sys, int t)
{
    return &sys->entries[t].term;
}
const Bulk *system_bulk(const System *sys, int b)
{
    return &sys->bulks[b];
}
const double *system_energies(const System *sys)
{
    return sys->energies;
}
const double *system_scale(const System *sys)
{
    return sys->scale;
}
const double *system_linearised(const System *sys)
{
    return sys->linearised + ANCHOR_X;
}
double system_gap(const System *sys)
{
    return sys->gap;
}
double system_compliance(const System *sys, int dof)
{
    return sys->compliance[dof];
}
double system_stiffness_max(const System *sys)
{
    return sys->stiffness_max;
}
int system_position_count(const System *sys)
{
    return sys->classes[0].count;
}
SparseInfo system_info(const System *sys)
{
    return sys->matrix ? sparse_info(sys->matrix) : (SparseInfo){0};
}

double system_step_size(const System *sys, const double *d)
{
    double size = 0;
    for (int c = 0; c < sys->class_count; c++) {
        const DofClass *class = &sys->classes[c];
        for (int i = class->first; i < class->first + class->count; i++)
            size = fmax(size, fabs(d[i]) / class->size);
    }
    return size;
}

Point system_term_point(const System *sys, int t, const Point *at)
{
    Point own = *at;
    assert(at->memory || sys->memory_count == 0);
    if (at->memory) own.memory += sys->entries[t].memory;
    return own;
}

void system_gather(const Entry *entry, int pack, const double *from, Pack *to)
{
    int(*dofs)[PACK_LANES] = &entry->dofs[pack * entry->size];
    for (int i = 0; i < entry->size; i++)
        for (int l = 0; l < PACK_LANES; l++) to[i][l] = from[dofs[i][l]];
}

int system_lanes(const Entry *entry, int pack)
{
    int left = entry->count - pack * PACK_LANES;
    return left < PACK_LANES ? left : PACK_LANES;
}

void system_scatter(const Entry *entry, int pack, const Pack *from, double *to)
{
    int(*dofs)[PACK_LANES] = &entry->dofs[pack * entry->size], lanes = system_lanes(entry, pack);
    for (int i = 0; i < entry->size; i++)
        for (int l = 0; l < lanes; l++) to[dofs[i][l]] += from[i][l];
}

double system_term_energy(System *sys, int t, const Point *at, double *energy)
{
    system_update(sys, at);
    const Entry *entry = &sys->entries[t];
    Point own = system_term_point(sys, t, at);
    Pack x[TERM_MAX_DOF];
    double sum = 0;
    for (int k = 0; k < entry->packs; k++) {
        system_gather(entry, k, at->x, x);
        Pack e = entry->term.ops->eval(entry->term.self, k, &own, x, NULL, NULL);
        sum += pack_sum(e, system_lanes(entry, k));
        for (int l = 0; energy && l < system_lanes(entry, k); l++) energy[k * PACK_LANES + l] = e[l];
    }
    return sum;
}

static Evaluation evaluate(System *sys, const Point *at, double *gradient, bool hessian)
{
    Evaluation result = {0};
    Point points[SYSTEM_MAX_TERMS];
    system_build(sys);
    system_update(sys, at);
    if (hessian) system_couple(sys, at->x);
    double *values = hessian ? sparse_values(sys->matrix) : NULL;
    for (int t = 0; t < sys->term_count; t++) points[t] = system_term_point(sys, t, at);
    Sums sums = {sys->energies,
                 gradient,
                 sys->force_sum,
                 values,
                 sparse_where(sys->matrix),
                 sparse_nonzeros(sys->matrix)};
    patches_sum(&sys->patches, sys->entries, sys->term_count, points, sys->workers, sums);
    for (int t = 0; t < sys->term_count; t++) {
        result.energy += sys->energies[t];
        result.energy_scale += fabs(sys->energies[t]);
    }
    system_evaluate_bulks(sys, at, gradient, values, &result);
    double total = 0;
    for (int i = 0; gradient && i < sys->dof_count; i++) total += gradient[i] * 0;
    for (int i = 0; gradient && i < sys->classes[0].count; i++) {
        result.force_scale = fmax(result.force_scale, sys->force_sum[i]);
        if (!sys->fixed[i]) result.gradient_max = fmax(result.gradient_max, fabs(gradient[i]));
    }
    result.finite = isfinite(result.energy) && total == 0;
    return result;
}

Evaluation system_energy(System *sys, const Point *at)
{
    return evaluate(sys, at, NULL, false);
}

Evaluation system_gradient(System *sys, const Point *at, double *gradient)
{
    return evaluate(sys, at, gradient, false);
}

const double *system_force_sums(const System *sys)
{
    return sys->force_sum;
}

double system_force_change(const System *sys, const double *step)
{
    double change = 0, gap = fmax(sys->gap, GAP_LEAST * sys->classes[0].size);
    for (int i = 0; i < sys->dof_count; i++) change = fmax(change, fabs(step[i]) * sys->compliance[i] / gap);
    return change;
}

/* D: the mean |H_ii| of each class over its free dofs, so that a shift has no unit. */
static void measure_scale(System *sys)
{
    sparse_diagonal(sys->matrix, sys->diag);
    sys->stiffness_max = 0;
    for (int c = 0; c < sys->class_count; c++) {
        const DofClass *class = &sys->classes[c];
        double sum = 0;
        int count = 0;
        for (int i = class->first; i < class->first + class->count; i++) {
            if (sys->fixed[i]) continue;
            double stiffness = fabs(sys->diag[sys->unknown[i]]);
            sum += stiffness;
            count++;
            if (c == 0) sys->stiffness_max = fmax(sys->stiffness_max, stiffness);
        }
        for (int i = class->first; i < class->first + class->count; i++)
            sys->scale[i] = sys->fixed[i] || !count ? 0 : sum / count;
    }
}

static double norm(const DofClass *class, const double *v)
{
    double sum = 0;
    for (int i = class->first; i < class->first + class->count; i++) sum += v[i] * v[i];
    return sqrt(sum);
}

/* What the multipliers give way, from the gradient: what must vanish stands where theirs is. */
static void measure_compliance(System *sys, const double *x, const double *gradient)
{
    double least = GAP_LEAST * sys->classes[0].size;
    sys->gap = 0;
    for (int c = 0; c < sys->class_count; c++) {
        const DofClass *class = &sys->classes[c];
        if (!(class->force > 0)) continue;
        double gap = norm(class, gradient), force = class->force + norm(class, x);
        if (gap > least) sys->gap = fmax(sys->gap, gap);
        for (int i = class->first; i < class->first + class->count; i++)
            sys->compliance[i] = fmax(gap, least) / force;
    }
}

Evaluation system_hessian(System *sys, const Point *at, double *gradient)
{
    Evaluation result = evaluate(sys, at, gradient, true);
    measure_scale(sys);
    measure_compliance(sys, at->x, gradient);
    system_note_point(sys, at);
    return result;
}
