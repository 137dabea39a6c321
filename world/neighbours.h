/* neighbours.h - which vertices and faces, and which edges, of a body or of several may meet, and where they are near.
 *
 * A rod's edges are its faces, too: their third corner is the second again, and counts for nothing. */
#pragma once
#include "world/distance.h"
#include "world/near.h"
#include "world/self_contact.h"

/* Pairs {vertex, face}, sorted; then {edge, edge}, the lower first, sorted. */
typedef struct PairList {
    int count, points, room; /* points: of the first kind */
    int (*pairs)[2];         /* owned                     */
} PairList;

void pair_list_clear(PairList *list);

/* Where a feature's middle is at rest, m, and whose it is. */
typedef struct Seat {
    double centre[3];
    int part;
} Seat;

typedef struct Neighbours {
    SelfContactDef def; /* margin: m */
    int face_count, (*faces)[3];
    bool *within;                        /* [vertex] in a solid: in no face, meets nothing  */
    double *vertex_weight, *edge_weight; /* area over the mean one                     */
    double *edge_square;                 /* length^2 at rest                           */
    Seat *vertex_seat, *face_seat, *edge_seat;
    NearTree *vertex_tree, *face_tree, *edge_tree;
    Box *vertex_boxes, *face_boxes, *edge_boxes; /* scratch */
    NearPairs found;
} Neighbours;

Neighbours *neighbours_create(const SelfContactDef *def);
void neighbours_destroy(Neighbours *n);

/* Around the straight ways of some vertices from `from` to `to`, and `grow` of the longest way more. */
Box neighbours_box(const int *vertices, int count, const double *from, const double *to, double grow);

/* In place of what the list held: all pairs that may meet of which these boxes do; [vertex][3] each. */
void neighbours_sweep(Neighbours *n, const double *from, const double *to, double grow, PairList *list);

/* The pairs that may meet with a distance below `radius`. */
void neighbours_find(Neighbours *n, const double *x, double radius, PairList *list);

/* All {edge, face} whose boxes meet at x, in no order; borrowed until n is asked again. */
NearPairs *neighbours_edges_and_faces(Neighbours *n, const double *x);

/* The four vertices of pair k of a list, and their coordinates. */
void neighbours_vertices(const Neighbours *n, const PairList *list, int k, int vertices[4]);
void neighbours_gather(const int vertices[4], const double *x, double to[DISTANCE_DOFS]);

/* D of such a pair (of edges, or of a vertex and a face), m. */
double neighbours_range(const Neighbours *n, const int pair[2], bool edges);

/* How distant the features of pair k are. */
DistanceOf *neighbours_distance(const Neighbours *n, const PairList *list, int k);

/* How far x is from y beside a motion of the whole: the largest of all vertices; NAN where it is no number. */
double neighbours_moved(const Neighbours *n, const double *x, const double *y);
