#include "cli/run.h"
#include "base/memory.h"
#include "solve/eigen.h"
#include <stdio.h>
#include <string.h>

static bool go_on(void *self, const NewtonInfo *info)
{
    (void)self, (void)info;
    return !progress_interrupted();
}

NewtonObserver run_observer(Run *run)
{
    return (NewtonObserver){go_on, run};
}

void run_newton(const Run *run, NewtonDef *def)
{
    def->max_iterations = run->scene->solver.max_iterations;
    def->step_tol = run->scene->solver.step_tolerance;
    def->force_tol = run->scene->solver.force_tolerance;
}

/* ---- A growing list of arrays, with the texts and numbers that belong to it ---- */

enum { LIST_MAX = 64 };

typedef struct List {
    int count, owned_count;
    Array arrays[LIST_MAX];
    void *owned[2 * LIST_MAX];
} List;

static void *keep(List *list, void *block)
{
    list->owned[list->owned_count++] = block;
    return block;
}

static double *numbers(List *list, size_t count)
{
    return keep(list, mem_alloc(count, sizeof(double)));
}

static void add(List *list, Array array)
{
    list->arrays[list->count++] = array;
}

static void clear(List *list)
{
    for (int k = 0; k < list->owned_count; k++) mem_free(list->owned[k]);
    *list = (List){0};
}

static bool put(Run *run, const char *kind, int index, List *list, Error *err)
{
    bool ok = journal_put(run->journal, kind, index, list->arrays, list->count, err);
    clear(list);
    return ok;
}

static Array block_array(const char *name, const ParamBlock *block, const double *p)
{
    int rank = block->width > 1 ? 2 : 1;
    return array_float(name, block->unit, p + block->offset, rank, block->count, block->width);
}

/* ---- Frames ---- */

static Point state_point(const State *state)
{
    return (Point){.x = state->x, .p = state->p, .time = state->time};
}

bool run_put_frame(Run *run, int index, double shown, const State *state, bool whole, Error *err)
{
    const Shell *shell = run->model->shell;
    System *sys = state->load_case->sys;
    Point at = state_point(state);
    List list = {0};
    add(&list, array_float("x", "m", state->x, 2, shell->mesh->vertex_count, 3));
    add(&list, array_float("time", "s", &shown, 0, 0, 0));
    add(&list, array_float("flux_density", "T", state->p + shell->flux_density, 2, 1, 3));
    for (int t = 0; t < system_term_count(sys); t++) {
        const Term *term = system_term(sys, t);
        int count = term->ops->count(term->self);
        if (count != shell->mesh->face_count) continue;
        double *energy = numbers(&list, (size_t)count);
        system_term_energy(sys, t, &at, energy);
        add(&list, array_float(keep(&list, mem_format("cell/energy_%s", term->ops->name)), "J", energy, 1,
                               count, 0));
    }
    if (whole) {
        add(&list, block_array("cell/magnetization", params_find(&shell->params, "magnetization"), state->p));
        add(&list, block_array("cell/young", params_find(&shell->params, "young"), state->p));
    }
    return put(run, "frame", index, &list, err);
}

/* ---- Final arrays ---- */

/* What both the plain paths and cases/<name> have. */
static void add_state(List *list, const char *x_name, const char *prefix, const State *state)
{
    System *sys = state->load_case->sys;
    Point at = state_point(state);
    int positions = system_position_count(sys);
    add(list, array_float(keep(list, mem_text(x_name)), "m", state->x, 2, positions / 3, 3));
    double *gradient = numbers(list, (size_t)system_dof_count(sys)),
           *energy = numbers(list, (size_t)system_term_count(sys));
    system_gradient(sys, &at, gradient);
    add(list, array_float(keep(list, mem_format("%s/gradient", prefix)), "N", gradient, 2, positions / 3, 3));
    for (int t = 0; t < system_term_count(sys); t++) {
        energy[t] = system_term_energy(sys, t, &at, NULL);
        add(list, array_float(keep(list, mem_format("%s/energy/%s", prefix, system_term(sys, t)->ops->name)),
                              "J", &energy[t], 0, 0, 0));
    }
}

