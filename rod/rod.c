#include "rod/rod.h"
#include "base/memory.h"
#include "rod/terms.h"
#include "solve/kinetic.h"
#include "solve/lumped.h"
#include <math.h>
#include <string.h>

static const double HOLD = 10;          /* of the link, in parts of the whole rod's stiffness */
static const double BASE_SHIFT = 1e-10; /* for a rod that may spin, or bend to any side (system.h) */
static const double PUSH = 60;          /* of a held end, in EI/L^2: clamps buckle at 4 pi^2 (system.h) */

Rod *rod_create(int elements, double length, RodSection unit, const RodActs *acts)
{
    return rod_create_strands(1, elements, &length, unit, acts);
}

Rod *rod_create_strands(int strands, int each, const double *length, RodSection unit, const RodActs *acts)
{
    int elements = strands * each;
    Rod *rod = mem_alloc(1, sizeof *rod);
    *rod = (Rod){.strands = strands, .elements = elements, .start = ROD_CLAMPED};
    rod->strand = mem_alloc((size_t)strands, sizeof *rod->strand);
    for (int k = 0; k < strands; k++) rod->strand[k] = (RodStrand){length[k], vec3(0, 0, 0), quat_identity()};
    if (acts) rod->fields = acts->fields, rod->potentials = acts->potentials, rod->couples = acts->couples;
    rod->bow = mem_alloc((size_t)elements, sizeof *rod->bow);
    rod->unit = mem_alloc((size_t)elements, sizeof *rod->unit);
    rod->heavier = mem_alloc((size_t)elements, sizeof *rod->heavier);
    for (int e = 0; e < elements; e++) rod->unit[e] = unit;
    Params *params = &rod->params;
    rod->young = params_add(params, "young", "Pa", elements, 1, false);
    rod->natural_strain = params_add(params, "natural_strain", "1/m", elements, 3, false);
    rod->magnetization = params_add(params, "magnetization", "A/m", elements, 3, false);
    rod->flux.uniform = params_add(params, "flux_density", "T", 1, 3, true);
    rod->gravity = params_add(params, "gravity", "m/s^2", 1, 3, true);
    rod->load = params_add(params, "load", "N", elements + strands, 3, true);
    rod->pull = params_add(params, "pull", "N", elements, 3, true);
    rod->damping = params_add(params, "damping", "N s/m^2", 1, 1, false);
    rod->flux = flux_blocks_add(params, &rod->fields, rod->flux.uniform);
    rod->couple = params_add(params, "couple", "N m", rod->couples ? elements + strands : 0, 3, true);
    rod->potential_scale = params_add(params, "potential_scale", "", rod->potentials.count, 1, true);
    return rod;
}

void rod_destroy(Rod *rod)
{
    if (!rod) return;
    mem_free(rod->strand);
    mem_free(rod->bow);
    mem_free(rod->unit);
    mem_free(rod->heavier);
    flux_fields_clear(&rod->fields);
    rod_potentials_clear(&rod->potentials);
    world_destroy(rod->world);
    mem_free(rod->edges);
    mem_free(rod->straight);
    mem_free(rod->part);
    mem_free(rod->lengths);
    mem_free(rod->radii);
    params_clear(&rod->params);
    mem_free(rod);
}

void rod_set_sections(Rod *rod, const RodSection *unit)
{
    int each = rod_each(rod);
    memcpy(rod->unit, unit, (size_t)rod->elements * sizeof *unit);
    for (int e = rod->elements - 1; e >= 0; e--) {
        int beyond = each - 1 - e % each;
        rod->heavier[e] = beyond ? rod->heavier[e + 1] + beyond * (unit[e + 1].mass - unit[e].mass) : 0;
    }
}

RodSection rod_largest_section(const Rod *rod)
{
    RodSection most = rod->unit[0];
    for (int e = 1; e < rod->elements; e++) rod_section_most(&most, &rod->unit[e]);
    return most;
}

double rod_length(const Rod *rod)
{
    double longest = 0;
    for (int k = 0; k < rod->strands; k++) longest = fmax(longest, rod->strand[k].length);
    return longest;
}

WorldBody rod_world_body(Rod *rod)
{
    RodLayout layout = rod_layout(rod, true);
    mem_free(rod->edges);
    mem_free(rod->straight);
    mem_free(rod->part);
    mem_free(rod->lengths);
    mem_free(rod->radii);
    rod->edges = mem_alloc((size_t)rod->elements, sizeof *rod->edges);
    rod->straight = mem_alloc((size_t)layout.nodes, sizeof *rod->straight);
    rod->part = mem_alloc((size_t)layout.nodes, sizeof *rod->part);
    rod->lengths = mem_alloc((size_t)rod->strands, sizeof *rod->lengths);
    rod->radii = mem_alloc((size_t)rod->elements, sizeof *rod->radii);
    for (int k = 0; k < rod->strands; k++) rod->lengths[k] = rod->strand[k].length;
    for (int e = 0; e < rod->elements; e++) {
        rod->radii[e] = rod->unit[e].reach;
        int node = rod->edges[e][0] = rod_element_node(&layout, e), next = rod->edges[e][1] = node + 1;
        rod->straight[next][0] = (e % layout.each + 1) * rod_element_length(rod, e);
        rod->part[node] = rod->part[next] = e / layout.each;
    }
    double reach = rod_largest_section(rod).reach;
    bool same = true;
    for (int e = 0; e < rod->elements; e++) same = same && rod->radii[e] == reach;
    return (WorldBody){.vertex_count = layout.nodes,
                       .first = layout.position,
                       .edge_count = rod->elements,
                       .edges = (const int(*)[2])rod->edges,
                       .rest = (const double(*)[3])rod->straight,
                       .part = rod->part,
                       .thickness = 2 * reach,
                       .outside = reach,
                       .outsides = same ? NULL : rod->radii,
                       .doubled = -1,
                       .strands = rod->strands,
                       .length = rod->lengths,
                       .radius = rod->radii};
}

