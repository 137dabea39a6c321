#include "rod/identify.h"
#include "base/memory.h"

static const double poisson_least = -0.9, poisson_most = 0.5;

/* What is minimised: the mean over s of the sum over poses of the squared distances. */
typedef struct Match {
    const RodIdentifyDef *def;
    int nodes;
    RodFrame *clamps; /* [poses] */
    Vec3 **moments;   /* [poses][stations] of the weight                              */
    Vec3 **shapes;    /* [poses][nodes] natural shapes seen from the clamp, the last  */
    Vec3 *residuals;  /* [poses * nodes] times the root of the node's weight          */
    Vec3 *others, *slopes[2];
    double length, size; /* of the rod; mean square distance of the shapes from the clamp    */
} Match;

/* Unknowns. */
typedef struct Guess {
    double log_young, poisson;
} Guess;

static bool frame_is_sound(RodFrame f)
{
    Vec3 n2 = vec3_sub(vec3_cross(f.n0, f.n1), f.n2), n0 = vec3_sub(vec3_cross(f.n1, f.n2), f.n0);
    return fabs(vec3_length(f.n0) - 1) < 0.02 && vec3_length(n2) < 0.02 && vec3_length(n0) < 0.02;
}

/* N, whatever the directions; of couples a force at the end that has them at the clamp. */
static double total_load(const RodIdentifyDef *def)
{
    const RodPose *first = &def->poses[0];
    double length = first->curve->length, part = length / (2 * first->curve->elements + 1);
    double sum = vec3_length(def->loads.line) * length + vec3_length(def->loads.end);
    for (int k = 0; k < def->loads.point_count; k++)
        sum += vec3_length(def->loads.points[k].force) + vec3_length(def->loads.points[k].couple) / length;
    for (int j = 0; first->along && j <= 2 * first->curve->elements; j++)
        sum += part * vec3_length(first->along[j]);
    return sum;
}

bool rod_identify_check(const RodIdentifyDef *def, Error *err)
{
    if (def->pose_count < 2) return error_set(err, "a material needs two poses of the rod or more");
    if (!(total_load(def) * def->radius > 0))
        return error_set(err, "a material needs a rod that has weight or loads, and a radius");
    const RodCurve *first = def->poses[0].curve;
    for (int p = 0; p < def->pose_count; p++) {
        const RodPose *pose = &def->poses[p];
        if (pose->curve->elements != first->elements)
            return error_set(err, "pose %d has %d elements, the first one %d", p + 1, pose->curve->elements,
                             first->elements);
        if (!(fabs(pose->curve->length - first->length) < 0.02 * first->length))
            return error_set(err, "pose %d is %g m long and the first one %g m: not the same rod", p + 1,
                             pose->curve->length, first->length);
        if (!frame_is_sound(pose->clamp))
            return error_set(
                err, "the frame of pose %d is not three unit vectors at right angles, right-handed", p + 1);
        double cosine = vec3_dot(vec3_unit(pose->clamp.n0), pose->curve->t[0]);
        if (cosine < cos(30 * M_PI / 180))
            return error_set(err, "the tangent in the frame of pose %d is %.0f degrees off the curve's",
                             p + 1, acos(fmax(cosine, -1)) * 180 / M_PI);
    }
    return true;
}

static RodFrame orthonormal(RodFrame f)
{
    Vec3 n0 = vec3_unit(f.n0), n1 = vec3_unit(vec3_axpy(-vec3_dot(f.n1, n0), n0, f.n1));
    return (RodFrame){n0, n1, vec3_cross(n0, n1)};
}

/* The loads on a pose, whose length is measured: what acts at the end acts at its end. */
static void find_moments(const RodPose *pose, RodLoads loads, Vec3 *moment)
{
    RodPointLoad *points = mem_alloc((size_t)loads.point_count, sizeof *points);
    for (int k = 0; k < loads.point_count; k++) {
        points[k] = loads.points[k];
        points[k].s = fmin(points[k].s, pose->curve->length);
    }
    loads.points = points, loads.along = pose->along;
    rod_moments(pose->curve, loads, moment);
    mem_free(points);
}

static Match match_create(const RodIdentifyDef *def)
{
    size_t poses = (size_t)def->pose_count, nodes = (size_t)def->poses[0].curve->elements + 1;
    Match m = {.def = def, .nodes = (int)nodes, .length = def->poses[0].curve->length};
    m.clamps = mem_alloc(poses, sizeof *m.clamps);
    m.moments = mem_alloc(poses, sizeof *m.moments);
    m.shapes = mem_alloc(poses, sizeof *m.shapes);
    m.residuals = mem_alloc(poses * nodes, sizeof *m.residuals);
    m.others = mem_alloc(poses * nodes, sizeof *m.others);
    for (int i = 0; i < 2; i++) m.slopes[i] = mem_alloc(poses * nodes, sizeof *m.slopes[i]);
    for (size_t p = 0; p < poses; p++) {
        m.clamps[p] = orthonormal(def->poses[p].clamp);
        m.moments[p] = mem_alloc(2 * nodes - 1, sizeof *m.moments[p]);
        m.shapes[p] = mem_alloc(nodes, sizeof *m.shapes[p]);
        find_moments(&def->poses[p], def->loads, m.moments[p]);
    }
    return m;
}

