#include "rod/identify.h"
#include "base/memory.h"

static const double poisson_least = -0.9, poisson_most = 0.5;

/* What is minimised: the mean over s of the sum over poses of the squared distances. */
typedef struct Match {
    const RodIdentifyDef *def;
    int nodes;
    const RodCurve **curves; /* [poses] borrowed: the poses', or a draw of them, and             */
    const Vec3 **along;      /* [poses] the loads that vary along it; NULL: none                 */
    RodFrame *clamps;        /* [poses] */
    Vec3 **moments;          /* [poses][stations] of all loads                               */
    Vec3 **shapes;           /* [poses][nodes] natural shapes seen from the clamp, the last  */
    Vec3 *residuals;         /* [poses * nodes] times the root of the node's weight          */
    Vec3 *others, *slopes[2];
    double least, most;  /* of Poisson's ratio: equal where it was given                      */
    double length, size; /* of the rod; mean square distance of the shapes from the clamp    */
} Match;

/* Unknowns. */
typedef struct Guess {
    double log_value, poisson;
} Guess;

RodSection rod_identify_section(const RodIdentifyDef *def, double value, double poisson)
{
    const RodSought sought = def->sought;
    return rod_circle(sought == ROD_SOUGHT_RADIUS ? value : def->radius,
                      sought == ROD_SOUGHT_YOUNG ? value : def->young, poisson,
                      sought == ROD_SOUGHT_DENSITY ? value : def->density);
}

/* What does not follow from the section. */
static RodLoads own_loads(const RodIdentifyDef *def, int pose)
{
    RodLoads loads = def->loads;
    loads.along = def->poses[pose].along;
    return loads;
}

RodLoads rod_identify_loads(const RodIdentifyDef *def, int pose, double value)
{
    RodSection section = rod_identify_section(def, value, 0.5);
    RodLoads loads = own_loads(def, pose);
    loads.line = vec3_axpy(section.mass, def->gravity, loads.line);
    loads.end = vec3_add(loads.end, vec3_scale(section.area * def->magnetization, def->flux_density));
    return loads;
}

static bool frame_is_sound(RodFrame f)
{
    Vec3 n2 = vec3_sub(vec3_cross(f.n0, f.n1), f.n2), n0 = vec3_sub(vec3_cross(f.n1, f.n2), f.n0);
    return fabs(vec3_length(f.n0) - 1) < 0.02 && vec3_length(n2) < 0.02 && vec3_length(n0) < 0.02;
}

/* N on that curve, whatever the directions; of couples a force at the end that has them at the clamp. */
static double total_load(RodLoads loads, const RodCurve *curve)
{
    int stations = 2 * curve->elements + 1;
    double length = curve->length, sum = vec3_length(loads.line) * length + vec3_length(loads.end);
    for (int k = 0; k < loads.point_count; k++)
        sum += vec3_length(loads.points[k].force) + vec3_length(loads.points[k].couple) / length;
    for (int j = 0; loads.along && j < stations; j++) sum += length / stations * vec3_length(loads.along[j]);
    return sum;
}

/* The logarithm of the value sought with which load L^2 = EI; for a radius with all of its loads or with those that do
 * not grow with it, whatever is more. */
static double middle_value(const RodIdentifyDef *def)
{
    const RodCurve *first = def->poses[0].curve;
    double length = first->length, inertia = M_PI * pow(def->radius, 4) / 4,
           area = M_PI * def->radius * def->radius;
    if (def->sought == ROD_SOUGHT_YOUNG)
        return log(total_load(rod_identify_loads(def, 0, 1), first) * pow(length, 2) / inertia);
    if (def->sought == ROD_SOUGHT_DENSITY)
        return log(def->young * inertia / (area * vec3_length(def->gravity) * pow(length, 3)));
    double grows = def->density * vec3_length(def->gravity) * length +
                   fabs(def->magnetization) * vec3_length(def->flux_density),
           stays = total_load(own_loads(def, 0), first), bend = pow(length, 2) * 4 / def->young;
    return log(fmax(sqrt(grows * bend), pow(stays / M_PI * bend, 0.25)));
}

/* By which power of the value EI changes against the weight. */
static double scan_power(const RodIdentifyDef *def)
{
    return def->sought == ROD_SOUGHT_RADIUS ? 2 : 1;
}

