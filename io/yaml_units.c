/* Numbers with units: "1.5 mm", "20 mT", "120 kA/m", "N s/m". */
#include "base/memory.h"
#include "io/yaml_private.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Exponents of m, kg, s, A, rad. */
enum { DIMENSIONS = 5 };

typedef struct Unit {
    double factor;
    int exponent[DIMENSIONS];
} Unit;

static const struct {
    const char *symbol;
    bool prefixed; /* takes k, m, .. */
    Unit unit;
} units[] = {
    {"m", true, {1, {1}}},
    {"g", true, {1e-3, {0, 1}}},
    {"s", true, {1, {0, 0, 1}}},
    {"A", true, {1, {0, 0, 0, 1}}},
    {"rad", true, {1, {0, 0, 0, 0, 1}}},
    {"deg", false, {M_PI / 180, {0, 0, 0, 0, 1}}},
    {"min", false, {60, {0, 0, 1}}},
    {"h", false, {3600, {0, 0, 1}}},
    {"Hz", true, {1, {0, 0, -1}}},
    {"N", true, {1, {1, 1, -2}}},
    {"Pa", true, {1, {-1, 1, -2}}},
    {"bar", true, {1e5, {-1, 1, -2}}},
    {"J", true, {1, {2, 1, -2}}},
    {"W", true, {1, {2, 1, -3}}},
    {"T", true, {1, {0, 1, -2, -1}}},
};

static const struct {
    const char *symbol;
    double factor;
} prefixes[] = {{"G", 1e9},  {"M", 1e6},         {"k", 1e3},         {"d", 1e-1}, {"c", 1e-2}, {"m", 1e-3},
                {"u", 1e-6}, {"\xc2\xb5", 1e-6}, {"\xce\xbc", 1e-6}, {"n", 1e-9}, {"p", 1e-12}};

/* What units may be of, for a sentence that says of which one it is. */
static const struct {
    const char *noun, *unit;
} kinds[] = {
    {"a length", "m"},
    {"an area", "m^2"},
    {"a volume", "m^3"},
    {"a mass", "g"},
    {"a density", "kg/m^3"},
    {"a time", "s"},
    {"a rate", "1/s"},
    {"an angle", "rad"},
    {"a speed", "m/s"},
    {"an acceleration", "m/s^2"},
    {"a curvature", "1/m"},
    {"a force", "N"},
    {"a force per length", "N/m"},
    {"a pressure", "Pa"},
    {"an energy", "J"},
    {"a power", "W"},
    {"a current", "A"},
    {"a magnetisation", "A/m"},
    {"a magnetic moment", "A m^2"},
    {"a flux density", "T"},
};

void unit_list(bool prefixed, const char *mark, Text *text)
{
    const char *before = "";
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        if (units[k].prefixed != prefixed) continue;
        text_add(text, "%s%s%s%s", before, mark, units[k].symbol, mark);
        before = ", ";
    }
}

void unit_list_prefixes(const char *mark, Text *text)
{
    for (size_t k = 0; k < sizeof prefixes / sizeof *prefixes; k++)
        if (!(prefixes[k].symbol[0] & 0x80))
            text_add(text, "%s%s%s%s", k ? ", " : "", mark, prefixes[k].symbol, mark);
}

static const Unit *find_unit(const char *symbol, size_t length, bool prefixed)
{
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strlen(units[k].symbol) == length && !strncmp(units[k].symbol, symbol, length) &&
            (!prefixed || units[k].prefixed))
            return &units[k].unit;
    return NULL;
}

static bool symbol_unit(const char *symbol, size_t length, Unit *unit)
{
    const Unit *whole = find_unit(symbol, length, false);
    if (whole) return *unit = *whole, true;
    for (size_t k = 0; k < sizeof prefixes / sizeof *prefixes; k++) {
        size_t size = strlen(prefixes[k].symbol);
        if (size >= length || strncmp(prefixes[k].symbol, symbol, size)) continue;
        const Unit *rest = find_unit(symbol + size, length - size, true);
        if (!rest) continue;
        *unit = *rest;
        unit->factor *= prefixes[k].factor;
        return true;
    }
    return false;
}

static bool is_symbol(char c)
{
    return isalpha((unsigned char)c) || (unsigned char)c >= 0x80;
}

