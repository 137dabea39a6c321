/* Arrows of the flux density of sources whose field varies in space: at the body and on a coarse grid around it. */
#include "base/memory.h"
#include "base/vec3.h"
#include "model/frame_flux.h"
#include "report/report_private.h"
#include <math.h>
#include <string.h>

enum { ON_BODY = 16, AROUND = 320 };

/* Beyond the body's way, in parts of its largest side; how far magnets and coils may be, in parts of its radius, for the grid to
 * reach them: as far as the page shows them. What is weaker than WEAKEST of the strongest is as weak as that. */
static const double BESIDE = 0.25, FAR = 4, WEAKEST = 1e-4;

typedef struct Arrows {
    const ReportPart *part; /* its way is the body's */
    FrameFlux flux;
    int count, on_body; /* the first ones are points of the body */
    int vertex[ON_BODY];
    double grid[AROUND][3];
    double *points, *B, *size; /* [frame][count][3] m, T; [frame][count] T */
} Arrows;

static bool read_points(const Arrows *a, int k, Array *points, Error *err)
{
    return result_read_step(a->part->data->result, "Points", a->part->frames[k], points, err);
}

static bool take_frame(Arrows *a, int k, Error *err)
{
    const ReportPart *part = a->part;
    double time = part->timed ? show_frame_time(part->data, part->frames[k]) : NAN;
    return frame_flux_take(&a->flux, part->data->result, part->frames[k], time, err);
}

/* ---- Where they are ---- */

/* Each point is the farthest one from those before it: they are spread over the body. */
static void choose_vertices(Arrows *a, const double (*x)[3], int count)
{
    double *away = mem_alloc((size_t)count, sizeof *away);
    for (int v = 0; v < count; v++) away[v] = INFINITY;
    for (int next = 0; a->on_body < ON_BODY && a->on_body < count;) {
        a->vertex[a->on_body++] = next;
        Vec3 from = vec3_load(x[next]);
        next = 0;
        for (int v = 0; v < count; v++) {
            Vec3 d = vec3_sub(vec3_load(x[v]), from);
            away[v] = fmin(away[v], vec3_dot(d, d));
            if (away[v] > away[next]) next = v;
        }
    }
    mem_free(away);
}

/* The way of the body, and what a grid beside it has to reach. */
static bool find_box(Arrows *a, double low[3], double high[3], Error *err)
{
    const ShowWay *way = &a->part->way;
    Array x;
    if (!read_points(a, 0, &x, err)) return false;
    choose_vertices(a, (const double(*)[3])x.data, x.dims[0]);
    array_clear(&x);
    Vec3 side = vec3_sub(way->high, way->low);
    double more = BESIDE * fmax(side.x, fmax(side.y, side.z));
    Vec3 beside = vec3(more, more, more);
    vec3_store(low, vec3_sub(way->low, beside));
    vec3_store(high, vec3_add(way->high, beside));
    return true;
}

static bool reach_sources(Arrows *a, double low[3], double high[3], Error *err)
{
    Vec3 middle = vec3_load(a->part->origin);
    double radius = vec3_length(vec3_sub(a->part->way.high, middle)), source[3];
    for (int k = 0; k < a->part->frame_count; k++) {
        if (!take_frame(a, k, err)) return false;
        for (int s = 0; s < a->flux.fields.count; s++) {
            if (!frame_flux_middle(&a->flux, s, source) ||
                vec3_length(vec3_sub(vec3_load(source), middle)) > FAR * radius)
                continue;
            for (int i = 0; i < 3; i++) low[i] = fmin(low[i], source[i]), high[i] = fmax(high[i], source[i]);
        }
    }
    return true;
}

/* The middles of cubes that fill the box. */
static void make_grid(Arrows *a, const double low[3], const double high[3])
{
    double volume = 1, side;
    int cells[3], count = AROUND + 1;
    for (int i = 0; i < 3; i++) volume *= high[i] - low[i];
    for (side = cbrt(volume / AROUND); count > AROUND; side *= 1.02) {
        count = 1;
        for (int i = 0; i < 3; i++)
            cells[i] = (int)fmax(1, lround((high[i] - low[i]) / side)), count *= cells[i];
    }
    for (int k = 0; k < count; k++) {
        const int at[3] = {k % cells[0], k / cells[0] % cells[1], k / cells[0] / cells[1]};
        for (int i = 0; i < 3; i++) a->grid[k][i] = low[i] + (high[i] - low[i]) * (at[i] + 0.5) / cells[i];
    }
    a->count = a->on_body + count;
}

