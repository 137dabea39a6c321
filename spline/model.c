#include "spline/model.h"
#include "base/memory.h"

SplineModelDef spline_model_default(void)
{
    return (SplineModelDef){.points = 4, .pair_kernel = PAIR_WENDLAND, .pair_radius = 1.6};
}

static void number_segments(SplineModel *model)
{
    int segment = 0;
    for (int k = 0; k < model->stroke_count; k++)
        for (int node = model->start[k]; node < model->start[k + 1] - 1; node++)
            model->segment_node[segment++] = node;
}

/* Places half a pen apart along the longest segment at rest; no fewer than four intervals. */
static SplineRule outline_rule(const SplineTarget *target, const double *rest, int segments)
{
    double longest = 0;
    for (int k = 0; k < segments; k++) longest = fmax(longest, rest[k]);
    return spline_rule_even(1 +
                            (int)fmin(fmax(ceil(2 * longest / target->page.pen), 4), RULE_MAX_POINTS - 1));
}

enum { GROUP_SEGMENTS = 64 };

static void group_strokes(SplineModel *model)
{
    model->group = mem_alloc((size_t)model->stroke_count + 1, sizeof *model->group);
    for (int k = 1, first = 0; k <= model->stroke_count; k++) {
        int segment = spline_first_segment(model, k);
        if (segment - first < GROUP_SEGMENTS && k < model->stroke_count) continue;
        model->group[++model->group_count] = k;
        first = segment;
    }
}

static Pack *packs_of(const double *values, int count)
{
    int packs = pack_count(count);
    Pack *to = mem_alloc((size_t)packs, sizeof *to);
    for (int k = 0; k < packs * PACK_LANES; k++)
        to[k / PACK_LANES][k % PACK_LANES] = values[k < count ? k : count - 1];
    return to;
}

SplineModel *spline_model_create(const SplineTarget *target, const Strokes *strokes, const double *rest,
                                 const SplineModelDef *def)
{
    SplineModel *model = mem_alloc(1, sizeof *model);
    *model = (SplineModel){.target = target,
                           .workers = def->workers,
                           .stroke_count = strokes->count,
                           .node_count = strokes_node_count(strokes),
                           .segment_count = strokes_segment_count(strokes),
                           .rule = spline_rule_gauss(def->points),
                           .wall_rule = spline_rule_hull(),
                           .pair_kernel = def->pair_kernel,
                           .pair_radius = def->pair_radius * target->spacing};
    const SplinePage *page = &target->page;
    bool ends = def->pair_kernel != PAIR_COULOMB;
    model->pair_reach = ends ? model->pair_radius : 4 * (page->width + page->height); /* beyond the page */
    if (target->outline) model->outline_rule = outline_rule(target, rest, model->segment_count);
    size_t segments = (size_t)model->segment_count;
    model->start = mem_alloc((size_t)strokes->count + 1, sizeof *model->start);
    if (strokes->count)
        memcpy(model->start, strokes->start, ((size_t)strokes->count + 1) * sizeof *model->start);
    model->segment_node = mem_alloc(segments, sizeof *model->segment_node);
    number_segments(model);
    group_strokes(model);
    model->rest = mem_copy(rest, segments, sizeof *rest);
    model->rest_pack = packs_of(rest, model->segment_count);
    return model;
}

void spline_model_destroy(SplineModel *model)
{
    if (!model) return;
    mem_free(model->start);
    mem_free(model->segment_node);
    mem_free(model->group);
    mem_free(model->rest);
    mem_free(model->rest_pack);
    mem_free(model);
}
