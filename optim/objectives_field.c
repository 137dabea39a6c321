/* Objectives of a control over time: they depend on parameters only. */
#include "base/memory.h"
#include "optim/objectives.h"
#include <math.h>
#include <stdbool.h>

enum { WIDTH = 3 };

typedef struct Field {
    Control control;
    bool jumps;                    /* differences between steps */
    int pairs, omega, alpha, beta; /* of a DMP row */
} Field;

/* The control in step n, or its change since step n - 1. */
static void sample(const Field *field, int n, const double *p, double *value)
{
    const Control *control = &field->control;
    control_value(control, n, control_time(control, n), p, value);
    if (!field->jumps) return;
    double before[WIDTH];
    control_value(control, n - 1, control_time(control, n - 1), p, before);
    for (int i = 0; i < WIDTH; i++) value[i] -= before[i];
}

static void add_sample(const Field *field, int n, const double *value, double *dp)
{
    const Control *control = &field->control;
    control_add(control, n, control_time(control, n), value, dp);
    if (!field->jumps) return;
    double minus[WIDTH];
    for (int i = 0; i < WIDTH; i++) minus[i] = -value[i];
    control_add(control, n - 1, control_time(control, n - 1), minus, dp);
}

static double field_value(const void *self, double weight, const double *x, const double *p, double *dx,
                          double *dp)
{
    (void)x, (void)dx;
    const Field *field = self;
    double sum = 0, value[WIDTH];
    for (int n = field->jumps ? 2 : 1; n <= field->control.steps; n++) {
        sample(field, n, p, value);
        for (int i = 0; i < WIDTH; i++) {
            sum += value[i] * value[i];
            value[i] *= 2 * weight;
        }
        if (dp) add_sample(field, n, value, dp);
    }
    return sum;
}

static void field_product(const void *self, double weight, const double *x, const double *p, const double *vx,
                          const double *vp, double *hx, double *hp)
{
    (void)x, (void)p, (void)vx, (void)hx;
    field_value(self, weight, NULL, vp, NULL, hp);
}

/* ---- DMP ---- */

/* Derivative of the pair's sum in step n with respect to w_j, component i. */
static double frequency_slope(const Field *field, const double *p, int j, int i, double t)
{
    double w = p[field->omega + j], alpha = p[field->alpha + WIDTH * j + i],
           beta = p[field->beta + WIDTH * j + i];
    return t * (beta * cos(w * t) - alpha * sin(w * t));
}

static void dmp_residual(const Field *field, int n, const double *p, double *r)
{
    double t = control_time(&field->control, n);
    sample(field, n, p, r);
    for (int j = 0; j < field->pairs; j++) {
        double c = cos(p[field->omega + j] * t), s = sin(p[field->omega + j] * t);
        for (int i = 0; i < WIDTH; i++)
            r[i] -= p[field->alpha + WIDTH * j + i] * c + p[field->beta + WIDTH * j + i] * s;
    }
}

/* dp += J_n^T r. */
static void dmp_transpose(const Field *field, int n, const double *p, const double *r, double *dp)
{
    double t = control_time(&field->control, n);
    add_sample(field, n, r, dp);
    for (int j = 0; j < field->pairs; j++) {
        double c = cos(p[field->omega + j] * t), s = sin(p[field->omega + j] * t);
        for (int i = 0; i < WIDTH; i++) {
            dp[field->alpha + WIDTH * j + i] -= c * r[i];
            dp[field->beta + WIDTH * j + i] -= s * r[i];
            dp[field->omega + j] -= frequency_slope(field, p, j, i, t) * r[i];
        }
    }
}

/* r = J_n v. */
static void dmp_tangent(const Field *field, int n, const double *p, const double *v, double *r)
{
    double t = control_time(&field->control, n);
    sample(field, n, v, r);
    for (int j = 0; j < field->pairs; j++) {
        double c = cos(p[field->omega + j] * t), s = sin(p[field->omega + j] * t);
        for (int i = 0; i < WIDTH; i++)
            r[i] -= v[field->alpha + WIDTH * j + i] * c + v[field->beta + WIDTH * j + i] * s +
                    v[field->omega + j] * frequency_slope(field, p, j, i, t);
    }
}

static double dmp_value(const void *self, double weight, const double *x, const double *p, double *dx,
                        double *dp)
{
    (void)x, (void)dx;
    const Field *field = self;
    double sum = 0, r[WIDTH];
    for (int n = 1; n <= field->control.steps; n++) {
        dmp_residual(field, n, p, r);
        for (int i = 0; i < WIDTH; i++) {
            sum += r[i] * r[i];
            r[i] *= 2 * weight;
        }
        if (dp) dmp_transpose(field, n, p, r, dp);
    }
    return sum;
}

static void dmp_product(const void *self, double weight, const double *x, const double *p, const double *vx,
                        const double *vp, double *hx, double *hp)
{
    (void)x, (void)vx, (void)hx;
    const Field *field = self;
    double r[WIDTH];
    for (int n = 1; n <= field->control.steps; n++) {
        dmp_tangent(field, n, p, vp, r);
        for (int i = 0; i < WIDTH; i++) r[i] *= 2 * weight;
        dmp_transpose(field, n, p, r, hp);
    }
}

static const ObjectiveOps magnitude_ops = {"field_magnitude", field_value, field_product, mem_free};
static const ObjectiveOps smoothness_ops = {"field_smoothness", field_value, field_product, mem_free};
static const ObjectiveOps dmp_ops = {"dmp", dmp_value, dmp_product, mem_free};

static Objective field_row(const ObjectiveOps *ops, Field field, double weight)
{
    return (Objective){ops, mem_copy(&field, 1, sizeof field), weight, 0, 0};
}

Objective objective_field_magnitude(const Control *control, double weight)
{
    return field_row(&magnitude_ops, (Field){.control = *control}, weight);
}

Objective objective_field_smoothness(const Control *control, double weight)
{
    return field_row(&smoothness_ops, (Field){.control = *control, .jumps = true}, weight);
}

/* Cosines and sines of whole periods are orthogonal on the steps, until they alternate from step to step. */
void objective_dmp_start(const Control *control, int pairs, int omega, int alpha, int beta, double *p)
{
    for (int j = 0; j < pairs; j++) p[omega + j] = 2 * M_PI * (j + 1) / control->duration;
    for (int j = 0; j < pairs && 2 * (j + 1) < control->steps; j++)
        for (int n = 1; n <= control->steps; n++) {
            double t = control_time(control, n), value[WIDTH];
            control_value(control, n, t, p, value);
            for (int i = 0; i < WIDTH; i++) {
                p[alpha + WIDTH * j + i] += 2 * value[i] * cos(p[omega + j] * t) / control->steps;
                p[beta + WIDTH * j + i] += 2 * value[i] * sin(p[omega + j] * t) / control->steps;
            }
        }
}

Objective objective_dmp(const Control *control, int pairs, int omega, int alpha, int beta, double weight)
{
    return field_row(
        &dmp_ops, (Field){.control = *control, .pairs = pairs, .omega = omega, .alpha = alpha, .beta = beta},
        weight);
}
