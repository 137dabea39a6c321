#include "view/show_curves.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "view/show_cases.h"
#include "view/ticks.h"
#include <math.h>
#include <string.h>

enum { STRANDS_FEW = 20, FACTS_MAX = 64 };

bool show_curves_has(const ShowData *data)
{
    Result *result = data->result;
    return !result_has(result, "slender/faces") &&
           (result_has(result, "slender/rod/input") || result_has(result, "slender/rod/x"));
}

/* ---- Reading ---- */

/* Offsets that begin at 0 and grow. */
static bool offsets_fit(const Array *array)
{
    const int *offsets = array->data;
    bool fits = array->dims[0] >= 2 && offsets[0] == 0;
    for (int k = 1; fits && k < array->dims[0]; k++) fits = offsets[k] > offsets[k - 1];
    return fits;
}

/* One strand: all points of the curves. */
static bool read_one_strand(ShowCurves *curves, Error *err)
{
    Result *result = curves->data->result;
    Array array;
    const char *path = result_has(result, "slender/rod/x") ? "slender/rod/x" : "slender/rod/input";
    if (!result_read_as(result, path, ARRAY_FLOAT64, 2, 3, &array, err)) return false;
    int *offsets = show_block(curves->data, 2, sizeof *offsets);
    offsets[1] = array.dims[0];
    curves->strands = offsets, curves->strand_count = 1;
    array_clear(&array);
    return true;
}

/* Of a result without cases the state that it has. */
static bool read_states(ShowCurves *curves, Error *err)
{
    ShowCases cases;
    size_t numbers = 3 * (size_t)curves->point_count;
    if (!show_cases(curves->data, &cases, err)) return false;
    curves->states = show_block(curves->data, (size_t)cases.count + 1, sizeof *curves->states);
    for (int k = 0; k < cases.count; k++) {
        const char *name = cases.names[k];
        const double(*x)[3] = show_case_dataset(curves->data, name, "x", numbers);
        if (!x) continue;
        ShowCurvesState *state = &curves->states[curves->state_count++];
        *state = (ShowCurvesState){.name = cases.count > 1 ? name : NULL, .load_case = name, .x = x};
        if (!curves->input) state->target = show_case_target(curves->data, name, x, curves->point_count);
    }
    if (curves->state_count) return true;
    curves->states[0].x = show_dataset(curves->data, "slender/rod/x", ARRAY_FLOAT64, numbers);
    curves->state_count = curves->states[0].x != NULL;
    return true;
}

bool show_curves_read(ShowCurves *curves, ShowData *data, Error *err)
{
    static const char STRANDS[] = "slender/rod/strands";
    Array array;
    *curves = (ShowCurves){.data = data};
    if (!result_has(curves->data->result, STRANDS)) {
        if (!read_one_strand(curves, err)) return false;
    } else {
        if (!result_read_as(curves->data->result, STRANDS, ARRAY_INT32, 1, 0, &array, err)) return false;
        curves->strands = show_keep(curves->data, array);
        curves->strand_count = array.dims[0] - 1;
        if (!offsets_fit(&array)) return error_set(err, "%s is not as slender writes it", STRANDS);
    }
    curves->point_count = curves->strands[curves->strand_count];
    size_t numbers = 3 * (size_t)curves->point_count;
    curves->input = show_dataset(curves->data, "slender/rod/input", ARRAY_FLOAT64, numbers);
    curves->natural = show_dataset(curves->data, "slender/rod/natural", ARRAY_FLOAT64, numbers);
    if (!read_states(curves, err)) return false;
    curves->x = curves->states[0].x;
    return curves->input || curves->x || error_set(err, "the result's curves are not as slender writes them");
}

