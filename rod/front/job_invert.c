/* The natural shape of rods that hang in given curves: by the frame-free integral, as strains, and as the
 * strains of a discrete rod that rests on its curve to rounding. */
#include "base/memory.h"
#include "rod/front/inversion.h"
#include "rod/self_contact.h"
#include "rod/stability.h"
#include <math.h>
#include <string.h>

static const double ELSEWHERE = 1e-4; /* of the length: another equilibrium */
static const double COARSE = 1e-2;    /* two ways to the same strains differ by that */

bool inversion_asks(const Scene *scene, SceneCheck check)
{
    for (int k = 0; k < scene->checks_count; k++)
        if (scene->checks[k] == (int)check) return true;
    return false;
}

/* ---- What it takes ---- */

static bool is_default(const SolverScene *solver)
{
    NewtonDef def = newton_default();
    return solver->max_iterations == def.max_iterations && solver->step_tolerance == def.step_tol &&
           solver->force_tolerance == def.force_tol;
}

bool rod_check_inversion(const RodModel *rm, const Scene *scene, YamlFile *file)
{
    const RodScene *from = rod_scene(scene);
    bool round_trip = false, stability = false, rests = false; /* asked about */
    for (int k = 0; k < scene->checks_count; k++) {
        round_trip |= scene->checks[k] == CHECK_ROUND_TRIP;
        stability |= scene->checks[k] == CHECK_STABILITY;
        rests |= scene->checks[k] != CHECK_SELF_CONTACT;
    }
    if (!from->curve && !from->motion)
        return yaml_refuse(file, "rod", "an inversion needs `curve`, the shape that is given, or `motion`");
    if (from->motion && rests)
        return yaml_refuse(file, "checks",
                           "a rod that moves is in no equilibrium: of `motion` only self_contact is checked");
    if (stability && (rm->list.couples || rm->list.placed))
        return yaml_refuse(file, "checks", "stability is that of a rod under forces that stay, without %s",
                           rm->list.couples ? "couples" : "loads that depend on its place");
    if (!from->motion && from->damping != 0)
        return yaml_refuse(file, "rod.damping", "an inversion uses this for a rod in `motion` only");
    const char *unused = scene->load_steps.mode != 0   ? "load_steps"
                         : !is_default(&scene->solver) ? "solver"
                                                       : NULL;
    return round_trip || !unused ||
           yaml_refuse(file, unused, "an inversion uses this for its round trip only: checks: [round_trip]");
}

/* ---- One strand ---- */

/* How far the two ways to the strains are apart, in parts of the largest: an independent check of both. */
static double compare_routes(const Inversion *o, int k, const Vec3 *moment)
{
    const RodModel *rm = o->rm;
    const RodCurve *curve = &rm->curves[k];
    const RodFrame *frames = rm->frames[k];
    int stations = 2 * curve->elements + 1;
    Vec3 *route = mem_alloc((size_t)stations, sizeof *route);
    double off = 0, largest = 0;
    rod_strain_route(curve, rod_model_sections(rm, k), o->loads[k], frames, route);
    for (int j = 0; j < stations; j++) {
        Vec3 direct = vec3_scale(
            -1, rod_bent(rod_section_at(rod_model_sections(rm, k), j), rod_to_frame(frames[j], moment[j])));
        off = fmax(off, vec3_length(vec3_sub(route[j], direct)));
        largest = fmax(largest, vec3_length(direct));
    }
    mem_free(route);
    return largest > 0 ? off / largest : 0;
}

