#include "view/show_cases.h"
#include "base/memory.h"
#include <string.h>

static const double CLOUD_DOT = 1.2; /* its radius, points */

bool show_cases(ShowData *data, ShowCases *cases, Error *err)
{
    static const char PATH[] = "slender/case_names";
    const char *only = data->def->only;
    Array array;
    *cases = (ShowCases){0};
    if (!result_has(data->result, PATH))
        return !only || error_set(err, "--case %s: the result has no load cases", only);
    if (!result_read_as(data->result, PATH, ARRAY_TEXT, 1, 0, &array, err)) return false;
    char *text = show_keep(data, array), *rest = NULL;
    size_t lines = 1;
    for (const char *c = text; *c; c++) lines += *c == '\n';
    const char **names = show_block(data, lines, sizeof *names);
    for (char *name = strtok_r(text, "\n", &rest); name; name = strtok_r(NULL, "\n", &rest))
        if (!only || !strcmp(only, name)) names[cases->count++] = name;
    cases->names = names;
    return cases->count > 0 || !only || error_set(err, "the result has no load case '%s'", only);
}

const char *show_cases_frame(ShowData *data, const ShowCases *cases, int frame)
{
    int from_end = result_step_count(data->result) - frame;
    bool named = !data->motion && cases->count > 1 && frame >= 0 && from_end <= cases->count;
    return named ? cases->names[cases->count - from_end] : show_frame_name(data, frame);
}

void *show_case_dataset(ShowData *data, const char *name, const char *what, size_t count)
{
    char *path = mem_format("slender/cases/%s/%s", name, what);
    void *numbers = show_dataset(data, path, ARRAY_FLOAT64, count);
    mem_free(path);
    return numbers;
}

const double (*show_case_target(ShowData *data, const char *name, const double (*x)[3], int count))[3]
{
    double(*target)[3] = show_case_dataset(data, name, "target", 3 * (size_t)count);
    if (target) show_fill_places(target, x, count);
    return (const double(*)[3])target;
}

const double (*show_case_cloud_points(ShowData *data, const char *name, const double (*x)[3], int count,
                                      int *points))[3]
{
    Array cloud;
    char *path = mem_format("slender/cases/%s/cloud", name);
    bool there = result_has(data->result, path) &&
                 result_read_as(data->result, path, ARRAY_FLOAT64, 2, 3, &cloud, NULL);
    mem_free(path);
    if (!there) return NULL;
    double(*at)[3] = show_keep(data, cloud), middle[3] = {0};
    *points = cloud.dims[0];
    for (int i = 0; i < 3 * count; i++) middle[i % 3] += x[i / 3][i % 3] / count;
    for (int k = 0; k < *points; k++) show_fill_places(&at[k], (const double(*)[3]) & middle, 1);
    return (const double(*)[3])at;
}

int show_case_cloud(ShowData *data, const char *name, const double (*x)[3], int count, Color ink,
                    const MarkDot **dots)
{
    int points = 0;
    const double(*at)[3] = show_case_cloud_points(data, name, x, count, &points);
    if (!at) return 0;
    MarkDot *made = show_block(data, (size_t)points, sizeof *made);
    for (int k = 0; k < points; k++) made[k] = (MarkDot){k ? NULL : "cloud", at[k], ink, CLOUD_DOT, false};
    *dots = made;
    return points;
}
