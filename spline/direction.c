#include "spline/direction.h"
#include "base/memory.h"
#include "spline/diffuse.h"

static const double NOISE = 0.1;  /* gradients below this part of the mean square one are not believed */
static const double LEAST = 1e-4; /* weight of the angle that holds where nothing else does          */

SplineDirectionDef spline_direction_default(void)
{
    return (SplineDirectionDef){.detail = 0.006, .smooth = 0.02, .spread = 0.02};
}

/* M of the doubled angle c (cos 2 phi, sin 2 phi). */
static void tensor_store(double *tensor, double cosine, double sine, double coherence)
{
    double length = hypot(cosine, sine), scale = length > 0 ? coherence / length : 0;
    tensor[0] = (coherence - scale * cosine) / 2;
    tensor[1] = -scale * sine / 2;
    tensor[2] = (coherence + scale * cosine) / 2;
}

Vec2 spline_direction_at(const SplineGrid *direction, const SplinePage *page, Vec2 at, double *coherence)
{
    double m[3];
    spline_grid_sample(direction, page, at, m);
    double cosine = m[2] - m[0], sine = -2 * m[1], length = hypot(cosine, sine);
    if (coherence) *coherence = length;
    if (!(length > 0)) return (Vec2){1, 0};
    double c = sqrt(fmax(1 + cosine / length, 0) / 2), s = sqrt(fmax(1 - cosine / length, 0) / 2);
    return (Vec2){c, copysign(s, sine)};
}

/* (z1, z2, |z|) of the gradient, z the doubled angle of the edge across it. */
static SplineField edge_field(const SplineField *tone, const SplinePage *page)
{
    SplineField edges = spline_field_like(tone, 3);
    int columns = tone->columns, rows = tone->rows;
    double per_x = columns / page->width / 2, per_y = rows / page->height / 2;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            const double *row = tone->values + (size_t)i * (size_t)columns;
            int above = i > 0 ? columns : 0, below = i + 1 < rows ? columns : 0;
            double gx = (row[j + (j + 1 < columns)] - row[j - (j > 0)]) * per_x;
            double gy = (row[j + below] - row[j - above]) * per_y;
            double *z = edges.values + 3 * ((size_t)i * (size_t)columns + (size_t)j);
            z[0] = gy * gy - gx * gx;
            z[1] = -2 * gx * gy;
            z[2] = gx * gx + gy * gy;
        }
    return edges;
}

/* What is believed: (a cos 2 phi, a sin 2 phi, a), with a little of the angle that holds where nothing else
 * does. */
static void weigh_edges(SplineField *edges, double angle)
{
    SplineGrid grid = spline_grid(edges);
    double noise = NOISE * spline_grid_mean(&grid, 2);
    size_t count = (size_t)edges->columns * (size_t)edges->rows;
    for (size_t i = 0; i < count; i++) {
        double *z = edges->values + 3 * i, scale = 1 / (z[2] + noise + 1e-9);
        double a = hypot(z[0], z[1]) * scale;
        z[0] = z[0] * scale + LEAST * cos(2 * angle);
        z[1] = z[1] * scale + LEAST * sin(2 * angle);
        z[2] = a + LEAST;
    }
}

SplineField spline_direction_from_tone(const SplineField *tone, const SplinePage *page,
                                       const SplineDirectionDef *def)
{
    SplineField fine = spline_field_resize(tone, page, def->detail / 2);
    spline_field_blur(&fine, page, def->detail);
    SplineField sharp = edge_field(&fine, page);
    SplineField edges = spline_field_resize(&sharp, page, def->detail);
    spline_field_clear(&fine);
    spline_field_clear(&sharp);
    spline_field_blur(&edges, page, def->smooth);
    weigh_edges(&edges, def->angle);

    SplineField u = spline_field_like(&edges, 2), direction = spline_field_like(&edges, 3);
    double pixels = def->spread * edges.columns / page->width;
    spline_diffuse(&edges, pixels * pixels, &u);
    size_t count = (size_t)u.columns * (size_t)u.rows;
    for (size_t i = 0; i < count; i++) {
        double *z = u.values + 2 * i;
        tensor_store(direction.values + 3 * i, z[0], z[1], fmin(hypot(z[0], z[1]), 1));
    }
    spline_field_clear(&edges);
    spline_field_clear(&u);
    return direction;
}

SplineField spline_direction_constant(const SplinePage *page, double angle)
{
    SplineField direction = spline_field_create(page, 0.01, 3);
    for (int i = 0; i < direction.columns * direction.rows; i++)
        tensor_store(direction.values + 3 * i, cos(2 * angle), sin(2 * angle), 1);
    return direction;
}

bool spline_direction_from_formula(Formula *formula, const SplinePage *page, SplineField *direction,
                                   Error *err)
{
    *direction = spline_field_create(page, 0.005, 3);
    for (int j = 0; j < direction->rows; j++)
        for (int i = 0; i < direction->columns; i++) {
            double place[] = {(i + 0.5) / direction->columns * page->width,
                              (j + 0.5) / direction->rows * page->height},
                   v[2];
            if (!formula_eval(formula, place, v, err)) {
                spline_field_clear(direction);
                return false;
            }
            double angle = atan2(v[1], v[0]);
            tensor_store(direction->values + 3 * (j * direction->columns + i), cos(2 * angle), sin(2 * angle),
                         fmin(hypot(v[0], v[1]), 1));
        }
    return true;
}
