/* shapes.h - generated meshes, as if read from a file: they pass the same checks and can be written as OBJ.
 *
 * All lie in the plane z = 0, counter-clockwise seen from +z, lengths in m. Each function fills *mesh (free
 * it with mesh_file_clear) or returns false and a sentence: counts are at least 1, lengths finite and
 * positive, and a mesh has at most SHAPE_MAX_FACES faces. */
#pragma once
#include "io/mesh_file.h"

enum { SHAPE_MAX_FACES = 20000000 };

/* How the cells of a sheet are split. */
typedef enum ShapePattern {
    PATTERN_RIGHT,     /* every diagonal from lower left to upper right      */
    PATTERN_ALTERNATE, /* diagonals change direction from cell to cell       */
    PATTERN_CROSSED    /* four triangles around a vertex in the cell's middle */
} ShapePattern;

/* Rectangle [0, size[0]] x [0, size[1]] of cells[0] x cells[1] cells. Vertex j*(cells[0]+1) + i is at (i, j);
 * the middles of crossed cells follow, cell by cell. Vertex groups: root (the edge x = 0), tip (the vertex of
 * the edge x = size[0] nearest to its middle, the lower one of two). */
bool shape_sheet(const double size[2], const int cells[2], ShapePattern pattern, MeshFile *mesh, Error *err);

/* A sheet [0, length] x [0, width] of n nearly square cells along its length; numbering and groups as there.
 */
bool shape_strip(double length, double width, int n, ShapePattern pattern, MeshFile *mesh, Error *err);

/* Six-pointed star, size from tip to opposite tip, centre (vertex 0) at the origin, one tip on +x: twelve
 * equilateral triangles of side size/(2 sqrt 3), each divided into n^2, 12 n^2 faces in all. Face groups: hub
 * (the hexagon) and flap1 (on +x), ... flap6 counter-clockwise. */
bool shape_hexagram(double size, int n, MeshFile *mesh, Error *err);

/* Disc of diameter size around the origin (vertex 0): n rings, ring k of 6 k vertices, starting on +x; 6 n^2
 * faces. Vertex groups: centre, rim. */
bool shape_disc(double size, int n, MeshFile *mesh, Error *err);

/* Corner-connected squares: the black cells of a checkerboard of n x n cells (n odd), each split into four triangles; a
 * square of that size around the origin. (n + 1)^2 + (n^2 + 1)/2 vertices, 2 (n^2 + 1) faces: grid points row by row, then
 * the squares' middles. Vertex groups: centre, rim (grid points on the boundary of the whole). */
bool shape_kirigami(double size, int n, MeshFile *mesh, Error *err);
