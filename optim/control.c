#include "optim/control.h"
#include <math.h>

int control_rows(ControlKind kind, int steps, int count)
{
    return kind == CONTROL_FRAME ? steps : kind == CONTROL_KNOT ? count : 1 + 2 * count;
}

double control_time(const Control *control, int step)
{
    return control->start + control->duration * step / control->steps;
}

/* A slope at knot k in terms of the rows around it: central, at the ends one-sided. */
static void add_slope(const Control *control, int k, double factor, int first, double *w)
{
    int low = k > 0 ? k - 1 : 0, high = k + 1 < control->rows ? k + 1 : k;
    w[high - first] += factor / (high - low);
    w[low - first] -= factor / (high - low);
}

static int knot_weights(const Control *control, double time, int *first, double *w)
{
    double s = (time - control->start) / control->duration * (control->rows - 1);
    int k = (int)floor(s), last = control->rows - 1;
    k = k < 0 ? 0 : k > last - 1 ? last - 1 : k;
    double t = s - k, t2 = t * t, t3 = t2 * t;
    *first = k > 0 ? k - 1 : 0;
    int count = (k + 2 <= last ? k + 2 : last) - *first + 1;
    for (int i = 0; i < count; i++) w[i] = 0;
    w[k - *first] += 2 * t3 - 3 * t2 + 1;
    w[k + 1 - *first] += 3 * t2 - 2 * t3;
    add_slope(control, k, t3 - 2 * t2 + t, *first, w);
    add_slope(control, k + 1, t3 - t2, *first, w);
    return count;
}

static int harmonic_weights(const Control *control, double time, double *w)
{
    double angle = 2 * M_PI * (time - control->start) / control->duration;
    w[0] = 1;
    for (int h = 1; 2 * h < control->rows; h++) {
        w[2 * h - 1] = cos(h * angle);
        w[2 * h] = sin(h * angle);
    }
    return control->rows;
}

/* The rows first .. first + count - 1 and their weights. */
static int weights(const Control *control, int step, double time, int *first, double *w)
{
    *first = 0;
    if (control->kind == CONTROL_KNOT) return knot_weights(control, time, first, w);
    if (control->kind == CONTROL_HARMONIC) return harmonic_weights(control, time, w);
    *first = step - 1;
    w[0] = 1;
    return 1;
}

void control_value(const Control *control, int step, double time, const double *p, double *value)
{
    double w[CONTROL_MAX_WEIGHTS];
    int first, count = weights(control, step, time, &first, w);
    const double *row = p + control->from + first * control->width;
    for (int i = 0; i < control->width; i++) value[i] = 0;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < control->width; i++) value[i] += w[k] * row[k * control->width + i];
}

void control_add(const Control *control, int step, double time, const double *value, double *dp)
{
    double w[CONTROL_MAX_WEIGHTS];
    int first, count = weights(control, step, time, &first, w);
    double *row = dp + control->from + first * control->width;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < control->width; i++) row[k * control->width + i] += w[k] * value[i];
}

void control_apply(const Control *control, int step, double time, double *p)
{
    double value[CONTROL_MAX_WIDTH];
    control_value(control, step, time, p, value);
    for (int i = 0; i < control->width; i++) p[control->to + i] = value[i];
}

void control_transpose(const Control *control, int step, double time, double *dp)
{
    control_add(control, step, time, dp + control->to, dp);
    for (int i = 0; i < control->width; i++) dp[control->to + i] = 0;
}
