#include "rod/pbd.h"
#include "base/memory.h"
#include "base/quat.h"

/* Where a held end goes within a step. */
typedef struct Goal {
    bool given;
    Vec3 place;
    Quat frame;
} Goal;

struct PbdRod {
    int elements, substeps, sweeps;
    RodSupport start, end;
    double h, drag;
    Vec3 gravity, *force;           /* force [nodes] */
    Vec3 flux_density, *magnet;     /* magnet [elements]; NULL: none                                */
    double mass, *inverse_mass;     /* of an element; [nodes] 0: held                               */
    double inverse_inertia;         /* of an element                                                */
    Vec3 stretch_compliance;        /* of an element's chord in parts of h, in its frame, 1/J       */
    Vec3 turn_compliance;           /* of half the angle between two elements (twist, 1, 2), 1/J    */
    Vec3 *chord;                    /* [elements] natural chord over h, in the element's frame      */
    Quat clamp, end_frame, *turn;   /* [elements + 1] natural rotation from the element before, or from
                                       the clamp, and to the end, in the frame of either            */
    Goal goal[2];                   /* of the first and the last node                               */
    Vec3 *x, *x_before, *v;         /* [nodes]                                                      */
    Quat *q, *q_before;             /* [elements] frames                                            */
    Vec3 *spin;                     /* [elements] rate of turning in its frame, 1/s                 */
    Vec3 *stretch_load, *turn_load; /* [elements], [elements + 1] the constraints' multipliers, J   */
    bool backwards;                 /* the first sweep of the next substep                          */
};

/* Chord over h of an element with constant strain, in the frame of its middle. */
static Vec3 natural_chord(Vec3 strain, double h)
{
    double half2 = vec3_dot(strain, strain) * h * h / 4, half = sqrt(half2);
    double lost_of_half2 = half2 < 1e-4 ? (1 - half2 / 20) / 6 : (1 - sin(half) / half) / half2;
    double sinc = 1 - half2 * lost_of_half2;
    return vec3_axpy(lost_of_half2 * h * h / 4 * strain.x, strain, vec3(sinc, 0, 0));
}

/* Rotation from the middle of the element before (the clamp, for the first) to that of element e of so many (the end,
 * behind the last). */
static Quat rotation_to(const Vec3 *strain, int e, int elements, double h)
{
    Quat before = e == 0 ? quat_identity() : quat_exp(vec3_scale(h / 2, strain[e - 1]));
    if (e == elements) return before;
    Quat half = quat_exp(vec3_scale(h / 2, strain[e]));
    return e == 0 ? half : quat_mul(before, half);
}

static void allocate(PbdRod *rod)
{
    size_t elements = (size_t)rod->elements, nodes = elements + 1;
    rod->force = mem_alloc(nodes, sizeof *rod->force);
    rod->inverse_mass = mem_alloc(nodes, sizeof *rod->inverse_mass);
    rod->chord = mem_alloc(elements, sizeof *rod->chord);
    rod->turn = mem_alloc(nodes, sizeof *rod->turn);
    rod->x = mem_alloc(nodes, sizeof *rod->x);
    rod->x_before = mem_alloc(nodes, sizeof *rod->x_before);
    rod->v = mem_alloc(nodes, sizeof *rod->v);
    rod->q = mem_alloc(elements, sizeof *rod->q);
    rod->q_before = mem_alloc(elements, sizeof *rod->q_before);
    rod->spin = mem_alloc(elements, sizeof *rod->spin);
    rod->stretch_load = mem_alloc(elements, sizeof *rod->stretch_load);
    rod->turn_load = mem_alloc(nodes, sizeof *rod->turn_load);
}

void pbd_rod_destroy(PbdRod *rod)
{
    void *blocks[] = {rod->force,     rod->magnet, rod->inverse_mass,
                      rod->chord,     rod->turn,   rod->x,
                      rod->x_before,  rod->v,      rod->q,
                      rod->q_before,  rod->spin,   rod->stretch_load,
                      rod->turn_load, rod};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) mem_free(blocks[k]);
}

