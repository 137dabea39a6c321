#include "rod/front/loads.h"
#include "base/memory.h"
#include "model/sequence.h"
#include <math.h>

static const char *const time_variables[] = {"t", NULL};
enum { PLACES = 4 }; /* the first of rod_place_variables say where the rod is */

/* ---- Reading ---- */

static bool read_vector(const Build *b, Key at, const LoadVectorScene *scene, const char *const *variables,
                        LoadVector *vector)
{
    if (!scene) return true;
    if (!scene->formula) {
        vector->value = vec3_load(scene->value);
        return true;
    }
    vector->formula = build_formula(b, at, scene->formula, 3, scene->where, scene->where_count, variables);
    return vector->formula != NULL;
}

/* What of the place a line load depends on; NULL: nothing. */
static const char *place_of(const Formula *line)
{
    for (int i = 0; line && i < PLACES; i++)
        if (formula_uses(line, rod_place_variables[i])) return rod_place_variables[i];
    return NULL;
}

/* Of a rod that moves, forces that follow from its place have to have a potential. */
static bool check_line(const Build *b, Key at, const Formula *line, bool known)
{
    const char *place = place_of(line);
    return known || !place ||
           yaml_refuse(b->file, at.text,
                       "a force that depends on where the rod is, %s, needs `potential` in place of "
                       "`line`, which is of s, "
                       "L and t",
                       place);
}

static bool read_potential(const Build *b, Key at, const RodLoadScene *scene, double size, RodLoadList *list)
{
    char *const expressions[] = {scene->potential};
    Formula *formula =
        build_formula(b, at, expressions, 1, scene->where, scene->where_count, rod_place_variables);
    if (formula) rod_potentials_add(&list->potentials, rod_potential_create(formula, size));
    return formula != NULL;
}

static bool read_load(const RodLoadScene *scene, const Build *b, int k, bool known, RodLoad *load)
{
    Key line = key("rod.loads[%d].line", k);
    load->point = !scene->point ? NAN : isnan(scene->point->value) ? INFINITY : scene->point->value;
    if (scene->point && !scene->force && !scene->couple)
        return yaml_refuse(b->file, key("rod.loads[%d]", k).text,
                           "`force` or `couple`, what acts at the point, is missing");
    bool ok = read_vector(b, line, scene->line, rod_place_variables, &load->line) &&
              check_line(b, line, load->line.formula, known);
    ok = read_vector(b, key("rod.loads[%d].force", k), scene->force, time_variables, &load->force) && ok;
    return read_vector(b, key("rod.loads[%d].couple", k), scene->couple, time_variables, &load->couple) && ok;
}

static bool is_timed(const RodLoad *load)
{
    const Formula *formulas[] = {load->line.formula, load->force.formula, load->couple.formula};
    bool timed = false;
    for (int i = 0; i < 3; i++) timed |= formulas[i] && formula_uses(formulas[i], "t");
    return timed;
}

bool rod_loads_read(const RodScene *scene, const Build *b, double size, bool known, RodLoadList *list)
{
    bool ok = true;
    list->items = mem_alloc((size_t)scene->loads_count, sizeof *list->items);
    for (int k = 0; k < scene->loads_count; k++) {
        const RodLoadScene *from = &scene->loads[k];
        if (from->potential) {
            ok = read_potential(b, key("rod.loads[%d].potential", k), from, size, list) && ok;
            list->placed = true;
            continue;
        }
        RodLoad *load = &list->items[list->count++];
        ok = read_load(from, b, k, known, load) && ok;
        list->couples |= from->couple != NULL;
        list->along |= load->line.formula != NULL;
        list->placed |= place_of(load->line.formula) != NULL;
        list->timed |= is_timed(load);
        if (scene->solver == ROD_SOLVER_PBD && list->timed)
            ok = yaml_refuse(b->file, key("rod.loads[%d]", k).text,
                             "solver: pbd knows loads that stay as they are: no formulas of t");
    }
    return ok;
}

void rod_loads_clear(RodLoadList *list)
{
    for (int k = 0; k < list->count; k++) {
        formula_destroy(list->items[k].line.formula);
        formula_destroy(list->items[k].force.formula);
        formula_destroy(list->items[k].couple.formula);
    }
    mem_free(list->items);
    rod_potentials_clear(&list->potentials);
}

/* ---- What they are ---- */

static bool vector_at(const LoadVector *vector, const double *variables, Vec3 *value, Error *err)
{
    double numbers[3];
    *value = vector->value;
    if (!vector->formula) return true;
    if (!formula_eval(vector->formula, variables, numbers, err)) return false;
    *value = vec3_load(numbers);
    return true;
}

