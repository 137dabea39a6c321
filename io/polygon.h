/* polygon.h - polygons to triangles.
 *
 * As the fan from the first corner, as MeshLab and trimesh split them, if all its triangles face the same
 * way; else by cutting off ears (Meisters, Polygons have ears, 1975). The fan does not depend on where
 * exactly the corners are, so that a bent state of a mesh is split as the mesh at rest is. */
#pragma once
#include <stdbool.h>

enum { POLYGON_MAX_CORNERS = 256 };

/* Writes count - 2 faces; count from 3 to POLYGON_MAX_CORNERS. False if the outline crosses itself or has no
 * area. */
bool polygon_split(const double (*points)[3], const int *corners, int count, int (*faces)[3]);
