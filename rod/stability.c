#include "rod/stability.h"
#include "base/memory.h"
#include "base/pack.h"
#include "rod/frame.h"

static const double BENT = 0.05; /* rad in an element: less follows from its ends */

enum { PLACES = 3, SIZE = 3 * PLACES, ELIMINATED = 6 };

/* d2E of one element is y.(stiff + load) y; of stiff the lower triangle only. y: the turns at the element's
 * end, middle and start, each in the axes of that place; in the order in which they are eliminated. */
typedef struct Element {
    double stiff[SIZE][SIZE], load[SIZE][SIZE];
} Element;

typedef struct Form {
    const RodEquilibrium *rod;
    double h;
    double softest, stiffest, inertia; /* stiffnesses; inertia: the smaller bending one */
    double moment, push, pull;         /* largest |m|, and |F0|phi|^2 - (F.phi) phi_0|/|phi|^2 where negative
                                        * and where positive */
    Element *elements;
} Form;

/* At the end, the middle and the start: Simpson's weights, and the slopes of the parabolas that are one at
 * the end, the middle and the start (columns), times h. */
static const double weights[PLACES] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
static const double slopes[PLACES][PLACES] = {{3, -4, 1}, {1, 0, -1}, {-1, 4, -3}};

/* eta.K eta at a place, for eta = a sum of eta[.][i] y_i. */
static void add_stiffness(Element *element, Vec3 stiffness, double weight, double eta[3][SIZE])
{
    const double *K = &stiffness.x;
    for (int i = 0; i < SIZE; i++)
        for (int j = 0; j <= i; j++)
            for (int n = 0; n < 3; n++) element->stiff[i][j] += weight * K[n] * eta[n][i] * eta[n][j];
}

/* m.(eta x phi) + F0 |phi|^2 - (F.phi) phi_0 at a place, where phi = y_first, y_first+1, y_first+2. */
static void add_load(Element *element, double weight, Vec3 m, Vec3 F, double eta[3][SIZE], int first)
{
    const double B[3][3] = {{0, m.z, -m.y}, {-m.z, 0, m.x}, {m.y, -m.x, 0}}; /* eta.B phi */
    const double G[3][3] = {{0, -F.y / 2, -F.z / 2}, {-F.y / 2, F.x, 0}, {-F.z / 2, 0, F.x}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < SIZE; j++) {
            double half = weight / 2 * (eta[0][j] * B[0][i] + eta[1][j] * B[1][i] + eta[2][j] * B[2][i]);
            element->load[j][first + i] += half;
            element->load[first + i][j] += half;
        }
        for (int j = 0; j < 3; j++) element->load[first + i][first + j] += weight * G[i][j];
    }
}

/* From stiffnesses, strains, moments and forces at the element's end, middle and start. */
static Element element_create(double h, const Vec3 *K, const Vec3 *k, const Vec3 *m, const Vec3 *F)
{
    Element element = {0};
    Vec3 axes[PLACES][3];
    Quat half, whole = rod_turn(h, k[2], k[1], k[0], &half), turns[PLACES] = {whole, half, quat_identity()};
    for (int a = 0; a < PLACES; a++)
        for (int i = 0; i < 3; i++) axes[a][i] = quat_rotate(turns[a], vec3(i == 0, i == 1, i == 2));
    for (int a = 0; a < PLACES; a++) {
        double eta[3][SIZE];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < SIZE; j++)
                eta[i][j] = slopes[a][j / 3] / h * vec3_dot(axes[a][i], axes[j / 3][j % 3]);
        add_stiffness(&element, K[a], weights[a] * h, eta);
        add_load(&element, weights[a] * h, m[a], F[a], eta, 3 * a);
    }
    return element;
}

/* Value at x of the parabola through three values at 0, 1/2 and 1. */
static Vec3 parabola(const Vec3 *f, double x)
{
    return vec3_axpy((1 - x) * (1 - 2 * x), f[0],
                     vec3_axpy(4 * x * (1 - x), f[1], vec3_scale(x * (2 * x - 1), f[2])));
}