static void fill_nodes(PbdRod *rod, const PbdRodDef *def)
{
    int last = rod->elements;
    for (int i = 0; i <= last; i++) {
        bool held = (i == 0 && def->start != ROD_FREE) || (i == last && def->end != ROD_FREE);
        rod->inverse_mass[i] = held ? 0 : (i == 0 || i == last ? 2 : 1) / rod->mass;
        if (def->force) rod->force[i] = def->force[i];
        if (def->start_places) rod->x[i] = def->start_places[i];
    }
}

static void fill_elements(PbdRod *rod, const PbdRodDef *def)
{
    const Vec3 *start = def->start_strain ? def->start_strain : def->natural_strain;
    double h = rod->h;
    int n = rod->elements;
    if (!def->start_places) rod->x[0] = def->position;
    for (int e = 0; e <= n; e++) rod->turn[e] = rotation_to(def->natural_strain, e, n, h);
    for (int e = 0; e < n; e++) {
        rod->chord[e] = natural_chord(def->natural_strain[e], h);
        rod->q[e] = quat_mul(e == 0 ? rod->clamp : rod->q[e - 1], rotation_to(start, e, n, h));
        if (def->start_places) continue;
        rod->x[e + 1] = vec3_axpy(h, quat_rotate(rod->q[e], rod->chord[e]), rod->x[e]);
    }
}

PbdRod *pbd_rod_create(const PbdRodDef *def)
{
    const double reach = 2; /* see the header; in parts of h */
    PbdRod *rod = mem_alloc(1, sizeof *rod);
    int n = def->elements;
    double h = def->length / n, m = def->section.mass * h;
    *rod = (PbdRod){.elements = n,
                    .substeps = def->substeps,
                    .sweeps = def->sweeps,
                    .start = def->start,
                    .end = def->end,
                    .h = h,
                    .drag = def->drag,
                    .gravity = def->gravity,
                    .mass = m,
                    .inverse_inertia = 1 / (reach * reach * m * h * h),
                    .stretch_compliance =
                        vec3(1 / (def->stretch.x * h), 1 / (def->stretch.y * h), 1 / (def->stretch.z * h)),
                    .turn_compliance = vec3(h / (4 * def->section.twist), h / (4 * def->section.bend1),
                                            h / (4 * def->section.bend2)),
                    .clamp = def->clamp,
                    .end_frame = def->end_frame};
    if (def->magnet) rod->magnet = mem_copy(def->magnet, (size_t)n, sizeof *rod->magnet);
    allocate(rod);
    fill_nodes(rod, def);
    fill_elements(rod, def);
    return rod;
}

/* By the small angle in its own frame. */
static Quat turned(Quat q, Vec3 angle)
{
    double e = vec3_dot(angle, angle) / 4, f = e < 1e-5 ? 1 - e * (0.5 - e * 0.375) : 1 / sqrt(1 + e);
    return quat_mul(q, (Quat){f, vec3_scale(f / 2, angle)});
}

/* Of an element: over h, in its frame. */
static Vec3 chord_of(const PbdRod *rod, int e)
{
    Vec3 chord = vec3_scale(1 / rod->h, vec3_sub(rod->x[e + 1], rod->x[e]));
    return quat_rotate(quat_conj(rod->q[e]), chord);
}

/* The rotation to an element (or the end, behind the last) from the one before, of the two quaternions that mean it the
 * one near the natural rotation: all four components decide, or a rod bent beyond straight takes its mirror image for its
 * natural shape. */
static Quat turn_to(const PbdRod *rod, int e)
{
    Quat p = quat_mul(quat_conj(e == 0 ? rod->clamp : rod->q[e - 1]),
                      e == rod->elements ? rod->end_frame : rod->q[e]);
    return quat_dot(p, rod->turn[e]) < 0 ? (Quat){-p.w, vec3_scale(-1, p.v)} : p;
}

