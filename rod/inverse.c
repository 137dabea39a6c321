#include "rod/inverse.h"
#include "base/memory.h"
#include "base/quat.h"
#include "solve/dense.h"

/* The place at arclength s: cubic between stations. */
static Vec3 place_at(const RodCurve *curve, double s)
{
    int last = 2 * curve->elements;
    double h = curve->length / last, part = fmin(fmax(s / h, 0), last);
    int j = part < last ? (int)part : last - 1;
    double a = part - j, b = 1 - a;
    Vec3 x = vec3_axpy(b * b * (1 + 2 * a), curve->x[j], vec3_scale(a * a * (1 + 2 * b), curve->x[j + 1]));
    return vec3_axpy(h * a * b * b, curve->t[j], vec3_axpy(-h * a * a * b, curve->t[j + 1], x));
}

/* What a force at arclength s does to all stations before it. */
static void add_point(const RodCurve *curve, double s, Vec3 force, Vec3 *moment)
{
    Vec3 place = place_at(curve, s);
    double h = curve->length / (2 * curve->elements);
    for (int j = 0; j <= 2 * curve->elements && j * h < s; j++)
        moment[j] = vec3_add(moment[j], vec3_cross(vec3_sub(place, curve->x[j]), force));
}

/* The part of a couple at arclength s that station j feels: all of it before, nothing beyond; at the middle of its own
 * element 1/6 + 4/6 part = what of the element lies before it. */
static double couple_part(const RodCurve *curve, double s, int j)
{
    double h = curve->length / curve->elements, little = 1e-9;
    if (s >= curve->length * (1 - little)) return 1;
    int node = (int)ceil(s / h - little), last = 2 * node; /* that its element ends in */
    return j < last - 1 ? 1 : j >= last ? 0 : 1.5 * (s / h - (node - 1)) - 0.25;
}

/* What point loads beyond do, where they are no forces. */
static Vec3 couple_at(const RodCurve *curve, RodLoads loads, int j)
{
    Vec3 sum = vec3(0, 0, 0);
    for (int k = 0; k < loads.point_count; k++)
        sum = vec3_axpy(couple_part(curve, loads.points[k].s, j), loads.points[k].couple, sum);
    return sum;
}

/* The integral over the step from station j on of f, by the cubic through its values at four stations, f(i) at j - 1 + i;
 * at the ends the four next ones. */
static const double cubic_weights[3][4] = {{9, 19, -5, 1}, {-1, 13, 13, -1}, {1, -5, 19, 9}};

/* What a load that varies pulls beyond station j + 1 is *pull, and its moment about there moment: both for station j. */
static Vec3 add_step(const RodCurve *curve, const Vec3 *load, int j, Vec3 moment, Vec3 *pull)
{
    int last = 2 * curve->elements, first = j == 0 ? 0 : j == last - 1 ? j - 2 : j - 1;
    const double *weight = cubic_weights[j - first], h = curve->length / last;
    moment = vec3_add(moment, vec3_cross(vec3_sub(curve->x[j + 1], curve->x[j]), *pull));
    for (int i = 0; i < 4; i++) {
        Vec3 p = vec3_scale(h / 24 * weight[i], load[first + i]);
        moment = vec3_add(moment, vec3_cross(vec3_sub(curve->x[first + i], curve->x[j]), p));
        *pull = vec3_add(*pull, p);
    }
    return moment;
}

static void add_along(const RodCurve *curve, const Vec3 *load, Vec3 *moment)
{
    Vec3 pull = vec3(0, 0, 0), own = pull;
    for (int j = 2 * curve->elements - 1; j >= 0; j--) {
        own = add_step(curve, load, j, own, &pull);
        moment[j] = vec3_add(moment[j], own);
    }
}

void rod_inertia(const RodCurve *const curves[3], const double time[3], int at, RodSections sections,
                 double drag, Vec3 *along)
{
    double before = time[1] - time[0], after = time[2] - time[1], both = time[2] - time[0];
    for (int j = 0; j <= 2 * curves[0]->elements; j++) {
        Vec3 x0 = curves[0]->x[j], x1 = curves[1]->x[j], x2 = curves[2]->x[j];
        Vec3 v01 = vec3_scale(1 / before, vec3_sub(x1, x0)), v12 = vec3_scale(1 / after, vec3_sub(x2, x1));
        Vec3 a = vec3_scale(2 / both, vec3_sub(v12, v01)),
             v = at == 1 ? vec3_scale(1 / both, vec3_sub(x2, x0)) : v12;
        along[j] = vec3_axpy(-rod_section_at(sections, j)->mass, a, vec3_scale(-drag, v));
    }
}

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
    for (int k = 0; k < loads.point_count; k++)
        add_point(curve, loads.points[k].s, loads.points[k].force, moment);
    add_point(curve, curve->length, loads.end, moment);
    if (loads.along) add_along(curve, loads.along, moment);
    for (int j = 0; loads.point_count && j <= last; j++)
        moment[j] = vec3_add(moment[j], couple_at(curve, loads, j));
    bool turned = vec3_length(loads.end_couple) > 0;
    for (int j = 0; turned && j <= last; j++) moment[j] = vec3_add(moment[j], loads.end_couple);
}

