#include "io/formula.h"
#include "base/memory.h"
#include <ctype.h>
#include <muParserDLL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_LENGTH = 4096, MAX_DEPTH = 200, MAX_HELPERS = 200 };

/* One expression as muParser holds it. */
typedef struct Expression {
    muParserHandle_t parser;
    char *text;
    bool *uses; /* [slot] does it name that variable or helper? */
} Expression;

struct Formula {
    int variable_count, helper_count, expression_count;
    char **names;      /* [variable_count + helper_count]                               */
    double *values;    /* the same; muParser points into it                             */
    Expression *items; /* [helper_count + expression_count], in the order of evaluation */
};

static double fun_mod(double a, double b)
{
    return a - b * floor(a / b);
}
static double fun_clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}
static double fun_step(double x)
{
    return x < 0 ? 0 : 1;
}

/* Keeps muParser from printing; the error is asked for after each call. */
static void ignore_error(muParserHandle_t parser)
{
    (void)parser;
}

static int slot_of(const Formula *formula, const char *name, int slots)
{
    for (int i = 0; i < slots; i++)
        if (!strcmp(formula->names[i], name)) return i;
    return -1;
}

static void list_names(const Formula *formula, int slots, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; i < slots && used + 1 < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", formula->names[i]);
}

/* muParser descends recursively. */
static bool check_text(const char *text, Error *err)
{
    int depth = 0;
    size_t length = strlen(text);
    if (length == 0) return error_set(err, "an expression is empty");
    if (length > MAX_LENGTH)
        return error_set(err, "an expression has %zu characters; %d are allowed", length, MAX_LENGTH);
    for (const char *c = text; *c; c++) {
        if (*c == '(') depth++;
        if (*c == ')') depth--;
        if (depth > MAX_DEPTH)
            return error_set(err, "an expression nests deeper than %d parentheses", MAX_DEPTH);
    }
    return true;
}

static bool refuse(const Formula *formula, const Expression *item, int slots, Error *err)
{
    char known[512];
    list_names(formula, slots, known, sizeof known);
    const char *token = mupGetErrorToken(item->parser);
    if (mupGetErrorCode(item->parser) == 1 || mupGetErrorCode(item->parser) == 4)
        return error_set(err, "unknown name '%s' in \"%s\"; known are %s, pi, e", token, item->text, known);
    return error_set(err, "\"%s\": %s", item->text, mupGetErrorMsg(item->parser));
}

static bool parse(Formula *formula, Expression *item, const char *text, int slots, Error *err)
{
    item->uses = mem_alloc((size_t)(formula->variable_count + formula->helper_count), sizeof(bool));
    item->text = mem_text(text);
    if (!check_text(text, err)) return false;
    item->parser = mupCreate(0);
    mupSetErrorHandler(item->parser, ignore_error);
    mupDefineConst(item->parser, "pi", M_PI);
    mupDefineConst(item->parser, "e", M_E);
    mupDefineFun2(item->parser, "mod", fun_mod, 1);
    mupDefineFun3(item->parser, "clamp", fun_clamp, 1);
    mupDefineFun1(item->parser, "step", fun_step, 1);
    for (int i = 0; i < slots; i++) mupDefineVar(item->parser, formula->names[i], &formula->values[i]);
    mupSetExpr(item->parser, text);
    mupEval(item->parser);
    if (mupError(item->parser)) return refuse(formula, item, slots, err);
    int used = mupGetExprVarNum(item->parser);
    for (int k = 0; k < used; k++) {
        const char *name;
        double *place;
        mupGetExprVar(item->parser, (unsigned)k, &name, &place);
        int slot = slot_of(formula, name, slots);
        if (slot >= 0) item->uses[slot] = true;
    }
    return true;
}

/* Is the name a word of the expression? */
static bool mentions(const char *expression, const char *name)
{
    size_t length = strlen(name);
    for (const char *c = expression; length && (c = strstr(c, name)) != NULL; c++) {
        bool begins = c == expression || (!isalnum((unsigned char)c[-1]) && c[-1] != '_');
        if (begins && !isalnum((unsigned char)c[length]) && c[length] != '_') return true;
    }
    return false;
}

/* Does a helper name another one that is not placed yet? (Its own name may be a variable's.) */
static bool waits(const FormulaHelper *helpers, int count, int helper, const bool *placed)
{
    for (int k = 0; k < count; k++)
        if (k != helper && !placed[k] && mentions(helpers[helper].expression, helpers[k].name)) return true;
    return false;
}

