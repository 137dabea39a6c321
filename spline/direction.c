#include "spline/direction.h"
#include "base/memory.h"
#include "spline/diffuse.h"
#include "spline/formula_field.h"

SplineDirectionDef spline_direction_default(const SplinePage *page)
{
    double pen = fmin(fmax(page->pen, 0.004), 0.01);
    return (SplineDirectionDef){.detail = pen, .smooth = 3.3 * pen, .spread = 5 * pen};
}

/* Turns u (width 2), the coherence times (cos 2 phi, sin 2 phi), into M. u is freed. */
static SplineField tensors(SplineField *u)
{
    SplineField direction = spline_field_like(u, 3);
    size_t count = (size_t)u->columns * (size_t)u->rows;
    for (size_t i = 0; i < count; i++) {
        const double *value = u->values + 2 * i;
        double *m = direction.values + 3 * i, coherence = hypot(value[0], value[1]);
        m[0] = (coherence - value[0]) / 2;
        m[1] = -value[1] / 2;
        m[2] = (coherence + value[0]) / 2;
    }
    spline_field_clear(u);
    return direction;
}

Vec2 spline_direction_at(const SplineGrid *direction, const SplinePage *page, Vec2 at, double *coherence)
{
    double m[3];
    spline_grid_sample(direction, page, at, m);
    double cosine = m[2] - m[0], sine = -2 * m[1], length = sqrt(cosine * cosine + sine * sine);
    if (coherence) *coherence = length;
    if (!(length > 0)) return (Vec2){1, 0};
    double x = sqrt(fmax(1 + cosine / length, 0) / 2), y = sqrt(fmax(1 - cosine / length, 0) / 2);
    return (Vec2){x, copysign(y, sine)};
}

/* ---- From edges ---- */

/* (z, |z|) of the gradient, z the doubled angle of the edge across it. It says nothing within `margin` of the
 * page's edges, where what was mirrored to smooth the tone bends it. */
static SplineField edge_field(const SplineField *tone, const SplinePage *page, double margin)
{
    SplineField edges = spline_field_like(tone, 3);
    int columns = tone->columns, rows = tone->rows;
    double per_x = columns / page->width, per_y = rows / page->height;
    int left = (int)ceil(margin * per_x), top = (int)ceil(margin * per_y);
    for (int i = top; i < rows - top; i++)
        for (int j = left; j < columns - left; j++) {
            const double *here = spline_field_pixel(tone, i, j);
            double gx = (here[1] - here[-1]) * per_x / 2, gy = (here[columns] - here[-columns]) * per_y / 2;
            double *z = spline_field_pixel(&edges, i, j);
            z[0] = gy * gy - gx * gx;
            z[1] = -2 * gx * gy;
            z[2] = gx * gx + gy * gy;
        }
    return edges;
}

/* From (z, <|grad D|^2>) to what is believed, (a cos 2 phi, a sin 2 phi, a), with a little of the angle that
 * holds where nothing else does. */
static void weigh_edges(SplineField *edges, double angle)
{
    SplineGrid grid = spline_grid(edges);
    double mean = spline_grid_mean(&grid, 2), noise = 0.02 * mean + 1e-9, least = 1e-4;
    size_t count = (size_t)edges->columns * (size_t)edges->rows;
    for (size_t i = 0; i < count; i++) {
        double *z = edges->values + 3 * i;
        double strong = 1 + 4 * z[2] / (z[2] + mean + 1e-9), scale = strong / (z[2] + noise);
        double a = scale * hypot(z[0], z[1]);
        z[0] = scale * z[0] + least * cos(2 * angle);
        z[1] = scale * z[1] + least * sin(2 * angle);
        z[2] = a + least;
    }
}

SplineField spline_direction_from_tone(const SplineField *tone, const SplinePage *page,
                                       const SplineDirectionDef *def)
{
    double pixel = page->width / tone->columns / 8; /* nothing is to be seen in smaller ones */
    SplineField fine = spline_field_resize(tone, page, fmax(def->detail / 2, pixel));
    spline_field_blur(&fine, page, def->detail);
    SplineField sharp = edge_field(&fine, page, 2 * def->detail);
    SplineField edges = spline_field_resize(&sharp, page, fmax(def->detail, pixel));
    spline_field_blur(&edges, page, def->smooth);
    weigh_edges(&edges, def->angle);

    SplineField u = spline_field_like(&edges, 2);
    double pixels = def->spread * edges.columns / page->width;
    spline_diffuse(&edges, pixels * pixels, &u);
    spline_field_blur(&u, page, def->smooth / 2);
    spline_field_clear(&fine);
    spline_field_clear(&sharp);
    spline_field_clear(&edges);
    return tensors(&u);
}

/* ---- As given ---- */

enum { GIVEN_SIDE = 200 }; /* pixels along a page of area 1 of what is given by formulas and pictures */

/* u of a vector, its length over 1 cut off. */
static void double_angle(double x, double y, double *u)
{
    double length = hypot(x, y), sure = fmin(length, 1);
    double c = length > 0 ? x / length : 0, s = length > 0 ? y / length : 0;
    u[0] = sure * (c * c - s * s);
    u[1] = sure * 2 * c * s;
}

SplineField spline_direction_constant(const SplinePage *page, double angle)
{
    SplineField u = spline_field_create(page, 1, 2);
    for (int i = 0; i < u.columns * u.rows; i++) double_angle(cos(angle), sin(angle), u.values + 2 * i);
    return tensors(&u);
}

bool spline_direction_from_formula(Formula *formula, const SplinePage *page, SplineField *direction,
                                   Error *err)
{
    SplineField u;
    if (!spline_field_from_formula(formula, page, 1.0 / GIVEN_SIDE, 2, &u, err)) return false;
    for (int i = 0; i < u.columns * u.rows; i++)
        double_angle(u.values[2 * i], u.values[2 * i + 1], u.values + 2 * i);
    *direction = tensors(&u);
    return true;
}

/* first and second are red and green, or the grey and NULL. Doubled angles, which have no jump, are what is
 * interpolated. */
static SplineField from_pictures(const Image *first, const Image *second, const SplinePage *page)
{
    SplineField full = {first->width, first->height, 2, NULL};
    size_t count = (size_t)full.columns * (size_t)full.rows;
    full.values = mem_alloc(2 * count, sizeof *full.values);
    for (size_t i = 0; i < count; i++) {
        double value = first->grey[i];
        if (second)
            double_angle(2 * value - 1, 2 * second->grey[i] - 1, full.values + 2 * i);
        else
            double_angle(cos(M_PI * value), sin(M_PI * value), full.values + 2 * i);
    }
    SplineField u = spline_field_resize(&full, page, 1.0 / GIVEN_SIDE);
    spline_field_clear(&full);
    return tensors(&u);
}

SplineField spline_direction_from_grey(const Image *image, const SplinePage *page)
{
    return from_pictures(image, NULL, page);
}

SplineField spline_direction_from_rgb(const Image rgb[3], const SplinePage *page)
{
    return from_pictures(&rgb[0], &rgb[1], page);
}

void spline_direction_turn(SplineField *direction, double angle)
{
    double c = cos(2 * angle), s = sin(2 * angle);
    size_t count = (size_t)direction->columns * (size_t)direction->rows;
    for (size_t i = 0; i < count; i++) {
        double *m = direction->values + 3 * i, trace = m[0] + m[2];
        double cosine = m[2] - m[0], sine = -2 * m[1], turned = c * cosine - s * sine;
        m[0] = (trace - turned) / 2;
        m[1] = -(s * cosine + c * sine) / 2;
        m[2] = (trace + turned) / 2;
    }
}
