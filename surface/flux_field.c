#include "surface/flux_field.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <string.h>

struct FluxField {
    Formula *formula; /* NULL: a dipole */
    double step;      /* m              */
    Vec3 at, moment;
};

FluxField *flux_field_formula(Formula *formula, double length)
{
    FluxField *field = mem_alloc(1, sizeof *field);
    field->formula = formula;
    field->step = length / 64;
    return field;
}

FluxField *flux_field_dipole(const double at[3], const double moment[3])
{
    FluxField *field = mem_alloc(1, sizeof *field);
    field->at = vec3_load(at);
    field->moment = vec3_load(moment);
    return field;
}

void flux_field_destroy(FluxField *field)
{
    if (!field) return;
    formula_destroy(field->formula);
    mem_free(field);
}

/* Where a formula is sampled: the point itself, then REACH steps either way along each line. */
enum { LINES = 6, REACH = 4, PLACES = 1 + 2 * REACH * LINES };

static const Vec3 line_direction[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};

static int place_along(int line, int k, bool minus)
{
    return 1 + 2 * (REACH * line + k - 1) + minus;
}

static void put_place(double *variables, Vec3 x, double time)
{
    double values[] = {x.x, x.y, x.z, hypot(x.x, x.y), time};
    memcpy(variables, values, sizeof values);
}

/* B[PLACES]; false where one of them is not finite. */
static bool sample_places(const FluxField *field, Vec3 x, double time, Vec3 *B)
{
    double variables[PLACES][5], results[PLACES][3];
    put_place(variables[0], x, time);
    for (int line = 0; line < LINES; line++)
        for (int k = 1; k <= REACH; k++)
            for (int minus = 0; minus < 2; minus++) {
                double step = minus ? -k * field->step : k * field->step;
                put_place(variables[place_along(line, k, minus)], vec3_axpy(step, line_direction[line], x),
                          time);
            }
    if (!formula_eval_all(field->formula, PLACES, variables[0], results[0], NULL)) return false;
    for (int k = 0; k < PLACES; k++) B[k] = vec3_load(results[k]);
    return true;
}

/* First and second derivative along a line, central differences of eighth order: for a field that varies on the
 * body's scale L, a step of L/64 leaves truncation and round-off both near 1e-12 (docs/theory.md). */
static void differences(const Vec3 *B, int line, double h, double first[3], double second[3])
{
    static const double c1[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    static const double c2[] = {8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    Vec3 d1 = vec3(0, 0, 0), d2 = vec3_scale(-205.0 / 72, B[0]);
    for (int k = 1; k <= REACH; k++) {
        Vec3 plus = B[place_along(line, k, false)], minus = B[place_along(line, k, true)];
        d1 = vec3_axpy(c1[k - 1], vec3_sub(plus, minus), d1);
        d2 = vec3_axpy(c2[k - 1], vec3_add(plus, minus), d2);
    }
    vec3_store(first, vec3_scale(1 / h, d1));
    vec3_store(second, vec3_scale(1 / (h * h), d2));
}

static void sample_formula(const FluxField *field, Vec3 x, double time, FluxSample *sample)
{
    Vec3 B[PLACES];
    if (!sample_places(field, x, time, B)) {
        *sample = (FluxSample){.flux = {NAN, NAN, NAN}};
        return;
    }
    double first[LINES][3], second[LINES][3];
    for (int line = 0; line < LINES; line++) differences(B, line, field->step, first[line], second[line]);
    vec3_store(sample->flux, B[0]);
    for (int l = 0; l < 3; l++) /* d2/dl dm = (d2/d(l+m)^2 - d2/dl^2 - d2/dm^2)/2 */
        for (int k = 0, m = (l + 1) % 3; k < 3; k++) {
            sample->gradient[k][l] = first[l][k];
            sample->curvature[k][l][l] = second[l][k];
            double mixed = 0.5 * (second[3 + l][k] - second[l][k] - second[m][k]);
            sample->curvature[k][l][m] = sample->curvature[k][m][l] = mixed;
        }
}

/* B = mu_0/4 pi (3 r (m.r)/r^5 - m/r^3), differentiated twice. */
static void sample_dipole(const FluxField *field, Vec3 x, FluxSample *sample)
{
    double r[3], m[3];
    Vec3 away = vec3_sub(x, field->at);
    vec3_store(r, away);
    vec3_store(m, field->moment);
    double d = vec3_length(away), mr = vec3_dot(field->moment, away);
    double s3 = 1e-7 / (d * d * d), s5 = s3 / (d * d), s7 = s5 / (d * d), s9 = s7 / (d * d);
    for (int k = 0; k < 3; k++) {
        sample->flux[k] = 3 * r[k] * mr * s5 - m[k] * s3;
        for (int l = 0; l < 3; l++) {
            double kl = k == l;
            sample->gradient[k][l] =
                3 * s5 * (kl * mr + r[k] * m[l] + m[k] * r[l]) - 15 * s7 * mr * r[k] * r[l];
            for (int n = 0; n < 3; n++) {
                double kn = k == n, ln = l == n;
                sample->curvature[k][l][n] =
                    3 * s5 * (kl * m[n] + kn * m[l] + ln * m[k]) -
                    15 * s7 * (kl * mr * r[n] + r[k] * m[l] * r[n] + m[k] * r[l] * r[n]) -
                    15 * s7 * (m[n] * r[k] * r[l] + mr * (kn * r[l] + ln * r[k])) +
                    105 * s9 * mr * r[k] * r[l] * r[n];
            }
        }
    }
}

void flux_field_eval(const FluxField *field, const double x[3], double time, FluxSample *sample)
{
    if (field->formula)
        sample_formula(field, vec3_load(x), time, sample);
    else
        sample_dipole(field, vec3_load(x), sample);
}

static bool formula_value(const FluxField *field, const double x[3], double time, double flux[3], Error *err)
{
    double variables[5];
    put_place(variables, vec3_load(x), time);
    return formula_eval(field->formula, variables, flux, err);
}

bool flux_field_is_known(const FluxField *field, const double x[3], double time, Error *err)
{
    double flux[3];
    return !field->formula || formula_value(field, x, time, flux, err);
}

void flux_field_value(const FluxField *field, const double x[3], double time, double flux[3])
{
    if (field->formula) {
        if (!formula_value(field, x, time, flux, NULL)) vec3_store(flux, vec3(NAN, NAN, NAN));
    } else {
        FluxSample sample;
        sample_dipole(field, vec3_load(x), &sample);
        memcpy(flux, sample.flux, sizeof sample.flux);
    }
}

int flux_fields_add(FluxFields *fields, FluxField *field)
{
    size_t count = (size_t)fields->count;
    fields->items = mem_resize(fields->items, count, count + 1, sizeof *fields->items);
    fields->items[count] = field;
    return fields->count++;
}

void flux_fields_clear(FluxFields *fields)
{
    for (int k = 0; k < fields->count; k++) flux_field_destroy(fields->items[k]);
    mem_free(fields->items);
}