static void match_clear(Match *m)
{
    for (int p = 0; p < m->def->pose_count; p++) {
        mem_free(m->moments[p]);
        mem_free(m->shapes[p]);
    }
    mem_free(m->clamps);
    mem_free(m->moments);
    mem_free(m->shapes);
    mem_free(m->residuals);
    mem_free(m->others);
    for (int i = 0; i < 2; i++) mem_free(m->slopes[i]);
}

/* The trapezoidal rule's, for a mean. */
static double node_weight(const Match *m, int i)
{
    return (i == 0 || i == m->nodes - 1 ? 0.5 : 1) / (m->nodes - 1);
}

/* Residuals of a guess; returns the sum of their squares. */
static double match_residuals(Match *m, Guess guess, Vec3 *residuals)
{
    int poses = m->def->pose_count;
    RodSection section = rod_circle(m->def->radius, exp(guess.log_young), guess.poisson, 0);
    for (int p = 0; p < poses; p++) {
        Vec3 *shape = m->shapes[p], start = m->def->poses[p].curve->x[0];
        rod_invert(m->def->poses[p].curve, section, m->moments[p], NULL, shape);
        for (int i = 0; i < m->nodes; i++) shape[i] = rod_to_frame(m->clamps[p], vec3_sub(shape[i], start));
    }
    double sum = 0;
    m->size = 0;
    for (int i = 0; i < m->nodes; i++) {
        Vec3 mean = vec3(0, 0, 0);
        double root = sqrt(node_weight(m, i));
        for (int p = 0; p < poses; p++) mean = vec3_axpy(1.0 / poses, m->shapes[p][i], mean);
        for (int p = 0; p < poses; p++) {
            Vec3 r = vec3_scale(root, vec3_sub(m->shapes[p][i], mean));
            residuals[p * m->nodes + i] = r;
            sum += vec3_dot(r, r);
        }
        m->size += poses * root * root * vec3_dot(mean, mean);
    }
    return sum;
}

static double product(const Match *m, const Vec3 *a, const Vec3 *b)
{
    double sum = 0;
    for (int k = 0; k < m->def->pose_count * m->nodes; k++) sum += vec3_dot(a[k], b[k]);
    return sum;
}

/* Derivatives of the residuals by the two unknowns, by central differences. */
static void match_slopes(Match *m, Guess guess)
{
    const double step = 1e-4;
    for (int i = 0; i < 2; i++) {
        Guess more = guess, less = guess;
        *(i == 0 ? &more.log_young : &more.poisson) += step;
        *(i == 0 ? &less.log_young : &less.poisson) -= step;
        match_residuals(m, more, m->slopes[i]);
        match_residuals(m, less, m->others);
        for (int k = 0; k < m->def->pose_count * m->nodes; k++)
            m->slopes[i][k] = vec3_scale(0.5 / step, vec3_sub(m->slopes[i][k], m->others[k]));
    }
}

/* Gauss-Newton's H = [a b; b c] and gradient (g, k) in (log E, nu). */
typedef struct Normal {
    double a, b, c, g, k;
} Normal;

static Normal normal_equations(const Match *m)
{
    const Vec3 *r = m->residuals;
    Vec3 *const *J = m->slopes;
    return (Normal){product(m, J[0], J[0]), product(m, J[0], J[1]), product(m, J[1], J[1]),
                    product(m, J[0], r), product(m, J[1], r)};
}

/* The damped step, within the limits of nu; small additions keep it finite where nothing depends on them. */
static Guess next_guess(const Match *m, Normal n, double damping, Guess from)
{
    double tiny = pow(1e-12 * m->length, 2), a = n.a * (1 + damping) + tiny, c = n.c * (1 + damping) + tiny;
    double whole = from.poisson - (a * n.k - n.b * n.g) / (a * c - n.b * n.b);
    double poisson = fmin(fmax(whole, poisson_least), poisson_most);
    double step = -(n.g + n.b * (poisson - from.poisson)) / a;
    return (Guess){from.log_young + fmin(fmax(step, -1), 1), poisson};
}

