#include "io/formula.h"
#include "base/memory.h"
#include "io/yaml_private.h"
#include <ctype.h>
#include <muParserDLL.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { MAX_LENGTH = 4096, MAX_DEPTH = 200, MAX_HELPERS = 200 };

typedef struct Expression {
    char *text;
    bool *uses; /* [slot] does it name that variable or helper? */
} Expression;

/* The expressions as muParser holds them, for one thread at a time: a parser reads its variables where it was
 * told that they lie, and calculates in itself. */
typedef struct Evaluator Evaluator;
struct Evaluator {
    Evaluator *next;
    double *values;            /* [variable_count + helper_count] */
    muParserHandle_t *parsers; /* [helper_count + expression_count] */
};

struct Formula {
    int variable_count, helper_count, expression_count;
    char **names;      /* [variable_count + helper_count]                               */
    Expression *items; /* [helper_count + expression_count], in the order of evaluation */
    Evaluator *idle;   /* those that no thread uses: as many as were ever needed at once */
    pthread_mutex_t lock;
};

/* muParser makes parsers, and says names and errors, by buffers that are shared by all parsers. Nothing is allocated by
 * mem_alloc under it. */
static pthread_mutex_t one_parser = PTHREAD_MUTEX_INITIALIZER;

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

/* muParser has = as an operator that changes a variable. */
static bool check_assignment(const char *text, Error *err)
{
    for (const char *c = text; *c; c++) {
        bool compares = c[1] == '=' || (c > text && strchr("=<>!", c[-1]));
        if (*c == '=' && !compares)
            return error_set(err, "\"%s\": the = at position %d is no part of an expression; == compares",
                             text, (int)(c - text));
    }
    return true;
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
    return check_assignment(text, err);
}

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '.';
}

/* Does a number begin there? */
static bool begins_number(const char *text, const char *c)
{
    return (c == text || !is_word(c[-1])) && (isdigit((unsigned char)*c) || *c == '.');
}

/* "3 mm * x": an expression has no units. */
static bool refuse_unit(const char *text, Error *err)
{
    double value;
    int length;
    for (const char *c = text; *c; c++)
        if (begins_number(text, c) && unit_begins(c, &value, &length))
            return error_set(err,
                             "\"%s\": '%.*s' has a unit, and numbers in expressions are plain, in SI: %.6g",
                             text, length, c, value);
    return true;
}

/* "0,5*x": muParser has commas between the parameters of functions, and parts of lists. */
static bool refuse_comma(const char *text, Error *err)
{
    for (const char *c = text; *c; c++) {
        if (!begins_number(text, c)) continue;
        int whole = (int)strspn(c, "0123456789"), part = 0;
        if (whole && c[whole] == ',') part = (int)strspn(c + whole + 1, "0123456789");
        if (part)
            return error_set(err, "\"%s\": numbers have a decimal point: %.*s.%.*s, not %.*s", text, whole, c,
                             part, c + whole + 1, whole + 1 + part, c);
    }
    return true;
}

enum { UNKNOWN_TOKEN = 1, UNEXPECTED_COMMA = 3, UNKNOWN_NAME = 4, TOO_MANY = 14 }; /* of muParser's errors */

static bool refuse(const Formula *formula, muParserHandle_t parser, const char *text, int slots, Error *err)
{
    enum { READABLE = 1000 }; /* muParser's C interface has 2 KiB for what it says */
    char known[512];
    int code = mupGetErrorCode(parser);
    list_names(formula, slots, known, sizeof known);
    if (strlen(text) > READABLE)
        return error_set(err, "an expression of %zu characters is not understood; known are %s, pi, e",
                         strlen(text), known);
    bool comma = code == UNEXPECTED_COMMA || code == TOO_MANY || !*mupGetErrorToken(parser);
    if (comma && !refuse_comma(text, err)) return false;
    if (!refuse_unit(text, err)) return false;
    if (code == UNKNOWN_TOKEN || code == UNKNOWN_NAME)
        return error_set(err, "unknown name '%s' in \"%s\"; known are %s, pi, e", mupGetErrorToken(parser),
                         text, known);
    return error_set(err, "\"%s\": %s", text, mupGetErrorMsg(parser));
}

