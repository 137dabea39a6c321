#include "surface/face.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <string.h>

FaceFrame face_frame(double (*rest)[3], const int *face)
{
    Vec3 x[3];
    for (int i = 0; i < 3; i++) x[i] = vec3_load(rest[face[i]]);
    Vec3 area = vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0])); /* 2 A n */
    double length = vec3_length(area);
    Vec3 normal = vec3_scale(1 / length, area);
    FaceFrame frame;
    vec3_store(frame.normal, normal);
    for (int i = 0; i < 3; i++) {
        Vec3 opposite = vec3_sub(x[(i + 2) % 3], x[(i + 1) % 3]);
        vec3_store(frame.hat[i], vec3_scale(1 / length, vec3_cross(normal, opposite)));
    }
    return frame;
}

void face_gradients(double (*rest)[3], const int *face, double b[3][2])
{
    FaceFrame frame = face_frame(rest, face);
    Vec3 along = vec3_unit(vec3_load(frame.hat[0])); /* any direction in the plane */
    Vec3 across = vec3_cross(vec3_load(frame.normal), along);
    for (int i = 0; i < 3; i++) {
        b[i][0] = vec3_dot(vec3_load(frame.hat[i]), along);
        b[i][1] = vec3_dot(vec3_load(frame.hat[i]), across);
    }
}

FaceLayer face_layer(const Mesh *mesh, double thickness, const int *rows, const bool *on)
{
    size_t faces = (size_t)mesh->face_count;
    FaceLayer layer = {.faces = mem_alloc(faces, sizeof *layer.faces),
                       .rows = mem_alloc(faces, sizeof *layer.rows),
                       .volume = mem_alloc(faces, sizeof *layer.volume),
                       .thickness = -1,
                       .rest = mesh->rest};
    for (int f = 0; thickness > 0 && f < mesh->face_count; f++) {
        int row = rows ? rows[f] : f, k = layer.count;
        if (on && !on[row]) continue;
        memcpy(layer.faces[k], mesh->faces[f], sizeof *layer.faces);
        layer.rows[k] = row;
        layer.volume[k] = mesh->rest_area[f] * thickness;
        layer.count++;
    }
    return layer;
}

void face_layer_clear(FaceLayer *layer)
{
    mem_free(layer->faces);
    mem_free(layer->rows);
    mem_free(layer->volume);
    *layer = (FaceLayer){0};
}
