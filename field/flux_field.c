#include "field/flux_field.h"
#include "base/memory.h"
#include "field/flux_shape.h"
#include "field/formula_jet.h"
#include <string.h>

/* What a field is, in its own frame. */
typedef struct FluxKind {
    const char *name; /* as in a scene */
    void (*eval)(const FluxField *field, const double x[3], double time, FluxSample *sample);
    /* Of kinds for which that is less work, or which are not known everywhere; else NULL. */
    bool (*value)(const FluxField *field, const double x[3], double time, double flux[3], Error *err);
    void (*shape)(const FluxField *field, MeshFile *shape); /* NULL: it has none */
    bool poles;                                             /* its strength is a remanence */
    /* Is it itself there, or a winding so near that the field is not known? NULL: never. */
    bool (*within)(const FluxField *field, const double x[3]);
    const char *infinite; /* where it is that; NULL: nowhere */
} FluxKind;

struct FluxField {
    char *name; /* owned; NULL: none */
    const FluxKind *kind;
    RigidMove motion;   /* its pivot is the frame's origin                              */
    bool own_axes;      /* its frame has other axes than space                          */
    double axes[3][3];  /* rows: own axes                                               */
    Formula *formula;   /* owned                                                        */
    double step;        /* m, of a formula's differences                                */
    CubicGrid grid[3];  /* of a map                                                     */
    double half[3];     /* m: of a block, of a rectangle; radius and half a length      */
    double strength[3]; /* T, A m^2: remanence, moment; A: current times turns          */
};

/* ---- Kinds ---- */

static FormulaOfPlace formula_of(const FluxField *field)
{
    return (FormulaOfPlace){.formula = field->formula, .results = 3, .numbers = 1, .step = field->step};
}

static void eval_formula(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    FormulaJet jet;
    FormulaOfPlace of = formula_of(field);
    formula_jet(&of, vec3_load(x), &time, &jet);
    memcpy(sample->flux, jet.value, sizeof sample->flux);
    memcpy(sample->gradient, jet.gradient, sizeof sample->gradient);
    memcpy(sample->curvature, jet.curvature, sizeof sample->curvature);
}

static bool value_formula(const FluxField *field, const double x[3], double time, double flux[3], Error *err)
{
    FormulaOfPlace of = formula_of(field);
    return formula_jet_value(&of, vec3_load(x), &time, flux, err);
}

/* Where the map is; a little more, for rounding. */
static bool in_map(const CubicGrid *grid, const double x[3])
{
    const double little = 1e-9;
    for (int i = 0; i < 3; i++) {
        double steps = (x[i] - grid->low[i]) / grid->step[i];
        if (grid->nodes[i] > 1 && !(steps >= -little && steps <= grid->nodes[i] - 1 + little)) return false;
    }
    return true;
}

static void eval_map(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    (void)time;
    *sample = (FluxSample){.flux = {NAN, NAN, NAN}};
    if (!in_map(&field->grid[0], x)) return;
    for (int k = 0; k < 3; k++) {
        SpaceSample at;
        cubic_grid_at(&field->grid[k], x, &at);
        sample->flux[k] = at.value;
        memcpy(sample->gradient[k], at.gradient, sizeof at.gradient);
        memcpy(sample->curvature[k], at.hessian, sizeof at.hessian);
    }
}

static bool value_map(const FluxField *field, const double x[3], double time, double flux[3], Error *err)
{
    FluxSample sample;
    eval_map(field, x, time, &sample);
    memcpy(flux, sample.flux, sizeof sample.flux);
    return in_map(&field->grid[0], x) ||
           error_set(err, "(%.4g, %.4g, %.4g) m is beyond the map", x[0], x[1], x[2]);
}

static void eval_dipole(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    (void)time;
    flux_of_dipole(field->strength, x, sample);
}

static void eval_block(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    (void)time;
    flux_of_block(field->half, field->strength, x, sample);
}

static void eval_cylinder(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    (void)time;
    flux_of_cylinder(field->half[0], field->half[1], field->strength, x, sample);
}

static void eval_round_coil(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    (void)time;
    flux_of_round_coil(field->half[0], field->half[1], field->strength[0], x, sample);
}

static void eval_rectangular_coil(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    (void)time;
    flux_of_rectangular_coil(field->half, field->strength[0], x, sample);
}

