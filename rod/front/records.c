/* Rods in the journal. */
#include "base/memory.h"
#include "job/run.h"
#include "rod/front/front.h"
#include "rod/stability.h"
#include "rod/stations.h"
#include <math.h>
#include <string.h>

/* How what holds the rod stands at first, and the section there. */
static void add_supports(const RodModel *rm, Arrays *list)
{
    int count = rod_support_count(rm);
    double *poses = arrays_numbers(list, 12 * (size_t)count);
    rod_support_poses(rm, poses);
    arrays_add(list, array_float("rod/support_pose", "1, m", poses, 2, count, 12));
    arrays_add(list, array_float("rod/section_outline", "m", rm->outline[0], 2, ROD_OUTLINE, 2));
}

void rod_add_sections(const RodModel *rm, int strands, int each, Arrays *list)
{
    if (!rm->varied && !rm->properties.scene->section) return;
    int elements = strands * each;
    double *stiffness = arrays_numbers(list, 3 * (size_t)elements),
           *mass = arrays_numbers(list, (size_t)elements), *radius = arrays_numbers(list, (size_t)elements);
    for (int e = 0; e < elements; e++) {
        const RodSection *section = rod_section_at(rod_model_sections(rm, e / each), 2 * (e % each) + 1);
        vec3_store(stiffness + 3 * e, rod_stiffness(section, 1));
        mass[e] = section->mass, radius[e] = section->reach;
    }
    arrays_add(list, array_float("rod/stiffness", "N m^2", stiffness, 2, elements, 3));
    arrays_add(list, array_float("rod/radius", "m", radius, 1, elements, 0));
    arrays_add(list, array_float("rod/line_density", "kg/m", mass, 1, elements, 0));
}

/* Simulated, natural and (if they were given) input curves, strand after strand: only the first ones move. */
void rod_add_static(const Model *model, Arrays *list)
{
    const RodModel *rm = model->self;
    if (!rm->rod) return; /* invert and identify have their own */
    const Rod *rod = rm->rod;
    int nodes = model->point_count, kinds = rm->curves ? 3 : 2, own = nodes / rod->strands,
        lines = kinds * rod->strands;
    int *range = arrays_keep(list, mem_alloc(2 * (size_t)lines, sizeof *range));
    double *still = arrays_numbers(list, 3 * (size_t)nodes * (size_t)(kinds - 1)),
           *s = arrays_numbers(list, (size_t)nodes);
    for (int k = 0; k < lines; k++) range[2 * k] = k * own, range[2 * k + 1] = own;
    memcpy(still, rm->natural, 3 * (size_t)nodes * sizeof *still);
    for (int i = 0; i < nodes; i++) {
        int strand = i / own, node = i % own;
        s[i] = node * rod_element_length(rod, strand * (own - 1));
        if (rm->curves) vec3_store(still + 3 * (nodes + i), rm->curves[strand].x[2 * node]);
    }
    if (rod->strands > 1) {
        int *starts = arrays_keep(list, mem_alloc((size_t)rod->strands + 1, sizeof *starts));
        for (int k = 0; k <= rod->strands; k++) starts[k] = k * own;
        arrays_add(list, array_int("rod/strands", starts, 1, rod->strands + 1, 0));
    }
    arrays_add(list, array_int("lines", range, 2, lines, 2));
    arrays_add(list, array_float("still", "m", still, 2, (kinds - 1) * nodes, 3));
    arrays_add(list, array_float("rod/s", "m", s, 1, nodes, 0));
    arrays_add(list,
               array_float("rod/gravity", "m/s^2", model->cases[0].stages[0].p + model->gravity, 1, 3, 0));
    arrays_add(list, array_float("rod/natural", "m", still, 2, nodes, 3));
    bool pinned = rod->start == ROD_PINNED || rod->end == ROD_PINNED;
    arrays_add(list, array_text("rod/supports", pinned ? "pinned" : "clamped"));
    add_supports(rm, list);
    if (rm->held) arrays_add(list, array_float("rod/held", "m", &rm->end_position.x, 1, 3, 0));
    rod_add_sections(rm, rod->strands, own - 1, list);
    if (rm->curves) arrays_add(list, array_float("rod/input", "m", still + 3 * nodes, 2, nodes, 3));
}

