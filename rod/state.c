/* States of a rod (rod.h). */
#include "base/memory.h"
#include "rod/chord.h"
#include "solve/dense.h"
#include <math.h>
#include <string.h>

RodLayout rod_layout(const Rod *rod, bool positions)
{
    int nodes = rod_node_count(rod), turn = positions ? 3 * nodes : 0, strain = turn + 3 * nodes,
        multiplier = rod->cosserat ? strain + 3 * rod->elements : strain;
    int reference = positions ? multiplier + 3 * rod->elements : multiplier;
    return (RodLayout){.nodes = nodes,
                       .elements = rod->elements,
                       .each = rod_each(rod),
                       .position = positions ? 0 : -1,
                       .turn = turn,
                       .strain = rod->cosserat ? strain : -1,
                       .multiplier = positions ? multiplier : -1,
                       .reference = reference,
                       .dofs = reference + 4 * nodes};
}

/* Turns of both nodes and strain of the elements. */
static void gather(const RodLayout *layout, int pack, const double *x, Pack own[9])
{
    for (int l = 0; l < PACK_LANES; l++) {
        int e = segment_lane(layout, pack, l), node = rod_element_node(layout, e);
        for (int i = 0; i < 6; i++) own[i][l] = x[layout->turn + 3 * node + i];
        for (int i = 0; i < 3; i++) own[6 + i][l] = layout->strain < 0 ? 0 : x[layout->strain + 3 * e + i];
    }
}

double rod_least_stretch(const RodLayout *layout, const double *x, int *element)
{
    double least = INFINITY;
    for (int e = 0; e < layout->elements; e++) {
        double stretch = 1 + x[layout->strain + 3 * e];
        if (stretch >= least) continue;
        least = stretch;
        if (element) *element = e;
    }
    return least;
}

bool rod_is_tangled(double least_stretch)
{
    return least_stretch <= 1e-3;
}

void rod_places(const Rod *rod, const RodLayout *layout, const double *x, int count, double *place)
{
    RodTerm term = {.rod = rod, .layout = *layout};
    Vec3 now = {0};
    for (int k = 0; k < pack_count(rod->elements); k++) {
        Pack own[9];
        gather(layout, k, x, own);
        Chord chord = chord_at(&term, k, x, own);
        Pack3 step = chord_world(&chord);
        for (int l = 0, e = k * PACK_LANES; l < PACK_LANES && e < layout->elements; l++, e++) {
            int node = rod_element_node(layout, e);
            if (e % layout->each == 0) {
                now = layout->position >= 0 ? vec3_load(x + layout->position + 3 * node)
                                            : rod->strand[e / layout->each].position;
                if (node < count) vec3_store(place + 3 * node, now);
            }
            now = vec3_add(now, vec3(step.x[l], step.y[l], step.z[l]));
            if (node + 1 < count) vec3_store(place + 3 * (node + 1), now);
        }
    }
}

/* Positions where rotations and strains have them. */
static void follow(const Rod *rod, const RodLayout *layout, double *x)
{
    if (layout->position >= 0) rod_places(rod, layout, x, layout->nodes, x + layout->position);
}

void rod_set_state(const Rod *rod, const RodLayout *layout, const Quat *q, double *x)
{
    for (int i = 0; i < layout->reference; i++) x[i] = 0;
    for (int i = 0; i < layout->nodes; i++) {
        double *to = x + layout->reference + 4 * i;
        to[0] = q[i].w;
        vec3_store(to + 1, q[i].v);
    }
    if (layout->position < 0) return;
    for (int k = 0; k < rod->strands; k++)
        vec3_store(x + layout->position + 3 * k * (layout->each + 1), rod->strand[k].position);
    follow(rod, layout, x);
}

void rod_copy_state(const Rod *rod, const RodLayout *from, const double *x, const RodLayout *to, double *y)
{
    Quat *q = mem_alloc((size_t)from->nodes, sizeof *q);
    for (int i = 0; i < from->nodes; i++) q[i] = rod_reference(from, x, i);
    rod_set_state(rod, to, q, y);
    mem_free(q);
    if (from->strain < 0 || to->strain < 0) return;
    memcpy(y + to->strain, x + from->strain, 3 * (size_t)rod->elements * sizeof *y);
    follow(rod, to, y);
}

/* Of a strand, from q[0] on. */
static void natural_frames(int elements, double h, const double *strain, Quat *q)
{
    for (int e = 0; e < elements; e++)
        q[e + 1] = quat_unit(quat_mul(q[e], quat_exp(vec3_scale(h, vec3_load(strain + 3 * e)))));
}

void rod_natural_state(const Rod *rod, const RodLayout *layout, const double *p, double *x)
{
    int each = layout->each;
    Quat *q = mem_alloc((size_t)layout->nodes, sizeof *q);
    for (int k = 0; k < rod->strands; k++) {
        Quat *own = q + k * (each + 1);
        own[0] = rod->strand[k].frame;
        natural_frames(each, rod_element_length(rod, k * each), p + rod->natural_strain + 3 * k * each, own);
    }
    rod_set_state(rod, layout, q, x);
    mem_free(q);
}