/* What lies between x (0: start) and the end of element e. */
static Element element_rest(const RodEquilibrium *rod, int e, double x)
{
    Vec3 K[PLACES], k[PLACES], m[PLACES], F[PLACES];
    for (int a = 0; a < PLACES; a++) {
        double place = 1 - (1 - x) * a / 2;
        K[a] = parabola(rod->K + 3 * e, place);
        k[a] = parabola(rod->k + 2 * e, place);
        m[a] = parabola(rod->m + 2 * e, place);
        F[a] = parabola(rod->F + 3 * e, place);
    }
    return element_create(rod->length / rod->elements * (1 - x), K, k, m, F);
}

static Form form_create(const RodEquilibrium *rod)
{
    Form form = {.rod = rod, .h = rod->length / rod->elements, .inertia = INFINITY, .softest = INFINITY};
    for (int i = 0; i < 3 * rod->elements; i++) {
        Vec3 K = rod->K[i];
        form.inertia = fmin(form.inertia, fmin(K.y, K.z));
        form.softest = fmin(form.softest, fmin(K.x, form.inertia));
        form.stiffest = fmax(form.stiffest, fmax(K.x, fmax(K.y, K.z)));
    }
    for (int j = 0; j <= 2 * rod->elements; j++) form.moment = fmax(form.moment, vec3_length(rod->m[j]));
    for (int i = 0; i < 3 * rod->elements; i++) {
        double force = vec3_length(rod->F[i]);
        form.push = fmax(form.push, (force - rod->F[i].x) / 2);
        form.pull = fmax(form.pull, (force + rod->F[i].x) / 2);
    }
    form.elements = mem_alloc((size_t)rod->elements, sizeof *form.elements);
    for (int e = 0; e < rod->elements; e++) form.elements[e] = element_rest(rod, e, 0);
    return form;
}

/* Eliminates an element's end and middle from factor stiff + load - shift; tail: what its end carries, and on
 * return its start. Returns minus the number of negative pivots. */
static PackMask eliminate(const Element *element, Pack factor, Pack shift, Pack tail[3][3])
{
    PackMask negative = {0};
    Pack A[SIZE][SIZE];
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j <= i; j++) {
            A[i][j] = factor * element->stiff[i][j] + element->load[i][j];
            if (i < 3) A[i][j] += tail[i][j];
        }
        A[i][i] -= weights[i / 3] * shift;
    }
    for (int k = 0; k < ELIMINATED; k++) {
        Pack least = 1e-10 * factor * element->stiff[k][k]; /* a conjugate point on a node */
        Pack pivot = pack_select(pack_abs(A[k][k]) < least, least, A[k][k]);
        negative += pivot < 0;
        for (int i = k + 1; i < SIZE; i++) {
            Pack part = A[i][k] / pivot;
            for (int j = k + 1; j <= i; j++) A[i][j] -= part * A[j][k];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) tail[i][j] = A[ELIMINATED + i][ELIMINATED + j];
    return negative;
}

/* The index of factor K, m, F less an eigenvalue; one pair of them in each lane. */
static PackMask indices(const Form *form, Pack factor, Pack eigenvalue)
{
    Pack tail[3][3] = {0}, shift = eigenvalue * (form->h * form->inertia);
    PackMask negative = {0};
    for (int e = form->rod->elements - 1; e >= 0; e--)
        negative += eliminate(&form->elements[e], factor, shift, tail);
    return -negative;
}

static int index_of(const Form *form, double factor, double eigenvalue)
{
    return (int)indices(form, pack_set(factor), pack_set(eigenvalue))[0];
}

/* Where the index becomes zero on the way of the factor, or of the eigenvalue, from an unstable value to a
 * stable one: the interval is cut in nine at a time. */
static double boundary(const Form *form, bool of_factor, double stable, double unstable)
{
    double length = form->rod->length, least = of_factor ? 0 : 1 / (length * length);
    while (fabs(stable - unstable) > 1e-8 * fmax(least, fmax(fabs(stable), fabs(unstable)))) {
        Pack at, one = pack_set(1), zero = {0};
        for (int l = 0; l < PACK_LANES; l++)
            at[l] = stable + (unstable - stable) * (l + 1) / (PACK_LANES + 1);
        PackMask index = of_factor ? indices(form, at, zero) : indices(form, one, at);
        int l = 0;
        while (l < PACK_LANES && index[l] == 0) l++;
        if (l > 0) stable = at[l - 1];
        if (l < PACK_LANES) unstable = at[l];
    }
    return (stable + unstable) / 2;
}