/* Goes down to the minimum nearby; false where it has not come there. */
static bool descend(Match *m, Guess *from, int *iterations)
{
    Guess guess = *from;
    double damping = 1e-3, sum = match_residuals(m, guess, m->residuals), moved = 1;
    bool lower = true;
    match_slopes(m, guess);
    for (int k = 0; lower && k < 60 && moved > 1e-9; k++) {
        Normal n = normal_equations(m);
        Guess next = next_guess(m, n, damping, guess);
        double less = match_residuals(m, next, m->others);
        while (!(less < sum) && damping < 1e6) {
            damping *= 10;
            next = next_guess(m, n, damping, guess);
            less = match_residuals(m, next, m->others);
        }
        lower = less < sum;
        if (!lower) break;
        moved = fabs(next.log_young - guess.log_young) + fabs(next.poisson - guess.poisson);
        guess = next, damping = fmax(damping / 10, 1e-12);
        sum = match_residuals(m, guess, m->residuals);
        match_slopes(m, guess);
        ++*iterations;
    }
    *from = guess;
    return !lower || moved <= 1e-9;
}

enum { SCAN = 49, STARTS = 3 }; /* eight steps per decade of E */

typedef struct Start {
    Guess guess;
    double relative; /* squared distance over squared size */
} Start;

static Start scan_at(Match *m, double log_young)
{
    Start best = {.relative = INFINITY};
    for (int k = 0; k < 3; k++) {
        Guess guess = {log_young, 0.25 * k};
        double relative = match_residuals(m, guess, m->others) / m->size;
        if (relative < best.relative) best = (Start){guess, relative};
    }
    return best;
}

/* The lowest places of the scan that are lower than their neighbours; returns how many. */
static int scan(Match *m, Start *starts)
{
    Start row[SCAN];
    double inertia = M_PI * pow(m->def->radius, 4) / 4;
    double middle = log(total_load(m->def) * pow(m->length, 2) / inertia);
    int count = 0;
    for (int k = 0; k < SCAN; k++) row[k] = scan_at(m, middle + (k - SCAN / 2) * log(10) / 8);
    for (int k = 0; k < SCAN; k++) {
        if ((k > 0 && row[k - 1].relative < row[k].relative) ||
            (k + 1 < SCAN && row[k + 1].relative < row[k].relative))
            continue;
        int at = count < STARTS ? count++ : STARTS;
        while (at > 0 && row[k].relative < starts[at - 1].relative) {
            if (at < STARTS) starts[at] = starts[at - 1];
            at--;
        }
        if (at < STARTS) starts[at] = row[k];
    }
    return count;
}

/* What the normal equations at the minimum say of both numbers; c is what nu's slope is worth beside an
 * unknown E. */
static void judge(const Match *m, Guess guess, double sum, RodMaterial *material)
{
    Normal n = normal_equations(m);
    double least = pow(1e-6 * m->length, 2); /* slopes below are rounding and quadrature */
    double freedom = fmax(1, 3 * (m->def->pose_count - 1) - 2), variance = sum / freedom;
    double c = n.a > 0 ? n.c - n.b * n.b / n.a : 0;
    bool at_limit = guess.poisson == poisson_least || guess.poisson == poisson_most;
    /* What E's slope is worth beside an unknown nu; all of it where nu is held, or tells nothing. */
    double a = at_limit || c <= least ? n.a : n.a - n.b * n.b / n.c;
    double young_error = a > least ? sqrt(variance / a) : INFINITY,
           poisson_error = a > least && c > least ? sqrt(variance / c) : INFINITY;
    material->young_known = young_error < 1.0 / 3, material->poisson_known = poisson_error < 0.3;
    material->young = material->young_known ? exp(guess.log_young) : NAN;
    material->young_error = material->young_known ? young_error * material->young : INFINITY;
    material->poisson = material->poisson_known ? guess.poisson : NAN;
    material->poisson_error = material->poisson_known ? poisson_error : INFINITY;
    material->poisson_at_limit = material->poisson_known && at_limit;
}

RodMaterial rod_identify(const RodIdentifyDef *def)
{
    RodMaterial material = {0};
    Match m = match_create(def);
    Start starts[STARTS], best = {.relative = INFINITY};
    int count = scan(&m, starts);
    for (int k = 0; k < count; k++) {
        Guess guess = starts[k].guess;
        bool converged = descend(&m, &guess, &material.iterations);
        double relative = match_residuals(&m, guess, m.residuals) / m.size;
        if (!(relative < best.relative)) continue;
        best = (Start){guess, relative};
        material.converged = converged;
    }
    double sum = match_residuals(&m, best.guess, m.residuals);
    match_slopes(&m, best.guess);
    material.distance = sqrt(sum / def->pose_count);
    judge(&m, best.guess, sum, &material);
    match_clear(&m);
    return material;
}
