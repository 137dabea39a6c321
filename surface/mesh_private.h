/* mesh_private.h - what mesh.c and mesh_groups.c share. */
#pragma once
#include "surface/mesh.h"

/* The file's groups in the mesh's numbering; vertices and edges must be known. */
void mesh_build_groups(Mesh *mesh, const MeshFile *file, MeshReport *report);
