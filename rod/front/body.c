/* The row of rods: models of them. */
#include "base/memory.h"
#include "job/jobs.h"
#include "rod/front/curves.h"
#include "rod/front/front.h"
#include "rod/pbd.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { LOAD_STEPS = 10 }; /* a natural shape is far from the loaded one; the way matters (docs/rods.md) */
static const double STEP_CAP = 1.5; /* rad */

/* ---- Loads and targets ---- */

static bool put_loads(Model *model, const Build *b, const char *at, const LoadScene *loads, int count,
                      double *p)
{
    const RodModel *rm = model->self;
    if (rm->list.timed)
        return yaml_refuse(
            b->file, at, "rod.loads follow formulas of t in all stages: loads in their place are not known");
    return rod_loads_put_dead(rm->rod, b, at, loads, count, p);
}

static bool load_rod(const Model *model, double time, double *p, Error *err)
{
    const RodModel *rm = model->self;
    return !rm->list.timed || rod_loads_put(&rm->list, rm->rod, NULL, time, p, err) ||
           model_unknown(model, "rod.loads", err);
}

/* The potentials. */
static bool knows_loads(const Model *model, double time, const double *place, Error *err)
{
    const Rod *rod = ((const RodModel *)model->self)->rod;
    for (int i = 0; rod && i < model->point_count; i++) {
        int each = rod_each(rod), strand = i / (each + 1);
        double L = rod->strand[strand].length;
        FormulaJet jet;
        RodPlace at = {vec3_load(place + 3 * i), time, L * (i % (each + 1)) / each, L};
        for (int k = 0; k < rod->potentials.count; k++)
            if (!rod_potential_known(rod->potentials.items[k], at, &jet, err))
                return model_unknown(model, "rod.loads", err);
    }
    return true;
}

/* Of cases and stages, each at its time. */
static bool load_stages(Model *model, const Build *b)
{
    Error err;
    bool ok = true;
    for (int k = 0; k < model->case_count; k++)
        for (int i = 0; ok && i < model->cases[k].stage_count; i++) {
            const Stage *stage = &model->cases[k].stages[i];
            ok = load_rod(model, stage->time, stage->p, &err) || yaml_refuse(b->file, "rod", "%s", err.text);
        }
    return ok;
}

/* Places for the nodes, at equal arclengths of a curve or by formula. */
static bool put_target(Model *model, const Build *b, const char *at, const TargetScene *scene,
                       double (*target)[3])
{
    static const char *const variables[] = {"s", "L", NULL};
    const RodModel *rm = model->self;
    const Rod *rod = rm->rod;
    Error err;
    double scale = isnan(scene->scale) ? 1 : scene->scale;
    if (scene->height_map || scene->strokes)
        return yaml_refuse(b->file, at,
                           "the target of a rod is a file with a polyline, three formulas of s and L, or a "
                           "cloud of points");
    if (scene->file) {
        RodCurve curve;
        if (!rod_curve_read(b, (Sampled){at, scene->file, scale, {-1, 0}, rod->elements}, &curve, NULL))
            return false;
        for (int i = 0; i <= rod->elements; i++) vec3_store(target[i], curve.x[2 * i]);
        rod_curve_clear(&curve);
        return true;
    }
    Formula *formula = build_formula(b, key("%s.formula", at), scene->formula, 3, scene->where,
                                     scene->where_count, variables);
    bool ok = formula != NULL;
    for (int i = 0; ok && i <= rod->elements; i++) {
        double place[] = {i * rod_element_length(rod, 0), rod_length(rod)};
        ok = formula_eval(formula, place, target[i], &err) || yaml_refuse(b->file, at, "%s", err.text);
    }
    formula_destroy(formula);
    return ok;
}

/* ---- The rod ---- */

/* What of the scene is for one rod; NULL: nothing. */
static const char *takes_one(const RodModel *rm, const Scene *scene)
{
    return !scene_job(scene)->motion ? "jobs other than invert, simulate and trajectory take one rod"
           : rm->preview             ? "solver: pbd takes one rod"
           : rod_scene(scene)->end   ? "rod.end holds one rod"
                                     : NULL;
}