/* A product of symbols with powers; after a slash they divide. False: *text is then where it is none. */
static bool parse_unit(const char **at, Unit *product)
{
    const char *text = *at;
    *product = (Unit){.factor = 1};
    if (text[0] == '1' && text[1] == '/') text++;
    for (int sign = 1; *text;) {
        if (*text == ' ' || *text == '*') {
            text++;
            continue;
        }
        if (*text == '/') {
            if (sign < 0) return *at = text, false;
            sign = -1;
            text++;
            continue;
        }
        size_t length = 0;
        while (is_symbol(text[length])) length++;
        Unit unit;
        if (!length || !symbol_unit(text, length, &unit)) return *at = text, false;
        text += length;
        int power = 1;
        if (*text == '^') {
            if (!isdigit((unsigned char)text[1]) || isdigit((unsigned char)text[2])) return *at = text, false;
            power = text[1] - '0';
            text += 2;
        }
        product->factor *= pow(unit.factor, sign * power);
        for (int d = 0; d < DIMENSIONS; d++) product->exponent[d] += sign * power * unit.exponent[d];
    }
    return true;
}

bool unit_is_known(const char *unit)
{
    Unit parsed;
    return !unit || (parse_unit(&unit, &parsed) && parsed.factor == 1);
}

static bool is_alike(const Unit *a, const Unit *b)
{
    return !memcmp(a->exponent, b->exponent, sizeof a->exponent);
}

/* "is a length", of a known one. */
static const char *kind_of(const Unit *unit)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const char *text = kinds[k].unit;
        Unit kind;
        if (parse_unit(&text, &kind) && is_alike(unit, &kind)) return kinds[k].noun;
    }
    return "of another kind";
}

/* What others write for a unit that is none here. */
static const struct {
    const char *symbol, *name, *is;
} foreign[] = {
    {"G", "a gauss", "0.1 mT"},    {"gauss", "a gauss", "0.1 mT"},        {"Oe", "an oersted", "79.577 A/m"},
    {"in", "an inch", "25.4 mm"},  {"inch", "an inch", "25.4 mm"},        {"psi", "a psi", "6894.76 Pa"},
    {"lbf", "a pound", "4.448 N"}, {"atm", "an atmosphere", "101325 Pa"},
};

static bool is_word(const char *at, int length, const char *prefix, const char *symbol)
{
    size_t first = strlen(prefix);
    return (size_t)length == first + strlen(symbol) && !strncasecmp(at, prefix, first) &&
           !strncasecmp(at + first, symbol, strlen(symbol));
}

/* The unit of that kind that differs from a word by capitals only; "" is none. Of m and M the one as it is written. */
static void near_unit(const char *at, int length, const Unit *wanted, char near[16])
{
    const size_t none = sizeof prefixes / sizeof *prefixes;
    near[0] = 0;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        for (size_t p = 0; p <= (units[k].prefixed ? none : 0); p++) {
            const char *prefix = !units[k].prefixed || p == none ? "" : prefixes[p].symbol;
            bool written = !strncmp(at, prefix, strlen(prefix));
            if (memcmp(units[k].unit.exponent, wanted->exponent, sizeof wanted->exponent) != 0) continue;
            if (is_word(at, length, prefix, units[k].symbol) && (written || !near[0]))
                snprintf(near, 16, "%s%s", prefix, units[k].symbol);
        }
}

/* Is one that near with m or M before it, of a word whose capitals say nothing of which? */
static bool is_milli_or_mega(const char *at, int length, const char *near)
{
    bool lower = false, upper = false;
    for (int i = 0; i < length; i++) {
        lower = lower || islower((unsigned char)at[i]);
        upper = upper || isupper((unsigned char)at[i]);
    }
    return (near[0] == 'm' || near[0] == 'M') && !(lower && upper) &&
           find_unit(near + 1, strlen(near + 1), true);
}

/* A hint at what may be meant by a word, if there is one: what it is, or what is written nearly so. */
static char *hint_at(const char *at, int length, const char *wanted)
{
    for (size_t k = 0; k < sizeof foreign / sizeof *foreign; k++)
        if (is_word(at, length, "", foreign[k].symbol))
            return mem_format("; %s is %s", foreign[k].name, foreign[k].is);
    Unit unit;
    char near[16];
    parse_unit(&wanted, &unit);
    near_unit(at, length, &unit, near);
    if (is_milli_or_mega(at, length, near))
        return mem_format("; capitals matter: M%s is mega, m%s is milli", near + 1, near + 1);
    return near[0] ? mem_format("; did you mean %s?", near) : mem_text("");
}

