/* Curves and frames of rods from formulas and files (rod_model.h). */
#include "rod/front/curves.h"
#include "base/memory.h"
#include "io/polyline_file.h"
#include "io/table.h"
#include "rod/samples.h"
#include <math.h>
#include <string.h>

/* ---- Curves ---- */

typedef struct FormulaCurve {
    Formula *formula;
    double strand;
    Error *err;
    bool failed;
} FormulaCurve;

static bool formula_point(void *self, double u, Vec3 *x)
{
    FormulaCurve *curve = self;
    double variables[] = {u, curve->strand}, place[3] = {0};
    if (curve->failed || !formula_eval(curve->formula, variables, place, curve->err)) {
        curve->failed = true;
        return false;
    }
    *x = vec3_load(place);
    return true;
}

static bool curves_from_formula(const Build *b, const RodCurveScene *scene, int elements, RodStrands *strands)
{
    const char *variables[] = {scene->parameter, "n", NULL};
    Error err, trouble;
    if (!scene->range)
        return yaml_refuse(b->file, "rod.curve", "a formula needs `range`, e.g. range: [0, 1]");
    Formula *formula = build_formula(b, key("rod.curve.formula"), scene->formula, 3, scene->where,
                                     scene->where_count, variables);
    if (!formula) return false;
    strands->curves = mem_alloc((size_t)scene->strands, sizeof *strands->curves);
    bool ok = true;
    for (int k = 0; ok && k < scene->strands; k++) {
        FormulaCurve curve = {formula, k, &trouble, false};
        ok = rod_curve_create(formula_point, &curve, scene->range[0], scene->range[1], elements,
                              &strands->curves[k], &err);
        strands->count += ok;
        if (!ok) yaml_refuse(b->file, "rod.curve.formula", "%s", curve.failed ? trouble.text : err.text);
    }
    formula_destroy(formula);
    return ok;
}

static RodSamplesDef samples_def(Sampled from)
{
    RodSamplesDef def = rod_samples_default();
    if (from.noise.mode < 0) def.noise = from.noise.value;
    return def;
}

/* Through the points of a strand; refused with the file's name and line. */
static bool curve_from_strand(const Build *b, Sampled from, const PolylineFile *file, int k, RodCurve *curve)
{
    RodSamplesDef def = samples_def(from);
    Error err;
    return rod_samples_curve(file->points + file->first[k], file->first[k + 1] - file->first[k], &def,
                             from.elements, curve, NULL, &err) ||
           yaml_refuse(b->file, from.at, "%s:%d: %s", from.path, file->line[k], err.text);
}

/* All polylines of a file, to be cleared in any case. */
static bool read_polylines(const Build *b, Sampled from, PolylineFile *file)
{
    Error err;
    *file = (PolylineFile){0};
    if (!polyline_file_read(from.path, file, &err)) return yaml_refuse(b->file, from.at, "%s", err.text);
    if (file->scaled && from.scale != 1)
        return yaml_refuse(b->file, from.at,
                           "%s: its header says units, which are honoured: leave `scale` out", from.path);
    for (int i = 0; i < file->point_count; i++) file->points[i] = vec3_scale(from.scale, file->points[i]);
    return true;
}

bool rod_curve_read(const Build *b, Sampled from, RodCurve *curve, RodDraws *draws)
{
    PolylineFile file;
    RodSamplesDef def = samples_def(from);
    Error err;
    bool ok = read_polylines(b, from, &file);
    if (ok && file.strand_count > 1)
        ok = yaml_refuse(b->file, from.at, "%s has %d polylines; one is needed here", from.path,
                         file.strand_count);
    ok = ok && curve_from_strand(b, from, &file, 0, curve);
    if (ok && draws)
        ok = rod_samples_draw(file.points, file.first[1], &def, from.elements, draws, &err) ||
             yaml_refuse(b->file, from.at, "%s:%d: with noise as large as its own: %s", from.path,
                         file.line[0], err.text);
    polyline_file_clear(&file);
    return ok;
}

