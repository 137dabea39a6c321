#include "world/water_law.h"

static const double EPSILON = 1e-5; /* m/s: below it drag is less than quadratic, so that it is smooth at 0 */

/* |y| made smooth, as a function of Y = y^2, and its derivative in Y. */
static Pack smooth_speed(Pack Y)
{
    return Y / pack_sqrt(Y + EPSILON * EPSILON);
}

static Pack smooth_speed_slope(Pack Y)
{
    Pack R = Y + EPSILON * EPSILON;
    return (Y / 2 + EPSILON * EPSILON) / (R * pack_sqrt(R));
}

/* ---- Faces: number[] = density ---- */

static int face_vertex(const WaterTerm *term, int element, int corner)
{
    return term->faces[element][corner];
}

/* The side of a face opposite to a corner, towards the vertex after it. */
static Pack3 side(const Pack *x, int corner)
{
    return pack3_sub(pack3_load(x + 3 * ((corner + 1) % 3)), pack3_load(x + 3 * ((corner + 2) % 3)));
}

/* The area's vector (x1 - x0) x (x2 - x0)/2. */
static Pack3 face_direction(const Pack *x)
{
    return pack3_scale(pack_set(0.5), pack3_cross(side(x, 1), side(x, 2)));
}

static Pack3 face_direction_rate(const Pack *x, const Pack *dx)
{
    Pack3 sum = {0};
    for (int i = 0; i < 3; i++)
        sum = pack3_axpy(pack_set(0.5), pack3_cross(pack3_load(dx + 3 * i), side(x, i)), sum);
    return sum;
}

static void face_direction_back(const Pack *x, Pack3 w, Pack *dx)
{
    for (int i = 0; i < 3; i++)
        pack3_store(dx + 3 * i,
                    pack3_axpy(pack_set(0.5), pack3_cross(side(x, i), w), pack3_load(dx + 3 * i)));
}

static Drag face_drag(const WaterTerm *term, int pack, const Stream *s, const double *number)
{
    (void)pack;
    double rho = number[0];
    Pack q = term->outer ? pack_select(s->q < 0, s->q, pack_set(0)) : s->q, Y = q * q;
    Pack R = s->V + EPSILON * EPSILON, root = pack_sqrt(R), speed = smooth_speed(Y);
    return (Drag){.lambda = {.value = rho * s->size * Y / root,
                             .size = rho * Y / root,
                             .q = 2 * rho * s->size * q / root,
                             .V = -rho * s->size * Y / (2 * R * root)},
                  .sigma = {.value = rho * s->size * speed,
                            .size = rho * speed,
                            .q = 2 * rho * s->size * q * smooth_speed_slope(Y)}};
}

const WaterLaw water_face_law = {.corners = 3,
                                 .numbers = 1,
                                 .vertex = face_vertex,
                                 .direction = face_direction,
                                 .direction_rate = face_direction_rate,
                                 .direction_back = face_direction_back,
                                 .drag = face_drag};

/* ---- Rods: number[] = density, viscosity ---- */

static int rod_vertex(const WaterTerm *term, int element, int corner)
{
    return element + element / term->each + corner;
}

static Pack3 rod_direction(const Pack *x)
{
    return pack3_sub(pack3_load(x + 3), pack3_load(x));
}

static Pack3 rod_direction_rate(const Pack *x, const Pack *dx)
{
    (void)x;
    return rod_direction(dx);
}

static void rod_direction_back(const Pack *x, Pack3 w, Pack *dx)
{
    (void)x;
    pack3_store(dx, pack3_sub(pack3_load(dx), w));
    pack3_store(dx + 3, pack3_add(pack3_load(dx + 3), w));
}

static Drag rod_drag(const WaterTerm *term, int pack, const Stream *s, const double *number)
{
    Pack Y = s->V - s->q * s->q;
    Y = pack_select(Y > 0, Y, pack_set(0));
    Pack cross, across, along;
    for (int l = 0; l < PACK_LANES; l++) {
        const RodDrag *drag = &term->rods[water_element(term, pack, l)];
        cross[l] = drag->length * number[0] * drag->cross;
        across[l] = drag->length * number[1] * drag->across;
        along[l] = drag->length * number[1] * drag->along;
    }
    Slope lambda = {.value = across + cross * smooth_speed(Y), .V = cross * smooth_speed_slope(Y)};
    lambda.q = -2 * s->q * lambda.V;
    return (Drag){.lambda = lambda, .sigma = {.value = along - lambda.value, .q = -lambda.q, .V = -lambda.V}};
}

const WaterLaw water_rod_law = {.corners = 2,
                                .numbers = 2,
                                .vertex = rod_vertex,
                                .direction = rod_direction,
                                .direction_rate = rod_direction_rate,
                                .direction_back = rod_direction_back,
                                .drag = rod_drag};