static bool check_rod(const RodModel *rm, const Scene *scene, const Build *b)
{
    const RodScene *from = rod_scene(scene);
    const char *alone;
    bool given = rm->curves != NULL;
    if (from->poses) return yaml_refuse(b->file, "rod.poses", "poses are for the job identify");
    if (given && rm->strand_count > 1 && (alone = takes_one(rm, scene)))
        return yaml_refuse(b->file, "rod.curve", "there are %d curves; %s", rm->strand_count, alone);
    if (given && from->model == ROD_COSSERAT && !from->natural_strain)
        return yaml_refuse(
            b->file, "rod.model",
            "the natural shape that sags into a curve is known of model: kirchhoff; cosserat needs "
            "`natural_strain`");
    if (from->model == ROD_COSSERAT && !(rm->unit.shear1 > 0 && rm->unit.shear2 > 0))
        return from->section
                   ? yaml_refuse(b->file, "rod.section",
                                 "model: cosserat needs `kappa`, its shear coefficients")
                   : yaml_refuse(
                         b->file, "rod.ellipse",
                         "so flat a section of so negative a `poisson` has no shear stiffness that is known");
    if (!given && !from->natural_strain)
        return yaml_refuse(b->file, "rod", "`curve` or `natural_strain` is missing");
    if (!given && isnan(from->length))
        return yaml_refuse(b->file, "rod", "without a curve, `length` is needed");
    return true;
}

/* The curves' state in x, and none of their shape in the rod: that has natural strains of its own. */
static void pose(RodModel *rm, double *x)
{
    rod_follow_curves(rm->rod, rm->curves, rm->frames, x);
    for (int e = 0; e < rm->rod->elements; e++) rm->rod->bow[e] = vec3(0, 0, 0);
}

/* The natural strains that make the rod rest on its curve, hanging under its loads in p; leaves the curve's
 * state in x, of turns only. */
static void balance(RodModel *rm, double time, double *p, double *x)
{
    rod_follow_curves(rm->rod, rm->curves, rm->frames, x);
    Rod rod = *rm->rod;
    if (!rod_field_varies(&rod, p)) rod.fields.count = 0; /* those of other cases: the hanging form will do */
    bool places = rod.fields.count > 0 || rod.potentials.count > 0;
    RodLayout turns = rod_layout(&rod, false), layout = rod_layout(&rod, places);
    double *y = mem_alloc((size_t)layout.dofs, sizeof *y);
    rod_copy_state(&rod, &turns, x, &layout, y);
    System *sys = places ? rod_system(&rod, rm->young, false) : rod_hanging_system(&rod);
    rod_balance(&rod, sys, &layout, time, y, p);
    system_destroy(sys);
    mem_free(y);
}

/* What curves mean: beside natural strains they are where the rod is let go. */
static void take_curve(RodModel *rm, const RodScene *scene, double time, double *p, double *x)
{
    if (scene->natural_strain)
        pose(rm, x);
    else
        balance(rm, time, p, x);
}

/* Where the job starts, in model->x, and the natural shape to be shown; x is the curve's state, if there is
 * one. */
static void make_states(Model *model, const RodScene *scene, bool hanging, const double *p, double *x)
{
    RodModel *rm = model->self;
    Rod *rod = rm->rod;
    RodLayout turns = rod_layout(rod, false);
    rm->layout = rod_layout(rod, !hanging);
    model->x = mem_alloc((size_t)rm->layout.dofs, sizeof *model->x);
    if (scene->start == ROD_START_CURVE)
        rod_copy_state(rod, &turns, x, &rm->layout, model->x);
    else
        rod_natural_state(rod, &rm->layout, p, model->x);
    rm->natural = mem_alloc(3 * (size_t)turns.nodes, sizeof *rm->natural);
    rod_natural_state(rod, &turns, p, x);
    rod_places(rod, &turns, x, turns.nodes, rm->natural);
}