const double *show_curves_radii(ShowData *data, int strand_count, const int *first)
{
    enum { OUTLINE = 24 };
    size_t nodes = (size_t)first[strand_count], elements = nodes - (size_t)strand_count;
    const double *each = show_dataset(data, "slender/rod/radius", ARRAY_FLOAT64, elements),
                 *outline = show_dataset(data, "slender/rod/section_outline", ARRAY_FLOAT64, 2 * OUTLINE);
    if (!each && !outline) return NULL;
    double *radius = show_block(data, nodes, sizeof *radius), reach = 0;
    for (int i = 0; outline && i < OUTLINE; i++)
        reach = fmax(reach, hypot(outline[2 * i], outline[2 * i + 1]));
    for (int k = 0; k < strand_count; k++)
        for (int i = first[k]; i < first[k + 1]; i++) {
            int before = i > first[k] ? i - 1 - k : i - k, after = i + 1 < first[k + 1] ? i - k : i - 1 - k;
            radius[i] = each ? (each[before] + each[after]) / 2 : reach;
        }
    return radius;
}

/* ---- Charts ---- */

/* A series over s, interrupted between the strands. values: every `stride`-th number. */
static ChartSeries make_series(const ShowCurves *curves, const char *name, const double *s,
                               const double *values, int stride)
{
    int count = curves->point_count + curves->strand_count, at = 0;
    double *x = show_block(curves->data, (size_t)count, sizeof *x),
           *y = show_block(curves->data, (size_t)count, sizeof *y);
    for (int k = 0; k < curves->strand_count; k++) {
        for (int i = curves->strands[k]; i < curves->strands[k + 1]; i++)
            x[at] = s[i], y[at++] = values[i * stride];
        x[at] = s[curves->strands[k]], y[at++] = NAN;
    }
    return (ChartSeries){.name = name, .count = count, .x = x, .y = y};
}

/* s [points]; NULL where it is not there, or many strands would only hide each other. */
static const double *lengths(const ShowCurves *curves)
{
    return curves->strand_count > STRANDS_FEW
               ? NULL
               : show_dataset(curves->data, "slender/rod/s", ARRAY_FLOAT64, (size_t)curves->point_count);
}

int show_curves_strains(const ShowCurves *curves, Chart charts[FRAMING_CHARTS])
{
    static const char *const names[] = {"twist", "k1", "k2"};
    const double *s = lengths(curves), *strain = show_dataset(curves->data, "slender/rod/natural_strain",
                                                              ARRAY_FLOAT64, 3 * (size_t)curves->point_count);
    if (!s || !strain) return 0;
    int framings = show_framings(curves->data, curves->strand_count, curves->strands, s, strain, charts);
    if (framings) return framings;
    ChartSeries *series = show_block(curves->data, 3, sizeof *series);
    for (int k = 0; k < 3; k++) series[k] = make_series(curves, names[k], s, strain + k, 3);
    charts[0] = (Chart){.x_label = "s",
                        .x_unit = "m",
                        .y_label = "natural strain",
                        .y_unit = "1/m",
                        .y_axis = CHART_LINEAR,
                        .series_count = 3,
                        .series = series,
                        .first_color = 2};
    return 1;
}

bool show_curves_have_target(const ShowCurves *curves)
{
    bool has = false;
    for (int k = 0; k < curves->state_count; k++) has |= curves->states[k].target != NULL;
    return has;
}

static ChartSeries distance_series(const ShowCurves *curves, const double *s, int state)
{
    const double(*x)[3] = state ? curves->states[state].x : curves->x,
          (*to)[3] = curves->input ? curves->input : curves->states[state].target;
    double *distance = show_block(curves->data, (size_t)curves->point_count, sizeof *distance);
    for (int i = 0; i < curves->point_count; i++)
        distance[i] = to ? vec3_length(vec3_sub(vec3_load(x[i]), vec3_load(to[i]))) : NAN;
    const char *name = curves->states[state].name;
    return make_series(curves, name ? name : "simulated", s, distance, 1);
}

