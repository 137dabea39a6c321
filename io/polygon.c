#include "io/polygon.h"
#include "base/vec3.h"
#include <string.h>

static const double least_part = 1e-9; /* of the polygon's area in a triangle of its own */

typedef struct Outline {
    const double (*points)[3];
    Vec3 normal;  /* of length twice the area (Newell) */
    double least; /* turn() of a triangle that has an area */
    int corners[POLYGON_MAX_CORNERS], count;
} Outline;

static Vec3 corner(const Outline *o, int i)
{
    return vec3_load(o->points[o->corners[i % o->count]]);
}

/* Twice the area of a triangle as the polygon's normal sees it. */
static double turn(const Outline *o, Vec3 a, Vec3 b, Vec3 c)
{
    return vec3_dot(o->normal, vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

static void set_face(const Outline *o, int a, int b, int c, int *face)
{
    face[0] = o->corners[a], face[1] = o->corners[b % o->count], face[2] = o->corners[c % o->count];
}

static bool split_fan(const Outline *o, int (*faces)[3])
{
    for (int i = 1; i + 1 < o->count; i++) {
        if (!(turn(o, corner(o, 0), corner(o, i), corner(o, i + 1)) > o->least)) return false;
        set_face(o, 0, i, i + 1, faces[i - 1]);
    }
    return true;
}

/* Does the corner after i stick out, with no other corner in its triangle? */
static bool is_ear(const Outline *o, int i)
{
    Vec3 a = corner(o, i), b = corner(o, i + 1), c = corner(o, i + 2);
    if (!(turn(o, a, b, c) > o->least)) return false;
    for (int k = i + 3; k < i + o->count; k++) {
        Vec3 p = corner(o, k);
        int name = o->corners[k % o->count];
        bool is_end = name == o->corners[i % o->count] || name == o->corners[(i + 2) % o->count];
        if (!is_end && turn(o, a, b, p) >= 0 && turn(o, b, c, p) >= 0 && turn(o, c, a, p) >= 0) return false;
    }
    return true;
}

static bool split_ears(Outline *o, int (*faces)[3])
{
    for (int cut = 0; o->count > 3; cut++) {
        int i = 0;
        while (i < o->count && !is_ear(o, i)) i++;
        if (i == o->count) return false;
        set_face(o, i, i + 1, i + 2, faces[cut]);
        int tip = (i + 1) % o->count;
        o->count--;
        memmove(o->corners + tip, o->corners + tip + 1, (size_t)(o->count - tip) * sizeof *o->corners);
    }
    return true;
}

bool polygon_split(const double (*points)[3], const int *corners, int count, int (*faces)[3])
{
    Outline o = {.points = points, .count = count};
    memcpy(o.corners, corners, (size_t)count * sizeof *corners);
    for (int i = 1; i + 1 < count; i++)
        o.normal = vec3_add(o.normal, vec3_cross(vec3_sub(corner(&o, i), corner(&o, 0)),
                                                 vec3_sub(corner(&o, i + 1), corner(&o, 0))));
    o.least = least_part * vec3_dot(o.normal, o.normal);
    if (split_fan(&o, faces)) return true;
    if (!split_ears(&o, faces)) return false;
    set_face(&o, 0, 1, 2, faces[count - 3]);
    return turn(&o, corner(&o, 0), corner(&o, 1), corner(&o, 2)) > o.least;
}