/* (c + a + b |y|^2 - b y y^T)^-1 r, by Sherman and Morrison's formula. */
static Vec3 solve_chord(Vec3 c, double a, double b, Vec3 y, Vec3 r)
{
    double all = a + b * vec3_dot(y, y);
    Vec3 to = vec3(r.x / (all + c.x), r.y / (all + c.y), r.z / (all + c.z)),
         own = vec3(y.x / (all + c.x), y.y / (all + c.y), y.z / (all + c.z));
    return vec3_axpy(b * vec3_dot(y, to) / (1 - b * vec3_dot(y, own)), own, to);
}

/* The forces act on the true chord, not on the frame's tangent: with the torque they are in balance, and the
 * step along the chord is not held back by the inertia against turning. */
static void solve_stretch(PbdRod *rod, int e, double dt2)
{
    Vec3 y = chord_of(rod, e), *load = &rod->stretch_load[e];
    Vec3 c = rod->stretch_compliance, r = vec3_sub(rod->chord[e], y);
    r = vec3(r.x - c.x * load->x, r.y - c.y * load->y, r.z - c.z * load->z);
    double w0 = dt2 / rod->h * rod->inverse_mass[e], w1 = dt2 / rod->h * rod->inverse_mass[e + 1];
    double a = (w0 + w1) / rod->h, b = dt2 * rod->inverse_inertia;
    Vec3 step = solve_chord(c, a, b, y, r);
    Vec3 push = quat_rotate(rod->q[e], step);
    *load = vec3_add(*load, step);
    rod->x[e] = vec3_axpy(-w0, push, rod->x[e]);
    rod->x[e + 1] = vec3_axpy(w1, push, rod->x[e + 1]);
    rod->q[e] = turned(rod->q[e], vec3_scale(b, vec3_cross(step, y)));
}

static void solve_turn(PbdRod *rod, int e, double dt2)
{
    bool ends = e == rod->elements, clamped = e == 0 || ends;
    double part = clamped ? 0.5 : 1, b = dt2 * rod->inverse_inertia, a = clamped ? b / 4 : b / 2;
    Quat p = turn_to(rod, e);
    Vec3 C = vec3_sub(p.v, rod->turn[e].v), *load = &rod->turn_load[e];
    Vec3 c = vec3_scale(part, rod->turn_compliance);
    Vec3 step = vec3(-(C.x + c.x * load->x) / (a + c.x), -(C.y + c.y * load->y) / (a + c.y),
                     -(C.z + c.z * load->z) / (a + c.z));
    *load = vec3_add(*load, step);
    Vec3 along = vec3_scale(p.w * b / 2, step), across = vec3_scale(b / 2, vec3_cross(p.v, step));
    if (!ends) rod->q[e] = turned(rod->q[e], vec3_sub(along, across));
    if (e > 0) rod->q[e - 1] = turned(rod->q[e - 1], vec3_scale(-1, vec3_add(along, across)));
}

static void sweep(PbdRod *rod, bool backwards, double dt2)
{
    int last = rod->elements - 1, first = rod->start == ROD_CLAMPED ? 0 : 1;
    if (backwards && rod->end == ROD_CLAMPED) solve_turn(rod, rod->elements, dt2);
    for (int k = 0; k <= last; k++) {
        int e = backwards ? last - k : k;
        if (backwards) solve_stretch(rod, e, dt2);
        if (e >= first) solve_turn(rod, e, dt2);
        if (!backwards) solve_stretch(rod, e, dt2);
    }
    if (!backwards && rod->end == ROD_CLAMPED) solve_turn(rod, rod->elements, dt2);
}