bool rod_identify_check(const RodIdentifyDef *def, Error *err)
{
    if (def->pose_count < 2) return error_set(err, "a material needs two poses of the rod or more");
    if (!(total_load(rod_identify_loads(def, 0, 1), def->poses[0].curve) > 0))
        return error_set(err, "a material needs a rod that has weight or loads");
    if (def->sought == ROD_SOUGHT_DENSITY && !(vec3_length(def->gravity) > 0))
        return error_set(err, "without gravity the poses do not tell density");
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
static void find_moments(const RodCurve *curve, RodLoads loads, Vec3 *moment)
{
    RodPointLoad *points = mem_alloc((size_t)loads.point_count, sizeof *points);
    for (int k = 0; k < loads.point_count; k++) {
        points[k] = loads.points[k];
        points[k].s = fmin(points[k].s, curve->length);
    }
    loads.points = points;
    rod_moments(curve, loads, moment);
    mem_free(points);
}

static void match_moments(Match *m, double value)
{
    for (int p = 0; p < m->def->pose_count; p++) {
        RodLoads loads = rod_identify_loads(m->def, p, value);
        loads.along = m->along[p];
        find_moments(m->curves[p], loads, m->moments[p]);
    }
}

static Match match_create(const RodIdentifyDef *def)
{
    size_t poses = (size_t)def->pose_count, nodes = (size_t)def->poses[0].curve->elements + 1;
    bool given = !isnan(def->poisson);
    Match m = {.def = def, .nodes = (int)nodes, .length = def->poses[0].curve->length};
    m.least = given ? def->poisson : poisson_least, m.most = given ? def->poisson : poisson_most;
    m.curves = mem_alloc(poses, sizeof *m.curves);
    m.along = mem_alloc(poses, sizeof *m.along);
    m.clamps = mem_alloc(poses, sizeof *m.clamps);
    m.moments = mem_alloc(poses, sizeof *m.moments);
    m.shapes = mem_alloc(poses, sizeof *m.shapes);
    m.residuals = mem_alloc(poses * nodes, sizeof *m.residuals);
    m.others = mem_alloc(poses * nodes, sizeof *m.others);
    for (int i = 0; i < 2; i++) m.slopes[i] = mem_alloc(poses * nodes, sizeof *m.slopes[i]);
    for (size_t p = 0; p < poses; p++) {
        m.curves[p] = def->poses[p].curve;
        m.along[p] = def->poses[p].along;
        m.clamps[p] = orthonormal(def->poses[p].clamp);
        m.moments[p] = mem_alloc(2 * nodes - 1, sizeof *m.moments[p]);
        m.shapes[p] = mem_alloc(nodes, sizeof *m.shapes[p]);
    }
    if (def->sought == ROD_SOUGHT_YOUNG) match_moments(&m, 1);
    return m;
}

static void match_clear(Match *m)
{
    for (int p = 0; p < m->def->pose_count; p++) {
        mem_free(m->moments[p]);
        mem_free(m->shapes[p]);
    }
    mem_free(m->curves);
    mem_free(m->along);
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
    double value = exp(guess.log_value);
    RodSection section = rod_identify_section(m->def, value, guess.poisson);
    if (m->def->sought != ROD_SOUGHT_YOUNG) match_moments(m, value); /* which is no load */
    for (int p = 0; p < poses; p++) {
        Vec3 *shape = m->shapes[p], start = m->curves[p]->x[0];
        rod_invert(m->curves[p], rod_alike(&section), m->moments[p], NULL, shape);
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
        *(i == 0 ? &more.log_value : &more.poisson) += step;
        *(i == 0 ? &less.log_value : &less.poisson) -= step;
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
    double poisson = fmin(fmax(whole, m->least), m->most);
    double step = -(n.g + n.b * (poisson - from.poisson)) / a;
    return (Guess){from.log_value + fmin(fmax(step, -1), 1), poisson};
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
        moved = fabs(next.log_value - guess.log_value) + fabs(next.poisson - guess.poisson);
        guess = next, damping = fmax(damping / 10, 1e-12);
        sum = match_residuals(m, guess, m->residuals);
        match_slopes(m, guess);
        ++*iterations;
    }
    *from = guess;
    return !lower || moved <= 1e-9;
}

enum { SCAN = 49, STARTS = 3 }; /* eight steps per decade of EI over the weight */

typedef struct Start {
    Guess guess;
    double relative; /* squared distance over squared size */
} Start;

static Start scan_at(Match *m, double log_value)
{
    Start best = {.relative = INFINITY};
    for (int k = 0; k < 3; k++) {
        Guess guess = {log_value, fmin(fmax(0.25 * k, m->least), m->most)};
        double relative = match_residuals(m, guess, m->others) / m->size;
        if (relative < best.relative) best = (Start){guess, relative};
    }
    return best;
}

/* The lowest places of the scan that are lower than their neighbours; returns how many. */
static int scan(Match *m, Start *starts)
{
    Start row[SCAN];
    double middle = middle_value(m->def), power = scan_power(m->def);
    int count = 0;
    for (int k = 0; k < SCAN; k++) row[k] = scan_at(m, middle + (k - SCAN / 2) * log(10) / 8 / power);
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

/* Relative variance of the value, and of nu (0 where it is held). */
typedef struct Variance {
    double value, poisson;
} Variance;

/* By the distance that is left; c is what nu's slope is worth beside an unknown value. */
static Variance left_variance(const Match *m, Normal n, double sum, bool held)
{
    double least = pow(1e-6 * m->length, 2); /* slopes below are rounding and quadrature */
    double freedom = fmax(1, 3 * (m->def->pose_count - 1) - (m->least == m->most ? 1 : 2)),
           variance = sum / freedom, c = n.a > 0 ? n.c - n.b * n.b / n.a : 0;
    /* What the value's slope is worth beside an unknown nu; all of it where nu is held, or tells nothing. */
    double a = held || c <= least ? n.a : n.a - n.b * n.b / n.c;
    if (!(a > least)) return (Variance){INFINITY, INFINITY};
    return (Variance){variance / a, c > least ? variance / c : INFINITY};
}

/* Puts a draw of their noise in the place of the poses that have noise. */
static void take_draw(Match *m, int draw)
{
    size_t stations = 2 * (size_t)m->nodes - 1;
    for (int p = 0; p < m->def->pose_count; p++) {
        const RodPose *pose = &m->def->poses[p];
        if (!pose->draws) continue;
        m->curves[p] = &pose->draws[draw];
        if (pose->along) m->along[p] = pose->along + ((size_t)draw + 1) * stations;
    }
}

/* By how far a Gauss-Newton step from the optimum goes with each draw of the poses' noise: more by as much as the distance
 * that is left, squared, is more than what noise leaves. False without noise. Leaves the moments of the last draw. */
static bool drawn_variance(Match *m, Guess guess, double sum, bool held, Variance *variance)
{
    Normal n = normal_equations(m);
    double left = 0;
    int draws = m->def->draw_count;
    *variance = (Variance){0, 0};
    for (int d = 0; d < draws; d++) {
        take_draw(m, d);
        match_moments(m, exp(guess.log_value));
        match_residuals(m, guess, m->others);
        for (int i = 0; i < m->def->pose_count * m->nodes; i++)
            m->others[i] = vec3_sub(m->others[i], m->residuals[i]);
        double g = product(m, m->slopes[0], m->others), k = product(m, m->slopes[1], m->others);
        double nu = held ? 0 : (n.a * k - n.b * g) / (n.a * n.c - n.b * n.b), value = (g - n.b * nu) / n.a;
        left += (product(m, m->others, m->others) - value * g - nu * k) / draws;
        variance->value += value * value / draws;
        variance->poisson += nu * nu / draws;
    }
    if (!(left > 0)) return false;
    double more = fmax(1, sum / left);
    variance->value *= more, variance->poisson *= more;
    return true;
}

/* Of the slopes: the root of the largest eigenvalue of H over the least. */
static double condition_of(Normal n)
{
    double mean = (n.a + n.c) / 2, off = hypot((n.a - n.c) / 2, n.b), least = mean - off;
    return least > 0 ? sqrt((mean + off) / least) : INFINITY;
}

/* What the slopes at the minimum say of both numbers. */
static void judge(Match *m, Guess guess, double sum, RodMaterial *material)
{
    Normal n = normal_equations(m);
    bool given = m->least == m->most, held = guess.poisson == m->least || guess.poisson == m->most;
    Variance left = left_variance(m, n, sum, held), drawn;
    if (!isinf(left.value) && drawn_variance(m, guess, sum, held || isinf(left.poisson), &drawn))
        left = (Variance){drawn.value, isinf(left.poisson) ? INFINITY : drawn.poisson};
    double error = sqrt(left.value), poisson_error = given ? 0 : sqrt(left.poisson);
    material->known = error < 1.0 / 3, material->poisson_known = poisson_error < 0.3;
    material->value = material->known ? exp(guess.log_value) : NAN;
    material->error = material->known ? error * material->value : INFINITY;
    material->poisson = material->poisson_known ? guess.poisson : NAN;
    material->poisson_error = material->poisson_known ? poisson_error : INFINITY;
    material->poisson_at_limit = material->poisson_known && !given && held;
    material->condition = given ? 1 : condition_of(n);
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