static System *make_system(const Model *model, bool motion)
{
    const RodModel *rm = model->self;
    return rod_system(rm->rod, rm->young, motion);
}

static void make_systems(Model *model, bool hanging, bool motion)
{
    RodModel *rm = model->self;
    for (int k = 0; k < model->case_count; k++) {
        Case *c = &model->cases[k];
        System *sys = hanging ? rod_hanging_system(rm->rod) : make_system(model, motion);
        case_start(c, model_take_system(model, sys), model->x);
    }
}

/* What the scene says of the model. */
static void set_model(Model *model)
{
    RodModel *rm = model->self;
    Rod *rod = rm->rod;
    model->params = &rod->params;
    model->gravity = rod->gravity;
    model->flux_blocks = rod->flux;
    model->fields = &rod->fields;
    model->moves = (rm->held && rod_leads_ends(model)) || rod_ends_move(rm);
}

/* Where the ends are. x: the state of turns only on the curve. */
static bool stand(Model *model, const Scene *scene, const Build *b, double *x)
{
    Error err;
    return (rod_stand_first(model, x, &err) || yaml_refuse(b->file, "rod", "%s", err.text)) &&
           rod_check_ends(model, scene, b);
}

/* Cases and states. With a field that varies in space or a potential, or where it meets something, no rod is only turns. */
static bool fill_cases(Model *model, const Scene *scene, const Build *b, bool readable)
{
    RodModel *rm = model->self;
    Rod *rod = rm->rod;
    bool motion = model->job->motion;
    double *p = params_vector(model->params),
           *curve = mem_alloc((size_t)rod_layout(rod, false).dofs, sizeof *curve);
    bool ok = rod_model_params(rm, scene, b, p) && readable;
    model_put_flux(model, 0, p);
    if (ok && rm->curves) take_curve(rm, rod_scene(scene), b->time, p, curve);
    ok = ok && model_cases(model, b, scene, p) && load_stages(model, b) && stand(model, scene, b, curve);
    bool hanging = !model->general && !motion && !model->job->design && rod->start == ROD_CLAMPED &&
                   rod->end == ROD_FREE && rod->fields.count == 0 && rod->potentials.count == 0 &&
                   !rod->world && !model->moves;
    if (ok) make_states(model, rod_scene(scene), hanging, p, curve);
    if (ok && model->job->given && !scene->start)
        ok = rod_end_is_held(rm, model->time, model->x) ||
             yaml_refuse(b->file, "rod.end", "the pose has its end elsewhere than where this holds it");
    else if (ok && rm->held && !rod_leads_ends(model) && !scene->start)
        ok = rod_settle(model, b, p);
    if (ok) make_systems(model, hanging, motion);
    mem_free(p);
    mem_free(curve);
    return ok;
}

static bool check_slender(const Rod *rod, const Build *b)
{
    double length = INFINITY, radius = rod_largest_section(rod).reach;
    for (int k = 0; k < rod->strands; k++) length = fmin(length, rod->strand[k].length);
    return length > ROD_WATER_SLENDER * radius ||
           yaml_refuse(
               b->file, "water",
               "its drag is that of a slender rod: longer than %d radii, but this one is %g m long with a "
               "radius of %g m",
               ROD_WATER_SLENDER, length, radius);
}

/* Takes the fields, and the model's potentials. */
static Rod *make_rod(RodModel *rm, const Scene *whole, const FluxFields *fields)
{
    const RodScene *scene = rod_scene(whole);
    RodActs acts = rod_model_acts(rm);
    acts.fields = *fields;
    acts.couples |= rod_loads_couple(whole);
    rm->list.potentials = (RodPotentials){0};
    int strands = rm->curves ? rm->strand_count : 1;
    double *length = mem_alloc((size_t)strands, sizeof *length);
    for (int k = 0; k < strands; k++) length[k] = rm->curves ? rm->curves[k].length : scene->length;
    Rod *rod = rod_create_strands(strands, scene->elements, length, rm->unit, &acts);
    rod_model_put_sections(rm, 0, rod);
    mem_free(length);
    return rod;
}

