#include "model/frame_flux.h"
#include "base/memory.h"
#include "model/model.h"
#include "model/stored.h"
#include <math.h>
#include <string.h>

static const char UNIFORM[] = "slender/frames/flux_uniform", SOURCES[] = "slender/frames/flux_sources";

void frame_flux_numbers(const FluxBlocks *blocks, const double *p, int source, double row[FRAME_FLUX_WIDTH])
{
    row[0] = p[blocks->scale + source] * p[blocks->strength + source];
    memcpy(row + 1, p + blocks->move + 3 * source, 3 * sizeof *row);
    memcpy(row + 4, p + blocks->turn + 3 * source, 3 * sizeof *row);
}

/* The fields of all cases or stages in the order of the body's, without the body. */
static bool read_fields(const Scene *scene, YamlFile *file, FluxFields *fields)
{
    Model model = {.time = scene->time.at};
    Build b = build_start(scene, NULL, model.time, file);
    b.timed = scene_job(scene)->motion ? &model.flux_of_time : NULL;
    bool ok = model_read_flux(&model, &b, scene, fields);
    timed_clear(&model.flux_of_time);
    mem_free(model.flux);
    return ok;
}

/* Makes the fields of the result's scene. */
static bool make_fields(Result *result, FluxFields *fields, Error *err)
{
    YamlFile *file;
    Scene scene;
    int count = 0;
    bool ok = stored_result_scene(result, &file, &scene) && read_fields(&scene, file, fields);
    const YamlError *errors = ok || !file ? NULL : yaml_errors(file, &count);
    if (!ok) error_set(err, "%s", count ? errors[0].sentence : "its scene cannot be read");
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ok;
}

bool frame_flux_open(FrameFlux *flux, Result *result, Error *err)
{
    *flux = (FrameFlux){0};
    if (!result_has(result, UNIFORM) || !result_has(result, SOURCES)) return true;
    if (!make_fields(result, &flux->fields, err)) return false;
    flux->blocks = flux_blocks_add(&flux->params, &flux->fields,
                                   params_add(&flux->params, "flux_density", "T", 1, 3, true));
    flux->p = params_vector(&flux->params);
    flux_blocks_default(&flux->fields, &flux->blocks, flux->p);
    return true;
}

void frame_flux_clear(FrameFlux *flux)
{
    flux_fields_clear(&flux->fields);
    params_clear(&flux->params);
    mem_free(flux->p);
}

/* So many numbers of a frame. */
static bool read_row(Result *result, const char *path, int frame, size_t count, double *row, Error *err)
{
    Array array;
    if (!result_read_rows(result, path, frame, 1, &array, err)) return false;
    bool fits = array.type == ARRAY_FLOAT64 && array_count(&array) == count;
    if (fits) memcpy(row, array.data, count * sizeof *row);
    array_clear(&array);
    return fits || error_set(err, "%s is not of the sources of its scene", path);
}

/* That of a stage, or of all states of rest; 0 where the result does not say. */
static double time_of(Result *result, int frame)
{
    static const char stages[] = "slender/stages/time", state[] = "slender/state/time";
    double time = 0;
    Array array;
    if (result_has(result, stages)) return read_row(result, stages, frame, 1, &time, NULL) ? time : 0;
    if (!result_has(result, state) || !result_read(result, state, &array, NULL)) return 0;
    if (array.type == ARRAY_FLOAT64 && array_count(&array) == 1) time = *(double *)array.data;
    array_clear(&array);
    return time;
}

bool frame_flux_take(FrameFlux *flux, Result *result, int frame, double time, Error *err)
{
    const FluxBlocks *blocks = &flux->blocks;
    size_t count = (size_t)flux->fields.count;
    double *rows = mem_alloc(FRAME_FLUX_WIDTH * count, sizeof *rows);
    bool ok = read_row(result, UNIFORM, frame, 3, flux->p + blocks->uniform, err) &&
              read_row(result, SOURCES, frame, FRAME_FLUX_WIDTH * count, rows, err);
    for (size_t k = 0; ok && k < count; k++) {
        const double *row = rows + FRAME_FLUX_WIDTH * k;
        flux->p[(size_t)blocks->scale + k] = row[0];
        memcpy(flux->p + (size_t)blocks->move + 3 * k, row + 1, 3 * sizeof *row);
        memcpy(flux->p + (size_t)blocks->turn + 3 * k, row + 4, 3 * sizeof *row);
    }
    flux->time = isnan(time) ? time_of(result, frame) : time;
    mem_free(rows);
    return ok;
}

/* False where it does not act. */
static bool place_of(const FrameFlux *flux, int source, FluxPlace *place)
{
    const FluxBlocks *blocks = &flux->blocks;
    *place =
        (FluxPlace){flux->time, flux->p + blocks->move + 3 * source, flux->p + blocks->turn + 3 * source};
    return flux->p[blocks->scale + source] != 0;
}

void frame_flux_at(const FrameFlux *flux, const double x[3], double B[3])
{
    FluxPlace place;
    flux_value((FluxSum){&flux->fields, flux->blocks, flux->p, flux->time}, x, B);
    for (int k = 0; k < flux->fields.count; k++)
        if (place_of(flux, k, &place) && flux_field_find_within(flux->fields.items[k], x, 1, place) == 0)
            B[0] = B[1] = B[2] = NAN;
}

bool frame_flux_middle(const FrameFlux *flux, int source, double middle[3])
{
    const FluxField *field = flux->fields.items[source];
    FluxPlace place;
    if (!place_of(flux, source, &place) || !flux_field_has_shape(field)) return false;
    flux_field_middle(field, place, middle);
    return true;
}
