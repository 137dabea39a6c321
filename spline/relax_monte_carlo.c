/* Simulated annealing with the six moves of Linewise. Each move has its inverse among the moves with the same
 * probability, and the change of volume of those that scale enters Metropolis' rule [Hastings 1970], so that
 * at one temperature strokes have the distribution exp(-E/T) over their dofs. The sizes of moves adapt
 * themselves between temperatures only. */
#include "base/memory.h"
#include "base/random.h"
#include "spline/local.h"
#include "spline/relax_private.h"
#include <math.h>

typedef struct Vary {
    Random random;
    double length; /* of a way of size 1, units of the page */
    int nodes;
    double (*q)[4]; /* [nodes] */
} Vary;

/* [Box and Muller 1958] */
static double gaussian(Random *random)
{
    double u = 1 - random_uniform(random), v = random_uniform(random);
    return sqrt(-2 * log(u)) * cos(2 * M_PI * v);
}

static void turn_vector(double *a, double angle)
{
    double x = a[0], y = a[1];
    a[0] = cos(angle) * x - sin(angle) * y;
    a[1] = sin(angle) * x + cos(angle) * y;
}

static void turn_about(double *p, Vec2 center, double angle)
{
    p[0] -= center.x, p[1] -= center.y;
    turn_vector(p, angle);
    p[0] += center.x, p[1] += center.y;
}

/* Moves return the logarithm of the factor by which they change volumes of the space of dofs. */
typedef double Move(Vary *s, double size);

static double translate(Vary *s, double size)
{
    double x = size * s->length * gaussian(&s->random), y = size * s->length * gaussian(&s->random);
    for (int k = 0; k < s->nodes; k++) s->q[k][0] += x, s->q[k][1] += y;
    return 0;
}

/* About the mean of the nodes, which stays where it is (that of the bounding box does not). */
static double rotate(Vary *s, double size)
{
    double angle = M_PI * size * gaussian(&s->random);
    Vec2 center = {0, 0};
    for (int k = 0; k < s->nodes; k++) center.x += s->q[k][0] / s->nodes, center.y += s->q[k][1] / s->nodes;
    for (int k = 0; k < s->nodes; k++) {
        turn_about(s->q[k], center, angle);
        turn_vector(s->q[k] + 2, angle);
    }
    return 0;
}

/* About the middle of its chord; its tangents by parts of the angle, half of it in the mean. (By half of it
 * always, as Linewise does, the alternating sum of the angles of an even number of nodes would never change.)
 */
static double rotate_segment(Vary *s, double size)
{
    int first = (int)(random_uniform(&s->random) * (s->nodes - 1));
    double angle = M_PI * size * gaussian(&s->random), *a = s->q[first], *b = s->q[first + 1];
    Vec2 center = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    turn_about(a, center, angle);
    turn_about(b, center, angle);
    turn_vector(a + 2, angle * random_uniform(&s->random));
    turn_vector(b + 2, angle * random_uniform(&s->random));
    return 0;
}

static double scale_tangents(Vary *s, double size)
{
    double u = size * gaussian(&s->random);
    for (int k = 0; k < s->nodes; k++) s->q[k][2] *= exp(u), s->q[k][3] *= exp(u);
    return 2 * s->nodes * u;
}

static double scale_each_tangent(Vary *s, double size)
{
    double sum = 0;
    for (int k = 0; k < s->nodes; k++) {
        double u = size * gaussian(&s->random);
        s->q[k][2] *= exp(u), s->q[k][3] *= exp(u);
        sum += 2 * u;
    }
    return sum;
}

/* About the middle between the ends, whose two coordinates stay. */
static double stretch(Vary *s, double size)
{
    double u = size * gaussian(&s->random), *a = s->q[0], *b = s->q[s->nodes - 1];
    double center[2] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    for (int k = 0; k < s->nodes; k++)
        for (int i = 0; i < 2; i++) {
            s->q[k][i] = center[i] + exp(u) * (s->q[k][i] - center[i]);
            s->q[k][2 + i] *= exp(u);
        }
    return (4 * s->nodes - 2) * u;
}

static Move *const moves[] = {translate, rotate, rotate_segment, scale_tangents, scale_each_tangent, stretch};