/* Of an expression that may use the first `slots` values. */
static muParserHandle_t create_parser(const Formula *formula, double *values, const char *text, int slots)
{
    muParserHandle_t parser = mupCreate(0);
    mupSetErrorHandler(parser, ignore_error);
    mupDefineConst(parser, "pi", M_PI);
    mupDefineConst(parser, "e", M_E);
    mupDefineFun2(parser, "mod", fun_mod, 1);
    mupDefineFun3(parser, "clamp", fun_clamp, 1);
    mupDefineFun1(parser, "step", fun_step, 1);
    for (int i = 0; i < slots; i++) mupDefineVar(parser, formula->names[i], &values[i]);
    mupSetExpr(parser, text);
    return parser;
}

static int item_count(const Formula *formula)
{
    return formula->helper_count + formula->expression_count;
}

/* How many values item i may use: a helper knows those before it. */
static int slots_of_item(const Formula *formula, int i)
{
    return formula->variable_count + (i < formula->helper_count ? i : formula->helper_count);
}

static Evaluator *evaluator_create(const Formula *formula)
{
    Evaluator *own = mem_alloc(1, sizeof *own);
    own->values = mem_alloc((size_t)(formula->variable_count + formula->helper_count), sizeof *own->values);
    own->parsers = mem_alloc((size_t)item_count(formula), sizeof *own->parsers);
    pthread_mutex_lock(&one_parser);
    for (int i = 0; i < item_count(formula); i++)
        own->parsers[i] =
            create_parser(formula, own->values, formula->items[i].text, slots_of_item(formula, i));
    pthread_mutex_unlock(&one_parser);
    return own;
}

static void evaluator_destroy(const Formula *formula, Evaluator *own)
{
    for (int i = 0; i < item_count(formula); i++) mupRelease(own->parsers[i]);
    mem_free(own->values);
    mem_free(own->parsers);
    mem_free(own);
}

/* An evaluator for this thread alone, until it is given back. */
static Evaluator *take(Formula *formula)
{
    pthread_mutex_lock(&formula->lock);
    Evaluator *own = formula->idle;
    if (own) formula->idle = own->next;
    pthread_mutex_unlock(&formula->lock);
    return own ? own : evaluator_create(formula);
}

static void give(Formula *formula, Evaluator *own)
{
    pthread_mutex_lock(&formula->lock);
    own->next = formula->idle;
    formula->idle = own;
    pthread_mutex_unlock(&formula->lock);
}

/* Does muParser take the item, and which names does it use? */
static bool check_item(Formula *formula, const Evaluator *own, int i, Error *err)
{
    Expression *item = &formula->items[i];
    muParserHandle_t parser = own->parsers[i];
    int slots = slots_of_item(formula, i);
    mupEval(parser);
    if (mupError(parser)) return refuse(formula, parser, item->text, slots, err);
    int results = 1;
    mupEvalMulti(parser, &results);
    if (results != 1)
        return refuse_comma(item->text, err) &&
               error_set(err, "\"%s\": a list of %d; a formula is one expression", item->text, results);
    int used = mupGetExprVarNum(parser);
    for (int k = 0; k < used; k++) {
        const char *name;
        double *place;
        mupGetExprVar(parser, (unsigned)k, &name, &place);
        int slot = slot_of(formula, name, slots);
        if (slot >= 0) item->uses[slot] = true;
    }
    return true;
}

