/* mesh_distance.h - the signed distance from a closed triangle mesh, negative inside.
 *
 * The nearest point is looked for in a tree of boxes; which side it is seen from tells the normal there: that of the
 * face, the sum of those of an edge's faces, or of a vertex's weighted by their angles [Baerentzen & Aanaes 2005]. */
#pragma once
#include "surface/mesh.h"

typedef struct MeshDistance MeshDistance;

/* Of a mesh whose edges have two faces each, and whose normals point outwards; it must outlive this. */
MeshDistance *mesh_distance_create(const Mesh *mesh);
void mesh_distance_destroy(MeshDistance *distance);

/* *face: one that is near, a guess which saves time (-1: none); then the nearest one. Re-entrant. */
double mesh_distance_at(const MeshDistance *distance, const double x[3], int *face);
