/* flux_shape.h - what magnets and coils look like, for pictures: in their own frames, their middle at 0, the axis along z. */
#pragma once
#include "io/mesh_file.h"

/* Adds triangles whose normals point out. */
void flux_shape_block(const double half[3], MeshFile *shape);
void flux_shape_cylinder(double radius, double half, MeshFile *shape);

/* Windings, as thick as a picture needs them: half a length of 0 is a ring. */
void flux_shape_round_coil(double radius, double half, MeshFile *shape);
void flux_shape_rectangular_coil(const double half[2], MeshFile *shape);