/* Couples of magnets, in their frames. */
static void turn_magnets(PbdRod *rod, double dt)
{
    for (int e = 0; rod->magnet && e < rod->elements; e++) {
        Vec3 B = quat_rotate(quat_conj(rod->q[e]), rod->flux_density);
        rod->spin[e] = vec3_axpy(dt * rod->inverse_inertia, vec3_cross(rod->magnet[e], B), rod->spin[e]);
    }
}

/* That part of the way that is left. */
static void lead_ends(PbdRod *rod, double part)
{
    for (int k = 0; k < 2; k++) {
        const Goal *goal = &rod->goal[k];
        Vec3 *x = &rod->x[k ? rod->elements : 0];
        Quat *frame = k ? &rod->end_frame : &rod->clamp;
        if (!goal->given) continue;
        bool clamped = (k ? rod->end : rod->start) == ROD_CLAMPED;
        Vec3 turn = vec3_scale(part, quat_log(quat_mul(quat_conj(*frame), goal->frame)));
        *x = part < 1 ? vec3_axpy(part, vec3_sub(goal->place, *x), *x) : goal->place;
        if (clamped) *frame = part < 1 ? quat_unit(quat_mul(*frame, quat_exp(turn))) : goal->frame;
    }
}

/* The ends go by that part of what is left of their way. */
static void substep(PbdRod *rod, double dt, double part)
{
    double slowed = 1 / (1 + rod->drag * dt);
    for (int i = 0; i <= rod->elements; i++) {
        rod->x_before[i] = rod->x[i];
        if (rod->inverse_mass[i] == 0) continue;
        Vec3 rate = vec3_axpy(rod->inverse_mass[i], rod->force[i], rod->gravity);
        rod->x[i] = vec3_axpy(dt * slowed, vec3_axpy(dt, rate, rod->v[i]), rod->x[i]);
    }
    lead_ends(rod, part);
    turn_magnets(rod, dt);
    for (int e = 0; e < rod->elements; e++) {
        rod->q_before[e] = rod->q[e];
        rod->q[e] = quat_unit(quat_mul(rod->q[e], quat_exp(vec3_scale(dt * slowed, rod->spin[e]))));
        rod->stretch_load[e] = rod->turn_load[e] = vec3(0, 0, 0);
    }
    rod->turn_load[rod->elements] = vec3(0, 0, 0);
    for (int k = 0; k < rod->sweeps; k++) sweep(rod, (k % 2 == 1) != rod->backwards, dt * dt * slowed);
    rod->backwards = !rod->backwards;
    for (int i = 0; i <= rod->elements; i++)
        rod->v[i] = vec3_scale(1 / dt, vec3_sub(rod->x[i], rod->x_before[i]));
    for (int e = 0; e < rod->elements; e++) {
        Quat step = quat_mul(quat_conj(rod->q_before[e]), rod->q[e]);
        rod->spin[e] = vec3_scale((step.w < 0 ? -2 : 2) / dt, step.v);
    }
}

void pbd_rod_step(PbdRod *rod, double dt)
{
    for (int k = 0; k < rod->substeps; k++) substep(rod, dt / rod->substeps, 1.0 / (rod->substeps - k));
}

void pbd_rod_set_field(PbdRod *rod, Vec3 flux_density)
{
    rod->flux_density = flux_density;
}

void pbd_rod_lead(PbdRod *rod, bool last, Vec3 place, Quat frame)
{
    rod->goal[last] = (Goal){true, place, frame};
}

const Vec3 *pbd_rod_positions(const PbdRod *rod)
{
    return rod->x;
}

const Vec3 *pbd_rod_velocities(const PbdRod *rod)
{
    return rod->v;
}

int pbd_rod_state_count(int elements)
{
    return 6 * (elements + 1) + 7 * elements + 1;
}

