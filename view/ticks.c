#include "view/ticks.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MINUS "\u2212"

enum { DIGITS = 3 }; /* of a number with its unit */

static const char *const superscripts[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                           "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};

/* Writes "10⁻³". */
static void power_text(int exponent, char text[TICKS_TEXT])
{
    char digits[16];
    snprintf(digits, sizeof digits, "%d", abs(exponent));
    int length = snprintf(text, TICKS_TEXT, "10%s", exponent < 0 ? "\u207b" : "");
    for (const char *d = digits; *d; d++)
        length += snprintf(text + length, (size_t)(TICKS_TEXT - length), "%s", superscripts[*d - '0']);
}

/* Prints with so many decimals and a typographic minus; never "-0". */
static void number_text(double number, int decimals, char *text, size_t size)
{
    char digits[TICKS_TEXT - 8];
    snprintf(digits, sizeof digits, "%.*f", decimals, fabs(number));
    bool zero = strspn(digits, "0.") == strlen(digits);
    snprintf(text, size, "%s%s", number < 0 && !zero ? MINUS : "", digits);
}

double ticks_round_up(double number)
{
    double power = pow(10, floor(log10(number)));
    for (int i = 0; i < 3; i++) {
        double step = (const double[]){1, 2, 5}[i] * power;
        if (step >= number * (1 - 1e-9)) return step;
    }
    return 10 * power;
}

double ticks_round_down(double number)
{
    return 1 / ticks_round_up(1 / number);
}

Ticks ticks_every(double step, double low, double high)
{
    Ticks ticks = {.count = 0};
    int decimals = (int)fmin(fmax(-floor(log10(step) + 1e-9), 0), 12);
    double first = ceil(low / step - 1e-6);
    for (int i = 0; i < TICKS_MAX; i++) {
        double value = (first + i) * step;
        if (value > high + 1e-6 * step) break;
        ticks.value[i] = value;
        number_text(value, decimals, ticks.text[i], TICKS_TEXT);
        ticks.count = i + 1;
    }
    return ticks;
}

Ticks ticks_linear(double low, double high, int wanted)
{
    if (high > low) return ticks_every(ticks_round_up((high - low) / wanted), low, high);
    return ticks_every(fabs(low) > 0 ? fabs(low) : 1, low, low);
}

Ticks ticks_log(double low, double high, int wanted)
{
    Ticks ticks = {.count = 0};
    int first = (int)ceil(log10(low) - 1e-9), last = (int)floor(log10(high) + 1e-9);
    int step = 1;
    while ((last - first) / step > wanted) step++;
    for (int e = first; e <= last && ticks.count < TICKS_MAX; e += step) {
        ticks.value[ticks.count] = pow(10, e);
        power_text(e, ticks.text[ticks.count++]);
    }
    return ticks;
}

/* Copies the unit with ^2 and ^3 raised. */
static void unit_text(const char *unit, char *text, size_t size)
{
    size_t length = 0;
    text[0] = 0;
    while (*unit && length + 4 < size) {
        bool raised = unit[0] == '^' && unit[1] >= '0' && unit[1] <= '9';
        if (raised) unit++;
        length += (size_t)snprintf(text + length, size - length, raised ? "%s" : "%.1s",
                                   raised ? superscripts[*unit - '0'] : unit);
        unit++;
    }
}

/* Does the unit begin with one of these symbols at the power one, so that a prefix means what it says? */
static bool unit_takes_prefix(const char *unit)
{
    static const char *const symbols[] = {"m", "A", "T", "N", "J", "Pa", "s", "W", "V", "Hz"};
    size_t length = strcspn(unit, "^*/ ");
    if (unit[length] != 0 && unit[length] != '/') return false;
    for (size_t i = 0; i < sizeof symbols / sizeof symbols[0]; i++)
        if (strlen(symbols[i]) == length && strncmp(symbols[i], unit, length) == 0) return true;
    return false;
}

/* A power of ten that says how large it is. */
static UnitScale power_scale(const char *unit, double size)
{
    UnitScale scale;
    int exponent = (int)floor(log10(size) + 1e-9);
    char power[TICKS_TEXT];
    power_text(exponent, power);
    scale.factor = pow(10, -exponent);
    snprintf(scale.unit, sizeof scale.unit, "%.22s%s%s", power, unit[0] ? " " : "", unit);
    return scale;
}

/* To so many digits, as it will be shown: that decides of the prefix. */
static double rounded(double number, int digits)
{
    char text[32];
    snprintf(text, sizeof text, "%.*e", digits - 1, number);
    double result = strtod(text, NULL);
    return isfinite(result) ? result : number;
}

UnitScale unit_scale(const char *unit, double greatest)
{
    static const char *const prefixes[] = {"p", "n", "\u00b5", "m", "", "k", "M", "G"};
    char plain[TICKS_TEXT - 24];
    unit_text(unit, plain, sizeof plain);
    double size = fabs(greatest);
    if (!(size >= DBL_MIN) || !isfinite(size)) size = 1;
    double shown = rounded(size, DIGITS), whole = rounded(size, DIGITS + 1); /* thousands have one more */
    int thousands = unit_takes_prefix(unit) ? (int)fmin(fmax(floor(log10(shown) / 3 + 1e-9), -4), 3) : 0;
    UnitScale scale = {.factor = pow(1000, -thousands)};
    if (shown * scale.factor < 0.01 * (1 - 1e-9) || whole * scale.factor >= 10000 * (1 - 1e-9))
        return power_scale(plain, shown);
    snprintf(scale.unit, sizeof scale.unit, "%s%s", prefixes[thousands + 4], plain);
    return scale;
}

void unit_format(double number, const char *unit, char *text, size_t size)
{
    if (!isfinite(number)) {
        snprintf(text, size, "%g", number);
        return;
    }
    UnitScale scale = unit_scale(unit, number);
    double shown = number * scale.factor;
    if (fabs(shown) < 1000) shown = rounded(number, DIGITS) * scale.factor;
    char digits[TICKS_TEXT];
    int whole = shown == 0 ? 1 : (int)floor(log10(fabs(shown)) + 1e-9) + 1;
    int decimals = whole >= DIGITS ? 0 : DIGITS - whole;
    number_text(shown, decimals, digits, sizeof digits);
    if (strchr(digits, '.')) { /* 50.0 says no more than 50 here */
        size_t length = strlen(digits);
        while (digits[length - 1] == '0') digits[--length] = 0;
        if (digits[length - 1] == '.') digits[length - 1] = 0;
    }
    bool power = strncmp(scale.unit, "10", 2) == 0;
    snprintf(text, size, "%s%s%s", digits, power ? "\u00b7" : scale.unit[0] ? " " : "", scale.unit);
}