/* An order in which each helper comes after those that it names, as near to the given one as can be. */
static bool order_helpers(const FormulaHelper *helpers, int count, int order[MAX_HELPERS], Error *err)
{
    bool placed[MAX_HELPERS] = {false};
    if (count > MAX_HELPERS) return error_set(err, "more than %d names beside a formula", MAX_HELPERS);
    for (int n = 0, next = 0; n < count; n++) {
        for (next = 0; next < count && (placed[next] || waits(helpers, count, next, placed));) next++;
        if (next == count) {
            for (next = 0; placed[next];) next++;
            return error_set(err, "the name '%.60s' beside the formula depends on itself, through others",
                             helpers[next].name);
        }
        placed[next] = true;
        order[n] = next;
    }
    return true;
}

Formula *formula_create(const char *const *expressions, int expression_count, const FormulaHelper *helpers,
                        int helper_count, const char *const *variables, Error *err)
{
    int order[MAX_HELPERS];
    if (!order_helpers(helpers, helper_count, order, err)) return NULL;
    Formula *formula = mem_alloc(1, sizeof *formula);
    while (variables[formula->variable_count]) formula->variable_count++;
    formula->helper_count = helper_count;
    formula->expression_count = expression_count;
    size_t slots = (size_t)(formula->variable_count + helper_count);
    formula->names = mem_alloc(slots, sizeof *formula->names);
    formula->values = mem_alloc(slots, sizeof *formula->values);
    formula->items = mem_alloc((size_t)(helper_count + expression_count), sizeof *formula->items);
    for (int i = 0; i < formula->variable_count; i++) formula->names[i] = mem_text(variables[i]);
    for (int i = 0; i < helper_count; i++)
        formula->names[formula->variable_count + i] = mem_text(helpers[order[i]].name);

    bool ok = true;
    for (int i = 0; ok && i < helper_count; i++)
        ok = parse(formula, &formula->items[i], helpers[order[i]].expression, formula->variable_count + i,
                   err);
    for (int i = 0; ok && i < expression_count; i++)
        ok = parse(formula, &formula->items[helper_count + i], expressions[i], (int)slots, err);
    if (ok) return formula;
    formula_destroy(formula);
    return NULL;
}

void formula_destroy(Formula *formula)
{
    if (!formula) return;
    for (int i = 0; i < formula->helper_count + formula->expression_count; i++) {
        if (formula->items[i].parser) mupRelease(formula->items[i].parser);
        mem_free(formula->items[i].text);
        mem_free(formula->items[i].uses);
    }
    for (int i = 0; i < formula->variable_count + formula->helper_count; i++) mem_free(formula->names[i]);
    mem_free(formula->names);
    mem_free(formula->values);
    mem_free(formula->items);
    mem_free(formula);
}

bool formula_eval(Formula *formula, const double *variables, double *result, Error *err)
{
    memcpy(formula->values, variables, (size_t)formula->variable_count * sizeof *variables);
    for (int i = 0; i < formula->helper_count; i++)
        formula->values[formula->variable_count + i] = mupEval(formula->items[i].parser);
    for (int i = 0; i < formula->expression_count; i++) {
        const Expression *item = &formula->items[formula->helper_count + i];
        result[i] = mupEval(item->parser);
        if (isfinite(result[i])) continue;
        char at[256] = "";
        size_t used = 0;
        for (int k = 0; k < formula->variable_count && used < sizeof at; k++)
            used += (size_t)snprintf(at + used, sizeof at - used, "%s%s = %g", k ? ", " : "",
                                     formula->names[k], variables[k]);
        return error_set(err, "\"%s\" is not a finite number at %s", item->text, at);
    }
    return true;
}

/* Whether item i names the slot, itself or through a helper before it. */
static bool item_uses(const Formula *formula, int i, int slot)
{
    if (formula->items[i].uses[slot]) return true;
    for (int k = 0; k < i && k < formula->helper_count; k++)
        if (formula->items[i].uses[formula->variable_count + k] && item_uses(formula, k, slot)) return true;
    return false;
}

bool formula_uses(const Formula *formula, const char *variable)
{
    int slot = slot_of(formula, variable, formula->variable_count);
    for (int i = 0; slot >= 0 && i < formula->expression_count; i++)
        if (item_uses(formula, formula->helper_count + i, slot)) return true;
    return false;
}
