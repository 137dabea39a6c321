#include "rod/stations.h"
#include "base/memory.h"
#include <math.h>

/* Values of elements, put at odd stations; means between them, and straight on to the ends. */
static void fill_nodes(int elements, Vec3 *v)
{
    int last = 2 * elements;
    for (int j = 2; j < last; j += 2) v[j] = vec3_scale(0.5, vec3_add(v[j - 1], v[j + 1]));
    v[0] = elements > 1 ? vec3_axpy(-0.5, vec3_sub(v[3], v[1]), v[1]) : v[1];
    v[last] = elements > 1 ? vec3_axpy(0.5, vec3_sub(v[last - 1], v[last - 3]), v[last - 1]) : v[1];
}

/* The dead loads beyond an element's middle, and by how much weight changes them over the element. */
static Vec3 loads_beyond(const Rod *rod, const double *p, int e, Vec3 *weight)
{
    double h = rod_element_length(rod, e);
    int each = rod_each(rod);
    Vec3 gravity = vec3_load(p + rod->gravity),
         pull = vec3_axpy(h * rod->heavier[e], gravity, vec3_load(p + rod->pull + 3 * e));
    *weight = vec3_scale(rod->unit[e].mass * h, gravity);
    return vec3_axpy(each - e % each - 0.5, *weight, pull);
}

/* With the force that turns the element as a uniform field does. */
static Vec3 element_pull(const Rod *rod, const double *p, int e, Vec3 *weight)
{
    Vec3 B = vec3_load(p + rod->flux.uniform);
    return vec3_axpy(rod->unit[e].area * p[rod->magnetization + 3 * e], B, loads_beyond(rod, p, e, weight));
}

/* In the frame of a strand's last node. */
static Vec3 end_couple(const Rod *rod, int strand, const RodLayout *layout, const double *x, const double *p)
{
    int last = strand * (layout->each + 1) + layout->each;
    if (!rod->couples) return vec3(0, 0, 0);
    return quat_rotate(quat_conj(rod_reference(layout, x, last)), vec3_load(p + rod->couple + 3 * last));
}

void rod_stations(const Rod *rod, int strand, const RodLayout *layout, const double *x, const double *p,
                  RodStations to)
{
    int each = layout->each;
    Vec3 *strain = mem_alloc((size_t)rod->elements, sizeof *strain), *k = to.k, *m = to.m;
    rod_element_strains(rod, layout, x, strain);
    for (int i = 0; i < each; i++) {
        int e = strand * each + i, node = rod_element_node(layout, e);
        double h = rod_element_length(rod, e);
        Vec3 off = vec3_sub(strain[e], vec3_load(p + rod->natural_strain + 3 * e)), weight;
        const RodSection *unit = &rod->unit[e];
        k[2 * i + 1] = strain[e];
        m[2 * i + 1] = vec3_scale(p[rod->young + e],
                                  vec3(unit->twist * off.x, unit->bend1 * off.y, unit->bend2 * off.z));
        Vec3 pull = element_pull(rod, p, e, &weight);
        Quat a = rod_reference(layout, x, node), middle = quat_mul(a, quat_exp(vec3_scale(h / 2, strain[e])));
        Quat frame[3] = {a, middle, rod_reference(layout, x, node + 1)};
        for (int j = 0; j < 3; j++)
            to.F[3 * i + j] = quat_rotate(quat_conj(frame[j]), vec3_axpy(0.5 * (1 - j), weight, pull));
    }
    fill_nodes(each, k);
    fill_nodes(each, m);
    if (rod->end == ROD_FREE) m[2 * each] = end_couple(rod, strand, layout, x, p);
    mem_free(strain);
}

/* What a helix with strain k is after a length h, from its start and in the frame there. */
static Vec3 helix_chord(Vec3 k, double h)
{
    Vec3 theta = vec3_scale(h, k), along = vec3(1, 0, 0);
    double angle2 = vec3_dot(theta, theta), angle = sqrt(angle2);
    bool small = angle < 1e-2;
    double s = small ? 1 - angle2 / 6 * (1 - angle2 / 20)
                     : sin(angle) / angle; /* sin a/a, (1 - cos a)/a^2, (1 - s)/a^2 */
    double c = small ? 0.5 - angle2 / 24 * (1 - angle2 / 30) : (1 - cos(angle)) / angle2;
    double d = small ? 1.0 / 6 - angle2 / 120 * (1 - angle2 / 42) : (1 - s) / angle2;
    Vec3 sum = vec3_axpy(d * theta.x, theta, vec3_axpy(c, vec3_cross(theta, along), vec3_scale(s, along)));
    return vec3_scale(h, sum);
}

void rod_curve_of(const Rod *rod, const RodLayout *layout, const double *x, RodCurve *curve)
{
    size_t stations = 2 * (size_t)rod->elements + 1;
    double h = rod_element_length(rod, 0), *place = mem_alloc(3 * (size_t)layout->nodes, sizeof *place);
    Vec3 *strain = mem_alloc((size_t)rod->elements, sizeof *strain);
    *curve = (RodCurve){.elements = rod->elements, .length = rod_length(rod)};
    curve->x = mem_alloc(stations, sizeof *curve->x);
    curve->t = mem_alloc(stations, sizeof *curve->t);
    curve->c = mem_alloc(stations, sizeof *curve->c);
    rod_places(rod, layout, x, layout->nodes, place);
    rod_element_strains(rod, layout, x, strain);
    for (int j = 0; j < (int)stations; j++) {
        int node = j / 2, e = node < rod->elements ? node : node - 1;
        Quat q = rod_reference(layout, x, node);
        Vec3 k = strain[e];
        curve->x[j] = vec3_load(place + 3 * node);
        if (j % 2) {
            curve->x[j] = vec3_add(curve->x[j], quat_rotate(q, helix_chord(k, h / 2)));
            q = quat_mul(q, quat_exp(vec3_scale(h / 2, k)));
        } else if (node > 0 && node < rod->elements) {
            k = vec3_scale(0.5, vec3_add(strain[node - 1], strain[node]));
        }
        curve->t[j] = quat_rotate(q, vec3(1, 0, 0));
        curve->c[j] = quat_rotate(q, vec3(0, k.z, -k.y));
    }
    mem_free(place);
    mem_free(strain);
}

void rod_element_forces(const Rod *rod, const RodLayout *layout, const double *x, const double *p,
                        Vec3 *force)
{
    Vec3 weight;
    for (int e = 0; e < layout->elements; e++)
        force[e] = layout->multiplier >= 0 ? vec3_load(x + layout->multiplier + 3 * e)
                                           : loads_beyond(rod, p, e, &weight);
}

void rod_node_moments(const Rod *rod, const RodLayout *layout, const double *x, const double *p, Vec3 *moment)
{
    size_t stations = 2 * (size_t)layout->each + 1;
    Vec3 *work = mem_alloc(2 * stations + 3 * (size_t)layout->each, sizeof *work), *m = work + stations;
    for (int k = 0; k < rod->strands; k++) {
        rod_stations(rod, k, layout, x, p, (RodStations){work, m, m + stations});
        for (int i = 0, node = k * (layout->each + 1); i <= layout->each; i++, node++)
            moment[node] = quat_rotate(rod_reference(layout, x, node), m[2 * i]);
    }
    mem_free(work);
}
