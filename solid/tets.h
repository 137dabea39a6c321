/* tets.h - the tetrahedra that fill a solid, and its surface: checked once and then constant.
 *
 * Nodes keep the file's order; where a linear mesh is made quadratic, the middles of its edges follow, in the order of
 * the edges' ends. Quadratic tetrahedra are straight: their middle nodes are the middles of their edges.
 *
 * The surface is made of the tetrahedra's faces that no other one has, all outwards: in the order of the file's triangles,
 * if it lists all of them, else in that of the tetrahedra. Both meshes of it have all nodes of the solid as vertices, in
 * one numbering, those within too: what selects vertices (fix, loads, targets) selects nodes.
 *
 * Groups: all that goes by one name in the file, points, lines, faces and tetrahedra, is one group of nodes of the surface
 * (dim 0), with the nodes between the corners; its lines, its faces that are on the surface and its tetrahedra stay groups of
 * those, too.
 *
 * What valid tetrahedra are: four different corners, a volume above 1e-9 of the cube of the longest edge, two at most at each
 * side and on different sides of it, all of the same hand (where all are of the other one they are turned round), one middle
 * node of its own for each edge, and no node that is in none of them. Pieces need not hang together. */
#pragma once
#include "surface/mesh.h"

enum { TET_LINEAR = 1, TET_QUADRATIC = 2 };

/* Corners between which the middles are, in the order of Tets.nodes. */
extern const int tet_edges[6][2];

typedef struct Tets {
    int count, order;
    int each;   /* nodes of a tetrahedron: 4 or 10                                                      */
    int *nodes; /* [count][each]: corners, positively oriented, then middles of 01 12 02 03 23 13; owned */
    double
        *volume;   /* [count] m^3 at rest; owned                                                            */
    int *across;   /* [count][4] the tetrahedra that have a side in common with it, -1: none; owned         */
    Mesh *surface; /* its faces have corners only, its cells are the tetrahedra; owned                      */
    int *behind;   /* [surface->face_count] the tetrahedron whose side each face is; owned                  */
    Mesh *skin;    /* the same faces, each in four through the middles of its edges where there are any:
                     * what meets the world, is magnetised and shown; owned                                  */
    int *
        skin_face; /* [skin->face_count] face of the surface that it is a part of; owned                    */
} Tets;

/* From a file with cells. order 2 raises linear ones, and puts middle nodes that are not in the middle there, with a warning;
 * order 1 leaves middle nodes out, with a warning. report may be NULL; else clear it, also
 * after a failure. On bad input NULL and a sentence that names file, line and element. */
Tets *tets_create(const MeshFile *file, int order, MeshReport *report, Error *err);
void tets_destroy(Tets *tets);

static inline int tets_node_count(const Tets *tets)
{
    return tets->surface->vertex_count;
}
