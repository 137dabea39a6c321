/* What the stages of a sequence are called: after what changes from the one before. */
#include "report/report_private.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>

/* A number or a vector of each stage, and how it is said. */
typedef struct Quantity {
    const char *path, *unit, *say;
    int width;
    const double *rows; /* [stage][width]; NULL: it is the same in all of them */
    bool turns;         /* its direction is not */
} Quantity;

static const Quantity quantities[] = {
    {.path = "slender/frames/flux_density", .unit = "T", .say = "%s", .width = 3},
    {.path = "slender/stages/time", .unit = "s", .say = "t = %s", .width = 1},
    {.path = "slender/stages/gravity", .unit = "m/s^2", .say = "gravity %s", .width = 3},
    {.path = "slender/stages/load_part", .unit = "", .say = "%s of the loads", .width = 1}};
enum { QUANTITIES = sizeof quantities / sizeof *quantities };

static const double SAME = 1e-6; /* frames are in single precision */

static double size_of(const double *row, int width)
{
    double square = 0;
    for (int i = 0; i < width; i++) square += row[i] * row[i];
    return sqrt(square);
}

/* In parts of what both are. */
static double change(const Quantity *q, int stage, int other)
{
    const double *a = q->rows + q->width * stage, *b = q->rows + q->width * other;
    double off[3], both = size_of(a, q->width) + size_of(b, q->width);
    for (int i = 0; i < q->width; i++) off[i] = a[i] - b[i];
    return both > 0 ? size_of(off, q->width) / both : 0;
}

/* Do they point to different sides? One that is 0 points nowhere. */
static bool is_turned(const Quantity *q, int stage, int other)
{
    const double *a = q->rows + q->width * stage, *b = q->rows + q->width * other;
    double across[3], both = size_of(a, q->width) * size_of(b, q->width), along = 0;
    if (q->width < 3) return false;
    for (int i = 0; i < 3; i++) {
        across[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
        along += a[i] * b[i];
    }
    return size_of(across, 3) > SAME * both || along < 0;
}

/* Where it changes: of all stages the pairs of neighbours, and for its direction all with the strongest. */
static void read_quantity(const ReportPart *part, Quantity *q)
{
    Array array;
    ShowData *data = part->data;
    if (!result_has(data->result, q->path) ||
        !result_read_as(data->result, q->path, ARRAY_FLOAT64, q->width > 1 ? 2 : 1,
                        q->width > 1 ? q->width : 0, &array, NULL))
        return;
    int count = array.dims[0], strongest = 0;
    bool changes = false;
    q->rows = show_keep(data, array);
    for (int k = 1; k < count; k++) {
        changes |= change(q, k, k - 1) > SAME;
        if (size_of(q->rows + q->width * k, q->width) > size_of(q->rows + q->width * strongest, q->width))
            strongest = k;
    }
    for (int k = 0; k < count; k++) q->turns |= is_turned(q, k, strongest);
    if (!changes || count < result_step_count(data->result)) q->rows = NULL;
}

/* "20 mT", of one that turns "20 mT along (0, 0.6, 0.8)". */
static const char *say(ShowData *data, const Quantity *q, int stage)
{
    char number[64];
    const double *row = q->rows + q->width * stage;
    double size = q->width > 1 ? size_of(row, q->width) : *row;
    unit_format(size, q->unit, number, sizeof number);
    char *words = show_text(data, q->say, number);
    if (!q->turns || size == 0) return words;
    double unit[3];
    for (int i = 0; i < 3; i++) unit[i] = fabs(row[i]) < 1e-3 * size ? 0 : row[i] / size;
    return show_text(data, "%s along (%.2g, %.2g, %.2g)", words, unit[0], unit[1], unit[2]);
}

const char *const *report_stages(const ReportPart *part)
{
    ShowData *data = part->data;
    Quantity known[QUANTITIES];
    const char **names = show_block(data, (size_t)part->frame_count, sizeof *names);
    for (int i = 0; i < QUANTITIES; i++) known[i] = quantities[i], read_quantity(part, &known[i]);
    for (int k = 0; k < part->frame_count; k++) {
        int stage = part->frames[k];
        const char *before = ": ";
        names[k] = show_text(data, "stage %d", stage);
        for (int i = 0; i < QUANTITIES; i++) {
            if (!known[i].rows || (stage > 0 && change(&known[i], stage, stage - 1) <= SAME)) continue;
            names[k] = show_text(data, "%s%s%s", names[k], before, say(data, &known[i], stage));
            before = ", ";
        }
    }
    return names;
}