static void judge_stability(Inversion *o, int k, const Vec3 *moment)
{
    const RodModel *rm = o->rm;
    const RodCurve *curve = &rm->curves[k];
    const RodFrame *frames = rm->frames[k];
    size_t stations = 2 * (size_t)o->elements + 1, ends = 3 * (size_t)o->elements;
    Vec3 *strain = mem_alloc(2 * stations + 2 * ends, sizeof *strain), *m = strain + stations,
         *F = m + stations, *K = F + ends;
    rod_strains(curve, frames, strain);
    for (size_t j = 0; j < stations; j++) m[j] = rod_to_frame(frames[j], moment[j]);
    rod_pulls(curve, o->loads[k], F);
    for (int i = 0; i < 3 * o->elements; i++) {
        int j = 2 * (i / 3) + i % 3;
        F[i] = rod_to_frame(frames[j], F[i]);
        K[i] = rod_stiffness(rod_section_at(rod_model_sections(rm, k), j), 1);
    }
    RodEquilibrium at = {o->elements, curve->length, strain, m, K, F};
    RodStability found = rod_stability(&at);
    o->lengths = fmax(o->lengths, rod_bending_lengths(&at));
    o->stable[k] = found.stable;
    o->index[k] = found.morse_index;
    o->lowest[k] = found.lowest_eigenvalue;
    o->critical_young[k] = found.critical_factor * rm->young;
    o->tail[k] = found.stable_tail;
    mem_free(strain);
}

static void find_contacts(Inversion *o, int k)
{
    RodContacts contacts =
        rod_self_contacts(inversion_strand(o, o->natural, k), o->nodes, 2 * o->rm->section.reach);
    size_t before = (size_t)o->pair_count;
    o->pairs = mem_resize(o->pairs, 3 * before, 3 * (before + (size_t)contacts.count), sizeof *o->pairs);
    for (int i = 0; i < contacts.count; i++) {
        int *pair = &o->pairs[3 * o->pair_count++];
        pair[0] = k, pair[1] = contacts.list[i].e1, pair[2] = contacts.list[i].e2;
    }
    o->touching[k] = contacts.count > 0;
    o->contact[k] = contacts.nearest.distance;
    rod_contacts_clear(&contacts);
}

/* What the given curve is: its frames, its strains in them, its curvature and torsion, and the force that it carries just
 * beyond each node. */
static void describe_input(Inversion *o, int k)
{
    const RodModel *rm = o->rm;
    const RodCurve *curve = &rm->curves[k];
    const RodFrame *frames = rm->frames[k];
    size_t stations = 2 * (size_t)o->elements + 1, pulls = 3 * (size_t)o->elements;
    Vec3 *strain = mem_alloc(stations + pulls, sizeof *strain), *pull = strain + stations;
    double *torsion = mem_alloc(stations, sizeof *torsion);
    rod_strains(curve, frames, strain);
    rod_torsion(curve, torsion);
    rod_pulls(curve, o->loads[k], pull);
    for (int i = 0; i < o->nodes; i++) {
        int node = k * o->nodes + i, j = 2 * i;
        o->s[node] = curve->length * i / o->elements;
        o->curvature[node] = vec3_length(curve->c[j]);
        o->torsion[node] = torsion[j];
        inversion_strand(o, o->input, k)[i] = curve->x[j];
        inversion_strand(o, o->tangent, k)[i] = frames[j].n0;
        inversion_strand(o, o->n1, k)[i] = frames[j].n1;
        inversion_strand(o, o->n2, k)[i] = frames[j].n2;
        inversion_strand(o, o->strain, k)[i] = strain[j];
        inversion_strand(o, o->force, k)[i] =
            vec3_sub(pull[i < o->elements ? 3 * i : 3 * i - 1], rm->magnetic);
    }
    mem_free(strain);
    mem_free(torsion);
}

/* What acts on a curve: of its last end's support, too, where that is unknown. */
static RodLoads find_loads(const Inversion *o, int k)
{
    const RodModel *rm = o->rm;
    const EndScene *end = rod_scene(o->run->scene)->end;
    RodLoads loads = rod_model_on_curve(rm, k);
    if (end && end->choose >= 0)
        rod_choose_end(&rm->curves[k], rod_model_sections(rm, k), rm->frames[k], (RodEndChoice)end->choose,
                       end->hold == HOLD_PINNED, &loads);
    return loads;
}