/* Of a helper: a name of its own, as muParser takes them. */
static bool check_name(const Formula *formula, int slot, Error *err)
{
    const char *name = formula->names[slot];
    size_t good = strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789");
    if (!*name || name[good] || (*name >= '0' && *name <= '9'))
        return error_set(
            err, "'%s' is no name for a part of a formula: letters, digits and _, a letter first", name);
    bool taken = slot_of(formula, name, slot) >= 0 || !strcmp(name, "pi") || !strcmp(name, "e");
    return !taken ||
           error_set(err, "the name '%s' has a meaning in this formula already; take another one", name);
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

static bool check_items(Formula *formula, Error *err)
{
    bool ok = true;
    for (int i = 0; ok && i < formula->helper_count; i++)
        ok = check_name(formula, formula->variable_count + i, err);
    for (int i = 0; ok && i < item_count(formula); i++) ok = check_text(formula->items[i].text, err);
    if (!ok) return false;
    Evaluator *own = take(formula);
    pthread_mutex_lock(&one_parser);
    for (int i = 0; ok && i < item_count(formula); i++) ok = check_item(formula, own, i, err);
    pthread_mutex_unlock(&one_parser);
    give(formula, own);
    return ok;
}

Formula *formula_create(const char *const *expressions, int expression_count, const FormulaHelper *helpers,
                        int helper_count, const char *const *variables, Error *err)
{
    int order[MAX_HELPERS];
    if (!order_helpers(helpers, helper_count, order, err)) return NULL;
    Formula *formula = mem_alloc(1, sizeof *formula);
    pthread_mutex_init(&formula->lock, NULL);
    while (variables[formula->variable_count]) formula->variable_count++;
    formula->helper_count = helper_count;
    formula->expression_count = expression_count;
    size_t slots = (size_t)(formula->variable_count + helper_count);
    formula->names = mem_alloc(slots, sizeof *formula->names);
    formula->items = mem_alloc((size_t)item_count(formula), sizeof *formula->items);
    for (int i = 0; i < formula->variable_count; i++) formula->names[i] = mem_text(variables[i]);
    for (int i = 0; i < helper_count; i++)
        formula->names[formula->variable_count + i] = mem_text(helpers[order[i]].name);
    for (int i = 0; i < item_count(formula); i++) {
        formula->items[i].text =
            mem_text(i < helper_count ? helpers[order[i]].expression : expressions[i - helper_count]);
        formula->items[i].uses = mem_alloc(slots, sizeof(bool));
    }
    if (check_items(formula, err)) return formula;
    formula_destroy(formula);
    return NULL;
}

void formula_destroy(Formula *formula)
{
    if (!formula) return;
    for (Evaluator *next; formula->idle; formula->idle = next) {
        next = formula->idle->next;
        evaluator_destroy(formula, formula->idle);
    }
    pthread_mutex_destroy(&formula->lock);
    for (int i = 0; i < item_count(formula); i++) {
        mem_free(formula->items[i].text);
        mem_free(formula->items[i].uses);
    }
    for (int i = 0; i < formula->variable_count + formula->helper_count; i++) mem_free(formula->names[i]);
    mem_free(formula->names);
    mem_free(formula->items);
    mem_free(formula);
}

static bool refuse_value(const Formula *formula, const char *text, const double *variables, Error *err)
{
    char at[256] = "";
    size_t used = 0;
    for (int k = 0; k < formula->variable_count && used < sizeof at; k++)
        used += (size_t)snprintf(at + used, sizeof at - used, "%s%s = %g", k ? ", " : "", formula->names[k],
                                 variables[k]);
    return error_set(err, "\"%s\" is not a finite number at %s", text, at);
}

static bool evaluate(const Formula *formula, const Evaluator *own, const double *variables, double *result,
                     Error *err)
{
    int helpers = formula->helper_count;
    memcpy(own->values, variables, (size_t)formula->variable_count * sizeof *variables);
    for (int i = 0; i < helpers; i++) own->values[formula->variable_count + i] = mupEval(own->parsers[i]);
    for (int i = 0; i < formula->expression_count; i++) {
        result[i] = mupEval(own->parsers[helpers + i]);
        if (!isfinite(result[i]))
            return refuse_value(formula, formula->items[helpers + i].text, variables, err);
    }
    return true;
}

bool formula_eval_all(Formula *formula, int count, const double *variables, double *results, Error *err)
{
    Evaluator *own = take(formula);
    bool ok = true;
    for (int k = 0; ok && k < count; k++)
        ok = evaluate(formula, own, variables + k * formula->variable_count,
                      results + k * formula->expression_count, err);
    give(formula, own);
    return ok;
}

bool formula_eval(Formula *formula, const double *variables, double *result, Error *err)
{
    return formula_eval_all(formula, 1, variables, result, err);
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
