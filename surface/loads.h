/* loads.h - dead loads on a mesh as forces at its vertices; load[vertex_count][3] in N is added to. Both return on how
 * many pieces they act: 0, nothing is loaded. */
#pragma once
#include "surface/select.h"

/* Along boundary edges with both ends among the vertices, N/m at rest: half of each edge's length to either end. */
int loads_on_edges(const Mesh *mesh, const Indices *on, const double line[3], double *load);

/* Over faces with all corners among the vertices, N/m^2 at rest: a third of each face's area to each corner; on
 * quadratic tetrahedra to each middle of its sides, and nothing to corners, as an even traction is borne. */
int loads_on_faces(const Mesh *mesh, const Indices *on, const double area[3], double *load);

/* N in all, shared equally by the vertices. */
int loads_on_vertices(const Indices *on, const double force[3], double *load);
