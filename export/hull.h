/* hull.h - closed surfaces around some elements of a mesh, as parts.h says. */
#pragma once
#include "export/parts.h"
#include "io/mesh_file.h"

/* Of the tetrahedra, else of the faces (with each one's thickness, m): of which part each is, from 0; fills in points, faces and
 * volume of parts that are empty. */
void hull_make(const MeshFile *mesh, const double *thickness, const int *part, Parts *parts);