static void add_modes(List *list, const State *state, int modes)
{
    System *sys = state->load_case->sys;
    Point at = state_point(state);
    int positions = system_position_count(sys), dofs = system_dof_count(sys), count = modes > 1 ? modes : 1;
    if (system_free_count(sys) == 0) return;
    double *values = numbers(list, (size_t)count), *vectors = numbers(list, (size_t)count * (size_t)dofs);
    if (!eigen_lowest(sys, &at, count, values, vectors)) return;
    add(list, array_float("final/lowest_eigenvalue", "N/m", values, 0, 0, 0));
    /* The mode of an instability is kept in any case: it says which way the body would go. */
    if (!modes && values[0] >= 0) return;
    double *mode = numbers(list, (size_t)count * (size_t)positions);
    for (int k = 0; k < count; k++)
        memcpy(mode + k * positions, vectors + k * dofs, (size_t)positions * sizeof *mode);
    add(list, array_float("final/eigenvalues", "N/m", values, 1, count, 0));
    Array shape = array_float("final/modes", "", mode, 3, count, positions / 3);
    shape.dims[2] = 3;
    add(list, shape);
}

/* Parameters of the last state; flux_density has a row for each. */
static void add_params(List *list, const Params *params, const State *states, int count)
{
    const State *last = &states[count - 1];
    for (int b = 0; b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        const char *name = keep(list, mem_format("design/%s", block->name));
        if (block->count == 0) continue;
        if (strcmp(block->name, "flux_density")) {
            add(list, block_array(name, block, last->p));
            continue;
        }
        double *flux = numbers(list, 3 * (size_t)count);
        for (int k = 0; k < count; k++) memcpy(flux + 3 * k, states[k].p + block->offset, 3 * sizeof *flux);
        add(list, array_float(name, block->unit, flux, 2, count, 3));
    }
}

static bool put_case(Run *run, const State *state, Error *err)
{
    List list = {0};
    const char *name = state->load_case->name;
    char prefix[256], x_name[300];
    snprintf(prefix, sizeof prefix, "cases/%.200s", name);
    snprintf(x_name, sizeof x_name, "%s/x", prefix);
    add_state(&list, x_name, prefix, state);
    add(&list, array_text(keep(&list, mem_format("%s/status", prefix)), newton_status_name(state->status)));
    const ParamBlock *flux = params_find(&run->model->shell->params, "flux_density");
    add(&list, array_float(keep(&list, mem_format("%s/flux_density", prefix)), "T", state->p + flux->offset,
                           1, 3, 0));
    if (state->load_case->target)
        add(&list, array_float(keep(&list, mem_format("%s/target", prefix)), "m", state->load_case->target[0],
                               2, run->model->shell->mesh->vertex_count, 3));
    return put(run, "final", 0, &list, err);
}

/* In the scene's order, a line each. */
static char *case_names(const State *states, int count)
{
    char *names = mem_text("");
    for (int k = 0; k < count; k++) {
        char *longer = mem_format("%s%s\n", names, states[k].load_case->name);
        mem_free(names);
        names = longer;
    }
    return names;
}

bool run_put_final(Run *run, const State *states, int count, const char *status, Error *err)
{
    List list = {0};
    add_state(&list, "state/x", "final", &states[count - 1]);
    add_params(&list, &run->model->shell->params, states, count);
    add_modes(&list, &states[count - 1], run->scene->modes);
    add(&list, array_text("status", status));
    add(&list, array_text("case_names", keep(&list, case_names(states, count))));
    if (!put(run, "final", 0, &list, err)) return false;
    for (int k = 0; k < count; k++)
        if (!put_case(run, &states[k], err)) return false;
    return true;
}

/* ---- State ---- */

bool run_put_state(Run *run, int index, const char *name, const double *values, size_t count, Error *err)
{
    Array array = array_float(name, "", values, 1, (int)count, 0);
    return journal_put(run->journal, "state", index, &array, 1, err);
}

bool run_get_state(Run *run, int index, const char *name, double *values, size_t count)
{
    Array array;
    if (!journal_has(run->journal, "state", index, name) ||
        !journal_get(run->journal, "state", index, name, &array, NULL))
        return false;
    bool ok = array.type == ARRAY_FLOAT64 && array_count(&array) == count;
    if (ok) memcpy(values, array.data, count * sizeof *values);
    array_clear(&array);
    return ok;
}
