/* self_contact.h - where a rod touches itself: segments of a polyline that are nearer to each other than a
 * distance, twice the half-width of the section say.
 *
 * Neighbours along the curve are near and do not touch: pairs with less than pi/2 distance of arclength
 * between them are left out. A curve that bends nowhere sharper than a circle whose diameter is the distance
 * (a thicker tube would be pinched by its own bend) has chords of at least distance sin(arclength/distance)
 * [Schur 1921]: up to pi/2 distance they may be short from bending alone, beyond it only a curve that comes
 * back has a chord below the distance. */
#pragma once
#include "base/vec3.h"

typedef struct RodContact {
    int e1, e2;      /* segments, e1 < e2; e is that from node e to node e + 1 */
    double distance; /* m */
} RodContact;

typedef struct RodContacts {
    int count;
    RodContact *list;   /* by e1, then e2; owned */
    RodContact nearest; /* {-1, -1, INFINITY} without contacts */
} RodContacts;

/* All passes of the polyline x[count], finite places in m, by its own segments: of consecutive segments e2
 * nearer to e1 than the distance, the nearest one only, so that the list does not grow with the square of the
 * resolution. O(count) for segments of like length (chunks as long as the distance in a hashed grid) and few
 * passes. */
RodContacts rod_self_contacts(const Vec3 *x, int count, double distance);
void rod_contacts_clear(RodContacts *contacts);

/* Between the nearest points of segments a0 a1 and b0 b1, which may be parallel or points. */
double rod_segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);
