/* Which evaluations of a design its frames are of. */
#include "model/stored.h"
#include "report/report_private.h"
#include <math.h>

/* How many evaluations were better than all before them, and which, better[count]. */
static int find_better(const double *objective, int count, int *better)
{
    int found = 0;
    double least = INFINITY;
    for (int k = 0; k < count; k++)
        if (objective[k] < least) least = objective[k], better[found++] = k;
    return found;
}

/* `output: {every: N}`. */
static int read_every(const ReportPart *part)
{
    YamlFile *file;
    Scene scene;
    int every = stored_result_scene(part->data->result, &file, &scene) ? scene.output.every : 0;
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return every;
}

/* The last frames, one of each case, are the best evaluation; those before are every so many better ones, the start first. */
void report_evaluations(const ReportPart *part)
{
    static const char path[] = "slender/history/objective";
    ShowData *data = part->data;
    Array history;
    if (part->timed || !result_has(data->result, path) ||
        !result_read_as(data->result, path, ARRAY_FLOAT64, 1, 0, &history, NULL))
        return;
    int every = read_every(part), cases = part->cases.count ? part->cases.count : 1;
    int *better = show_block(data, array_count(&history), sizeof *better);
    int found = find_better(history.data, (int)array_count(&history), better);
    array_clear(&history);
    if (found == 0) return;
    document_open(part->document, "evaluations", '[');
    for (int k = 0; k < part->frame_count; k++) {
        int from_end = result_step_count(data->result) - part->frames[k], at = every * part->frames[k];
        document_number(part->document, NULL, better[from_end <= cases || at >= found ? found - 1 : at]);
    }
    document_close(part->document);
}