void rod_body_places(const Model *model, const double *x, double *place)
{
    const RodModel *rm = model->self;
    const RodLayout *layout = &rm->layout;
    if (layout->position >= 0)
        memcpy(place, x + layout->position, 3 * (size_t)layout->nodes * sizeof *place);
    else
        rod_places(rm->rod, layout, x, layout->nodes, place);
}

/* At the nodes the means of the elements beside them. */
static void add_means(const RodLayout *layout, const char *name, const char *unit, const double *values,
                      Arrays *list)
{
    double *mean = arrays_numbers(list, 3 * (size_t)layout->nodes);
    for (int e = 0; e < layout->elements; e++)
        for (int side = 0; side < 2; side++) {
            bool end = side ? (e + 1) % layout->each == 0 : e % layout->each == 0;
            double *to = mean + 3 * (rod_element_node(layout, e) + side);
            for (int i = 0; i < 3; i++) to[i] += (end ? 1 : 0.5) * values[3 * e + i];
        }
    arrays_add(list, array_float(name, unit, mean, 2, layout->nodes, 3));
}

void rod_add_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list)
{
    (void)whole;
    const RodModel *rm = model->self;
    const RodLayout *layout = &rm->layout;
    if (rod_ends_move(rm)) {
        double *poses = arrays_numbers(list, 12 * (size_t)rod_support_count(rm));
        rod_support_poses_in(rm, shot->at.x, poses);
        arrays_add(list, array_float("support_pose", "1, m", poses, 2, rod_support_count(rm), 12));
    }
    if (layout->strain >= 0) add_means(layout, "point/stretch", "", shot->at.x + layout->strain, list);
}

void rod_add_stress(const Model *model, const Snapshot *shot, Arrays *list)
{
    const RodModel *rm = model->self;
    const RodLayout *layout = &rm->layout;
    const double *x = shot->at.x;
    Vec3 *values = mem_alloc((size_t)layout->elements, sizeof *values);
    double *moment = arrays_numbers(list, 3 * (size_t)layout->nodes);
    rod_element_strains(rm->rod, layout, x, values);
    add_means(layout, "point/strain", "1/m", &values->x, list);
    rod_element_forces(rm->rod, layout, x, shot->p, values);
    add_means(layout, "point/force", "N", &values->x, list);
    rod_node_moments(rm->rod, layout, x, shot->p, (Vec3 *)moment);
    arrays_add(list, array_float("point/moment", "N m", moment, 2, layout->nodes, 3));
    mem_free(values);
}

void rod_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list)
{
    const RodModel *rm = model->self;
    int elements = rm->rod->elements;
    double *strain = arrays_numbers(list, 3 * (size_t)elements),
           *force = arrays_numbers(list, 3 * (size_t)elements),
           *moment = arrays_numbers(list, 3 * (size_t)model->point_count);
    rod_element_strains(rm->rod, &rm->layout, shot->at.x, (Vec3 *)strain);
    rod_element_forces(rm->rod, &rm->layout, shot->at.x, shot->p, (Vec3 *)force);
    rod_node_moments(rm->rod, &rm->layout, shot->at.x, shot->p, (Vec3 *)moment);
    char *name = arrays_keep(list, mem_format("%s/strain", prefix));
    arrays_add(list, array_float(name, "1/m", strain, 2, elements, 3));
    if (rm->layout.strain >= 0) {
        name = arrays_keep(list, mem_format("%s/stretch", prefix));
        arrays_add(list, array_float(name, "", shot->at.x + rm->layout.strain, 2, elements, 3));
    }
    name = arrays_keep(list, mem_format("%s/force", prefix));
    arrays_add(list, array_float(name, "N", force, 2, elements, 3));
    name = arrays_keep(list, mem_format("%s/moment", prefix));
    arrays_add(list, array_float(name, "N m", moment, 2, model->point_count, 3));
}

