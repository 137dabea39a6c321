/* Of an inversion: curves of one moving rod at several times, from files or a result, and what inertia and drag are as loads
 * on them. */
#include "base/memory.h"
#include "io/result.h"
#include "rod/front/front.h"
#include <math.h>
#include <string.h>

enum { NEEDED = 3 }; /* for a second difference */

/* Curves at times, ascending. */
typedef struct Sequence {
    int count;
    RodCurve *curves; /* [count] owned */
    double *times;    /* [count] s     */
} Sequence;

static void sequence_clear(Sequence *m)
{
    for (int k = 0; k < m->count; k++) rod_curve_clear(&m->curves[k]);
    mem_free(m->curves);
    mem_free(m->times);
}

static Sequence sequence_create(int most)
{
    return (Sequence){.curves = mem_alloc((size_t)most, sizeof(RodCurve)),
                      .times = mem_alloc((size_t)most, sizeof(double))};
}

static bool from_files(const Build *b, const RodMotionScene *scene, int elements, Sequence *m)
{
    bool ok = true;
    *m = sequence_create(scene->frames_count);
    for (int k = 0; ok && k < scene->frames_count; k++, m->count += ok) {
        const RodMotionFrameScene *frame = &scene->frames[k];
        Key at = key("rod.motion.frames[%d].file", k);
        m->times[k] = frame->time;
        ok = rod_curve_read(b, (Sampled){at.text, frame->file, 1, frame->noise, elements}, &m->curves[k],
                            NULL);
    }
    return ok;
}

/* The rod's nodes in a frame of a result, and its time. */
static bool read_frame(Result *result, int k, int nodes, Array *x, double *time, Error *err)
{
    Array value;
    bool whole = result_has(result, "slender/frames/x");
    if (!(whole ? result_read_rows(result, "slender/frames/x", k, 1, x, err)
                : result_read_step(result, "Points", k, x, err)))
        return false;
    bool ok = x->type == ARRAY_FLOAT64 && array_count(x) >= 3 * (size_t)nodes;
    if (!ok) error_set(err, "frame %d has fewer places than the rod has nodes", k);
    ok = ok && result_read_rows(result, "VTKHDF/Steps/Values", k, 1, &value, err);
    if (ok) *time = *(double *)value.data, array_clear(&value);
    if (!ok) array_clear(x);
    return ok;
}

static bool read_frames(Result *result, int elements, Sequence *m, Error *err)
{
    const RodSamplesDef exact = {.noise = 0};
    Array s;
    if (!result_has(result, "slender/rod/s") || result_has(result, "slender/rod/strands"))
        return error_set(err, "it is no result of one rod");
    if (!result_read_as(result, "slender/rod/s", ARRAY_FLOAT64, 1, 0, &s, err)) return false;
    int nodes = s.dims[0], frames = result_step_count(result);
    array_clear(&s);
    bool ok = true;
    *m = sequence_create(frames);
    for (int k = 0; ok && k < frames; k++, m->count += ok) {
        Array x;
        ok = read_frame(result, k, nodes, &x, &m->times[k], err);
        if (!ok) break;
        ok = rod_samples_curve(x.data, nodes, &exact, elements, &m->curves[k], NULL, err);
        array_clear(&x);
    }
    return ok;
}

static bool from_result(const Build *b, const RodMotionScene *scene, int elements, Sequence *m)
{
    Error err;
    Result *result = result_open(scene->result, &err);
    if (!result) return yaml_refuse(b->file, "rod.motion.result", "%s", err.text);
    bool ok = read_frames(result, elements, m, &err);
    result_close(result);
    return ok || yaml_refuse(b->file, "rod.motion.result", "%s: %s", scene->result, err.text);
}

/* Are they of one rod, whose clamp stays as it is, one after the other? */
static bool check(const Build *b, const Sequence *m)
{
    const char *at = "rod.motion";
    if (m->count < NEEDED)
        return yaml_refuse(b->file, at, "it has %d frames; accelerations need %d", m->count, NEEDED);
    for (int k = 1; k < m->count; k++) {
        const RodCurve *first = &m->curves[0], *own = &m->curves[k];
        if (!(m->times[k] > m->times[k - 1]))
            return yaml_refuse(b->file, at,
                               "its times must increase: frame %d is at %g s, the one before at %g s", k,
                               m->times[k], m->times[k - 1]);
        if (fabs(own->length - first->length) > 0.02 * first->length)
            return yaml_refuse(b->file, at, "frame %d is %g m long and the first one %g m: not the same rod",
                               k, own->length, first->length);
        if (vec3_dot(own->t[0], first->t[0]) < cos(10 * M_PI / 180))
            return yaml_refuse(b->file, at,
                               "the rod turns at its clamp: frame %d begins in another direction than "
                               "the first one",
                               k);
    }
    return true;
}

/* Each frame that has its neighbours becomes a strand, with frames that begin with one and the same n1. */
static bool make_strands(RodModel *model, const RodScene *scene, const Build *b, Sequence *m)
{
    int at = scene->motion->difference == ROD_CENTRAL ? 1 : 2, count = m->count - 2;
    size_t stations = 2 * (size_t)scene->elements + 1;
    Vec3 normal = vec3_load(scene->bishop_normal);
    model->strand_count = count;
    model->curves = mem_alloc((size_t)count, sizeof *model->curves);
    model->frames = mem_alloc((size_t)count, sizeof *model->frames);
    model->inertia = mem_alloc((size_t)count, sizeof *model->inertia);
    model->times = mem_copy(m->times + at, (size_t)count, sizeof *model->times);
    for (int k = 0; k < count; k++) model->curves[k] = m->curves[k + at];
    bool ok = rod_model_take_properties(model, scene, b);
    for (int k = 0; ok && k < count; k++) {
        const RodCurve *const three[] = {&m->curves[k], &m->curves[k + 1], &m->curves[k + 2]};
        model->inertia[k] = mem_alloc(stations, sizeof **model->inertia);
        model->frames[k] = mem_alloc(stations, sizeof **model->frames);
        rod_inertia(three, m->times + k, at, rod_model_sections(model, k), scene->damping, model->inertia[k]);
        if (k == 0 && isnan(normal.x)) {
            rod_frenet(three[at], model->frames[0]);
            normal = model->frames[0][0].n1;
        }
        rod_bishop(three[at], normal, model->frames[k]);
    }
    for (int k = 0; k < count; k++) m->curves[k + at] = (RodCurve){0};
    return ok;
}

bool rod_read_motion(RodModel *model, const RodScene *scene, const Build *b)
{
    Sequence m = {0};
    const RodMotionScene *motion = scene->motion;
    bool ok = (motion->result ? from_result : from_files)(b, motion, scene->elements, &m) && check(b, &m);
    ok = ok && make_strands(model, scene, b, &m);
    sequence_clear(&m);
    return ok;
}