void rod_pulls(const RodCurve *curve, RodLoads loads, Vec3 *pull)
{
    double h = curve->length / curve->elements;
    for (int i = 0; i < 3 * curve->elements; i++) {
        int e = i / 3;
        double s = (e + i % 3 / 2.0) * h, inside = (e + (i % 3 == 1 ? 0.5 : i % 3 ? 1 - 1e-9 : 1e-9)) * h;
        pull[i] = vec3_axpy(curve->length - s, loads.line, loads.end);
        for (int k = 0; k < loads.point_count; k++)
            if (loads.points[k].s > inside) pull[i] = vec3_add(pull[i], loads.points[k].force);
    }
    Vec3 beyond = vec3(0, 0, 0);
    for (int j = 2 * curve->elements; loads.along && j >= 0; j--) {
        if (j < 2 * curve->elements) add_step(curve, loads.along, j, beyond, &beyond);
        int start = 3 * (j / 2) + j % 2; /* of the element that begins there, and the end of the one before */
        if (j < 2 * curve->elements) pull[start] = vec3_add(pull[start], beyond);
        if (j > 0 && j % 2 == 0) pull[start - 1] = vec3_add(pull[start - 1], beyond);
    }
}

/* K^-1 R^T M in the frame. */
static Vec3 strain_of(const RodSection *section, RodFrame frame, Vec3 moment)
{
    return rod_bent(section, rod_to_frame(frame, moment));
}

static Vec3 rate(const RodCurve *curve, RodSections sections, const Vec3 *moment, const RodFrame *frames,
                 int j)
{
    const RodSection *section = rod_section_at(sections, j);
    if (frames) return vec3_scale(-1, rod_to_world(frames[j], strain_of(section, frames[j], moment[j])));
    Vec3 t = curve->t[j], along = vec3_scale(vec3_dot(moment[j], t), t), across = vec3_sub(moment[j], along);
    return vec3_scale(-1, vec3_axpy(1 / section->bend1, across, vec3_scale(1 / section->twist, along)));
}