static bool is_finite_shape(const Inversion *o, int k)
{
    double sum = 0;
    for (int i = 0; i < o->nodes; i++) {
        Vec3 x = inversion_strand(o, o->natural, k)[i], strain = inversion_strand(o, o->natural_strain, k)[i];
        sum += fabs(x.x) + fabs(x.y) + fabs(x.z) + fabs(strain.x) + fabs(strain.y) + fabs(strain.z);
    }
    for (int i = 0; i < 3 * o->elements; i++)
        sum += fabs(o->strain_elements[3 * (size_t)k * (size_t)o->elements + (size_t)i]);
    return isfinite(sum);
}

static bool is_round(RodSections sections, int stations)
{
    bool round = true;
    for (int j = 0; j < (sections.vary ? stations : 1); j++)
        round &= sections.at[j].bend1 == sections.at[j].bend2;
    return round;
}

static void invert_strand(Inversion *o, int k)
{
    const RodModel *rm = o->rm;
    const RodCurve *curve = &rm->curves[k];
    const Scene *scene = o->run->scene;
    size_t stations = 2 * (size_t)o->elements + 1;
    Vec3 *moment = mem_alloc(2 * stations, sizeof *moment), *strain = moment + stations;
    RodSections sections = rod_model_sections(rm, k);
    bool round = is_round(sections, (int)stations);
    o->loads[k] = find_loads(o, k);
    rod_moments(curve, o->loads[k], moment);
    rod_invert(curve, sections, moment, round ? NULL : rm->frames[k], inversion_strand(o, o->natural, k));
    rod_natural_strains(curve, sections, moment, rm->frames[k], strain);
    if (rm->times) rod_untwist(curve, strain);
    for (int i = 0; i < o->nodes; i++) {
        inversion_strand(o, o->natural_strain, k)[i] = strain[2 * i];
        inversion_strand(o, o->moment, k)[i] = moment[2 * i];
    }
    describe_input(o, k);
    o->route[k] = compare_routes(o, k, moment);
    if (inversion_asks(scene, CHECK_STABILITY) && !rod_scene(scene)->end) judge_stability(o, k, moment);
    if (inversion_asks(scene, CHECK_SELF_CONTACT)) find_contacts(o, k);
    inversion_elements(o, k);
    mem_free(moment);
    if (!is_finite_shape(o, k)) o->lost++, o->worst = NEWTON_NOT_FINITE;
}

/* ---- What is left ---- */

/* A number for each strand; of a single one the number itself. */
static Array per_strand(const Inversion *o, const char *name, const char *unit, const double *values)
{
    return array_float(name, unit, values, o->strands > 1, o->strands, 0);
}

static Array flag_per_strand(const Inversion *o, const char *name, const int *values)
{
    return array_int(name, values, o->strands > 1, o->strands, 0);
}

static Array per_node(const Inversion *o, const char *name, const char *unit, const double *values)
{
    return array_float(name, unit, values, 2, o->strands * o->nodes, 3);
}

/* Of the given curve. */
static void add_input(const Inversion *o, Arrays *list)
{
    int nodes = o->strands * o->nodes;
    arrays_add(list, array_float("rod/s", "m", o->s, 1, nodes, 0));
    arrays_add(list, per_node(o, "rod/input", "m", o->input));
    arrays_add(list, per_node(o, "rod/tangent", "", o->tangent));
    arrays_add(list, per_node(o, "rod/n1", "", o->n1));
    arrays_add(list, per_node(o, "rod/n2", "", o->n2));
    arrays_add(list, per_node(o, "rod/strain", "1/m", o->strain));
    arrays_add(list, array_float("rod/curvature", "1/m", o->curvature, 1, nodes, 0));
    arrays_add(list, array_float("rod/torsion", "1/m", o->torsion, 1, nodes, 0));
    arrays_add(list, per_node(o, "rod/force", "N", o->force));
    arrays_add(list, per_node(o, "rod/moment", "N m", o->moment));
}

