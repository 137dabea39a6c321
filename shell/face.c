#include "shell/face.h"
#include "base/vec3.h"

FaceFrame face_frame(const Shell *shell, int face)
{
    const Mesh *mesh = shell->mesh;
    Vec3 x[3];
    for (int i = 0; i < 3; i++) x[i] = vec3_load(mesh->rest[mesh->faces[face][i]]);
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
