#include "rod/inverse.h"
#include "base/memory.h"
#include "base/quat.h"

void rod_moments(const RodCurve *curve, RodLoads loads, Vec3 *moment)
{
    int last = 2 * curve->elements;
    double h = curve->length / last;
    Vec3 integral = vec3(0, 0, 0); /* of x from the station to the end */
    moment[last] = integral;
    for (int j = last - 1; j >= 0; j--) {
        Vec3 ends = vec3_add(curve->x[j], curve->x[j + 1]), turn = vec3_sub(curve->t[j], curve->t[j + 1]);
        integral = vec3_axpy(h / 2, ends, vec3_axpy(h * h / 12, turn, integral));
        Vec3 arm = vec3_axpy(-(curve->length - j * h), curve->x[j], integral);
        moment[j] = vec3_cross(arm, loads.line);
    }
}

/* K^-1 R^T M in the frame. */
static Vec3 strain_of(RodSection section, RodFrame frame, Vec3 moment)
{
    Vec3 m = rod_to_frame(frame, moment);
    return vec3(m.x / section.twist, m.y / section.bend1, m.z / section.bend2);
}

static Vec3 rate(const RodCurve *curve, RodSection section, const Vec3 *moment, const RodFrame *frames, int j)
{
    if (frames) return vec3_scale(-1, rod_to_world(frames[j], strain_of(section, frames[j], moment[j])));
    Vec3 t = curve->t[j], along = vec3_scale(vec3_dot(moment[j], t), t), across = vec3_sub(moment[j], along);
    return vec3_scale(-1, vec3_axpy(1 / section.bend1, across, vec3_scale(1 / section.twist, along)));
}

void rod_invert(const RodCurve *curve, RodSection section, const Vec3 *moment, const RodFrame *frames,
                Vec3 *natural)
{
    double h = curve->length / curve->elements;
    Quat Q = quat_identity();
    Vec3 w0 = rate(curve, section, moment, frames, 0);
    natural[0] = curve->x[0];
    for (int e = 0; e < curve->elements; e++) {
        Vec3 w1 = rate(curve, section, moment, frames, 2 * e + 1),
             w2 = rate(curve, section, moment, frames, 2 * e + 2);
        Quat half, whole = rod_turn(h, w0, w1, w2, &half), middle = quat_mul(Q, half);
        Q = quat_unit(quat_mul(Q, whole));
        /* int Q dx by parts: exact for a constant Q, however sharply the curve bends within the element. */
        Vec3 d1 = vec3_sub(curve->x[2 * e + 1], curve->x[2 * e]),
             d2 = vec3_sub(curve->x[2 * e + 2], curve->x[2 * e]);
        Vec3 turned = quat_rotate(Q, vec3_axpy(-h / 6, vec3_cross(w2, d2), d2));
        natural[e + 1] =
            vec3_add(natural[e], vec3_axpy(-4 * h / 6, quat_rotate(middle, vec3_cross(w1, d1)), turned));
        w0 = w2;
    }
}

void rod_strains(const RodCurve *curve, const RodFrame *frames, Vec3 *strains)
{
    int stations = 2 * curve->elements + 1;
    double *twist = mem_alloc((size_t)stations, sizeof *twist);
    rod_twist(curve, frames, twist);
    for (int j = 0; j < stations; j++)
        strains[j] =
            vec3(twist[j], -vec3_dot(curve->c[j], frames[j].n2), vec3_dot(curve->c[j], frames[j].n1));
    mem_free(twist);
}

void rod_natural_strains(const RodCurve *curve, RodSection section, const Vec3 *moment,
                         const RodFrame *frames, Vec3 *strains)
{
    rod_strains(curve, frames, strains);
    for (int j = 0; j <= 2 * curve->elements; j++)
        strains[j] = vec3_sub(strains[j], strain_of(section, frames[j], moment[j]));
}

/* d of -K^-1 R^T M over ds: K^-1 ([ex]x R^T T + K d x k), T = line (L - s) the pull of what hangs beyond. */
static Vec3 strain_rate(RodSection section, RodFrame frame, Vec3 k, Vec3 pull, Vec3 d)
{
    Vec3 Kd = vec3(section.twist * d.x, section.bend1 * d.y, section.bend2 * d.z),
         T = rod_to_frame(frame, pull);
    Vec3 r = vec3_add(vec3_cross(vec3(1, 0, 0), T), vec3_cross(Kd, k));
    return vec3(r.x / section.twist, r.y / section.bend1, r.z / section.bend2);
}

void rod_strain_route(const RodCurve *curve, RodSection section, RodLoads loads, const RodFrame *frames,
                      Vec3 *d)
{
    int last = 2 * curve->elements;
    double h = curve->length / curve->elements;
    Vec3 *k = mem_alloc((size_t)last + 1, sizeof *k);
    rod_strains(curve, frames, k);
    for (int j = 0; j <= last; j++) d[j] = vec3(0, 0, 0);
    for (int j = last; j > 0; j -= 2) { /* Runge-Kutta over an element, backwards */
        Vec3 pull[3], rates[4], at = d[j];
        for (int i = 0; i < 3; i++) pull[i] = vec3_scale(curve->length - (j - i) * h / 2, loads.line);
        rates[0] = strain_rate(section, frames[j], k[j], pull[0], at);
        rates[1] = strain_rate(section, frames[j - 1], k[j - 1], pull[1], vec3_axpy(-h / 2, rates[0], at));
        rates[2] = strain_rate(section, frames[j - 1], k[j - 1], pull[1], vec3_axpy(-h / 2, rates[1], at));
        rates[3] = strain_rate(section, frames[j - 2], k[j - 2], pull[2], vec3_axpy(-h, rates[2], at));
        Vec3 sum = vec3_add(vec3_add(rates[0], rates[3]), vec3_scale(2, vec3_add(rates[1], rates[2])));
        d[j - 2] = vec3_axpy(-h / 6, sum, at);
        d[j - 1] = vec3_axpy(
            0.5, vec3_add(d[j], d[j - 2]),
            vec3_scale(h / 8,
                       vec3_sub(strain_rate(section, frames[j - 2], k[j - 2], pull[2], d[j - 2]), rates[0])));
    }
    mem_free(k);
}
