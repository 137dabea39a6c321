/* shapes.h - solids of tetrahedra that the program makes, in metres, as if read from a file: they pass the same checks.
 *
 * All are sheets of triangles made thick: between the copies of a triangle in two layers lies a prism of three
 * tetrahedra, whose diagonals run from the vertex of lower number below to that of higher number above, so that
 * neighbours fit without thought. Each function fills *mesh (free it with mesh_file_clear) or returns false and a sentence.
 *
 * Node layer*n + v is vertex v of the sheet's n in that layer, from 0. Faces are all of the surface: below as the sheet's,
 * above, then the walls along its boundary edges. Groups of the sheet stay groups: of faces those of the solid's faces at
 * them, walls too, and of the tetrahedra between; of edges those of the walls at them, and nodes; of vertices nodes. Beside
 * them bottom and top, of faces. */
#pragma once
#include "surface/mesh.h"
#include "surface/shapes.h"

/* A sheet that is made thick: from where it lies along its normals (each vertex along the mean of its faces', weighted by
 * area). Refused: a sheet with a group bottom or top, and more than SHAPE_MAX_FACES tetrahedra. */
bool solid_shape_extrude(const Mesh *sheet, double thickness, int layers, MeshFile *mesh, Error *err);

/* [0, size[0]] x [0, size[1]] x [0, size[2]] of cells of six tetrahedra around a diagonal, all one way [Kuhn 1960]. Groups of
 * its sides: left, right (x), front, back (y), bottom, top (z). */
bool solid_shape_box(const double size[3], const int cells[3], MeshFile *mesh, Error *err);

/* The same whose cells along x and y are split by a pattern. */
bool solid_shape_plate(const double size[3], const int cells[3], ShapePattern pattern, MeshFile *mesh,
                       Error *err);

/* What is enough for a shape of its own. NAN and 0: its default. */
typedef struct SolidShapeDef {
    double size, thickness; /* m      */
    int n, layers;          /* at least 1 */
} SolidShapeDef;

/* A hand of square cells of size/10/n, its palm [0, 1.1 size] x [0, size]; thickness size/20; n 1. Little, ring, middle and
 * index finger point to +y, the thumb to +x. Groups: wrist (the side y = 0), palm, thumb, index, middle, ring, little, and
 * anchors: below and above, in the middle of each finger, at three stations along it. */
bool solid_shape_hand(SolidShapeDef def, MeshFile *mesh, Error *err);

/* A cup: half an ellipsoid that is open above, its rim of diameter size in the plane z = 0, 3/4 of it deep; n rings (10);
 * thickness 3/40 of it, inwards. Groups: rim and centre (nodes), bottom (the outer side), top (the inner one), and of faces lower (their
 * middles below half of the depth) and ribbon (0.4 to 0.6 of it). */
bool solid_shape_heart(SolidShapeDef def, MeshFile *mesh, Error *err);

/* A star of five arms around the origin, from z = 0 up, inscribed in a circle of diameter size, the first arm on +x: notches
 * at 0.4 of its radius, tips 0.16 of it wide; n cells across an arm (3); thickness 0.06 size. Groups: arm1 .. arm5
 * counter-clockwise, each a fifth of it, and centre (nodes). */
bool solid_shape_starfish(SolidShapeDef def, MeshFile *mesh, Error *err);

/* For shapes: refuses too many tetrahedra, before much is made of them. */
bool solid_shape_check_count(double count, Error *err);

/* The prisms of a sheet, whose nodes are still to be placed. */
bool solid_shape_prisms(const Mesh *sheet, int layers, MeshFile *mesh, Error *err);

/* A group that a shape adds; takes the members. There is room for four. */
void solid_shape_group(MeshFile *mesh, const char *name, int dim, int *members, int count);