static bool curves_from_file(const Build *b, const RodCurveScene *scene, int elements, RodStrands *strands)
{
    Sampled from = {"rod.curve.file", scene->file, scene->scale, scene->noise, elements};
    PolylineFile file;
    bool ok = read_polylines(b, from, &file);
    strands->curves = mem_alloc((size_t)file.strand_count, sizeof *strands->curves);
    for (int k = 0; ok && k < file.strand_count; k++) {
        ok = curve_from_strand(b, from, &file, k, &strands->curves[k]);
        strands->count += ok;
    }
    polyline_file_clear(&file);
    return ok;
}

/* ---- Frames ---- */

/* n1 at the clamp: what was asked for, or Frenet's. */
static bool first_normal(const Build *b, const RodScene *scene, const RodCurve *curve, RodFrame *frames,
                         Vec3 *normal)
{
    rod_frenet(curve, frames);
    *normal = frames[0].n1;
    if (isnan(scene->bishop_normal[0])) return true;
    *normal = vec3_load(scene->bishop_normal);
    Vec3 across = vec3_cross(*normal, curve->t[0]);
    return vec3_length(across) > 1e-6 * vec3_length(*normal) ||
           yaml_refuse(b->file, "rod.bishop_normal", "it is along the curve's tangent at the clamp, or zero");
}

/* How a curve is to be framed, and where the scene says so: rod.frame, or an entry of rod.frames. */
typedef struct Framing {
    const RodFrameScene *frame;
    Key at;
} Framing;