/* What of the text from `at` on is no unit, and which there are. */
static void no_unit(const char *text, const char *at, const char *wanted, char *wrong, size_t size)
{
    int length = 0;
    while (is_symbol(at[length])) length++;
    if (length == 0) {
        snprintf(
            wrong, size,
            "must be a number in %s, and '%.60s' is none: units have powers by ^ and one slash, as kg/m^3",
            wanted, text);
        return;
    }
    char *hint = hint_at(at, length, wanted);
    if (*hint) {
        snprintf(wrong, size, "must be a number in %s, and '%.*s' is no unit%s", wanted,
                 length < 60 ? length : 60, at, hint);
        mem_free(hint);
        return;
    }
    mem_free(hint);
    Text list = {0};
    unit_list(true, "", &list);
    text_add(&list, ", with ");
    unit_list_prefixes("", &list);
    text_add(&list, " before them, and ");
    unit_list(false, "", &list);
    snprintf(wrong, size, "must be a number in %s, and '%.*s' is no unit: there are %s", wanted,
             length < 60 ? length : 60, at, list.text);
    mem_free(list.text);
}

/* Decimal only: strtod would take hexadecimal, "inf" and "nan" too. */
static bool decimal(const char *text, double *value, const char **rest)
{
    const char *c = text + (*text == '-' || *text == '+');
    if (!isdigit((unsigned char)*c) && !(*c == '.' && isdigit((unsigned char)c[1]))) return false;
    if (c[0] == '0' && (c[1] == 'x' || c[1] == 'X')) return false;
    char *end;
    *value = strtod(text, &end);
    *rest = end;
    return true;
}

/* ".nan", "-.inf", "inf": YAML's numbers that are not finite, and what programs print for them. */
static bool is_not_finite(const char *text)
{
    static const char *const words[] = {"nan", "inf", "infinity"};
    text += *text == '-' || *text == '+';
    text += *text == '.';
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (!strcasecmp(text, words[k])) return true;
    return false;
}

bool unit_is_number(const char *text)
{
    double value;
    const char *rest;
    if (is_not_finite(text)) return true;
    if (!decimal(text, &value, &rest)) return false;
    if (*rest && *rest != ' ' && !is_symbol(*rest)) return false;
    while (*rest == ' ') rest++;
    for (const char *c = rest; *c; c++)
        if (!is_symbol(*c) && !isdigit((unsigned char)*c) && !strchr(" /^", *c)) return false;
    return *rest == 0 || is_symbol(*rest);
}

bool unit_begins(const char *text, double *value, int *length)
{
    const char *rest;
    if (!decimal(text, value, &rest)) return false;
    while (*rest == ' ') rest++;
    size_t symbol = 0;
    while (is_symbol(rest[symbol])) symbol++;
    Unit unit;
    if (!symbol || isdigit((unsigned char)rest[symbol]) || rest[symbol] == '_' ||
        !symbol_unit(rest, symbol, &unit))
        return false;
    *value *= unit.factor;
    *length = (int)(rest + symbol - text);
    return true;
}

bool unit_parse(const char *text, const char *unit, double *value, char *wrong, size_t size)
{
    const char *in = unit ? " in " : "", *name = unit ? unit : "", *rest;
    if (!decimal(text, value, &rest) || (*rest && *rest != ' ' && !is_symbol(*rest))) {
        snprintf(wrong, size, "must be a %snumber%s%s, not '%.60s'", is_not_finite(text) ? "finite " : "", in,
                 name, text);
        return false;
    }
    while (*rest == ' ') rest++;
    if (*rest) {
        Unit given, wanted;
        if (!unit) {
            snprintf(wrong, size, "must be a plain number, without the unit in '%.60s'", text);
            return false;
        }
        const char *in_unit = unit;
        if (!parse_unit(&rest, &given)) return no_unit(text, rest, unit, wrong, size), false;
        if (!parse_unit(&in_unit, &wanted) || !is_alike(&given, &wanted)) {
            snprintf(wrong, size, "must be a number in %s, and '%.60s' is %s", unit, text, kind_of(&given));
            return false;
        }
        *value *= given.factor;
    }
    if (isfinite(*value)) return true;
    snprintf(wrong, size, "must be a finite number%s%s, not '%.60s'", in, name, text);
    return false;
}

bool yaml_quantity(const char *text, double *value)
{
    const char *rest;
    Unit unit;
    if (!decimal(text, value, &rest) || (*rest && *rest != ' ' && !is_symbol(*rest))) return false;
    while (*rest == ' ') rest++;
    if (!parse_unit(&rest, &unit)) return false;
    *value *= unit.factor;
    return isfinite(*value);
}

void number_format(double value, char text[40])
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, 40, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    /* 1e+05 is a text to other YAML readers, 1.0e+05 is not. */
    char *e = strchr(text, 'e');
    if (!e || strchr(text, '.')) return;
    char tail[16];
    snprintf(tail, sizeof tail, "%s", e);
    snprintf(e, (size_t)(text + 40 - e), ".0%s", tail);
}

bool yaml_number(const char *text, const char *unit, double *value)
{
    char wrong[200];
    return unit_parse(text, unit, value, wrong, sizeof wrong) && isfinite(*value);
}