static void shape_block(const FluxField *field, MeshFile *shape)
{
    flux_shape_block(field->half, shape);
}

static void shape_cylinder(const FluxField *field, MeshFile *shape)
{
    flux_shape_cylinder(field->half[0], field->half[1], shape);
}

static void shape_round_coil(const FluxField *field, MeshFile *shape)
{
    flux_shape_round_coil(field->half[0], field->half[1], shape);
}

static void shape_rectangular_coil(const FluxField *field, MeshFile *shape)
{
    flux_shape_rectangular_coil(field->half, shape);
}

static bool within_block(const FluxField *field, const double x[3])
{
    return fabs(x[0]) < field->half[0] && fabs(x[1]) < field->half[1] && fabs(x[2]) < field->half[2];
}

static bool within_cylinder(const FluxField *field, const double x[3])
{
    return hypot(x[0], x[1]) < field->half[0] && fabs(x[2]) < field->half[1];
}

static const double NEAR = 0.01; /* of the radius: windings are thicker */

static bool within_round(const FluxField *field, const double x[3])
{
    double beyond = fmax(0, fabs(x[2]) - field->half[1]);
    return hypot(hypot(x[0], x[1]) - field->half[0], beyond) < NEAR * field->half[0];
}

/* Its four wires lie in the plane of its first two axes. */
static bool within_rectangle(const FluxField *field, const double x[3])
{
    double out[2], least = fmin(field->half[0], field->half[1]);
    for (int i = 0; i < 2; i++) out[i] = fabs(x[i]) - field->half[i];
    double inside = fmin(0, fmax(out[0], out[1])),
           away = fmax(-inside, hypot(fmax(0, out[0]), fmax(0, out[1])));
    return hypot(away, x[2]) < NEAR * least;
}

static const FluxKind
    by_formula = {"formula", eval_formula, value_formula, NULL, false, NULL, NULL},
    by_map = {"map", eval_map, value_map, NULL, false, NULL, NULL},
    of_dipole = {"dipole", eval_dipole, NULL, NULL, false, NULL, "at its own place"},
    of_block = {"magnet", eval_block, NULL, shape_block, true, within_block, "on its edges"},
    of_cylinder = {"magnet", eval_cylinder, NULL, shape_cylinder, true, within_cylinder, "on its rims"},
    of_round_coil = {"coil", eval_round_coil, NULL, shape_round_coil, false, within_round, "on its wire"},
    of_rectangular_coil = {"coil", eval_rectangular_coil, NULL,         shape_rectangular_coil,
                           false,  within_rectangle,      "on its wire"};

/* ---- Making them ---- */

static FluxField *make(const FluxKind *kind, const double at[3])
{
    FluxField *field = mem_alloc(1, sizeof *field);
    field->kind = kind;
    if (at) memcpy(field->motion.pivot, at, sizeof field->motion.pivot);
    return field;
}

FluxField *flux_field_formula(Formula *formula, double length)
{
    FluxField *field = make(&by_formula, NULL);
    field->formula = formula;
    field->step = length / 64;
    return field;
}

FluxField *flux_field_map(const CubicGrid component[3])
{
    FluxField *field = make(&by_map, NULL);
    memcpy(field->grid, component, sizeof field->grid);
    return field;
}

FluxField *flux_field_dipole(const double at[3], const double moment[3])
{
    FluxField *field = make(&of_dipole, at);
    memcpy(field->strength, moment, sizeof field->strength);
    return field;
}

FluxField *flux_field_block(const double at[3], const double size[3], const double remanence[3])
{
    FluxField *field = make(&of_block, at);
    memcpy(field->strength, remanence, sizeof field->strength);
    for (int i = 0; i < 3; i++) field->half[i] = size[i] / 2;
    return field;
}

/* A frame whose z is the axis, x across it and space's z (x if they are the same). */
static void set_axis(FluxField *field, const double axis[3])
{
    Vec3 z = vec3_unit(vec3_load(axis)), x = vec3_cross(vec3(0, 0, 1), z);
    x = vec3_dot(x, x) > 0 ? vec3_unit(x) : vec3(1, 0, 0);
    field->own_axes = true;
    vec3_store(field->axes[0], x);
    vec3_store(field->axes[1], vec3_cross(z, x));
    vec3_store(field->axes[2], z);
}