void rod_invert(const RodCurve *curve, RodSections sections, const Vec3 *moment, const RodFrame *frames,
                Vec3 *natural)
{
    double h = curve->length / curve->elements;
    Quat Q = quat_identity();
    Vec3 w0 = rate(curve, sections, moment, frames, 0);
    natural[0] = curve->x[0];
    for (int e = 0; e < curve->elements; e++) {
        Vec3 w1 = rate(curve, sections, moment, frames, 2 * e + 1),
             w2 = rate(curve, sections, moment, frames, 2 * e + 2);
        Quat half, whole = rod_turn(h, w0, w1, w2, &half), middle = quat_mul(Q, half);
        Q = quat_trim(quat_mul(Q, whole));
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

void rod_natural_strains(const RodCurve *curve, RodSections sections, const Vec3 *moment,
                         const RodFrame *frames, Vec3 *strains)
{
    rod_strains(curve, frames, strains);
    for (int j = 0; j <= 2 * curve->elements; j++)
        strains[j] = vec3_sub(strains[j], strain_of(rod_section_at(sections, j), frames[j], moment[j]));
}

/* The strain in a frame that is turned by an angle about the tangent and has no twist. */
static Vec3 untwisted(Vec3 k, double angle)
{
    double c = cos(angle), s = sin(angle);
    return vec3(0, c * k.y + s * k.z, c * k.z - s * k.y);
}

void rod_untwist(const RodCurve *curve, Vec3 *k)
{
    double h = curve->length / curve->elements, angle = 0; /* minus the integral of the twist */
    Vec3 *to = k;
    for (int e = 0; e < curve->elements; e++, to += 2) {
        double twist = to[0].x, middle = to[1].x, end = to[2].x;
        to[0] = untwisted(to[0], angle);
        to[1] = untwisted(to[1], angle - h / 24 * (5 * twist + 8 * middle - end));
        angle -= h / 6 * (twist + 4 * middle + end);
    }
    to[0] = untwisted(to[0], angle);
}

/* d of m = R^T M over ds, T the pull of what hangs beyond. */
static Vec3 moment_rate(RodFrame frame, Vec3 k, Vec3 pull, Vec3 m)
{
    return vec3_sub(vec3_cross(m, k), vec3_cross(vec3(1, 0, 0), rod_to_frame(frame, pull)));
}

void rod_strain_route(const RodCurve *curve, RodSections sections, RodLoads loads, const RodFrame *frames,
                      Vec3 *d)
{
    int last = 2 * curve->elements;
    double h = curve->length / curve->elements;
    Vec3 *k = mem_alloc((size_t)last + 1, sizeof *k), *m = d,
         *pulls = mem_alloc(3 * (size_t)curve->elements, sizeof *pulls);
    rod_strains(curve, frames, k);
    rod_pulls(curve, loads, pulls);
    m[last] = rod_to_frame(frames[last], vec3_add(couple_at(curve, loads, last), loads.end_couple));
    for (int j = last; j > 0; j -= 2) { /* Runge-Kutta over an element, backwards */
        const Vec3 *pull = pulls + 3 * (j / 2 - 1);
        Vec3 rates[4], at = m[j];
        rates[0] = moment_rate(frames[j], k[j], pull[2], at);
        rates[1] = moment_rate(frames[j - 1], k[j - 1], pull[1], vec3_axpy(-h / 2, rates[0], at));
        rates[2] = moment_rate(frames[j - 1], k[j - 1], pull[1], vec3_axpy(-h / 2, rates[1], at));
        rates[3] = moment_rate(frames[j - 2], k[j - 2], pull[0], vec3_axpy(-h, rates[2], at));
        Vec3 sum = vec3_add(vec3_add(rates[0], rates[3]), vec3_scale(2, vec3_add(rates[1], rates[2])));
        m[j - 2] = vec3_axpy(-h / 6, sum, at);
        m[j - 1] = vec3_axpy(
            0.5, vec3_add(m[j], m[j - 2]),
            vec3_scale(h / 8, vec3_sub(moment_rate(frames[j - 2], k[j - 2], pull[0], m[j - 2]), rates[0])));
        for (int i = j - 2; i < j; i++) { /* couples within the element */
            Vec3 jump = vec3_sub(couple_at(curve, loads, i), couple_at(curve, loads, j));
            m[i] = vec3_add(m[i], rod_to_frame(frames[i], jump));
        }
    }
    for (int j = 0; j <= last; j++) d[j] = vec3_scale(-1, rod_bent(rod_section_at(sections, j), m[j]));
    mem_free(k);
    mem_free(pulls);
}

/* What is least of a station: rows of it for the moment there, r = r0 + A M. */
static void least_rows(const RodSection *section, RodFrame f, RodEndChoice choice, Vec3 rows[3])
{
    bool straight = choice == ROD_STRAIGHTEST;
    double K[3] = {section->twist, section->bend1, section->bend2};
    const Vec3 axes[3] = {f.n0, f.n1, f.n2};
    for (int i = 0; i < 3; i++)
        rows[i] = vec3_scale(!straight ? 1 / sqrt(K[i]) : i > 0 ? -1 / K[i] : 0, axes[i]);
}

static const double UNDETERMINED = 1e-12;

void rod_choose_end(const RodCurve *curve, RodSections sections, const RodFrame *frames, RodEndChoice choice,
                    bool hinge, RodLoads *loads)
{
    enum { UNKNOWNS = 6 }; /* force times length, couple */
    int last = 2 * curve->elements, n = hinge ? 3 : UNKNOWNS;
    double A[UNKNOWNS][UNKNOWNS] = {{0}}, b[UNKNOWNS] = {0}, trace = 0, L = curve->length;
    Vec3 *moment = mem_alloc(2 * ((size_t)last + 1), sizeof *moment), *k = moment + last + 1;
    rod_moments(curve, *loads, moment);
    rod_natural_strains(curve, sections, moment, frames, k);
    for (int j = 0; j <= last; j++) {
        double simpson = j == 0 || j == last ? 1 : j % 2 ? 4 : 2;
        Vec3 rows[3], arm = vec3_scale(1 / L, vec3_sub(curve->x[last], curve->x[j]));
        least_rows(rod_section_at(sections, j), frames[j], choice, rows);
        for (int i = 0; i < 3; i++) {
            double r = choice == ROD_STRAIGHTEST ? i > 0 ? (&k[j].x)[i] : 0 : vec3_dot(rows[i], moment[j]);
            double slope[UNKNOWNS]; /* row.(arm x F + C) */
            vec3_store(slope, vec3_cross(rows[i], arm));
            vec3_store(slope + 3, rows[i]);
            for (int u = 0; u < n; u++) {
                b[u] -= simpson * slope[u] * r;
                for (int v = 0; v < n; v++) A[u][v] += simpson * slope[u] * slope[v];
            }
        }
    }
    mem_free(moment);
    for (int u = 0; u < n; u++) trace += A[u][u];
    for (int u = 0; u < n; u++) A[u][u] += UNDETERMINED * trace;
    if (!dense_cholesky(n, A[0], UNKNOWNS)) return; /* no numbers */
    dense_forward(n, A[0], UNKNOWNS, b);
    dense_backward(n, A[0], UNKNOWNS, b);
    loads->end = vec3_axpy(1 / L, vec3_load(b), loads->end);
    if (!hinge) loads->end_couple = vec3_add(loads->end_couple, vec3_load(b + 3));
}