void rod_element_strains(const Rod *rod, const RodLayout *layout, const double *x, Vec3 *strain)
{
    for (int k = 0; k < pack_count(rod->elements); k++) {
        Pack own[9];
        gather(layout, k, x, own);
        Segment s = segment_at(layout, k, x, own);
        Pack3 theta = segment_theta(&s);
        for (int l = 0, e = k * PACK_LANES; l < PACK_LANES && e < rod->elements; l++, e++) {
            double h = rod_element_length(rod, e);
            strain[e] = vec3(theta.x[l] / h, theta.y[l] / h, theta.z[l] / h);
        }
    }
}

void rod_follow_curves(Rod *rod, const RodCurve *curves, RodFrame *const *frames, double *x)
{
    RodLayout layout = rod_layout(rod, false);
    double *place = mem_alloc(3 * (size_t)layout.nodes, sizeof *place);
    Quat *q = mem_alloc((size_t)layout.nodes, sizeof *q);
    for (int k = 0; k < rod->strands; k++) {
        Quat *own = q + k * (layout.each + 1);
        for (int i = 0; i <= layout.each; i++) {
            RodFrame f = frames[k][2 * i];
            own[i] = quat_from_axes(f.n0, f.n1, f.n2);
        }
        rod->strand[k] = (RodStrand){curves[k].length, curves[k].x[0], own[0]};
    }
    for (int e = 0; e < rod->elements; e++) rod->bow[e] = vec3(0, 0, 0);
    rod_set_state(rod, &layout, q, x);
    rod_places(rod, &layout, x, layout.nodes, place);
    for (int e = 0; e < rod->elements; e++) {
        int node = rod_element_node(&layout, e);
        const Vec3 *station = curves[e / layout.each].x + 2 * (e % layout.each);
        Vec3 wanted = vec3_sub(station[2], station[0]),
             chord = vec3_sub(vec3_load(place + 3 * node + 3), vec3_load(place + 3 * node));
        rod->bow[e] = quat_rotate(quat_conj(q[node]), vec3_sub(wanted, chord));
    }
    mem_free(place);
    mem_free(q);
}

/* m with rows m = b. */
static Vec3 solve(const Vec3 rows[3], Vec3 b)
{
    Vec3 c0 = vec3_cross(rows[1], rows[2]), c1 = vec3_cross(rows[2], rows[0]),
         c2 = vec3_cross(rows[0], rows[1]);
    Vec3 sum = vec3_axpy(b.x, c0, vec3_axpy(b.y, c1, vec3_scale(b.z, c2)));
    return vec3_scale(1 / vec3_dot(rows[0], c0), sum);
}

/* What a moment m of each element does on a turn of its node: rows.m; rows of nodes a (0..2) and b (3..5). */
static void turn_rows(const RodLayout *layout, const double *x, Vec3 (*rows)[6])
{
    static const Pack none[6] = {{0}};
    Pack3 zero = {{0}, {0}, {0}};
    for (int k = 0; k * PACK_LANES < layout->elements; k++) {
        Segment s = segment_at(layout, k, x, none);
        for (int i = 0; i < 6; i++) {
            Pack3 unit = pack3(pack_set(i % 3 == 0), pack_set(i % 3 == 1), pack_set(i % 3 == 2));
            Pack3 row =
                segment_theta_rate(&s, i < 3 ? segment_rate(&s, unit, zero) : segment_rate(&s, zero, unit));
            for (int l = 0, e = k * PACK_LANES; l < PACK_LANES && e < layout->elements; l++, e++)
                rows[e][i] = vec3(row.x[l], row.y[l], row.z[l]);
        }
    }
}

static bool ends_strand(const RodLayout *layout, int e)
{
    return (e + 1) % layout->each == 0;
}

/* The multipliers that leave no force on the positions: what each element carries, from the free end on. */
static void set_multipliers(const RodLayout *layout, System *sys, const Point *at, double *x, double *force)
{
    double *multiplier = x + layout->multiplier;
    memset(multiplier, 0, 3 * (size_t)layout->elements * sizeof *multiplier);
    system_gradient(sys, at, force);
    Vec3 carried = vec3(0, 0, 0);
    for (int e = layout->elements - 1; e >= 0; e--) {
        if (ends_strand(layout, e)) carried = vec3(0, 0, 0);
        carried =
            vec3_sub(carried, vec3_load(force + layout->position + 3 * (rod_element_node(layout, e) + 1)));
        vec3_store(multiplier + 3 * e, carried);
    }
}

static void add_to_multipliers(const RodLayout *layout, double *x, Vec3 force)
{
    double *multiplier = x + layout->multiplier;
    for (int e = 0; e < layout->elements; e++)
        vec3_store(multiplier + 3 * e, vec3_add(vec3_load(multiplier + 3 * e), force));
}

