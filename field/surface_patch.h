/* surface_patch.h - surfaces for pictures, of obstacles and of sources: patches of triangles over a square of parameters. */
#pragma once
#include "io/mesh_file.h"

/* The point at u, v in 0..1. */
typedef void SurfacePlace(const void *self, double u, double v, double x[3]);

/* Adds a patch of cells[0] x cells[1] pairs of triangles, whose normals are dx/du x dx/dv, or the opposite. */
void surface_add_patch(MeshFile *surface, const int cells[2], bool opposite, SurfacePlace *place,
                       const void *self);

/* Two directions that make a right-handed frame with a third of length 1: first x second = axis. */
void surface_frame(const double axis[3], double first[3], double second[3]);
