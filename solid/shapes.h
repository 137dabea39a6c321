/* shapes.h - solids of tetrahedra that the program makes, in metres. */
#pragma once
#include "io/mesh_file.h"

/* A box from 0 to size, of cells of six tetrahedra around a diagonal, all one way [Kuhn 1960]. Groups of its sides: left, right
 * (x), front, back (y), bottom, top (z). */
bool solid_shape_box(const double size[3], const int cells[3], MeshFile *mesh, Error *err);