void pbd_rod_get_state(const PbdRod *rod, double *state)
{
    int nodes = rod->elements + 1;
    double *v = state + 3 * nodes, *q = v + 3 * nodes, *spin = q + 4 * rod->elements;
    for (int i = 0; i < nodes; i++) {
        vec3_store(state + 3 * i, rod->x[i]);
        vec3_store(v + 3 * i, rod->v[i]);
    }
    for (int e = 0; e < rod->elements; e++) {
        q[4 * e] = rod->q[e].w;
        vec3_store(q + 4 * e + 1, rod->q[e].v);
        vec3_store(spin + 3 * e, rod->spin[e]);
    }
    spin[3 * rod->elements] = rod->backwards;
}

void pbd_rod_set_state(PbdRod *rod, const double *state)
{
    int nodes = rod->elements + 1;
    const double *v = state + 3 * nodes, *q = v + 3 * nodes, *spin = q + 4 * rod->elements;
    for (int i = 0; i < nodes; i++) {
        rod->x[i] = vec3_load(state + 3 * i);
        rod->v[i] = vec3_load(v + 3 * i);
    }
    for (int e = 0; e < rod->elements; e++) {
        rod->q[e] = (Quat){q[4 * e], vec3_load(q + 4 * e + 1)};
        rod->spin[e] = vec3_load(spin + 3 * e);
    }
    rod->backwards = spin[3 * rod->elements] != 0;
}

void pbd_rod_frames(const PbdRod *rod, RodFrame *frames)
{
    for (int e = 0; e < rod->elements; e++)
        frames[e] = (RodFrame){quat_rotate(rod->q[e], vec3(1, 0, 0)), quat_rotate(rod->q[e], vec3(0, 1, 0)),
                               quat_rotate(rod->q[e], vec3(0, 0, 1))};
}

void pbd_rod_stretches(const PbdRod *rod, Vec3 *strain)
{
    for (int e = 0; e < rod->elements; e++) strain[e] = vec3_sub(chord_of(rod, e), rod->chord[e]);
}

/* r.r/c, component by component. */
static double square_over(Vec3 r, Vec3 c)
{
    return r.x * r.x / c.x + r.y * r.y / c.y + r.z * r.z / c.z;
}

static double turn_energy(const PbdRod *rod, int e)
{
    bool ends = e == rod->elements;
    if ((e == 0 && rod->start != ROD_CLAMPED) || (ends && rod->end != ROD_CLAMPED)) return 0;
    Vec3 turn = vec3_sub(turn_to(rod, e).v, rod->turn[e].v);
    return square_over(turn, vec3_scale(e == 0 || ends ? 1 : 2, rod->turn_compliance));
}

PbdRodSums pbd_rod_sums(const PbdRod *rod)
{
    PbdRodSums sums = {0};
    int last = rod->elements;
    for (int i = 0; i <= last; i++) {
        double m = i == 0 || i == last ? rod->mass / 2 : rod->mass;
        Vec3 momentum = vec3_scale(m, rod->v[i]);
        sums.kinetic += vec3_dot(momentum, rod->v[i]) / 2;
        sums.potential -= vec3_dot(vec3_axpy(m, rod->gravity, rod->force[i]), rod->x[i]);
        sums.momentum = vec3_add(sums.momentum, momentum);
        sums.spin = vec3_add(sums.spin, vec3_cross(rod->x[i], momentum));
    }
    for (int e = 0; e < last; e++) {
        sums.kinetic += vec3_dot(rod->spin[e], rod->spin[e]) / (2 * rod->inverse_inertia);
        sums.spin = vec3_axpy(1 / rod->inverse_inertia, quat_rotate(rod->q[e], rod->spin[e]), sums.spin);
        sums.elastic += square_over(vec3_sub(chord_of(rod, e), rod->chord[e]), rod->stretch_compliance) / 2;
        if (rod->magnet) sums.magnetic -= vec3_dot(quat_rotate(rod->q[e], rod->magnet[e]), rod->flux_density);
    }
    for (int e = 0; e <= last; e++) sums.elastic += turn_energy(rod, e);
    return sums;
}