FluxField *flux_field_cylinder(const double at[3], const double axis[3], double radius, double length,
                               const double remanence[3])
{
    FluxField *field = make(&of_cylinder, at);
    set_axis(field, axis);
    field->half[0] = radius, field->half[1] = length / 2;
    for (int i = 0; i < 3; i++)
        field->strength[i] = vec3_dot(vec3_load(field->axes[i]), vec3_load(remanence));
    return field;
}

FluxField *flux_field_round_coil(const double at[3], const double axis[3], double radius, double length,
                                 double current)
{
    FluxField *field = make(&of_round_coil, at);
    set_axis(field, axis);
    field->half[0] = radius, field->half[1] = length / 2, field->strength[0] = current;
    return field;
}

FluxField *flux_field_rectangular_coil(const double at[3], const double axis[3], const double sides[2],
                                       double current)
{
    FluxField *field = make(&of_rectangular_coil, at);
    set_axis(field, axis);
    field->half[0] = sides[0] / 2, field->half[1] = sides[1] / 2, field->strength[0] = current;
    return field;
}

void flux_field_set_move(FluxField *field, Timed move, Timed turn)
{
    field->motion.move = move, field->motion.turn = turn;
}

void flux_field_set_name(FluxField *field, const char *name)
{
    mem_free(field->name);
    field->name = mem_text(name);
}

const char *flux_field_name(const FluxField *field)
{
    return field->name ? field->name : "";
}

void flux_field_destroy(FluxField *field)
{
    if (!field) return;
    mem_free(field->name);
    formula_destroy(field->formula);
    for (int k = 0; k < 3; k++) cubic_grid_clear(&field->grid[k]);
    rigid_move_clear(&field->motion);
    mem_free(field);
}

/* ---- Where they are ---- */

/* Its frame at a time: own = axes (x - origin); axes NULL: those of space. */
typedef struct Stand {
    double origin[3], rows[3][3];
    const double (*axes)[3];
} Stand;

/* axes = axes R^T */
static void turn_axes(Stand *stand, const double R[3][3])
{
    double axes[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            axes[i][j] = stand->axes ? 0 : R[j][i];
            for (int k = 0; stand->axes && k < 3; k++) axes[i][j] += stand->axes[i][k] * R[j][k];
        }
    memcpy(stand->rows, axes, sizeof axes);
    stand->axes = (const double(*)[3])stand->rows;
}

static bool stand_at(const FluxField *field, FluxPlace place, Stand *stand, Error *err)
{
    const RigidMove *motion = &field->motion;
    memcpy(stand->origin, motion->pivot, sizeof stand->origin);
    stand->axes = field->own_axes ? field->axes : NULL;
    if (timed_is_given(&motion->move) || timed_is_given(&motion->turn)) {
        RigidPose pose;
        if (!rigid_move_pose(motion, place.time, &pose, err)) return false;
        for (int i = 0; i < 3; i++) { /* of what is at the pivot at rest */
            stand->origin[i] = pose.shift[i];
            for (int j = 0; j < 3; j++) stand->origin[i] += pose.turn[i][j] * motion->pivot[j];
        }
        if (timed_is_given(&motion->turn)) turn_axes(stand, (const double(*)[3])pose.turn);
    }
    for (int i = 0; place.move && i < 3; i++) stand->origin[i] += place.move[i];
    const double *turn = place.turn;
    if (!turn || (turn[0] == 0 && turn[1] == 0 && turn[2] == 0)) return true;
    double R[3][3];
    rigid_rotation(turn, R);
    turn_axes(stand, (const double(*)[3])R);
    return true;
}

static void own_place(const Stand *stand, const double x[3], double own[3])
{
    double r[3];
    for (int i = 0; i < 3; i++) r[i] = own[i] = x[i] - stand->origin[i];
    for (int i = 0; stand->axes && i < 3; i++)
        own[i] = stand->axes[i][0] * r[0] + stand->axes[i][1] * r[1] + stand->axes[i][2] * r[2];
}

void flux_field_eval(const FluxField *field, const double x[3], FluxPlace place, FluxSample *sample)
{
    Stand stand;
    double own[3];
    if (!stand_at(field, place, &stand, NULL)) {
        *sample = (FluxSample){.flux = {NAN, NAN, NAN}};
        return;
    }
    own_place(&stand, x, own);
    field->kind->eval(field, own, place.time, sample);
    if (stand.axes) flux_sample_turn(stand.axes, sample);
}

