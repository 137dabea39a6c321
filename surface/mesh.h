/* mesh.h - the triangle surface a shell lives on: faces, edges, neighbours and rest areas, checked once and
 * then constant.
 *
 * Numbering. Vertices, edges and faces count from 0. Faces keep the file's order. Vertices keep the file's
 * order too, but those in no face (and, of a solid, in no tetrahedron) are removed and those joined by `weld`
 * are one; file_vertex and vertex_of_file translate. Indices that a user writes (scene, CSV) are the file's: pass them through
 * mesh_vertex().
 *
 * What a valid surface is: every edge has one or two faces, and two faces run along their common edge in
 * opposite directions (so normals agree). Legal: several components, corner-connected parts (a vertex whose
 * faces form several fans), and coincident vertices (slits, kirigami cuts), the last with a warning. */
#pragma once
#include "base/error.h"
#include "io/mesh_file.h"

typedef struct Mesh {
    int vertex_count, face_count, edge_count, component_count, group_count, file_vertex_count;
    double (*rest)[3]; /* [vertex] rest position, m */
    int (*faces)[3];   /* [face] vertices; the normal is (x1 - x0) x (x2 - x0) */
    int (*edges)[2];   /* [edge] v0 < v1; sorted by v0, then v1 */
    /* [edge] left face (runs v0 -> v1) and right face (runs v1 -> v0); -1 where there is none */
    int (*edge_faces)[2];
    /* [face][i] the edge OPPOSITE to the face's vertex i: from vertex i+1 to i+2 (mod 3) */
    int (*face_edges)[3];
    /* [face][i] +1 where the face runs along face_edges[i] from v0 to v1, else -1 */
    signed char (*face_edge_sign)[3];
    double *rest_area;          /* [face] m^2 */
    int cell_count, cell_nodes; /* of a solid: tetrahedra of so many vertices; 0: a surface alone */
    int *cells;                 /* [cell][cell_nodes], as the file's (mesh_file.h) */
    int (*face_middles)[3]; /* [face] of quadratic tetrahedra: the vertices between its corners; else NULL */
    int *vertex_component;  /* [vertex] connected part, by first vertex; a common vertex connects */
    MeshGroup *groups;      /* [group_count] the file's, in this mesh's numbering; faces as they were */
    int *group_order;       /* [group_count] by name and dimension */
    int *file_vertex;       /* [vertex] its number in the file (the lowest of those joined) */
    int *vertex_of_file;    /* [file_vertex_count] the mesh's vertex, -1 where removed */
} Mesh;

/* What the user should know about a mesh that was accepted, and about what comes with it. */
typedef struct MeshReport {
    int warning_count;
    char **warnings; /* sentences "file:line: ..."; owned */
} MeshReport;

/* Adds a sentence; report may be NULL. */
void mesh_warn(MeshReport *report, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* "file:line" of an element; generated and binary meshes have no lines (NULL). */
typedef struct MeshPlace {
    char text[512];
} MeshPlace;

MeshPlace mesh_place(const MeshFile *file, const int *lines, int element);

static const double MESH_FARTHEST = 1e6; /* m, of a coordinate */

/* Refuses what is no mesh at all: coordinates that are not finite or too far, indices out of range in faces, tetrahedra and
 * groups. mesh_create begins with it. */
bool mesh_check_file(const MeshFile *file, Error *err);

/* Checks the file's surface and builds the mesh; copies what it needs. Vertices closer than weld (m; 0 =
 * off) to one of lower number are joined first. report may be NULL; else clear it, also after a
 * failure. On bad input returns NULL and a sentence that names file, line and element: a coordinate
 * that is not finite or beyond 1e6 m, an index out of range or repeated in its face, a face of no area
 * (below 1e-12 L^2, L the bounding box's diagonal) or a sliver (height below 1e-6 of its longest edge),
 * an edge with three faces, two faces that run along their edge the same way or have the same three
 * vertices, a mesh without vertices or faces. */
Mesh *mesh_create(const MeshFile *file, double weld, MeshReport *report, Error *err);

void mesh_destroy(Mesh *mesh);

void mesh_report_clear(MeshReport *report);

/* The mesh's vertex for a vertex number of the file; false and a sentence where there is none or it was
 * removed. */
bool mesh_vertex(const Mesh *mesh, int file_vertex, int *vertex, Error *err);

/* Where a vertex stands in another file with so many: one that numbers them as the mesh's file does, or, without
 * those that were removed or joined, as the mesh does and so all that results export. */
static inline int mesh_row(const Mesh *mesh, int vertex_count, int vertex)
{
    return vertex_count == mesh->vertex_count ? vertex : mesh->file_vertex[vertex];
}

/* Has another file so many vertices as one of these two? */
static inline bool mesh_fits(const Mesh *mesh, int vertex_count)
{
    return vertex_count == mesh->file_vertex_count || vertex_count == mesh->vertex_count;
}

/* The edge between two vertices of the mesh, in any order; -1 if they share none. */
int mesh_edge(const Mesh *mesh, int a, int b);

/* Which corner (0, 1, 2) of the face lies opposite to that edge of it. */
int mesh_corner(const Mesh *mesh, int face, int edge);

static inline bool mesh_edge_is_boundary(const Mesh *mesh, int edge)
{
    return mesh->edge_faces[edge][0] < 0 || mesh->edge_faces[edge][1] < 0;
}

/* Vertices on the boundary, ascending; the caller frees the array. */
int *mesh_boundary(const Mesh *mesh, int *count);

/* Lowest and highest coordinates at rest, m. */
void mesh_bounding_box(const Mesh *mesh, double low[3], double high[3]);

/* Length of the bounding box's diagonal, m. */
double mesh_diagonal(const Mesh *mesh);

/* The group of that name and dimension (0 vertices, 1 edges, 2 faces, 3 cells), or NULL: one name may stand for a
 * surface, a curve and points at once. */
const MeshGroup *mesh_group(const Mesh *mesh, const char *name, int dim);

/* For a sentence: "palm, thumb, index", those of that dimension, -1: of any; "none" where there are none. As many as there is
 * room for; the caller frees. */
char *mesh_group_names(const Mesh *mesh, int dim);

/* The mean length of its edges at rest, m. */
double mesh_mean_edge(const Mesh *mesh);
