#include "spline/target.h"
#include "base/memory.h"
#include <math.h>

static double mean_density(const SplineGrid *grid)
{
    double sum = 0;
    long count = (long)grid->columns * grid->rows;
    for (long k = 0; k < count; k++) sum += fmin(fmax(grid->values[k], 0), 1);
    return sum / (double)count;
}

double spline_line_distance(const SplineGrid *density, const SplinePage *page)
{
    double sum = 0, drawn = 0, blank = spline_blank_density(page);
    long count = (long)density->columns * density->rows;
    for (long k = 0; k < count; k++) {
        if (!(density->values[k] >= blank)) continue;
        sum += fmin(density->values[k], 1);
        drawn++;
    }
    return page->pen / (drawn > 0 ? sum / drawn : blank);
}

SplineTarget *spline_target_create(const SplinePage *page, const SplineFields *fields, const ProbesDef *def)
{
    SplineTarget *target = mem_alloc(1, sizeof *target);
    *target = (SplineTarget){.page = *page,
                             .density = mean_density(&fields->density),
                             .spacing = spline_line_distance(&fields->density, page),
                             .probes = probes_create(page, &fields->density, def),
                             .align = grid_spline_create(&fields->align, page),
                             .potential = grid_spline_create(&fields->potential, page),
                             .flow = grid_spline_create(&fields->flow, page),
                             .outline = grid_spline_create(&fields->outline, page)};
    return target;
}

void spline_target_destroy(SplineTarget *target)
{
    if (!target) return;
    probes_destroy(target->probes);
    grid_spline_destroy(target->align);
    grid_spline_destroy(target->potential);
    grid_spline_destroy(target->flow);
    grid_spline_destroy(target->outline);
    mem_free(target);
}

double spline_ink_budget(const SplineTarget *target)
{
    return target->density / target->page.pen;
}

int spline_stroke_budget(const SplineTarget *target, int segments, double rest)
{
    return (int)lround(spline_ink_budget(target) / (segments * rest + 2 * spline_pen_cap(&target->page)));
}
