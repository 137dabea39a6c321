/* clip.h - a body cut open by a plane: what is left of its triangles and, where tetrahedra fill it, the cut itself.
 *
 * The plane cuts the body at rest, so that every moment shows the same part of it: new points are parts of two of its
 * nodes, and move with them. Quadratic tetrahedra are cut as the eight linear ones between their nodes, whose sides are the
 * triangles that their faces are shown as: cut and surface meet without gaps. [Marching tetrahedra: Doi and Koide 1991] */
#pragma once
#include <stdbool.h>

typedef struct ClipPlane {
    double point[3],
        normal[3]; /* m; what lies on the normal's side is left out. Zeros: no plane, nothing is */
} ClipPlane;

bool clip_is_given(const ClipPlane *plane);

/* What is cut, at rest; borrowed. */
typedef struct ClipBody {
    int vertex_count, face_count, cell_count,
        cell_nodes; /* no cells: a surface, which is cut open and left so */
    const double (*rest)[3];
    const int (*faces)[3];
    const int *cells;        /* [cell_count][cell_nodes] 4 or 10, as Gmsh numbers them */
    const int *cell_of_face; /* [face_count]; NULL: none                               */
} ClipBody;

/* (1 - part) from + part to: a vertex of the body, or where an edge meets the plane. */
typedef struct ClipPoint {
    int from, to;
    double part;
} ClipPoint;

typedef struct Clip {
    int point_count, face_count;
    ClipPoint *points;
    int (*faces)[3]; /* of points                                                      */
    int *face;       /* [face_count] the body's, that it is or is a part of; -1: on the cut */
    int *cell;       /* [face_count] the tetrahedron that it is a side of or lies in; -1: none */
} Clip;

/* Clear it. A plane that passes the body by leaves no face, or all of them. */
Clip clip_create(const ClipBody *body, const ClipPlane *plane);
void clip_clear(Clip *clip);

/* The points where the body's vertices are at x. */
void clip_points(const Clip *clip, const double (*x)[3], double (*points)[3]);