/* Is it known how stable the state is? Of one rod that does not stretch, with a free end, no magnetisation across the tangent, no field that varies in space, no couple, no potential, and nothing that it meets. */
static bool is_judged(const Rod *rod, const double *p)
{
    const double *B = p + rod->flux.uniform;
    bool across = false, field = B[0] != 0 || B[1] != 0 || B[2] != 0;
    bool alone = !rod_field_varies(rod, p) && !rod_has_couples(rod, p) && rod->potentials.count == 0 &&
                 !rod->world && rod->strands == 1 && !rod->cosserat;
    for (int e = 0; e < rod->elements; e++)
        across |= field && (p[rod->magnetization + 3 * e + 1] != 0 || p[rod->magnetization + 3 * e + 2] != 0);
    return alone && rod->start == ROD_CLAMPED && rod->end == ROD_FREE && !across;
}

/* The rod as stability.h takes it; *work is the caller's. */
static RodEquilibrium equilibrium_of(const RodModel *rm, const Snapshot *shot, Vec3 **work)
{
    const Rod *rod = rm->rod;
    size_t stations = 2 * (size_t)rod->elements + 1, ends = 3 * (size_t)rod->elements;
    Vec3 *k = *work = mem_alloc(2 * stations + 2 * ends, sizeof *k), *m = k + stations, *F = m + stations,
         *K = F + ends;
    for (size_t i = 0; i < ends; i++)
        K[i] = rod_stiffness(&rod->unit[i / 3], shot->p[(size_t)rod->young + i / 3]);
    rod_stations(rod, 0, &rm->layout, shot->at.x, shot->p, (RodStations){k, m, F});
    return (RodEquilibrium){rod->elements, rod_length(rod), k, m, K, F};
}

/* Where elements are too long for what they are to show, how stable the rod is stays unknown. */
static void add_stability(const RodModel *rm, const Snapshot *shot, Arrays *list)
{
    Vec3 *work;
    RodEquilibrium at = equilibrium_of(rm, shot, &work);
    bool known = rod_bending_lengths(&at) <= 1;
    double *lowest = arrays_numbers(list, 1);
    *lowest = known ? rod_lowest_eigenvalue(&at) : NAN;
    arrays_add(list, array_float("final/lowest_eigenvalue", "1/m^2", lowest, 0, 0, 0));
    if (known) {
        int *flags = arrays_keep(list, mem_alloc(2, sizeof *flags));
        flags[1] = rod_morse_index(&at);
        flags[0] = flags[1] == 0;
        arrays_add(list, array_int("rod/stable", &flags[0], 0, 0, 0));
        arrays_add(list, array_int("rod/morse_index", &flags[1], 0, 0, 0));
    }
    mem_free(work);
}

char *rod_crushed(const Model *model, const Snapshot *shot, bool failed)
{
    const RodModel *rm = model->self;
    if (!rm->rod->cosserat) return NULL;
    int element;
    double least = rod_least_stretch(&rm->layout, shot->at.x, &element);
    bool tangled = rod_is_tangled(least);
    if (!tangled && !(failed && shot->status == NEWTON_TANGLED)) return NULL;
    return mem_format("%selement %d is pressed to %.2g of its length: what acts on it is too strong for its "
                      "Young's modulus of "
                      "%.3g Pa",
                      tangled ? "" : "next, something would be turned inside out; ", element, least,
                      shot->p[rm->rod->young + element]);
}

static const double LARGE_STRAIN = 0.2;

/* A stretch or shear beyond the linear law. */
static char *doubt_strain(const RodLayout *layout, const double *x)
{
    double most = 0;
    for (int i = 0; i < 3 * layout->elements; i++) most = fmax(most, fabs(x[layout->strain + i]));
    if (most <= LARGE_STRAIN) return NULL;
    return mem_format(
        "an element stretches or shears by %.2g: model: cosserat has a linear law, for small strains", most);
}