/* ---- What they are ---- */

static bool fill_frame(Arrows *a, int k, Error *err)
{
    Array array;
    size_t first = (size_t)k * (size_t)a->count;
    double(*points)[3] = (double(*)[3])a->points + first, (*B)[3] = (double(*)[3])a->B + first;
    if (!take_frame(a, k, err) || !read_points(a, k, &array, err)) return false;
    for (int v = 0; v < a->on_body; v++)
        memcpy(points[v], (const double *)array.data + 3 * a->vertex[v], sizeof *points);
    memcpy(points + a->on_body, a->grid, (size_t)(a->count - a->on_body) * sizeof *points);
    array_clear(&array);
    for (int n = 0; n < a->count; n++) {
        frame_flux_at(&a->flux, points[n], B[n]);
        a->size[first + (size_t)n] = vec3_length(vec3_load(B[n]));
    }
    return true;
}

/* Directions beside sizes, whose logarithm is told. False where there is no field anywhere. */
static bool split(Arrows *a)
{
    double low, high;
    size_t count = (size_t)a->part->frame_count * (size_t)a->count;
    document_range(a->size, count, &low, &high);
    for (size_t n = 0; n < count; n++) {
        double size = a->size[n];
        for (size_t i = 0; i < 3; i++) a->B[3 * n + i] = size > 0 ? a->B[3 * n + i] / size : 0;
        a->size[n] = size > 0 ? fmax(size, WEAKEST * high) : NAN;
    }
    return high > 0;
}

/* One row of what is the same in all frames. */
static Packed rows_of(const Arrows *a, const double *rows, Packed shape)
{
    shape.rows = (size_t)a->part->frame_count;
    if (report_is_static(rows, shape.rows, shape.width)) shape.rows = 1;
    return shape;
}

static void add_arrows(const Arrows *a)
{
    Document *document = a->part->document;
    size_t count = (size_t)a->count;
    document_open(document, "arrows", '{');
    document_number(document, "on_body", a->on_body);
    Packed points = rows_of(a, a->points, (Packed){.width = 3 * count, .stride = 3, .bits = 16}),
           ways = rows_of(a, a->B, (Packed){.width = 3 * count, .stride = 3, .bits = 8}),
           sizes = rows_of(a, a->size, (Packed){.width = count, .stride = 1, .bits = 8, .log = true});
    report_places(a->part, "points", a->points, points);
    document_packed(document, "directions", a->B, ways);
    document_packed(document, "sizes", a->size, sizes);
    document_close(document);
}

static bool make_arrows(Arrows *a, Error *err)
{
    double low[3], high[3];
    size_t frames = (size_t)a->part->frame_count;
    if (!find_box(a, low, high, err) || !reach_sources(a, low, high, err)) return false;
    make_grid(a, low, high);
    a->points = show_block(a->part->data, 3 * frames * (size_t)a->count, sizeof *a->points);
    a->B = show_block(a->part->data, 3 * frames * (size_t)a->count, sizeof *a->B);
    a->size = show_block(a->part->data, frames * (size_t)a->count, sizeof *a->size);
    for (int k = 0; k < a->part->frame_count; k++)
        if (!fill_frame(a, k, err)) return false;
    return true;
}

/* All else is there where they cannot be made. */
void report_flux(const ReportPart *part)
{
    Arrows arrows = {.part = part};
    Error gone;
    bool ok = frame_flux_open(&arrows.flux, part->data->result, &gone), any = ok && arrows.flux.fields.count;
    if (any && part->frame_count) ok = make_arrows(&arrows, &gone);
    if (!ok)
        document_text(part->document, "no_arrows", gone.text);
    else if (arrows.count && split(&arrows))
        add_arrows(&arrows);
    frame_flux_clear(&arrows.flux);
}
