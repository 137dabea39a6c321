/* control.h - a parameter that changes from step to step, as rows of unknowns in the parameter vector.
 *
 * The rows [rows][width] are a block of p like any other; the entry `to` of p keeps the current value, which
 * is a sum of rows with weights that depend on the step. So terms know nothing of it: what they add to the
 * derivative of the current value goes back to the rows with the same weights. */
#pragma once

typedef enum ControlKind {
    CONTROL_FRAME,    /* a row for each step of time: row n - 1 acts in step n                              */
    CONTROL_KNOT,     /* rows at equal distances in time, joined by a C1 cubic spline (Catmull-Rom)         */
    CONTROL_HARMONIC, /* a mean and (cos, sin) of 1, 2, .. periods in the whole time: rows 1 + 2 harmonics */
} ControlKind;

typedef struct Control {
    ControlKind kind;
    int from, to;           /* entries in p of the rows and of the current value */
    int rows, width, steps; /* width <= CONTROL_MAX_WIDTH */
    double start, duration; /* s, of the whole motion */
} Control;

enum { CONTROL_MAX_WIDTH = 8 };    /* numbers in a value                                               */
enum { CONTROL_MAX_WEIGHTS = 65 }; /* so many rows at most make a value: up to 32 harmonics */

/* Rows that a control of so many steps has; `count` is that of knots (>= 2) or harmonics (1..32). */
int control_rows(ControlKind kind, int steps, int count);

/* Step 1..steps, and the time at its end or that of a part of it. p: the current value from the rows. */
void control_apply(const Control *control, int step, double time, double *p);

/* The value itself, value[width], and its transpose: the rows in dp += weights * value. */
void control_value(const Control *control, int step, double time, const double *p, double *value);
void control_add(const Control *control, int step, double time, const double *value, double *dp);

/* dp: the current value's derivative goes to the rows, and becomes zero. */
void control_transpose(const Control *control, int step, double time, double *dp);

/* The time at the end of a step. */
double control_time(const Control *control, int step);