bool rod_loads_at(const RodLoadList *list, double time, RodPointLoad *points, RodLoads *loads, Error *err)
{
    bool ok = true;
    *loads = (RodLoads){.points = points};
    for (int k = 0; ok && k < list->count; k++) {
        const RodLoad *load = &list->items[k];
        if (isnan(load->point)) {
            loads->line = vec3_add(loads->line, load->line.value);
            continue;
        }
        RodPointLoad *point = &points[loads->point_count++];
        point->s = load->point;
        ok = vector_at(&load->force, &time, &point->force, err) &&
             vector_at(&load->couple, &time, &point->couple, err);
    }
    return ok;
}

/* Adds -grad u. */
static bool add_potentials(const RodPotentials *potentials, RodPlace at, Vec3 *force, Error *err)
{
    FormulaJet jet;
    for (int k = 0; k < potentials->count; k++) {
        if (!rod_potential_known(potentials->items[k], at, &jet, err)) return false;
        *force = vec3_axpy(-1, vec3_load(jet.gradient[0]), *force);
    }
    return true;
}

bool rod_loads_along(const RodLoadList *list, int elements, double length, const RodCurve *curve, double time,
                     Vec3 *along, Error *err)
{
    bool ok = true;
    for (int j = 0; ok && j <= 2 * elements; j++) {
        RodPlace at = {curve ? curve->x[j] : vec3(0, 0, 0), time, length * j / (2 * elements), length};
        double variables[] = {at.x.x, at.x.y, at.x.z, hypot(at.x.x, at.x.y), at.time, at.s, at.L};
        along[j] = vec3(0, 0, 0);
        for (int k = 0; ok && k < list->count; k++) {
            Vec3 own;
            if (!list->items[k].line.formula) continue;
            ok = vector_at(&list->items[k].line, variables, &own, err);
            if (ok) along[j] = vec3_add(along[j], own);
        }
        ok = ok && (!curve || add_potentials(&list->potentials, at, &along[j], err));
    }
    return ok;
}

bool rod_loads_put(const RodLoadList *list, const Rod *rod, const RodCurve *curves, double time, double *p,
                   Error *err)
{
    int each = rod_each(rod);
    RodLoads loads;
    RodPointLoad *points = mem_alloc((size_t)list->count, sizeof *points);
    Vec3 *along = mem_alloc(2 * (size_t)each + 1, sizeof *along);
    bool ok = rod_loads_at(list, time, points, &loads, err);
    RodLoadList lines = *list;
    lines.potentials.count = 0; /* those of the rod are a term */
    for (int k = 0; ok && k < rod->strands; k++) {
        if (list->along) loads.along = along;
        ok = !list->along || rod_loads_along(&lines, each, rod->strand[k].length, curves ? &curves[k] : NULL,
                                             time, along, err);
        if (ok) rod_share_loads(rod, k, loads, p);
    }
    if (ok) rod_sum_loads(rod, p);
    mem_free(along);
    mem_free(points);
    return ok;
}

/* ---- Of stages and cases ---- */

static bool have_couples(const LoadScene *loads, int count)
{
    bool have = false;
    for (int k = 0; k < count; k++) have |= !isnan(loads[k].couple[0]);
    return have;
}

bool rod_loads_couple(const Scene *scene)
{
    bool have = false;
    for (int k = 0; k < sequence_said(scene); k++) {
        StageScene stage = sequence_stage(scene, k);
        have |= have_couples(stage.loads, stage.loads_count);
    }
    for (int k = 0; k < scene->cases_count; k++)
        have |= have_couples(scene->cases[k].loads, scene->cases[k].loads_count);
    return have;
}

static bool read_dead(const Rod *rod, const Build *b, Key at, const LoadScene *load, RodPointLoad *point)
{
    double length = rod_length(rod);
    if (!load->point)
        return yaml_refuse(b->file, at.text,
                           "of a rod it needs `point`, where it acts: an arclength, or `end`");
    *point = (RodPointLoad){.s = isnan(load->point->value) ? INFINITY : load->point->value};
    if (!isnan(load->force[0])) point->force = vec3_load(load->force);
    if (!isnan(load->couple[0])) point->couple = vec3_load(load->couple);
    return !isfinite(point->s) || point->s <= length * (1 + 1e-9) ||
           yaml_refuse(b->file, at.text, "a load is at s = %g m, beyond the rod's length of %g m", point->s,
                       length);
}

bool rod_loads_put_dead(const Rod *rod, const Build *b, const char *at, const LoadScene *loads, int count,
                        double *p)
{
    RodPointLoad *points = mem_alloc((size_t)count, sizeof *points);
    RodLoads all = {.points = points};
    bool ok = true;
    for (int k = 0; k < count; k++)
        if (!isnan(loads[k].line[0]))
            all.line = vec3_add(all.line, vec3_load(loads[k].line));
        else
            ok = read_dead(rod, b, key("%s[%d]", at, k), &loads[k], &points[all.point_count++]) && ok;
    for (int k = 0; ok && k < rod->strands; k++) rod_share_loads(rod, k, all, p);
    if (ok) rod_sum_loads(rod, p);
    mem_free(points);
    return ok;
}
