/* ticks.h - where an axis is labelled, and how numbers and units are written.
 *
 * Texts are UTF-8. */
#pragma once
#include <stddef.h>

enum { TICKS_MAX = 16, TICKS_TEXT = 64 };

typedef struct Ticks {
    int count;
    double value[TICKS_MAX]; /* ascending, within the range */
    char text[TICKS_MAX]
             [TICKS_TEXT]; /* all with the same number of decimals: "0.5", "1.0"; typographic minus */
} Ticks;

/* Multiples of 1, 2 or 5 times a power of ten within [low, high], wanted (2..10) or fewer intervals. low ==
 * high gives one tick there. */
Ticks ticks_linear(double low, double high, int wanted);

/* Multiples of step within [low, high], the first TICKS_MAX of them. */
Ticks ticks_every(double step, double low, double high);

/* Powers of ten within [low, high], both > 0: every one, every second, ... so that no more than `wanted` + 1
 * remain. Texts are "10⁻³". */
Ticks ticks_log(double low, double high, int wanted);

/* The nearest 1, 2 or 5 times a power of ten that is not below (not above) the number, which is > 0. */
double ticks_round_up(double number);
double ticks_round_down(double number);

/* How numbers up to some size are shown in a unit: shown = factor * number, followed by `unit`. */
typedef struct UnitScale {
    double factor;
    char unit[TICKS_TEXT]; /* "kA/m", "10⁻⁶ m²", "" */
} UnitScale;

/* Picks the SI prefix (p .. G) that shows the greatest number as 1..1000. Units that take none (products,
 * powers, 1/m, rad, no unit), and numbers beyond the prefixes, get a power of ten instead, unless the number is shown
 * within 0.01..10000. "m^2" is written "m²". */
UnitScale unit_scale(const char *unit, double greatest);

/* number with three significant digits and its scaled unit: "50 mT", "1.25 kA/m", "3.1·10⁻⁶ m²". */
void unit_format(double number, const char *unit, char *text, size_t size);
