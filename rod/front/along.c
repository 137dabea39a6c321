/* What a rod is made of along its strands (rod_model.h). */
#include "base/memory.h"
#include "rod/front/rod_model.h"
#include <math.h>

/* Along a strand; all that is largest, into the model. */
static bool vary(RodModel *model, const Build *b, int elements, double L, RodVaried *varied)
{
    int stations = 2 * elements + 1;
    varied->unit = mem_alloc((size_t)stations, sizeof *varied->unit);
    varied->section = mem_alloc((size_t)stations, sizeof *varied->section);
    varied->young = mem_alloc((size_t)stations, sizeof *varied->young);
    for (int j = 0; j < stations; j++) {
        RodSection *unit = &varied->unit[j], *section = &varied->section[j];
        double *young = &varied->young[j];
        if (!rod_properties_at(&model->properties, b, L * j / (2 * elements), L, unit, young)) return false;
        *section = rod_section_of(*unit, *young);
        rod_section_most(&model->unit, unit);
        rod_section_most(&model->section, section);
        model->young = fmax(model->young, *young);
    }
    return true;
}

bool rod_model_take_properties(RodModel *model, const RodScene *scene, const Build *b)
{
    const RodProperties *properties = &model->properties;
    int strands = model->strand_count ? model->strand_count : 1;
    double length = model->strand_count ? rod_model_longest(model) : scene->length;
    if (properties->varies && isnan(length)) return true; /* check_rod refuses it */
    if (!rod_properties_at(properties, b, 0, length, &model->unit, &model->young)) return false;
    model->section = rod_section_of(model->unit, model->young);
    if (!properties->varies) return true;
    bool ok = rod_properties_check(properties, b, length);
    model->varied = mem_alloc((size_t)strands, sizeof *model->varied);
    for (int k = 0; ok && k < strands; k++)
        ok = vary(model, b, scene->elements, model->strand_count ? model->curves[k].length : length,
                  &model->varied[k]);
    return ok;
}

RodSections rod_model_sections(const RodModel *model, int strand)
{
    return model->varied ? (RodSections){model->varied[strand].section, true} : rod_alike(&model->section);
}

/* The station in the middle of an element of its strand. */
static int middle_station(const Rod *rod, int e)
{
    return 2 * (e % rod_each(rod)) + 1;
}

void rod_model_put_sections(const RodModel *model, int strand, Rod *rod)
{
    if (!model->varied) return;
    RodSection *unit = mem_alloc((size_t)rod->elements, sizeof *unit);
    for (int e = 0; e < rod->elements; e++)
        unit[e] = model->varied[strand + e / rod_each(rod)].unit[middle_station(rod, e)];
    rod_set_sections(rod, unit);
    mem_free(unit);
}

void rod_model_put_young(const RodModel *model, int strand, const Rod *rod, double *p)
{
    for (int e = 0; model->varied && e < rod->elements; e++)
        p[rod->young + e] = model->varied[strand + e / rod_each(rod)].young[middle_station(rod, e)];
}

void rod_model_clear_varied(RodModel *model)
{
    for (int k = 0; model->varied && k < (model->strand_count ? model->strand_count : 1); k++) {
        mem_free(model->varied[k].unit);
        mem_free(model->varied[k].section);
        mem_free(model->varied[k].young);
    }
    mem_free(model->varied);
    rod_properties_clear(&model->properties);
}
