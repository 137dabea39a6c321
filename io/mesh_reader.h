/* mesh_reader.h - a MeshFile that grows while it is read. Private to the mesh readers and, for OBJ,
 * polyline_obj.c. */
#pragma once
#include "io/lookup.h"
#include "io/mesh_file.h"
#include "io/scan.h"

/* A face of more than three corners, split when all vertices are known. */
typedef struct Polygon {
    int first_face, count;
    size_t first_corner;
} Polygon;

typedef struct MeshReader {
    MeshFile *mesh;
    Lookup group_lookup;
    Polygon *polygons;
    int *corners; /* of all polygons */
    int polygon_count;
    size_t corner_count, vertex_room, face_room, cell_room, group_room, polygon_room, corner_room;
    size_t *member_room; /* [group_count] */
} MeshReader;

enum { READER_MAX_INDEX = 500000000 };

/* The block with room for `count` entries at least; grows *room. */
void *reader_grow(void *block, size_t *room, size_t count, size_t size);

void reader_add_vertex(MeshReader *reader, const double *x, int line);

/* A face with three corners or more; it becomes count - 2 faces of the mesh. Refused: fewer, or too many. */
bool reader_add_face(MeshReader *reader, const Scan *scan, const int *corners, int count);

/* A tetrahedron of 4 or 10 nodes. Refused: one that has not as many as those before it, or too many of them. */
bool reader_add_cell(MeshReader *reader, const Scan *scan, const int *nodes, int count);

/* The group of that name and dimension, made if it is new. */
int reader_group(MeshReader *reader, const char *name, int length, int dim);

/* One index of a vertex, face or cell, or two of an edge. */
void reader_group_add(MeshReader *reader, int group, const int *members);

/* The faces from the first one to the last. */
void reader_group_add_faces(MeshReader *reader, int group, int first);

/* When all is read: refuses corners that do not exist (counted from `base` in the file), splits polygons and
 * drops groups without members. */
bool reader_finish(MeshReader *reader, Scan *scan, int base);

/* A binary file has no lines. */
void reader_drop_lines(MeshReader *reader);

/* Frees what only reading needed. */
void reader_clear(MeshReader *reader);

/* The formats. */
bool mesh_read_obj(Scan *scan, MeshReader *reader);
bool mesh_read_ply(Scan *scan, MeshReader *reader);
bool mesh_read_msh(Scan *scan, MeshReader *reader);
bool mesh_read_stl(Scan *scan, MeshReader *reader);

/* Of OBJ: its comments and joined lines; the coordinates of a v line; a word of an f, l or p line as an index
 * from 0. */
void obj_begin(Scan *scan);
bool obj_vertex(Scan *scan, MeshReader *reader);
bool obj_index(const Scan *scan, Word word, int vertex_count, int *index);