static double lowest_eigenvalue(const Form *form)
{
    /* Below: eta.K eta + m.(eta x phi) >= -|m|^2/(4 K) |phi|^2. Above: the turn sin(pi s/2 L) about an axis
     * that is fixed in space, twice for what a parabola makes of it. */
    double quarter = M_PI / (2 * form->rod->length);
    double below = -1.01 * (form->moment * form->moment / (4 * form->softest) + form->push) / form->inertia;
    double above = 2 * (quarter * quarter * form->stiffest + form->pull) / form->inertia;
    while (isfinite(above) && index_of(form, 1, above) == 0) above *= 2;
    return boundary(form, false, below, above);
}

static double critical_factor(const Form *form)
{
    /* The mean square of phi is at most that of eta times (2 L/pi)^2. */
    double quarter = 2 * form->rod->length / M_PI;
    double above = 1.1 * (form->moment + form->push * quarter) * quarter / form->softest,
           below = 1e-6 * above;
    if (!(above > 0)) return 0;
    while (isfinite(above) && index_of(form, above, 0) > 0) above *= 2;
    return index_of(form, below, 0) > 0 ? boundary(form, true, above, below) : 0;
}

static double stable_tail(const Form *form)
{
    Pack tail[3][3] = {0}, carried[3][3], one = pack_set(1), zero = {0};
    for (int e = form->rod->elements - 1; e >= 0; e--) {
        memcpy(carried, tail, sizeof tail);
        if (eliminate(&form->elements[e], one, zero, tail)[0] == 0) continue;
        double stable = 1, unstable = 0; /* within the element */
        while (stable - unstable > 1e-8) {
            double middle = (stable + unstable) / 2;
            Element rest = element_rest(form->rod, e, middle);
            memcpy(tail, carried, sizeof tail);
            *(eliminate(&rest, one, zero, tail)[0] == 0 ? &stable : &unstable) = middle;
        }
        return form->rod->length - (e + stable) * form->h;
    }
    return form->rod->length;
}

RodStability rod_stability(const RodEquilibrium *rod)
{
    Form form = form_create(rod);
    RodStability r = {.morse_index = index_of(&form, 1, 0),
                      .lowest_eigenvalue = lowest_eigenvalue(&form),
                      .critical_factor = critical_factor(&form),
                      .stable_tail = stable_tail(&form)};
    r.stable = r.morse_index == 0;
    mem_free(form.elements);
    return r;
}

int rod_morse_index(const RodEquilibrium *rod)
{
    Form form = form_create(rod);
    int index = index_of(&form, 1, 0);
    mem_free(form.elements);
    return index;
}

double rod_lowest_eigenvalue(const RodEquilibrium *rod)
{
    Form form = form_create(rod);
    double eigenvalue = lowest_eigenvalue(&form);
    mem_free(form.elements);
    return eigenvalue;
}

double rod_critical_factor(const RodEquilibrium *rod)
{
    Form form = form_create(rod);
    double factor = critical_factor(&form);
    mem_free(form.elements);
    return factor;
}

double rod_stable_tail(const RodEquilibrium *rod)
{
    Form form = form_create(rod);
    double tail = stable_tail(&form);
    mem_free(form.elements);
    return tail;
}

double rod_bending_lengths(const RodEquilibrium *rod)
{
    double h = rod->length / rod->elements, most = 0;
    for (int e = 0; e < rod->elements; e++) {
        double bend = fmin(rod->K[3 * e + 1].y, rod->K[3 * e + 1].z);
        if (h * vec3_length(rod->m[2 * e + 1]) < BENT * bend) continue;
        for (int i = 0; i < 3; i++) most = fmax(most, vec3_length(rod->F[3 * e + i]) / bend);
    }
    return h * sqrt(most);
}