bool show_curves_distance(const ShowCurves *curves, Chart *chart)
{
    const double *s = lengths(curves);
    if (!s || !(curves->input || show_curves_have_target(curves)) || !curves->x) return false;
    int count = curves->input ? 1 : curves->state_count;
    ChartSeries *series = show_block(curves->data, (size_t)count, sizeof *series);
    for (int k = 0; k < count; k++) series[k] = distance_series(curves, s, k);
    *chart = (Chart){.x_label = "s",
                     .x_unit = "m",
                     .y_label = curves->input ? "distance to input" : "distance to target",
                     .y_unit = "m",
                     .y_axis = CHART_LINEAR,
                     .series_count = count,
                     .series = series,
                     .first_color = 1};
    return true;
}

/* ---- Facts ---- */

typedef struct Facts {
    const ShowCurves *curves;
    ShowFact *list; /* [FACTS_MAX] */
    int count;
} Facts;

static void add_fact(Facts *facts, const char *name, const char *value)
{
    if (facts->count < FACTS_MAX) facts->list[facts->count++] = (ShowFact){name, value};
}

/* Numbers at a path, as doubles: one, or one for each strand. NULL where there are none. */
static const double *numbers(const ShowCurves *curves, const char *path, int *count, const char **unit)
{
    Array array;
    if (!result_has(curves->data->result, path) || !result_read(curves->data->result, path, &array, NULL))
        return NULL;
    *count = array.type == ARRAY_TEXT ? 0 : (int)array_count(&array);
    *unit = show_text(curves->data, "%s", array.unit ? array.unit : "");
    double *values = show_block(curves->data, (size_t)*count, sizeof *values);
    for (int k = 0; k < *count; k++)
        values[k] =
            array.type == ARRAY_INT32 ? ((const int *)array.data)[k] : ((const double *)array.data)[k];
    array_clear(&array);
    return *count ? values : NULL;
}

/* "lowest eigenvalue 25.8 1/m²", of several strands the least or the greatest. */
static void add_number(Facts *facts, const char *path, const char *words, bool least)
{
    int count;
    const char *unit;
    char text[64];
    const double *values = numbers(facts->curves, path, &count, &unit);
    if (!values) return;
    double shown = values[0];
    for (int k = 1; k < count; k++) shown = least ? fmin(shown, values[k]) : fmax(shown, values[k]);
    if (!isfinite(shown)) return;
    unit_format(shown, unit, text, sizeof text);
    add_fact(facts, words, show_text(facts->curves->data, "%s", text));
}

static void add_stability(Facts *facts)
{
    int count, stable = 0;
    const char *unit;
    const double *values = numbers(facts->curves, "slender/rod/stable", &count, &unit);
    for (int k = 0; values && k < count; k++) stable += values[k] != 0;
    if (values && count > 1)
        add_fact(facts, NULL, show_text(facts->curves->data, "%d of %d stable", stable, count));
    else if (values)
        add_fact(facts, NULL, stable ? "stable" : "unstable");
    add_number(facts, "slender/rod/lowest_eigenvalue", "lowest eigenvalue", true);
    add_number(facts, "slender/rod/critical_young", "stable above a Young's modulus of", false);
    if (values && stable < count) add_number(facts, "slender/rod/morse_index", "Morse index", false);
}

/* Each number below a group, named as it is: metrics/largest_distance is "largest distance". */
static void add_group(Facts *facts, const char *group)
{
    char **paths;
    int count;
    size_t length = strlen(group);
    if (!result_list(facts->curves->data->result, &paths, &count, NULL)) return;
    for (int k = 0; k < count; k++) {
        int values;
        const char *unit;
        if (strncmp(paths[k], group, length) || !numbers(facts->curves, paths[k], &values, &unit) ||
            values > 1)
            continue;
        char *words = show_text(facts->curves->data, "%s", paths[k] + length);
        for (char *c = words; *c; c++)
            if (*c == '_' || *c == '/') *c = ' ';
        add_number(facts, paths[k], words, true);
    }
    mem_free(paths);
}

int show_curves_facts(const ShowCurves *curves, const ShowFact **facts)
{
    Facts all = {curves, show_block(curves->data, FACTS_MAX, sizeof *all.list), 0};
    add_stability(&all);
    add_group(&all, "slender/rod/identified/");
    add_group(&all, "slender/metrics/");
    *facts = all.list;
    return all.count;
}