static bool turn_frames(const Build *b, Framing how, const RodCurve *curve, RodFrame *frames)
{
    static const char *const variables[] = {"s", "L", NULL};
    Key at = key("%s.formula", how.at.text);
    Error err;
    Formula *formula = build_formula(b, at, (char *const *)&how.frame->formula, 1, NULL, 0, variables);
    bool ok = formula != NULL;
    for (int j = 0; ok && j <= 2 * curve->elements; j++) {
        double angle, values[] = {curve->length * j / (2 * curve->elements), curve->length};
        ok = formula_eval(formula, values, &angle, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
        if (ok) frames[j] = rod_turned(frames[j], angle);
    }
    formula_destroy(formula);
    return ok;
}

static bool frames_from_file(const Build *b, Framing how, const RodCurve *curve, RodFrame *frames)
{
    Key at = key("%s.file", how.at.text);
    Table table;
    bool ok = rod_table_read(b, at.text, how.frame->file, "s [m], x, y, z", curve->length, &table);
    for (int j = 0; ok && j <= 2 * curve->elements; j++) {
        double normal[3];
        rod_table_at(&table, curve->length * j / (2 * curve->elements), normal);
        Vec3 n1 = vec3_load(normal), t = curve->t[j], across = vec3_axpy(-vec3_dot(n1, t), t, n1);
        ok = vec3_length(across) > 1e-3 * vec3_length(n1) ||
             yaml_refuse(b->file, at.text, "n1 is along the tangent near s = %g m",
                         curve->length * j / (2 * curve->elements));
        if (ok) frames[j] = (RodFrame){t, vec3_unit(across), vec3_cross(t, vec3_unit(across))};
    }
    table_clear(&table);
    return ok;
}

static bool make_frames(const Build *b, const RodScene *scene, Framing how, const RodCurve *curve,
                        RodFrame *frames)
{
    Vec3 normal;
    const RodFrameScene *frame = how.frame;
    int kind = frame->formula ? frame->from : frame->kind;
    bool turns_least = !frame->file && kind == FRAME_BISHOP;
    if (!isnan(scene->bishop_normal[0]) && !turns_least && !scene->frames)
        return yaml_refuse(b->file, "rod.bishop_normal",
                           "it is of Bishop's frames, and `frame` gives others");
    if (frame->file) return frames_from_file(b, how, curve, frames);
    if (!first_normal(b, scene, curve, frames, &normal)) return false;
    if (kind == FRAME_BISHOP) rod_bishop(curve, normal, frames);
    return !frame->formula || turn_frames(b, how, curve, frames);
}

/* One curve as many times as it has framings. */
static bool repeat_curve(const Build *b, const RodScene *scene, RodStrands *strands)
{
    if (strands->count > 1)
        return yaml_refuse(b->file, "rod.frames", "they are of one curve, and there are %d", strands->count);
    size_t count = (size_t)scene->frames_count, stations = 2 * (size_t)scene->elements + 1;
    strands->curves = mem_resize(strands->curves, 1, count, sizeof *strands->curves);
    for (; strands->count < scene->frames_count; strands->count++) {
        RodCurve *curve = &strands->curves[strands->count];
        *curve = strands->curves[0];
        curve->x = mem_copy(curve->x, stations, sizeof *curve->x);
        curve->t = mem_copy(curve->t, stations, sizeof *curve->t);
        curve->c = mem_copy(curve->c, stations, sizeof *curve->c);
    }
    return true;
}

bool rod_strands_read(const Build *b, const RodScene *scene, RodStrands *strands)
{
    const RodCurveScene *curve = scene->curve;
    *strands = (RodStrands){0};
    if (!(curve->formula ? curves_from_formula : curves_from_file)(b, curve, scene->elements, strands))
        return false;
    if (scene->frames && !repeat_curve(b, scene, strands)) return false;
    strands->frames = mem_alloc((size_t)strands->count, sizeof *strands->frames);
    for (int k = 0; k < strands->count; k++) {
        strands->frames[k] = mem_alloc(2 * (size_t)scene->elements + 1, sizeof **strands->frames);
        Framing how = scene->frames ? (Framing){&scene->frames[k], key("rod.frames[%d]", k)}
                                    : (Framing){&scene->frame, key("rod.frame")};
        if (!make_frames(b, scene, how, &strands->curves[k], strands->frames[k])) return false;
    }
    return true;
}

void rod_strands_clear(RodStrands *strands)
{
    for (int k = 0; k < strands->count; k++) {
        rod_curve_clear(&strands->curves[k]);
        if (strands->frames) mem_free(strands->frames[k]);
    }
    mem_free(strands->curves);
    mem_free(strands->frames);
    *strands = (RodStrands){0};
}

bool rod_table_open(const Build *b, const char *at, const char *path, const char *names, Table *table)
{
    Error err;
    if (!table_read(path, names, table, &err) || !table_check_increasing(table, path, "s", &err))
        return yaml_refuse(b->file, at, "%s", err.text);
    return table->rows >= 2 || yaml_refuse(b->file, at, "%s has fewer than two rows", path);
}

bool rod_table_check(const Build *b, const char *at, const char *path, double length, const Table *table)
{
    const double little = 1e-3;
    int end = table->rows - 1;
    double first = table->values[0], last = table->values[(size_t)end * (size_t)table->columns];
    if (first < -little * length || last > (1 + little) * length)
        return yaml_refuse(b->file, at, "%s:%d: s goes from %g to %g m, and the rod is %g m long", path,
                           table->line[end], first, last, length);
    return last - first >= (1 - little) * TABLE_SHARE * length ||
           yaml_refuse(b->file, at,
                       "%s:%d: s goes from %g to %g m only, and the rod is %g m long: rows along half of it "
                       "at least are needed",
                       path, table->line[end], first, last, length);
}

bool rod_table_read(const Build *b, const char *at, const char *path, const char *names, double length,
                    Table *table)
{
    return rod_table_open(b, at, path, names, table) && rod_table_check(b, at, path, length, table);
}

void rod_table_at(const Table *table, double s, double *values)
{
    int width = table->columns, row = 0, above = table->rows - 1; /* s is beyond `row`, or it is the first */
    while (above - row > 1) {
        int middle = (row + above) / 2;
        *(table->values[middle * width] < s ? &row : &above) = middle;
    }
    const double *a = table->values + row * width, *b = a + width;
    double part = b[0] > a[0] ? fmin(fmax((s - a[0]) / (b[0] - a[0]), 0), 1) : 0;
    for (int k = 1; k < width; k++) values[k - 1] = a[k] + part * (b[k] - a[k]);
}
