/* sheet.h - the sheet of 8192 triangles that most cases measure: 0.1 m square, 1 mm thick, held at x = 0. */
#pragma once
#include "shell/shell.h"

typedef struct Sheet {
    Shell *shell;
    System *sys;
    double *p, *gradient;
    State state;
} Sheet;

/* In statics it is magnetised along x in a field across; in motion (dynamic) its weight is all there is. */
Sheet sheet_create(BendingModel bending, bool dynamic);
Sheet sheet_create_fine(int cells, BendingModel bending, bool dynamic); /* of 2 cells^2 triangles */
void sheet_destroy(Sheet *s);

/* Rolled by half a radian in all. */
void sheet_bend(Sheet *s);

/* Seconds of a Hessian of the sheet's state by a System (its own, or another), at the two times in turn; and of a factor of
 * the last one. The least of many: the machine's other work only ever adds. */
double sheet_hessian_seconds(System *sys, Sheet *s, const double times[2]);
double sheet_factor_seconds(System *sys);