static const double UNDETERMINED = 1e-14; /* a force along a straight rod turns nothing: it is 0 */

/* The support's force at the last end, which all elements carry, that leaves the least on free turns and strains: a linear
 * problem of least squares. */
static Vec3 fit_support(const RodLayout *layout, System *sys, const Point *at, double *x)
{
    size_t n = (size_t)layout->dofs;
    double *g = mem_alloc(4 * n, sizeof *g), A[3][3] = {{0}}, b[3] = {0};
    const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    system_gradient(sys, at, g);
    for (int k = 0; k < 3; k++) {
        add_to_multipliers(layout, x, unit[k]);
        system_gradient(sys, at, g + (size_t)(k + 1) * n);
        add_to_multipliers(layout, x, vec3_scale(-1, unit[k]));
    }
    for (int d = layout->turn; d < layout->multiplier; d++)
        for (int i = 0; !system_is_fixed(sys, d) && i < 3; i++) {
            const double *gi = g + (size_t)(i + 1) * n;
            b[i] -= (gi[d] - g[d]) * g[d];
            for (int j = 0; j < 3; j++)
                A[i][j] += (gi[d] - g[d]) * (g[(size_t)(j + 1) * n + (size_t)d] - g[d]);
        }
    mem_free(g);
    double trace = A[0][0] + A[1][1] + A[2][2];
    if (trace == 0) return vec3(0, 0, 0);
    for (int i = 0; i < 3; i++) A[i][i] += UNDETERMINED * trace;
    if (!dense_cholesky(3, A[0], 3)) return vec3(0, 0, 0); /* no numbers */
    dense_forward(3, A[0], 3, b);
    dense_backward(3, A[0], 3, b);
    return vec3_load(b);
}

void rod_carry(const Rod *rod, System *sys, const RodLayout *layout, const Point *at, double *x)
{
    double *force = mem_alloc((size_t)layout->dofs, sizeof *force);
    set_multipliers(layout, sys, at, x, force);
    mem_free(force);
    if (rod->end != ROD_FREE) add_to_multipliers(layout, x, fit_support(layout, sys, at, x));
}

/* The strains that a Cosserat rod's loads give its elements; its positions follow. */
static void set_strains(const Rod *rod, System *sys, const RodLayout *layout, const Point *at, double *x,
                        double *work)
{
    system_gradient(sys, at, work);
    for (int i = 0; i < 3 * rod->elements; i++) {
        const RodSection *unit = &rod->unit[i / 3];
        const double K[3] = {unit->stretch, unit->shear1, unit->shear2};
        x[layout->strain + i] -= work[layout->strain + i] /
                                 (at->p[rod->young + i / 3] * rod_element_length(rod, i / 3) * K[i % 3]);
    }
    follow(rod, layout, x);
}

void rod_balance(const Rod *rod, System *sys, const RodLayout *layout, double time, double *x, double *p)
{
    rod_balance_end(rod, sys, layout, time, vec3(0, 0, 0), x, p);
}

void rod_balance_end(const Rod *rod, System *sys, const RodLayout *layout, double time, Vec3 couple,
                     double *x, double *p)
{
    size_t elements = (size_t)rod->elements;
    Vec3 *strain = mem_alloc(elements, sizeof *strain), (*rows)[6] = mem_alloc(elements, sizeof *rows);
    double *force = mem_alloc((size_t)layout->dofs, sizeof *force);
    rod_element_strains(rod, layout, x, strain);
    for (int e = 0; e < rod->elements; e++) vec3_store(p + rod->natural_strain + 3 * e, strain[e]);
    Point at = {.x = x, .p = p, .time = time};
    if (layout->strain >= 0) follow(rod, layout, x);
    if (layout->multiplier >= 0) set_multipliers(layout, sys, &at, x, force);
    if (layout->strain >= 0) set_strains(rod, sys, layout, &at, x, force);
    system_gradient(sys, &at, force);
    turn_rows(layout, x, rows);
    Vec3 carried = vec3(0, 0, 0); /* what the element beyond does to the node */
    for (int e = rod->elements - 1; e >= 0; e--) {
        int node = rod_element_node(layout, e) + 1;
        if (ends_strand(layout, e))
            carried = vec3_scale(-1, quat_rotate(quat_conj(rod_reference(layout, x, node)), couple));
        Vec3 load = vec3_add(vec3_load(force + layout->turn + 3 * node), carried);
        Vec3 m = solve(rows[e] + 3, vec3_scale(-1, load));
        for (int i = 0; i < 3; i++) (&carried.x)[i] = vec3_dot(rows[e][i], m);
        const RodSection *unit = &rod->unit[e];
        double young = p[rod->young + e], K[3] = {unit->twist, unit->bend1, unit->bend2};
        for (int i = 0; i < 3; i++) p[rod->natural_strain + 3 * e + i] -= (&m.x)[i] / (young * K[i]);
    }
    mem_free(strain);
    mem_free(rows);
    mem_free(force);
}
