#include "surface/flux_field.h"
#include "base/memory.h"
#include "surface/formula_jet.h"
#include <string.h>

struct FluxField {
    FormulaOfPlace of; /* its formula is owned; NULL: a dipole */
    Vec3 at, moment;
};

FluxField *flux_field_formula(Formula *formula, double length)
{
    FluxField *field = mem_alloc(1, sizeof *field);
    field->of = (FormulaOfPlace){formula, 3, 1, length / 64};
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
    formula_destroy(field->of.formula);
    mem_free(field);
}

static void sample_formula(const FluxField *field, Vec3 x, double time, FluxSample *sample)
{
    FormulaJet jet;
    formula_jet(&field->of, x, &time, &jet);
    memcpy(sample->flux, jet.value, sizeof sample->flux);
    memcpy(sample->gradient, jet.gradient, sizeof sample->gradient);
    memcpy(sample->curvature, jet.curvature, sizeof sample->curvature);
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
    if (field->of.formula)
        sample_formula(field, vec3_load(x), time, sample);
    else
        sample_dipole(field, vec3_load(x), sample);
}

bool flux_field_is_known(const FluxField *field, const double x[3], double time, Error *err)
{
    double flux[3];
    return !field->of.formula || formula_jet_value(&field->of, vec3_load(x), &time, flux, err);
}

void flux_field_value(const FluxField *field, const double x[3], double time, double flux[3])
{
    if (field->of.formula) {
        if (!formula_jet_value(&field->of, vec3_load(x), &time, flux, NULL))
            vec3_store(flux, vec3(NAN, NAN, NAN));
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