/* Jobs that move rods. */
static bool fill(Model *model, const Scene *scene, const Build *b)
{
    RodModel *rm = model->self;
    const RodScene *from = rod_scene(scene);
    Build sized = *b;
    FluxFields fields;
    if (!check_rod(rm, scene, b)) return false;
    sized.size = rm->curves ? rod_model_longest(rm) : from->length;
    bool readable = model_read_flux(model, &sized, scene, &fields);
    rm->rod = make_rod(rm, scene, &fields);
    rm->rod->cosserat = from->model == ROD_COSSERAT;
    model->point_count = rod_node_count(rm->rod);
    WorldBody shown = rod_world_body(rm->rod);
    readable = model_read_world(model, &sized, scene, &shown, &rm->rod->world) && readable;
    if (scene->water && !check_slender(rm->rod, b)) return false;
    if (rm->preview && !rod_model_check_preview(rm, scene, b->file)) return false;
    if (!rod_read_supports(rm, from, b) || !rod_model_check_points(rm, b, rod_length(rm->rod))) return false;
    rod_add_supports(model);
    set_model(model);
    model_add_blocks(model, scene);
    return fill_cases(model, scene, &sized, readable) &&
           (!model->job->motion ||
            model_velocity(model, b, "rod.velocity", from->velocity, model->x + rm->layout.position));
}

static bool create(Model *model, const Scene *scene, YamlFile *file)
{
    Build b = build_start(scene, NULL, model->time, file);
    b.report = &model->report;
    b.timed = model->job->motion ? &model->flux_of_time : NULL;
    model->point_count = rod_scene(scene)->elements + 1;
    model->load_steps = LOAD_STEPS;
    model->step_cap = STEP_CAP;
    model->self = rod_model_create(scene, &b);
    if (!model->self) return false;
    if (model->job == &rod_job_invert) return rod_check_inversion(model->self, scene, file);
    return model->job == &rod_job_identify || fill(model, scene, &b);
}

static void destroy(void *self)
{
    rod_model_destroy(self);
}

/* ---- Designs ---- */

static bool put_numbers(Model *model, const Build *b, const char *at, const NumberScene *scene,
                        const ParamBlock *block, double *values)
{
    (void)model, (void)scene, (void)values;
    return yaml_refuse(b->file, at, "the unknown %s of a rod starts at rod.%s", block->name, block->name);
}

static bool put_vectors(Model *model, const Build *b, const char *at, const VectorScene *scene,
                        const ParamBlock *block, double *values)
{
    (void)block;
    return rod_model_vectors(b, at, scene, ((const RodModel *)model->self)->rod, values);
}

/* All nodes, the ends of its strands (by either of their names), or the node of that number. */
static bool select_part(const Model *model, const Build *b, const char *at, const char *name, Indices *found)
{
    const Rod *rod = ((const RodModel *)model->self)->rod;
    int nodes = model->point_count, first = 0, step = 1, count = nodes;
    if (!strcmp(name, "tip") || !strcmp(name, "end"))
        first = rod_each(rod), step = first + 1, count = rod->strands;
    else if (model_point_number(name, nodes, &first))
        count = 1;
    else if (strcmp(name, "all"))
        return yaml_refuse(b->file, at,
                           "'%s' must be `tip` (or `end`), `all`, or the number of a node, 0 to %d", name,
                           nodes - 1);
    *found = (Indices){count, mem_alloc((size_t)count, sizeof(int))};
    for (int i = 0; i < count; i++) found->items[i] = first + step * i;
    return true;
}

/* ---- The row ---- */

static const Likeness likeness[] = {{"rod/s", "a rod of another length, or of other elements"}, {0}};

static Masses masses(const Model *model)
{
    return rod_masses(((const RodModel *)model->self)->rod);
}

/* In parts of an element's stiffness: what is less is rounding of the rotations. */
static const double MOMENT_LITTLE = 16 * DBL_EPSILON;

