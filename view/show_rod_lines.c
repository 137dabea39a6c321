#include "view/show_rod_lines.h"
#include "base/memory.h"
#include "view/ticks.h"
#include <math.h>
#include <string.h>

enum { LINE_LENGTH = 110 };

typedef struct Print {
    ShowData *data;
    RodLines lines;
} Print;

/* Adds to the last line, or begins another one where that is full. */
static void add_text(Print *print, const char *text)
{
    if (print->lines.count > 0) {
        const char *last = print->lines.text[print->lines.count - 1];
        if (strlen(last) + strlen(text) < LINE_LENGTH) {
            print->lines.text[print->lines.count - 1] = show_text(print->data, "%s, %s", last, text);
            return;
        }
    }
    if (print->lines.count < ROD_LINES_MAX)
        print->lines.text[print->lines.count++] = show_text(print->data, "%s", text);
}

/* Numbers at a path, as doubles: one, or one for each strand. NULL where there are none. */
static const double *numbers(Print *print, const char *path, int *count, const char **unit)
{
    Array array;
    if (!result_has(print->data->result, path) || !result_read(print->data->result, path, &array, NULL))
        return NULL;
    *count = array.type == ARRAY_TEXT ? 0 : (int)array_count(&array);
    *unit = show_text(print->data, "%s", array.unit ? array.unit : "");
    double *values = show_block(print->data, (size_t)*count, sizeof *values);
    for (int k = 0; k < *count; k++)
        values[k] =
            array.type == ARRAY_INT32 ? ((const int *)array.data)[k] : ((const double *)array.data)[k];
    array_clear(&array);
    return *count ? values : NULL;
}

/* "lowest eigenvalue 25.8 1/m²", of several strands the least or the greatest. */
static void add_number(Print *print, const char *path, const char *words, bool least)
{
    int count;
    const char *unit;
    char text[64];
    const double *values = numbers(print, path, &count, &unit);
    if (!values) return;
    double shown = values[0];
    for (int k = 1; k < count; k++) shown = least ? fmin(shown, values[k]) : fmax(shown, values[k]);
    if (!isfinite(shown)) return;
    unit_format(shown, unit, text, sizeof text);
    add_text(print, show_text(print->data, "%s %s", words, text));
}

static void add_stability(Print *print)
{
    int count, stable = 0;
    const char *unit;
    const double *values = numbers(print, "slender/rod/stable", &count, &unit);
    for (int k = 0; values && k < count; k++) stable += values[k] != 0;
    if (values && count > 1)
        add_text(print, show_text(print->data, "%d of %d stable", stable, count));
    else if (values)
        add_text(print, stable ? "stable" : "unstable");
    add_number(print, "slender/rod/lowest_eigenvalue", "lowest eigenvalue", true);
    add_number(print, "slender/rod/critical_young", "stable above a Young's modulus of", false);
    if (values && stable < count) add_number(print, "slender/rod/morse_index", "Morse index", false);
}

/* Each number below a group, named as it is: metrics/largest_distance is "largest distance". */
static void add_group(Print *print, const char *group)
{
    char **paths;
    int count;
    size_t length = strlen(group);
    if (!result_list(print->data->result, &paths, &count, NULL)) return;
    for (int k = 0; k < count; k++) {
        int values;
        const char *unit;
        if (strncmp(paths[k], group, length) || !numbers(print, paths[k], &values, &unit) || values > 1)
            continue;
        char *words = show_text(print->data, "%s", paths[k] + length);
        for (char *c = words; *c; c++)
            if (*c == '_' || *c == '/') *c = ' ';
        add_number(print, paths[k], words, true);
    }
    mem_free(paths);
}

RodLines show_rod_lines(ShowData *data, int strands, int points)
{
    Print whole = {.data = data}, *print = &whole;
    Array status;
    if (result_read(print->data->result, "slender/status", &status, NULL)) {
        add_text(print, status.data);
        array_clear(&status);
    }
    if (strands > 1)
        add_text(print, show_text(print->data, "%d strands, %d points", strands, points));
    else
        add_text(print, show_text(print->data, "%d elements", points - 1));
    add_stability(print);
    add_group(print, "slender/rod/identified/");
    add_group(print, "slender/metrics/");
    return print->lines;
}