Masses rod_masses(const Rod *rod)
{
    RodLayout layout = rod_layout(rod, false);
    Masses masses = masses_zero(layout.nodes);
    for (int e = 0; e < rod->elements; e++) {
        double half = rod->unit[e].mass * rod_element_length(rod, e) / 2,
               *node = masses.fixed + rod_element_node(&layout, e);
        node[0] += half, node[1] += half;
    }
    return masses;
}

double rod_strand_mass(const Rod *rod, int strand)
{
    int first = strand * rod_each(rod);
    return rod->unit[first].mass * rod->strand[strand].length +
           rod->heavier[first] * rod_element_length(rod, first);
}

void rod_default_params(const Rod *rod, double young, double *p)
{
    for (int i = 0; i < rod->params.size; i++) p[i] = 0;
    for (int e = 0; e < rod->elements; e++) p[rod->young + e] = young;
    flux_blocks_default(&rod->fields, &rod->flux, p);
    for (int k = 0; k < rod->potentials.count; k++) p[rod->potential_scale + k] = 1;
}

bool rod_field_varies(const Rod *rod, const double *p)
{
    bool varies = false;
    for (int k = 0; k < rod->fields.count; k++) varies |= p[rod->flux.scale + k] != 0;
    return varies;
}

bool rod_has_couples(const Rod *rod, const double *p)
{
    bool has = false;
    for (int i = 0; rod->couples && i < 3 * rod_node_count(rod); i++) has |= p[rod->couple + i] != 0;
    return has;
}

void rod_sum_loads(const Rod *rod, double *p)
{
    RodLayout layout = rod_layout(rod, false);
    Vec3 sum = vec3(0, 0, 0);
    for (int e = rod->elements - 1; e >= 0; e--) {
        if ((e + 1) % layout.each == 0) sum = vec3(0, 0, 0);
        sum = vec3_add(sum, vec3_load(p + rod->load + 3 * (rod_element_node(&layout, e) + 1)));
        vec3_store(p + rod->pull + 3 * e, sum);
    }
}

static void add_to(double *to, double part, Vec3 what)
{
    vec3_store(to, vec3_axpy(part, what, vec3_load(to)));
}

/* Of each element its load times the part of it that is a node's: Simpson's rule. */
static void share_along(int elements, double h, const Vec3 *along, double *load)
{
    for (int e = 0; e < elements; e++)
        for (int side = 0; side < 2; side++) {
            add_to(load + 3 * (e + side), h / 6, along[2 * (e + side)]);
            add_to(load + 3 * (e + side), h / 3, along[2 * e + 1]);
        }
}

void rod_share_loads(const Rod *rod, int strand, RodLoads loads, double *p)
{
    int each = rod_each(rod), first = strand * (each + 1);
    double h = rod_element_length(rod, strand * each), *load = p + rod->load + 3 * first;
    for (int i = 0; i <= each; i++)
        vec3_store(load + 3 * i, vec3_scale(i == 0 || i == each ? h / 2 : h, loads.line));
    if (loads.along) share_along(each, h, loads.along, load);
    for (int i = 0; rod->couples && i <= 3 * each + 2; i++) p[rod->couple + 3 * first + i] = 0;
    for (int k = 0; k < loads.point_count; k++) {
        double part = fmin(loads.points[k].s / h, each);
        int e = part < each ? (int)part : each - 1;
        for (int side = 0; side < 2; side++) {
            double share = side ? part - e : 1 - (part - e);
            add_to(load + 3 * (e + side), share, loads.points[k].force);
            if (rod->couples) add_to(p + rod->couple + 3 * (first + e + side), share, loads.points[k].couple);
        }
    }
}

/* ---- Systems ---- */

static void add_terms(System *sys, const Rod *rod, const RodLayout *layout, double hold)
{
    bool positions = layout->position >= 0;
    const bool is[] = {[ROD_ANY_FORM] = true,
                       [ROD_STRETCHING] = layout->strain >= 0,
                       [ROD_HANGING] = !positions,
                       [ROD_WITH_POSITIONS] = positions,
                       [ROD_WITH_COUPLES] = rod->couples,
                       [ROD_WITH_POTENTIALS] = rod->potentials.count > 0};
    for (int r = 0; r < rod_term_row_count; r++)
        if (is[rod_term_rows[r].form]) system_add(sys, rod_term_rows[r].create(rod, *layout, hold));
}

