/* select.h - which vertices an entry of a scene means (fix, loads, objectives).
 *
 * An entry may give several conditions; a vertex must satisfy all of them ({boundary: true, box: ..} is the
 * boundary within the box). Positions are those at rest. */
#pragma once
#include "surface/mesh.h"

/* A list of indices; items is owned by whoever holds the list. */
typedef struct Indices {
    int count;
    int *items;
} Indices;

/* The conditions, as the scene states them; zeroed = none. */
typedef struct Selection {
    Indices vertices; /* the file's numbering; count 0: not given */
    bool has_box;
    double box[2][3]; /* lower and upper corner, m; the faces of the box belong to it, rounding aside: all
                       * that is nearer than 1e-9 of the mesh's diagonal, of the sphere too */
    bool has_ball;
    double center[3], radius; /* m; the sphere belongs to the ball */
    char *group;   /* vertices of all groups of that name, and of their edges and faces; NULL: not given */
    bool boundary; /* vertices on the boundary */
} Selection;

/* The selected vertices of the mesh, ascending and unique; the caller frees found->items. Refused with a
 * sentence: no condition at all, a vertex or group that does not exist, an empty box or ball, a selection
 * that catches nothing. */
bool select_vertices(const Mesh *mesh, const Selection *selection, Indices *found, Error *err);

/* Edges of the mesh with both ends among the vertices, ascending (clamps); the caller frees items. May be
 * empty. */
Indices select_edges(const Mesh *mesh, const Indices *vertices);

/* The same, boundary edges only (line loads). */
Indices select_boundary_edges(const Mesh *mesh, const Indices *vertices);
