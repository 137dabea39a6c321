/* rod_taper.h - a rod of rectangles that grow smaller along each strand, for tests. */
#pragma once
#include "base/memory.h"
#include "rod/rod.h"

/* Sides at the clamp, m, and what is left of them at the end, which the elements' middles have their part of. */
static inline void rod_taper(Rod *rod, double width, double height, const double left[2], double poisson,
                             double density)
{
    int each = rod_each(rod);
    RodSection *unit = mem_alloc((size_t)rod->elements, sizeof *unit);
    for (int e = 0; e < rod->elements; e++) {
        double part = (e % each + 0.5) / each;
        unit[e] = rod_rectangle(width * (1 - part + left[0] * part), height * (1 - part + left[1] * part), 1,
                                poisson, density);
    }
    rod_set_sections(rod, unit);
    mem_free(unit);
}
