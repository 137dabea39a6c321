/* formula.h - expressions of named variables, evaluated by muParser through its C interface.
 *
 * A Formula holds one or more expressions over the same variables, with named helpers (`where`) that are
 * evaluated first, each after those that it names, in whatever order they are given. Beside muParser's own
 * functions there are pi, e, atan2, mod(a, b), clamp(x, lo, hi), step(x). Each is one expression: assignments and lists,
 * which muParser takes, are refused. */
#pragma once
#include "base/error.h"

typedef struct Formula Formula;

typedef struct FormulaHelper {
    const char *name, *expression;
} FormulaHelper;

/* variables: NULL-terminated list of names, e.g. {"x", "y", "z", "r", "t", NULL}. On failure returns NULL and
 * one sentence that quotes the expression, points at the place and names the variables that are known. */
Formula *formula_create(const char *const *expressions, int expression_count, const FormulaHelper *helpers,
                        int helper_count, const char *const *variables, Error *err);

void formula_destroy(Formula *formula);

/* result[expression_count] at the variables' values (in their order). Returns false and a sentence with the
 * values of the variables where a result is not finite. Re-entrant: any number of threads may call it at once. */
bool formula_eval(Formula *formula, const double *variables, double *result, Error *err);

/* The same at `count` points, variables[count][variables], results[count][expression_count], for less; it ends
 * at the first result that is not finite. */
bool formula_eval_all(Formula *formula, int count, const double *variables, double *results, Error *err);

/* Does any expression (through its helpers too) depend on that variable? */
bool formula_uses(const Formula *formula, const char *variable);