/* What holds the last ends. */
static void add_support(const Inversion *o, Arrays *list)
{
    size_t size = 3 * (size_t)o->strands;
    double *force = arrays_numbers(list, size), *couple = arrays_numbers(list, size);
    for (int k = 0; k < o->strands; k++) {
        vec3_store(force + 3 * k, vec3_sub(o->loads[k].end, o->rm->magnetic));
        vec3_store(couple + 3 * k, o->loads[k].end_couple);
    }
    arrays_add(list, array_float("rod/end_force", "N", force, 2, o->strands, 3));
    arrays_add(list, array_float("rod/end_couple", "N m", couple, 2, o->strands, 3));
}

static void add_checks(const Inversion *o, Arrays *list)
{
    const Scene *scene = o->run->scene;
    if (inversion_asks(scene, CHECK_STABILITY)) arrays_add(list, flag_per_strand(o, "rod/stable", o->stable));
    if (inversion_asks(scene, CHECK_STABILITY) && !rod_scene(scene)->end) {
        arrays_add(list, flag_per_strand(o, "rod/morse_index", o->index));
        arrays_add(list, per_strand(o, "rod/lowest_eigenvalue", "1/m^2", o->lowest));
        arrays_add(list, per_strand(o, "rod/critical_young", "Pa", o->critical_young));
        arrays_add(list, per_strand(o, "rod/stable_tail", "m", o->tail));
    }
    if (inversion_asks(scene, CHECK_SELF_CONTACT)) {
        arrays_add(list, flag_per_strand(o, "rod/self_contact", o->touching));
        arrays_add(list, per_strand(o, "rod/contact_distance", "m", o->contact));
        if (o->pair_count) arrays_add(list, array_int("rod/contact_pairs", o->pairs, 2, o->pair_count, 3));
    }
    if (o->x) {
        arrays_add(list, per_node(o, "rod/x", "m", o->x));
        arrays_add(list, per_strand(o, "metrics/round_trip", "m", o->round_trip));
        arrays_add(list, per_strand(o, "metrics/energy_above", "J", o->gain));
    }
}

/* Lines of simulated (or else natural), input and natural curves; only the first ones count as the body. */
static bool put_shapes(const Inversion *o, Error *err)
{
    int points = o->strands * o->nodes, kinds = o->x ? 3 : 2;
    size_t size = 3 * (size_t)points;
    int *range = mem_alloc(2 * (size_t)(kinds * o->strands), sizeof *range);
    double *still = mem_alloc(size * (size_t)(kinds - 1), sizeof *still), time = 0;
    for (int k = 0; k < kinds * o->strands; k++) range[2 * k] = k * o->nodes, range[2 * k + 1] = o->nodes;
    memcpy(still, o->input, size * sizeof *still);
    if (o->x) memcpy(still + size, o->natural, size * sizeof *still);
    Array statics[] = {array_int("lines", range, 2, kinds * o->strands, 2),
                       array_float("still", "m", still, 2, (kinds - 1) * points, 3)};
    Array frame[] = {array_float("x", "m", o->x ? o->x : o->natural, 2, points, 3),
                     array_float("time", "s", &time, 0, 0, 0)};
    bool ok = journal_put(o->run->journal, "static", 0, statics, 2, err) &&
              journal_put(o->run->journal, "frame", 0, frame, 2, err);
    mem_free(range);
    mem_free(still);
    return ok;
}