/* The value in space; false and a sentence where it is not known. */
static bool value_at(const FluxField *field, const double x[3], FluxPlace place, double flux[3], Error *err)
{
    Stand stand;
    double own[3];
    if (!stand_at(field, place, &stand, err)) return false;
    own_place(&stand, x, own);
    if (field->kind->value) {
        if (!field->kind->value(field, own, place.time, flux, err)) return false;
    } else {
        FluxSample sample;
        field->kind->eval(field, own, place.time, &sample);
        memcpy(flux, sample.flux, sizeof sample.flux);
        if (!isfinite(flux[0] + flux[1] + flux[2]))
            return error_set(err, "the field of the %s '%s', at (%.4g, %.4g, %.4g) m, is infinite %s",
                             field->kind->name, flux_field_name(field), x[0], x[1], x[2],
                             field->kind->infinite);
    }
    if (stand.axes) flux_vector_turn(stand.axes, flux);
    return true;
}

bool flux_field_is_known(const FluxField *field, const double x[3], FluxPlace place, Error *err)
{
    double flux[3];
    return value_at(field, x, place, flux, err);
}

void flux_field_value(const FluxField *field, const double x[3], FluxPlace place, double flux[3])
{
    if (!value_at(field, x, place, flux, NULL)) vec3_store(flux, vec3(NAN, NAN, NAN));
}

bool flux_field_pose(const FluxField *field, FluxPlace place, RigidPose *pose, Error *err)
{
    Stand stand;
    if (!stand_at(field, place, &stand, err)) return false;
    for (int i = 0; i < 3; i++) {
        pose->shift[i] = stand.origin[i];
        for (int j = 0; j < 3; j++) pose->turn[i][j] = stand.axes ? stand.axes[j][i] : i == j;
    }
    return true;
}

const char *flux_field_kind(const FluxField *field)
{
    return field->kind->name;
}

bool flux_field_has_shape(const FluxField *field)
{
    return field->kind->shape;
}

/* n.B_r/|B_r| */
static double pole_of(const FluxField *field, const MeshFile *shape, int face)
{
    Vec3 Br = vec3_load(field->strength), x[3];
    for (int i = 0; i < 3; i++) x[i] = vec3_load(shape->vertices[shape->faces[face][i]]);
    Vec3 n = vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0]));
    double scale = vec3_length(n) * vec3_length(Br);
    return field->kind->poles && scale > 0 ? vec3_dot(n, Br) / scale : 0;
}

void flux_field_shape(const FluxField *field, MeshFile *shape, double **pole)
{
    *shape = (MeshFile){.path = mem_text(flux_field_name(field))};
    if (field->kind->shape) field->kind->shape(field, shape);
    *pole = mem_alloc((size_t)shape->face_count, sizeof **pole);
    for (int f = 0; f < shape->face_count; f++) (*pole)[f] = pole_of(field, shape, f);
}

void flux_field_middle(const FluxField *field, FluxPlace place, double middle[3])
{
    Stand stand;
    if (!stand_at(field, place, &stand, NULL)) vec3_store(stand.origin, vec3(NAN, NAN, NAN));
    memcpy(middle, stand.origin, sizeof stand.origin);
}

int flux_field_find_within(const FluxField *field, const double *x, int count, FluxPlace place)
{
    Stand stand;
    if (!field->kind->within || !stand_at(field, place, &stand, NULL)) return -1;
    for (int k = 0; k < count; k++) {
        double own[3];
        own_place(&stand, x + 3 * k, own);
        if (field->kind->within(field, own)) return k;
    }
    return -1;
}

bool flux_field_has_winding(const FluxField *field)
{
    return field->kind->within && !field->kind->poles;
}

int flux_fields_add(FluxFields *fields, FluxField *field)
{
    size_t count = (size_t)fields->count;
    fields->items = mem_resize(fields->items, count, count + 1, sizeof *fields->items);
    fields->items[count] = field;
    return fields->count++;
}

void flux_fields_clear(FluxFields *fields)
{
    for (int k = 0; k < fields->count; k++) flux_field_destroy(fields->items[k]);
    mem_free(fields->items);
}
