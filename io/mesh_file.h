/* mesh_file.h - meshes from files: of triangles OBJ, PLY and STL (ASCII and binary), and Gmsh .msh 2.2 and 4.1 (ASCII),
 * which may have tetrahedra, too; docs/meshes.md says what is read of each.
 *
 * Reads what the file says, with the line of every face, and judges only the file (syntax, numbers, indices
 * out of range); whether the mesh is a valid shell is for surface/mesh.h. Polygons become triangles
 * (polygon.h). Coordinates in metres unless the scene gives a unit. */
#pragma once
#include "base/error.h"

/* A named set: OBJ `g`/`o` names, Gmsh physical groups, the solids of an STL file. dim says what the members
 * are: 0 vertices, 1 edges (pairs of vertices), 2 faces, 3 cells; groups of one name may differ in it. */
typedef struct MeshGroup {
    char *name;
    int dim;
    int count;
    int *members; /* [count] vertex, face or cell indices; [2*count] vertex pairs for edges; owned */
} MeshGroup;

typedef struct MeshFile {
    char *path;
    int vertex_count, face_count, group_count;
    double (*vertices)[3];      /* [vertex] m; owned                                */
    int *vertex_line;           /* [vertex] line in the file, from 1; NULL if generated or binary; owned */
    int (*faces)[3];            /* [face] vertices in the file's order; owned       */
    int *face_line;             /* [face] line in the file, from 1; NULL if generated or binary; owned */
    int cell_count, cell_nodes; /* tetrahedra, of 4 or 10 vertices each; none in a mesh of triangles */
    int *
        cells; /* [cell][cell_nodes] vertices: corners, then, of 10, the middles of the edges 01 12 02 03 23 13,
                     * as Gmsh numbers them; owned */
    int *cell_line;    /* [cell] line in the file, from 1; NULL if generated or binary; owned */
    MeshGroup *groups; /* owned                                            */
} MeshFile;

/* Format by the ending (.obj, .ply, .stl, .msh), any case. On false *mesh is empty. */
bool mesh_file_read(const char *path, MeshFile *mesh, Error *err);

/* The same from memory (tests and fuzzing); format is "obj", "ply", "stl" or "msh". */
bool mesh_file_parse(const char *path, const char *format, const char *text, long length, MeshFile *mesh,
                     Error *err);

/* Refuses tetrahedra in a file that was read: where a mesh of triangles is asked for. */
bool mesh_file_check_triangles(const MeshFile *mesh, Error *err);

/* Writes OBJ with groups; numbers keep every bit (%.17g), blanks in names become _. */
bool mesh_file_write_obj(const char *path, const MeshFile *mesh, Error *err);

/* Frees what the struct owns and empties it. */
void mesh_file_clear(MeshFile *mesh);

/* The group of that name and dimension, or NULL. */
const MeshGroup *mesh_file_group(const MeshFile *mesh, const char *name, int dim);
