#include "base/memory.h"
#include "export/body.h"
#include "io/colormap.h"
#include "view/show_mesh.h"
#include <math.h>
#include <string.h>

/* What the faces show: numbers at each moment, or once for all of them. */
typedef struct Paint {
    int count;             /* 0: nothing */
    const double **values; /* [count][face] */
} Paint;

/* Points of the body, each with its own colours: where a vertex has faces of several, there are several of it. */
typedef struct Corners {
    int count;
    int *from;  /* [count] the vertex that it is              */
    int *next;  /* [count] another one of that vertex, or -1  */
    int *face;  /* [count] one of its faces                   */
    int *first; /* [vertex] -1: none                          */
} Corners;

static bool same_value(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static bool same_paint(const Paint *paint, int f, int g)
{
    for (int k = 0; k < paint->count; k++)
        if (!same_value(paint->values[k][f], paint->values[k][g])) return false;
    return true;
}

static bool never_changes(const Paint *paint, int faces)
{
    for (int k = 1; k < paint->count; k++)
        for (int f = 0; f < faces; f++)
            if (!same_value(paint->values[k][f], paint->values[0][f])) return false;
    return true;
}

static int corner_of(Corners *corners, const Paint *paint, int vertex, int face)
{
    int corner = corners->first[vertex];
    while (corner >= 0 && !same_paint(paint, corners->face[corner], face)) corner = corners->next[corner];
    if (corner >= 0) return corner;
    corner = corners->count++;
    corners->from[corner] = vertex, corners->face[corner] = face;
    corners->next[corner] = corners->first[vertex];
    return corners->first[vertex] = corner;
}

static void find_corners(ShowData *data, const Clip *clip, const Paint *paint, Corners *corners,
                         int (*faces)[3])
{
    size_t most = 3 * (size_t)clip->face_count;
    *corners = (Corners){.from = show_block(data, most, sizeof *corners->from),
                         .next = show_block(data, most, sizeof *corners->next),
                         .face = show_block(data, most, sizeof *corners->face),
                         .first = show_block(data, (size_t)clip->point_count, sizeof *corners->first)};
    for (int v = 0; v < clip->point_count; v++) corners->first[v] = -1;
    for (int f = 0; f < clip->face_count; f++)
        for (int i = 0; i < 3; i++) faces[f][i] = corner_of(corners, paint, clip->faces[f][i], f);
}

/* One scale for all moments, as a picture's. */
static ColorScale scale_of(const Paint *paint, int faces)
{
    double *all = mem_alloc((size_t)paint->count * (size_t)faces, sizeof *all);
    for (int k = 0; k < paint->count; k++)
        memcpy(all + (size_t)k * (size_t)faces, paint->values[k], (size_t)faces * sizeof *all);
    ColorScale scale = color_scale_fit(all, paint->count * faces);
    mem_free(all);
    return scale;
}

static void add_colors(ShowData *data, const Corners *corners, const Paint *paint, const ColorScale *scale,
                       ExportBody *body)
{
    body->colors = show_block(data, (size_t)paint->count, sizeof *body->colors);
    body->color_count = paint->count;
    for (int k = 0; k < paint->count; k++) {
        float(*colors)[3] = show_block(data, (size_t)corners->count, sizeof *colors);
        for (int c = 0; c < corners->count; c++) {
            Color color = color_scale_color(scale, paint->values[k][corners->face[c]]);
            colors[c][0] = (float)color_linear(color.r);
            colors[c][1] = (float)color_linear(color.g);
            colors[c][2] = (float)color_linear(color.b);
        }
        body->colors[k] = (const float(*)[3])colors;
    }
}

/* The numbers of the last moment, where all have one. */
static void add_values(ShowData *data, const Corners *corners, const Paint *paint, ExportBody *body)
{
    float *numbers = show_block(data, (size_t)corners->count, sizeof *numbers);
    bool all = true;
    for (int c = 0; c < corners->count; c++) {
        numbers[c] = (float)paint->values[paint->count - 1][corners->face[c]];
        all &= isfinite(numbers[c]);
    }
    if (all) body->values = numbers;
}

/* What was asked for, at all moments. */
static bool read_paint(ShowData *data, const ShowMesh *mesh, const Moments *moments, Paint *paint,
                       ExportBody *body, Error *err)
{
    *paint = (Paint){.values = show_block(data, (size_t)moments->count, sizeof *paint->values)};
    for (int k = 0; k < moments->count; k++) {
        const double **values = &paint->values[k];
        if (!show_mesh_field(mesh, moments->frames[k], values, &body->field_name, &body->field_unit, err))
            return false;
        paint->count += *values != NULL;
    }
    if (paint->count && never_changes(paint, mesh->clip.face_count)) paint->count = 1;
    return true;
}

static bool place_corners(ShowData *data, const ShowMesh *mesh, const Corners *corners,
                          const Moments *moments, ExportBody *body, Error *err)
{
    int count = mesh->body.vertex_count;
    const double(**x)[3] = moments_points(data, moments, "slender/state/x", count, err);
    if (!x) return false;
    body->middle = moments_middle(moments, x, count);
    body->x = show_block(data, (size_t)moments->count, sizeof *body->x);
    for (int k = 0; k < moments->count; k++) {
        const double(*points)[3] = show_mesh_points(mesh, x[k]);
        float(*places)[3] = show_block(data, (size_t)corners->count, sizeof *places);
        for (int c = 0; c < corners->count; c++) {
            Vec3 from = vec3_sub(vec3_load(points[corners->from[c]]), body->middle);
            places[c][0] = (float)from.x, places[c][1] = (float)from.y, places[c][2] = (float)from.z;
        }
        body->x[k] = (const float(*)[3])places;
    }
    return true;
}

static bool fill(ShowData *data, const ShowMesh *mesh, const Moments *moments, ExportBody *body, Error *err)
{
    Paint paint;
    Corners corners;
    const Clip *clip = &mesh->clip;
    if (!read_paint(data, mesh, moments, &paint, body, err)) return false;
    int(*faces)[3] = show_block(data, (size_t)clip->face_count, sizeof *faces);
    find_corners(data, clip, &paint, &corners, faces);
    body->name = "body", body->indices = faces[0];
    body->point_count = corners.count, body->index_count = 3 * clip->face_count;
    if (paint.count) {
        ColorScale scale = scale_of(&paint, clip->face_count);
        add_colors(data, &corners, &paint, &scale, body);
        add_values(data, &corners, &paint, body);
    }
    return place_corners(data, mesh, &corners, moments, body, err);
}

bool body_of_mesh(ShowData *data, const Moments *moments, ExportBody *body, Error *err)
{
    ShowMesh mesh;
    bool ok = show_mesh_read(&mesh, data, err) && fill(data, &mesh, moments, body, err);
    show_mesh_clear(&mesh);
    return ok;
}
