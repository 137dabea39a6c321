/* mesh.h - the mesh of a result as that of a file: faces, tetrahedra and named groups, at rest or in a frame. */
#pragma once
#include "io/mesh_file.h"
#include "io/result.h"

enum { MESH_FINAL = -1, MESH_REST = -2 };

/* False and a sentence where one of them is no number. */
bool export_check_points(const double (*x)[3], int count, Error *err);

/* At a frame, or one of these. Clear the file in any case. False and a sentence where there is no such frame, no mesh, or a
 * point is no number. */
bool export_mesh_read(Result *result, int frame, MeshFile *file, Error *err);

/* ---- Of a frame, or of one of these, where the last frame's are the final ones ---- */

/* The magnetisation: rows of the tetrahedra, then of the faces; NaN where they have none. */
bool export_magnetization_read(Result *result, int frame, const MeshFile *file, Array *M, Error *err);

/* m, of each face of a shell; the array is empty of what has none. */
bool export_thickness_read(Result *result, int frame, const MeshFile *file, Array *thickness, Error *err);
