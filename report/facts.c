/* What a result says in single numbers, and its scene. */
#include "base/memory.h"
#include "report/report_private.h"
#include "view/show_curves.h"
#include "view/ticks.h"
#include <string.h>

static void add_fact(Document *document, const char *name, const char *value)
{
    document_open(document, NULL, '[');
    document_text(document, NULL, name);
    document_text(document, NULL, value);
    document_close(document);
}

/* A single number, in a fitting unit, or a text of one line. */
static void add_single(Document *document, const char *name, const Array *array)
{
    char text[64];
    if (array->type == ARRAY_TEXT) {
        if (!strchr(array->data, '\n')) add_fact(document, name, array->data);
    } else if (array->rank == 0) {
        double value = array->type == ARRAY_INT32 ? *(const int *)array->data : *(const double *)array->data;
        unit_format(value, array->unit ? array->unit : "", text, sizeof text);
        add_fact(document, name, text);
    }
}

static bool begins_with(const char *path, const char *const *groups, int count)
{
    for (int k = 0; k < count; k++)
        if (!strncmp(path, groups[k], strlen(groups[k]))) return true;
    return false;
}

static bool is_told_elsewhere(const char *path, bool rods)
{
    static const char *const all[] = {"state/", "scene", "cases/"}, *const of_rods[] = {
                                                                        "rod/stable",
                                                                        "rod/lowest_eigenvalue",
                                                                        "rod/critical_young",
                                                                        "rod/morse_index",
                                                                        "rod/identified/",
                                                                        "metrics/"};
    return begins_with(path, all, 3) || (rods && begins_with(path, of_rods, 6));
}

/* How much of it there is. */
static void add_size(const ReportPart *part, const char *name, const char *path)
{
    Array array;
    if (!result_has(part->data->result, path) || !result_read(part->data->result, path, &array, NULL)) return;
    add_fact(part->document, name, show_text(part->data, "%d", array.dims[0]));
    array_clear(&array);
}

static bool add_rods(const ReportPart *part, Error *err)
{
    ShowCurves curves;
    const ShowFact *facts;
    if (!show_curves_read(&curves, part->data, err)) return false;
    int count = show_curves_facts(&curves, &facts);
    add_fact(part->document, "strands", show_text(part->data, "%d", curves.strand_count));
    add_fact(part->document, "nodes", show_text(part->data, "%d", curves.point_count));
    for (int k = 0; k < count; k++)
        add_fact(part->document, facts[k].name ? facts[k].name : "stability", facts[k].value);
    return true;
}

bool report_facts(const ReportPart *part, Error *err)
{
    static const char group[] = "slender/";
    Result *result = part->data->result;
    char **paths;
    int count;
    Array array;
    bool rods = show_curves_has(part->data);
    if (!result_list(result, &paths, &count, err)) return false;
    document_open(part->document, "facts", '[');
    bool ok = !rods || add_rods(part, err);
    add_size(part, "faces", "slender/faces");
    add_size(part, "tetrahedra", "slender/cells");
    if (result_has(result, "slender/faces")) add_size(part, "vertices", "slender/rest");
    for (int k = 0; k < count; k++) {
        const char *name = paths[k] + strlen(group);
        if (strncmp(paths[k], group, strlen(group)) != 0 || is_told_elsewhere(name, rods) ||
            !result_read(result, paths[k], &array, NULL))
            continue;
        add_single(part->document, name, &array);
        array_clear(&array);
    }
    document_close(part->document);
    mem_free(paths);
    if (result_has(result, "slender/scene") && result_read(result, "slender/scene", &array, NULL)) {
        document_text(part->document, "scene", array.data);
        array_clear(&array);
    }
    return ok;
}
