/* tets_private.h - what the steps of tets_create share. */
#pragma once
#include "solid/tets.h"

/* Some corners in ascending order, and what they are of. */
typedef struct Corners {
    int of[3]; /* of an edge two, and 0                                                          */
    int number;
    int tet; /* one that has them */
} Corners;

typedef struct Build {
    MeshFile file; /* as it was given, but for its cells: they are a copy, all turned round if need be */
    Tets *tets;
    MeshFile nodes; /* all nodes as vertices, the tetrahedra, and groups          */
    Corners *edges; /* [edge_count] by their corners; number: the middle's node, -1: none */
    int edge_count;
    int (*faces)[3]; /* [face_count] of the surface    */
    int face_count;
    int *face_of_file;             /* [file.face_count] -1: none    */
    int curved_count, curved_node; /* middles that were not in the middle; the farthest */
    double curved_by, curved_part; /* and how far: m, and in parts of its edge          */
    MeshReport *report;
    Error *err;
} Build;

/* "file:line: tetrahedron 5 (corners 1, 2, 3, 4) is .."; false. */
bool tets_refuse(const Build *build, int tet, const char *format, ...) __attribute__((format(printf, 3, 4)));

static inline const int *tets_cell(const Build *build, int tet)
{
    return build->file.cells + (size_t)tet * (size_t)build->file.cell_nodes;
}

/* Sorts up to three corners; tells whether an odd number of exchanges did. */
bool tets_sort_corners(int *of, int count);

/* By corners; those of the same ones by number, then by tetrahedron. */
int tets_compare_corners(const void *a, const void *b);
int tets_compare_all(const void *a, const void *b);

/* The node in the middle of two corners; -1 where there is none. */
int tets_middle(const Build *build, int a, int b);

/* Refuses what fills no volume, measures the rest, turns all round where all are of the other hand, and finds the edges where
 * they have middles. */
bool tets_check(Build *build);

/* The sides that only one tetrahedron has; refused where one has three, or two on the same side. */
bool tets_find_surface(Build *build);

/* The file's groups in the numbers of nodes and of the surface. */
void tets_make_groups(Build *build);
