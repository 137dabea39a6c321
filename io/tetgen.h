/* tetgen.h - files of TetGen 1.5: .smesh for it, .node and .ele from it. */
#pragma once
#include "io/mesh_file.h"

/* A surface of triangles, its coordinates times scale, every bit of them. */
bool tetgen_write(const char *path, const double (*vertices)[3], int vertex_count, double scale,
                  const int (*faces)[3], int face_count, Error *err);

/* The nodes in STEM.node and the tetrahedra in STEM.ele, which count from 0. On false *mesh is empty. */
bool tetgen_read(const char *stem, MeshFile *mesh, Error *err);