char *rod_doubt(const Model *model, const Snapshot *shot)
{
    const RodModel *rm = model->self;
    const Rod *rod = rm->rod;
    char *lost = rod_doubt_magnets(model, shot);
    if (lost) return lost;
    if (model->job->rest && rod_has_couples(rod, shot->p))
        return mem_text("couples have no potential: no energy says whether the rod would stay where it is");
    if (rod->cosserat) return doubt_strain(&rm->layout, shot->at.x);
    if (!is_judged(rod, shot->p)) return NULL;
    Vec3 *work;
    RodEquilibrium at = equilibrium_of(rm, shot, &work);
    double lengths = rod_bending_lengths(&at);
    mem_free(work);
    if (lengths <= 1) return NULL;
    return mem_format(
        "the elements are too long: the rod bends within sqrt(EI/F) = %.2g m, and one of them has %.2g times "
        "that; rod.elements: %.0f or more would show where it rests and how stable it is",
        rod_element_length(rod, 0) / lengths, lengths, ceil(rod->elements * lengths));
}

/* A rod of turns only is looked at with positions, which have the mass. */
static void add_vibrations(const Model *model, const Snapshot *shot, int modes, Arrays *list)
{
    const RodModel *rm = model->self;
    if (rm->layout.position >= 0) {
        Point at = state_point(&shot->at, shot->p);
        run_add_vibrations(model, shot->load_case->sys, &at, modes, list);
        return;
    }
    RodLayout layout = rod_layout(rm->rod, true);
    System *sys = model_take_system(model, rod_system(rm->rod, shot->p[rm->rod->young], false));
    State state = system_state(sys);
    rod_copy_state(rm->rod, &rm->layout, shot->at.x, &layout, state.x);
    state.time = shot->at.time;
    Point at = state_point(&state, shot->p);
    rod_carry(rm->rod, sys, &layout, &at, state.x);
    run_add_vibrations(model, sys, &at, modes, list);
    state_destroy(&state);
    system_destroy(sys);
}

void rod_add_final(const Model *model, const Snapshot *shot, int modes, Arrays *list)
{
    const RodModel *rm = model->self;
    const Rod *rod = rm->rod;
    int nodes = model->point_count;
    double *place = arrays_numbers(list, 3 * (size_t)nodes),
           *moment = arrays_numbers(list, 3 * (size_t)nodes);
    rod_body_places(model, shot->at.x, place);
    rod_node_moments(rod, &rm->layout, shot->at.x, shot->p, (Vec3 *)moment);
    arrays_add(list, array_float("rod/x", "m", place, 2, nodes, 3));
    arrays_add(list, array_float("rod/moment", "N m", moment, 2, nodes, 3));
    arrays_add(list, array_float("rod/natural_strain_elements", "1/m", shot->p + rod->natural_strain, 2,
                                 rod->elements, 3));
    if (is_judged(rod, shot->p)) add_stability(rm, shot, list);
    if (modes) add_vibrations(model, shot, modes, list);
}

double rod_add_mean_strains(const double *strain, int count, int nodes, Arrays *list)
{
    size_t numbers = 3 * (size_t)nodes;
    double *mean = arrays_numbers(list, numbers), *spread = arrays_numbers(list, numbers), all = 0;
    for (size_t i = 0; i < numbers; i++) {
        double sum = 0;
        for (int k = 0; k < count; k++) mean[i] += strain[(size_t)k * numbers + i] / count;
        for (int k = 0; k < count; k++) sum += pow(strain[(size_t)k * numbers + i] - mean[i], 2);
        spread[i] = sqrt(sum / count);
        all += sum / count / nodes;
    }
    arrays_add(list, array_float("rod/identified/natural_strain", "1/m", mean, 2, nodes, 3));
    arrays_add(list, array_float("rod/identified/natural_strain_spread", "1/m", spread, 2, nodes, 3));
    return sqrt(all);
}
