/* mesh_reader.h - a MeshFile that grows while it is read. Private to the mesh readers and, for OBJ,
 * polyline_file.c. */
#pragma once
#include "io/mesh_file.h"
#include "io/scan.h"

typedef struct MeshReader {
    MeshFile *mesh;
    size_t vertex_room, face_room;
    size_t *group_room; /* [group_count] */
} MeshReader;

enum { READER_MAX_INDEX = 500000000 };

void reader_add_vertex(MeshReader *reader, const double *x, int line);
void reader_add_face(MeshReader *reader, const int *vertices, int line);

/* The group of that name and dimension, made if it is new. */
int reader_group(MeshReader *reader, const char *name, int length, int dim);

/* One index of a vertex or face, or two of an edge. */
void reader_group_add(MeshReader *reader, int group, const int *members);

/* The formats. */
bool mesh_read_obj(Scan *scan, MeshReader *reader);
bool mesh_read_ply(Scan *scan, MeshReader *reader);
bool mesh_read_msh(Scan *scan, MeshReader *reader);

/* Of OBJ: the coordinates of a v line, and a word of an f, l or p line as an index from 0. */
bool obj_vertex(Scan *scan, MeshReader *reader);
bool obj_index(const Scan *scan, Word word, int vertex_count, int *index);