/* What each strand's frames are: a line each, as the scene says it. */
static void add_framings(const Inversion *o, Arrays *list)
{
    static const char *const kinds[] = {"frenet", "bishop"};
    char *text = mem_text("");
    for (int k = 0; k < o->strands; k++) {
        const RodFrameScene *frame = &rod_scene(o->run->scene)->frames[k];
        const char *slash = frame->file ? strrchr(frame->file, '/') : NULL;
        text = mem_join(text, k ? "\n" : "",
                        frame->formula ? frame->formula
                        : slash        ? slash + 1
                        : frame->file  ? frame->file
                                       : kinds[frame->kind]);
    }
    arrays_add(list, array_text("rod/frames", arrays_keep(list, text)));
}

/* Of a moving rod. */
static void add_motion(Inversion *o, Arrays *list)
{
    arrays_add(list, array_float("rod/times", "s", o->rm->times, 1, o->strands, 0));
    o->spread = rod_add_mean_strains(o->natural_strain, o->strands, o->nodes, list);
}

static bool put_results(Inversion *o, const char *status, Error *err)
{
    Arrays list = {0};
    int *starts = arrays_keep(&list, mem_alloc((size_t)o->strands + 1, sizeof *starts));
    for (int k = 0; k <= o->strands; k++) starts[k] = k * o->nodes;
    arrays_add(&list, array_text("status", status));
    add_input(o, &list);
    arrays_add(&list, per_node(o, "rod/natural", "m", o->natural));
    arrays_add(&list, per_node(o, "rod/natural_strain", "1/m", o->natural_strain));
    arrays_add(&list, array_float("rod/natural_strain_elements", "1/m", o->strain_elements, 2,
                                  o->strands * o->elements, 3));
    arrays_add(&list, per_strand(o, "metrics/residual", "", o->residual));
    arrays_add(&list, per_strand(o, "metrics/strain_route", "", o->route));
    arrays_add(&list, array_float("rod/gravity", "m/s^2", rod_scene(o->run->scene)->gravity, 1, 3, 0));
    rod_add_sections(o->rm, o->strands, o->elements, &list);
    if (o->strands > 1) arrays_add(&list, array_int("rod/strands", starts, 1, o->strands + 1, 0));
    if (rod_scene(o->run->scene)->end) add_support(o, &list);
    if (o->rm->times) add_motion(o, &list);
    if (rod_scene(o->run->scene)->frames) add_framings(o, &list);
    add_checks(o, &list);
    return put_shapes(o, err) && arrays_replace(&list, o->run->journal, "final", err);
}

/* Which other equilibrium, and why: the way from the natural shape leads there. */
static void say_elsewhere(const Inversion *o, int elsewhere, double worst)
{
    double most = 0;
    for (int k = 0; k < o->strands; k++)
        if (fabs(o->gain[k]) > fabs(most)) most = o->gain[k];
    host_say(o->run->host,
             "%d of %d rods come to rest elsewhere when they are let down from their natural shape, up "
             "to %.2g m away: "
             "in another equilibrium, with up to %.3g J %s energy than on the curve, that lies nearer on "
             "this way (a rod "
             "held on its curve and let go stays there where rod/stable is 1)",
             elsewhere, o->strands, worst, fabs(most), most > 0 ? "less" : "more");
}

static void say(const Inversion *o)
{
    const Host *host = o->run->host;
    int unstable = 0, touching = 0, elsewhere = 0;
    double worst = 0, route = 0;
    for (int k = 0; k < o->strands; k++) {
        unstable += inversion_asks(o->run->scene, CHECK_STABILITY) && !o->stable[k];
        touching += o->touching[k];
        elsewhere += o->round_trip[k] > ELSEWHERE * o->rm->curves[k].length;
        worst = fmax(worst, o->round_trip[k]);
        route = fmax(route, o->route[k]);
    }
    if (o->lost)
        host_say(host,
                 "%d of %d natural shapes are not finite numbers: loads or stiffness are beyond all bounds",
                 o->lost, o->strands);
    if (route > COARSE)
        host_say(
            host,
            "natural strains are good to %.2g of the largest only: the curve bends too much for %d elements",
            route, o->elements);
    if (unstable)
        host_say(host, "%d of %d curves unstable: the rod would not stay there%s", unstable, o->strands,
                 rod_scene(o->run->scene)->end
                     ? ""
                     : " (rod/critical_young says from which Young's modulus on it would)");
    if (o->lengths > 1)
        host_say(host,
                 "the elements are too long to tell how stable a curve is: one of them has %.2g times the "
                 "length sqrt(EI/F) within which the rod bends; rod.elements: %.0f or more would",
                 o->lengths, ceil(o->elements * o->lengths));
    if (o->rm->times)
        host_say(host, "natural strains at %d times agree to %.2g 1/m, rms", o->strands, o->spread);
    if (touching) host_say(host, "%d of %d natural shapes touch themselves", touching, o->strands);
    if (elsewhere)
        say_elsewhere(o, elsewhere, worst);
    else if (o->x)
        host_say(host, "the simulated rod rests %.2g m from its curve", worst);
}

