#include "base/memory.h"
#include "export/body.h"
#include "io/colormap.h"
#include "view/show_mesh.h"
#include <math.h>
#include <string.h>

/* Points of the body, each with one colour: where a vertex has faces of several, there are several of it. */
typedef struct Corners {
    int count;
    int *from;     /* [count] the vertex that it is                */
    int *next;     /* [count] another one of that vertex, or -1    */
    double *value; /* [count] of its faces                         */
    int *first;    /* [vertex] -1: none                            */
} Corners;

static bool same_value(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static int corner_of(Corners *corners, int vertex, double value)
{
    int corner = corners->first[vertex];
    while (corner >= 0 && !same_value(corners->value[corner], value)) corner = corners->next[corner];
    if (corner >= 0) return corner;
    corner = corners->count++;
    corners->from[corner] = vertex, corners->value[corner] = value;
    corners->next[corner] = corners->first[vertex];
    return corners->first[vertex] = corner;
}

/* values: [face] of a field, or NULL. */
static void find_corners(ShowData *data, const Clip *clip, const double *values, Corners *corners,
                         int (*faces)[3])
{
    size_t most = 3 * (size_t)clip->face_count;
    *corners = (Corners){.from = show_block(data, most, sizeof *corners->from),
                         .next = show_block(data, most, sizeof *corners->next),
                         .value = show_block(data, most, sizeof *corners->value),
                         .first = show_block(data, (size_t)clip->point_count, sizeof *corners->first)};
    for (int v = 0; v < clip->point_count; v++) corners->first[v] = -1;
    for (int f = 0; f < clip->face_count; f++)
        for (int i = 0; i < 3; i++)
            faces[f][i] = corner_of(corners, clip->faces[f][i], values ? values[f] : 0);
}

/* Their colours, and the numbers where all have one. */
static void paint(ShowData *data, const Corners *corners, const double *values, int faces, ExportBody *body)
{
    ColorScale scale = color_scale_fit(values, faces);
    float(*colors)[3] = show_block(data, (size_t)corners->count, sizeof *colors);
    float *numbers = show_block(data, (size_t)corners->count, sizeof *numbers);
    bool all = true;
    for (int k = 0; k < corners->count; k++) {
        Color color = color_scale_color(&scale, corners->value[k]);
        colors[k][0] = (float)color_linear(color.r);
        colors[k][1] = (float)color_linear(color.g);
        colors[k][2] = (float)color_linear(color.b);
        numbers[k] = (float)corners->value[k];
        all &= isfinite(numbers[k]);
    }
    body->colors = (const float(*)[3])colors;
    if (all) body->values = numbers;
}

static bool place_corners(ShowData *data, const ShowMesh *mesh, const Corners *corners,
                          const Moments *moments, ExportBody *body, Error *err)
{
    body->x = show_block(data, (size_t)moments->count, sizeof *body->x);
    for (int k = 0; k < moments->count; k++) {
        const double(*x)[3] =
            moments_points(data, moments->frames[k], "slender/state/x", mesh->body.vertex_count, err);
        if (!x) return false;
        const double(*points)[3] = show_mesh_points(mesh, x);
        float(*places)[3] = show_block(data, (size_t)corners->count, sizeof *places);
        for (int c = 0; c < corners->count; c++)
            for (int i = 0; i < 3; i++) places[c][i] = (float)points[corners->from[c]][i];
        body->x[k] = (const float(*)[3])places;
    }
    return true;
}

static bool fill(ShowData *data, const ShowMesh *mesh, const Moments *moments, ExportBody *body, Error *err)
{
    const double *values;
    Corners corners;
    const Clip *clip = &mesh->clip;
    int last = moments->frames[moments->count - 1];
    if (!show_mesh_field(mesh, last, &values, &body->field_name, &body->field_unit, err)) return false;
    int(*faces)[3] = show_block(data, (size_t)clip->face_count, sizeof *faces);
    find_corners(data, clip, values, &corners, faces);
    body->name = "body", body->indices = faces[0];
    body->point_count = corners.count, body->index_count = 3 * clip->face_count;
    if (values) paint(data, &corners, values, clip->face_count, body);
    return place_corners(data, mesh, &corners, moments, body, err);
}

bool body_of_mesh(ShowData *data, const Moments *moments, ExportBody *body, Error *err)
{
    ShowMesh mesh;
    bool ok = show_mesh_read(&mesh, data, err) && fill(data, &mesh, moments, body, err);
    show_mesh_clear(&mesh);
    return ok;
}