enum { MOVES = sizeof moves / sizeof *moves };

static const double FIRST_SIZE = 0.1, LEAST_SIZE = 1e-4;

typedef struct Annealing {
    Relaxation *r;
    Local *local;
    Vary vary;
    double size[MOVES];
    int tried[MOVES], taken[MOVES];
} Annealing;

/* One try at a random stroke; returns the change of the energy. */
static double try_move(Annealing *a, double T)
{
    Relaxation *r = a->r;
    Vary *vary = &a->vary;
    int stroke = (int)(random_uniform(&vary->random) * r->model->stroke_count);
    int kind = (int)(random_uniform(&vary->random) * MOVES);
    double *at = r->strokes->q + 4 * r->model->start[stroke];
    vary->nodes = r->model->start[stroke + 1] - r->model->start[stroke];
    size_t bytes = (size_t)vary->nodes * sizeof *vary->q;
    memcpy(vary->q, at, bytes);
    double volume = moves[kind](vary, a->size[kind]);
    double change = local_change(a->local, stroke, vary->q[0]);
    a->tried[kind]++;
    if (!(log(1 - random_uniform(&vary->random)) < volume - change / T)) {
        local_reject(a->local);
        return 0;
    }
    local_accept(a->local);
    memcpy(at, vary->q, bytes);
    a->taken[kind]++;
    return change;
}

/* Bold where nearly all is taken, timid where hardly anything is. */
static void adapt_sizes(Annealing *a)
{
    for (int k = 0; k < MOVES; k++) {
        double rejected = a->tried[k] ? 1 - (double)a->taken[k] / a->tried[k] : 0.55;
        if (rejected < 0.5) a->size[k] *= 1.4;
        if (rejected > 0.6) a->size[k] /= 1.4;
        a->size[k] = fmin(fmax(a->size[k], LEAST_SIZE), 1);
        a->tried[k] = a->taken[k] = 0;
    }
}

static double acceptance(const Annealing *a)
{
    double tried = 0, taken = 0;
    for (int k = 0; k < MOVES; k++) tried += a->tried[k], taken += a->taken[k];
    return tried > 0 ? taken / tried : 0;
}

/* The energy by the system: round-off does not gather. */
static bool settle_accounts(Annealing *a)
{
    Point at = relax_point(a->r, a->r->strokes->q);
    bool finite = system_energy(a->r->sys, &at).finite;
    a->r->info.evaluations++;
    relax_take_energies(a->r);
    local_renew(a->local);
    return finite;
}

/* Sweeps at one temperature; false when the observer stops it. */
static bool anneal(Annealing *a, double T)
{
    Relaxation *r = a->r;
    for (int sweep = 0; sweep < r->def->sweeps; sweep++) {
        for (int k = 0; k < r->model->stroke_count; k++)
            r->info.energy += try_move(a, T * r->target->spacing);
        r->info.iterations++;
        r->info.temperature = T;
        r->info.acceptance = acceptance(a);
        if (sweep == r->def->sweeps - 1) settle_accounts(a);
        if (!relax_tell(r)) return false;
    }
    adapt_sizes(a);
    return true;
}

void relax_monte_carlo(Relaxation *r)
{
    Annealing a = {.r = r, .local = local_create(r->model, &r->weights, r->strokes->q, NULL)};
    a.vary = (Vary){random_seed(r->def->seed), r->target->spacing, 0,
                    mem_alloc((size_t)r->model->node_count, sizeof *a.vary.q)};
    for (int k = 0; k < MOVES; k++) a.size[k] = FIRST_SIZE;
    r->info.status = settle_accounts(&a) ? RELAX_MAX_ITERATIONS : RELAX_NOT_FINITE;
    int steps = r->def->temperatures;
    double first = r->def->temperature_first, ratio = r->def->temperature_last / first;
    for (int k = 0; k < steps && r->info.status == RELAX_MAX_ITERATIONS; k++)
        if (!anneal(&a, first * pow(ratio, steps > 1 ? (double)k / (steps - 1) : 0)))
            r->info.status = RELAX_STOPPED;
    mem_free(a.vary.q);
    local_destroy(a.local);
}