/* All vectors, numbers of nodes and of strands, in one block. */
static double *make_numbers(Inversion *o)
{
    double **vectors[] = {
        &o->input, &o->natural, &o->natural_strain, &o->moment, &o->strain_elements, &o->x, &o->tangent,
        &o->n1,    &o->n2,      &o->strain,         &o->force};
    double **scalars[] = {&o->s, &o->curvature, &o->torsion};
    double **alone[] = {&o->lowest,     &o->critical_young, &o->tail,  &o->contact,
                        &o->round_trip, &o->residual,       &o->route, &o->gain};
    enum {
        VECTORS = sizeof vectors / sizeof *vectors,
        SCALARS = sizeof scalars / sizeof *scalars,
        ALONE = sizeof alone / sizeof *alone
    };
    size_t strands = (size_t)o->strands, all = strands * (size_t)o->nodes;
    double *numbers = mem_alloc((3 * VECTORS + SCALARS) * all + ALONE * strands, sizeof *numbers),
           *at = numbers;
    for (int i = 0; i < VECTORS; i++, at += 3 * all) *vectors[i] = at;
    for (int i = 0; i < SCALARS; i++, at += all) *scalars[i] = at;
    for (int i = 0; i < ALONE; i++, at += strands) *alone[i] = at;
    return numbers;
}

static RunStatus run_invert(Run *run, Error *err)
{
    const RodModel *rm = ((const RodModel *)run->model->self);
    size_t strands = (size_t)rm->strand_count, nodes = (size_t)run->model->point_count;
    Inversion o = {
        .run = run, .rm = rm, .strands = rm->strand_count, .elements = (int)nodes - 1, .nodes = (int)nodes};
    bool round_trip = inversion_asks(run->scene, CHECK_ROUND_TRIP);
    double *numbers = make_numbers(&o);
    o.loads = mem_alloc(strands, sizeof *o.loads);
    if (!round_trip) o.x = NULL;
    o.stable = mem_alloc(3 * strands, sizeof *o.stable), o.index = o.stable + strands,
    o.touching = o.index + strands;
    int done = 0;
    for (; done < o.strands && !host_stops(run->host); done++) {
        invert_strand(&o, done);
        host_step(run->host, done + 1, o.strands, "natural shapes");
    }
    bool interrupted = done < o.strands, converged = o.worst == NEWTON_CONVERGED;
    bool ok = put_results(&o, interrupted ? "interrupted" : newton_status_name(o.worst), err);
    if (ok && !interrupted) say(&o);
    mem_free(numbers);
    mem_free(o.loads);
    mem_free(o.stable);
    mem_free(o.pairs);
    if (!ok) return RUN_CANNOT_WRITE;
    return interrupted ? RUN_INTERRUPTED : converged ? RUN_DONE : RUN_NOT_CONVERGED;
}

static const char *const free_keys[] = {"output.precision", NULL};

const JobRow rod_job_invert = {
    .name = "invert",
    .noun = "an inversion",
    .run = run_invert,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
};