/* What is out of balance on free dofs, and on what scale. */
static Balance balance_of(const System *sys, const double *gradient, int first, int count)
{
    Balance left = {.what = "moments", .unit = "N m"};
    const double *sums = system_force_sums(sys);
    for (int i = first; i < first + count; i++) {
        left.scale = fmax(left.scale, sums[i]);
        if (!system_is_fixed(sys, i)) left.most = fmax(left.most, fabs(gradient[i]));
    }
    return left;
}

/* Forces on nodes can be in balance always: what cannot are the moments; and what a Cosserat rod's elements carry may not be
 * what their strains say. */
static Balance balance_pose(const Model *model, Case *c)
{
    const RodModel *rm = model->self;
    const RodLayout *layout = &rm->layout;
    Point at = state_point(&c->state, c->stages[0].p);
    if (layout->multiplier >= 0) rod_carry(rm->rod, c->sys, layout, &at, c->state.x);
    double *gradient = mem_alloc((size_t)layout->dofs, sizeof *gradient);
    bool finite = system_gradient(c->sys, &at, gradient).finite;
    Balance left = balance_of(c->sys, gradient, layout->turn, 3 * layout->nodes);
    double h = rod_element_length(rm->rod, 0),
           stiffest = fmax(rm->section.twist, fmax(rm->section.bend1, rm->section.bend2)) / h;
    if (left.most <= MOMENT_LITTLE * stiffest) left.most = 0;
    if (layout->strain >= 0) {
        Balance carried = balance_of(c->sys, gradient, layout->strain, 3 * layout->elements);
        if (carried.most <= MOMENT_LITTLE * h * rm->section.stretch) carried.most = 0;
        if (carried.most > 0 && carried.most * left.scale >= left.most * carried.scale)
            left = (Balance){"forces", "N", carried.most / h, carried.scale / h, true};
    }
    mem_free(gradient);
    left.finite = finite;
    return left;
}

static const BodyOps ops = {
    .create = create,
    .destroy = destroy,
    .put_loads = put_loads,
    .put_target = put_target,
    .load = load_rod,
    .knows = knows_loads,
    .put_numbers = put_numbers,
    .put_vectors = put_vectors,
    .select = select_part,
    .masses = masses,
    .move = rod_move_ends,
    .system = make_system,
    .supports = rod_support_forces,
    .couples = rod_support_couples,
    .balance = balance_pose,
    .add_static = rod_add_static,
    .add_frame = rod_add_frame,
    .add_state = rod_add_state,
    .add_stress = rod_add_stress,
    .add_final = rod_add_final,
    .likeness = likeness,
    .take_state = rod_take_state,
    .places = rod_body_places,
    .doubt = rod_doubt,
    .crushed = rod_crushed,
    .crushed_as = NEWTON_TANGLED,
    .describe = rod_describe,
    .advise = rod_advise,
    .dof_sizes = rod_dof_sizes,
    .cost = rod_cost,
};

static const KeyUse uses[] = {
    {"fix", "!rod {a rod is held by rod.clamp, rod.hold and rod.end}"},
    {"loads", "!rod {loads of a rod are under rod.loads}"},
    {"target", "/rod.solver: newton"},
    {"solver", "/rod.solver: newton & /job: equilibrium, design, simulate, trajectory, invert"},
    {"obstacles", "/rod.solver: newton"},
    {"contact", "/rod.solver: newton"},
    {"water", "/rod.solver: newton"},
    {"probes", "/rod.solver: newton"},
    {"time", "!/rod.motion {the frames of rod.motion have times of their own}"},
    {"modes", "/rod.solver: newton & /job: equilibrium, evaluate, design, simulate, trajectory"},
    {0},
};

static const JobRow *const jobs[] = {&job_equilibrium, &job_evaluate,   &job_design,       &rod_job_simulate,
                                     &job_trajectory,  &rod_job_invert, &rod_job_identify, NULL};

const BodyRow rod_body = {
    .key = "rod",
    .noun = "a rod",
    .nouns = "rods",
    .doc = "the body: a rod",
    .table = &rod_table,
    .uses = uses,
    .jobs = jobs,
    .ops = &ops,
};
