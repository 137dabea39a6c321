/* Flux densities: sources that are summed. */
#include "base/memory.h"
#include "base/vec3.h"
#include "model/build.h"
#include "model/flux_map.h"
#include <math.h>
#include <string.h>

/* Those of one key so far. */
typedef struct Sources {
    double *uniform;    /* [3] T, of all, now        */
    double lasting[3];  /* of those that do not change */
    FluxFields *fields; /* the body's                */
    int first;          /* of them that is of this key */
} Sources;

static bool add_uniform(Sources *sources, const double *value)
{
    for (int i = 0; i < 3; i++) sources->uniform[i] += value[i], sources->lasting[i] += value[i];
    return true;
}

/* ---- In time ---- */

/* A uniform field: its value now, and where time matters later, what it follows from. Takes timed. */
static bool add_timed(const Build *b, Key at, Timed timed, bool changes, Sources *sources)
{
    double value[3];
    Error err;
    bool ok = timed_eval(&timed, b->time, value, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
    if (ok && b->timed && changes) {
        *b->timed = timed;
        for (int i = 0; i < 3; i++) sources->uniform[i] += value[i];
        return true;
    }
    timed_clear(&timed);
    return ok && add_uniform(sources, value);
}

/* A formula that depends on time only is a uniform field, but for the second one in a motion. */
static bool add_formula(const Build *b, Key at, const FluxScene *scene, Sources *sources, FluxField **field)
{
    at = key("%s.formula", at.text);
    Formula *formula =
        build_formula(b, at, scene->formula, 3, scene->where, scene->where_count, build_variables_time);
    if (!formula) return false;
    bool varies = b->timed && timed_is_given(b->timed);
    for (int k = 0; k < 4; k++) varies |= formula_uses(formula, build_variables_time[k]);
    if (!varies)
        return add_timed(b, at, (Timed){.formula = formula, .first = TIMED_ALL}, formula_uses(formula, "t"),
                         sources);
    *field = flux_field_formula(formula, b->size);
    return true;
}

/* In statics a table must have rows around that time, in a motion over a good part of it. */
static bool check_times(const Build *b, Key at, const char *path, const Table *table)
{
    int last = table->rows - 1;
    double from = table->values[0], to = table->values[(size_t)table->columns * (size_t)last],
           end = b->time + b->duration, covered = fmin(to, end) - fmax(from, b->time);
    const double little = 0.01;
    if (covered >= (1 - 1e-9) * TABLE_SHARE * b->duration) {
        if (b->duration > 0 && b->duration < little * (to - from))
            mesh_warn(b->report,
                      "%s: t goes from %g to %g s, and the motion from %g to %g s only: is t in seconds?",
                      path, from, to, b->time, end);
        return true;
    }
    if (b->duration == 0)
        return yaml_refuse(b->file, at.text,
                           "%s:%d: t goes from %g to %g s, and it is needed at %g s (time.at)", path,
                           table->line[last], from, to, b->time);
    return yaml_refuse(b->file, at.text,
                       "%s:%d: t goes from %g to %g s, and the motion from %g to %g s: rows along half of it "
                       "at least are needed",
                       path, table->line[last], from, to, b->time, end);
}

static bool read_timed(const Build *b, Key at, const char *path, const char *columns, Timed *timed)
{
    Error err;
    if (!timed_read(path, columns, timed, &err)) return yaml_refuse(b->file, at.text, "%s", err.text);
    if (check_times(b, at, path, &timed->table)) return true;
    timed_clear(timed);
    return false;
}

static bool add_table(const Build *b, Key at, const char *path, Sources *sources)
{
    Timed timed = {0};
    at = key("%s.file", at.text);
    if (b->timed && timed_is_given(b->timed))
        return yaml_refuse(b->file, at.text, "only one of the list may be a file, or a formula of t alone");
    return read_timed(b, at, path, "t [s], Bx [T], By [T], Bz [T]", &timed) &&
           add_timed(b, at, timed, true, sources);
}

/* At up to 64 times of a motion, or in statics at one. */
static bool check_path(const Build *b, Key at, const Timed *path)
{
    int times = b->duration > 0 ? 64 : 0;
    for (int k = 0; k <= times; k++) {
        double time = b->time + (times ? b->duration * k / times : 0), value[3];
        Error err;
        if (!timed_eval(path, time, value, &err)) return yaml_refuse(b->file, at.text, "%s", err.text);
    }
    return true;
}

/* Three numbers in time; NULL: nothing. The columns of a file as in table_read. */
static bool read_path(const Build *b, Key at, const PathScene *scene, const char *columns, Timed *path)
{
    *path = (Timed){.first = TIMED_ALONE};
    if (!scene) return true;
    if (scene->file) return read_timed(b, key("%s.file", at.text), scene->file, columns, path);
    path->formula = build_formula(b, at, scene->formula, 3, NULL, 0, (const char *const[]){"t", NULL});
    return path->formula && check_path(b, at, path);
}

bool build_rigid_move(const Build *b, Key at, const PathScene *move, const PathScene *turn, RigidMove *motion)
{
    bool ok = read_path(b, key("%s.move", at.text), move, "t [s], x [m], y [m], z [m]", &motion->move);
    return read_path(b, key("%s.turn", at.text), turn, "t [s], x [rad], y [rad], z [rad]", &motion->turn) &&
           ok;
}

/* ---- Magnets and coils ---- */

static bool has_axis(const Build *b, Key at, const double axis[3])
{
    return axis[0] != 0 || axis[1] != 0 || axis[2] != 0 ||
           yaml_refuse(b->file, key("%s.axis", at.text).text, "has no direction: it is [0, 0, 0]");
}

static bool make_magnet(const Build *b, Key at, const MagnetScene *magnet, FluxField **field)
{
    double moment[3];
    if (!isnan(magnet->size[0])) {
        *field = flux_field_block(magnet->at, magnet->size, magnet->remanence);
    } else if (!isnan(magnet->radius)) {
        if (isnan(magnet->length))
            return yaml_refuse(b->file, at.text, "a cylinder needs its `length` beside its `radius`");
        if (!has_axis(b, at, magnet->axis)) return false;
        *field =
            flux_field_cylinder(magnet->at, magnet->axis, magnet->radius, magnet->length, magnet->remanence);
    } else {
        for (int i = 0; i < 3; i++) moment[i] = magnet->remanence[i] * magnet->volume / FLUX_MU_0;
        *field = flux_field_dipole(magnet->at, moment);
    }
    return true;
}

static bool make_coil(const Build *b, Key at, const CoilScene *coil, FluxField **field)
{
    double current = coil->current * coil->turns;
    if (!has_axis(b, at, coil->axis)) return false;
    *field = !isnan(coil->size[0])
                 ? flux_field_rectangular_coil(coil->at, coil->axis, coil->size, current)
                 : flux_field_round_coil(coil->at, coil->axis, coil->radius, coil->length, current);
    return true;
}

static bool make_map(const Build *b, Key at, const FluxMapScene *map, FluxField **field)
{
    Error err;
    *field = flux_map_read(map->file, map->scale, &err);
    return *field || yaml_refuse(b->file, key("%s.file", at.text).text, "%s", err.text);
}

/* A source: into the sums, or a field. */
static bool read_source(const Build *b, Key at, const FluxScene *scene, Sources *sources, FluxField **field)
{
    if (scene->formula_count) return add_formula(b, at, scene, sources, field);
    if (scene->file) return add_table(b, at, scene->file, sources);
    if (scene->magnet) return make_magnet(b, key("%s.magnet", at.text), scene->magnet, field);
    if (scene->coil) return make_coil(b, key("%s.coil", at.text), scene->coil, field);
    if (scene->map) return make_map(b, key("%s.map", at.text), scene->map, field);
    if (!scene->dipole) return add_uniform(sources, scene->value);
    *field = flux_field_dipole(scene->dipole->at, scene->dipole->moment);
    return true;
}

static bool add_source(const Build *b, Key at, const FluxScene *scene, Sources *sources)
{
    FluxField *field = NULL;
    if (!read_source(b, at, scene, sources, &field)) return false;
    if (!field) {
        bool moves = scene->move || scene->turn;
        return !moves || yaml_refuse(b->file, key("%s.%s", at.text, scene->move ? "move" : "turn").text,
                                     "a field that is the same everywhere has no place: give the numbers as "
                                     "formulas of t");
    }
    RigidMove motion = {0};
    bool ok = build_rigid_move(b, at, scene->move, scene->turn, &motion);
    flux_field_set_move(field, motion.move, motion.turn);
    char *name = scene->name ? mem_text(scene->name) : mem_format("source%d", sources->fields->count + 1);
    ok = build_check_name(b, key("%s.name", at.text), "a source", name) && ok;
    for (int k = sources->first; k < sources->fields->count; k++)
        if (!strcmp(flux_field_name(sources->fields->items[k]), name))
            ok = yaml_refuse(b->file, key("%s.name", at.text).text, "there are two sources named '%s'", name);
    flux_field_set_name(field, name);
    mem_free(name);
    flux_fields_add(sources->fields, field);
    return ok;
}

bool build_flux(const Build *b, Key at, const FluxScene *list, int count, double *uniform, FluxFields *fields)
{
    Sources sources = {.uniform = uniform, .fields = fields, .first = fields->count};
    bool ok = true;
    memset(uniform, 0, 3 * sizeof *uniform);
    for (int k = 0; k < count; k++)
        ok = add_source(b, count > 1 ? key("%s[%d]", at.text, k) : at, &list[k], &sources) && ok;
    if (b->timed) memcpy(b->timed->add, sources.lasting, sizeof sources.lasting);
    return ok;
}
