#include "surface/face.h"
#include "base/vec3.h"

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