/* m, of the half elements beside each node: what drag it has. */
static void node_lengths(const Rod *rod, double *share)
{
    int each = rod_each(rod);
    for (int k = 0; k < rod->strands; k++)
        for (int i = 0; i <= each; i++)
            share[k * (each + 1) + i] = (i == 0 || i == each ? 0.5 : 1) * rod->strand[k].length / each;
}

/* Weight and loads on positions; in motion inertia and damping. */
static void add_lumped_terms(System *sys, const Rod *rod, bool dynamic)
{
    int nodes = rod_node_count(rod);
    system_add(sys, lumped_gravity_term(rod_masses(rod), rod->gravity));
    system_add(sys, lumped_load_term(nodes, rod->load));
    if (!dynamic) return;
    double *length = mem_alloc((size_t)nodes, sizeof *length);
    node_lengths(rod, length);
    system_add(sys, kinetic_inertia_term(rod_masses(rod)));
    system_add(sys, kinetic_damping_term(nodes, length, rod->damping));
    mem_free(length);
}

static void fix(System *sys, int first, int count, bool held)
{
    for (int i = first; held && i < first + count; i++) system_fix(sys, i);
}

/* Node after node along the strands; an element's strain and multipliers after both its nodes. */
static void set_order(System *sys, const RodLayout *layout)
{
    int *order = mem_alloc((size_t)layout->dofs, sizeof *order), count = 0;
    for (int i = 0; i < layout->nodes; i++) {
        for (int k = 0; layout->position >= 0 && k < 3; k++) order[count++] = layout->position + 3 * i + k;
        for (int k = 0; k < 3; k++) order[count++] = layout->turn + 3 * i + k;
        int strand = i / (layout->each + 1), e = i - strand - 1;
        bool ends = i % (layout->each + 1) > 0;
        for (int k = 0; layout->strain >= 0 && ends && k < 3; k++)
            order[count++] = layout->strain + 3 * e + k;
        for (int k = 0; layout->multiplier >= 0 && ends && k < 3; k++)
            order[count++] = layout->multiplier + 3 * e + k;
    }
    for (; count < layout->dofs; count++) order[count] = count;
    system_set_order(sys, order);
    mem_free(order);
}

static DofClass strains_of(const Rod *rod, const RodLayout *layout)
{
    return (DofClass){.first = layout->strain, .count = 3 * rod->elements, .size = 1};
}

System *rod_hanging_system(const Rod *rod)
{
    RodLayout layout = rod_layout(rod, false);
    DofClass classes[] = {{.count = 3 * layout.nodes, .size = 1}, strains_of(rod, &layout)};
    System *sys = system_create(layout.dofs, classes, rod->cosserat ? 2 : 1);
    add_terms(sys, rod, &layout, 0);
    for (int k = 0; k < rod->strands; k++) fix(sys, layout.turn + 3 * k * (layout.each + 1), 3, true);
    fix(sys, layout.reference, 4 * layout.nodes, true);
    set_order(sys, &layout);
    system_prepare(sys);
    return sys;
}

System *rod_system(const Rod *rod, double young, bool dynamic)
{
    RodLayout layout = rod_layout(rod, true);
    int end = 3 * layout.elements;
    RodSection most = rod_largest_section(rod);
    double bend = young * fmax(most.bend1, most.bend2), length = rod_length(rod);
    DofClass classes[] = {
        {.first = layout.position, .count = 3 * layout.nodes, .size = length},
        {.first = layout.turn, .count = 3 * layout.nodes, .size = 1},
        {.first = layout.multiplier, .count = end - 3, .size = INFINITY, .multipliers = true},
        {.first = layout.multiplier + end - 3,
         .count = 3,
         .size = INFINITY,
         .multipliers = true,
         .force = rod->end == ROD_FREE ? 0 : PUSH * bend / pow(length, 2)},
        strains_of(rod, &layout)};
    System *sys = system_create(layout.dofs, classes, rod->cosserat ? 5 : 4);
    add_terms(sys, rod, &layout, HOLD * bend / pow(length, 3));
    add_lumped_terms(sys, rod, dynamic);
    if (rod->world) world_add_terms(rod->world, sys, dynamic);
    for (int k = 0; k < rod->strands; k++) {
        int first = 3 * k * (layout.each + 1), last = first + 3 * layout.each;
        fix(sys, layout.position + first, 3, true);
        fix(sys, layout.turn + first, 3, rod->start == ROD_CLAMPED);
        fix(sys, layout.position + last, 3, rod->end != ROD_FREE);
        fix(sys, layout.turn + last, 3, rod->end == ROD_CLAMPED);
    }
    bool spins = rod->start == ROD_PINNED && rod->end != ROD_CLAMPED;
    if (spins || (rod->end != ROD_FREE && !dynamic)) system_set_base_shift(sys, BASE_SHIFT);
    fix(sys, layout.reference, 4 * layout.nodes, true);
    set_order(sys, &layout);
    system_prepare(sys);
    return sys;
}
