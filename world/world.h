/* world.h - all that a body meets, as terms for its systems. */
#pragma once
#include "solve/params.h"
#include "solve/system.h"
#include "world/contact.h"
#include "world/pierce.h"
#include "world/self_contact.h"
#include "world/water.h"

/* What a body shows to the world; borrowed. */
typedef struct WorldBody {
    int vertex_count, first; /* positions of vertex v are the dofs first + 3v .. + 2 */
    int edge_count, face_count;
    const int (*edges)[2], (*faces)[3]; /* a rod has no faces                                */
    const double (*rest)[3];            /* m                                                 */
    const int *part;                    /* [vertex] the piece that it belongs to; NULL: one  */
    const bool *fixed;                  /* [3*vertex_count] held; NULL: nothing              */
    double thickness;                   /* m; a rod's diameter, a fifth of the edges of a solid's skin */
    double outside; /* m, from its points to its outside: half a thickness, a rod's radius; 0 of a solid */
    const double *
        outsides; /* [face, or edge of a rod] m, where it is not the same everywhere, of which the above are the
                             * largest; NULL: it is, and stays so */
    int doubled;          /* first entry in p of twice `outsides`; -1: not in p */
    bool closed;          /* its faces bound a solid: there is no water within  */
    int strands;          /* rods, one after the other; of a shell 0           */
    const double *length; /* [strands] m                                       */
    const double *radius; /* [edges] m, of rods: what water flows round        */
} WorldBody;

/* Of which what touches sinks in by less than 1 %: a shell's thickness, a rod's radius, a fifth of the edges of a solid's skin, m. */
double world_body_measure(const WorldBody *body);

enum { SAMPLE_KINDS = 3 }; /* vertices, middles of edges, of faces */

/* Where it is thinnest, in parts of where it is thickest. */
double world_thinnest(const WorldBody *body);

typedef struct World {
    WorldBody body;
    Obstacle *obstacles; /* [obstacle_count] owned */
    int obstacle_count;
    bool rubs;                 /* there is friction                                            */
    bool implicit;             /* what friction lags is the step's end's (MarchDef.implicit)    */
    bool local;                /* the offset is the body's own, part by part, not the same everywhere */
    double offset, slip_speed; /* m, the largest; m/s                                          */
    ContactDef contacts[SAMPLE_KINDS]; /* of those that the obstacles need                            */
    Outside *outside[SAMPLE_KINDS];    /* of their samples; owned; NULL: the body's is the same everywhere */
    int contact_kinds;

    bool self;       /* it meets itself, and its pieces each other, ..               */
    double distance; /* .. nearer than this, m; the largest                          */
    bool self_local; /* that is the body's own, part by part, not the same everywhere */
    double *vertex_outside,
        *edge_outside; /* [vertex], [edge] m: by which it is; owned; NULL: it is the same */
    bool wet, outer;   /* there is water; it knows only the outer sides of faces      */
    FluxField *flow;   /* of the water, beside its uniform velocity; owned; NULL: none */
    Water water;

    /* First entries in p, of the blocks that there are: */
    int stiffness;      /* [1] N/m, of contact with obstacles at a sample */
    int friction;       /* [obstacle]                                     */
    int self_stiffness; /* [1] J, of self contact                         */
    int self_friction;  /* [1]                                            */
} World;

/* Takes the obstacles, each with its own `feature`; all else is still to be set. */
World *world_create(const WorldBody *body, Obstacle *obstacles, int obstacle_count);
void world_destroy(World *world);

/* Its blocks of parameters; before the body's vectors are made. */
void world_add_params(World *world, Params *params);

/* What a body feels of all that it meets, at a point of statics or at the end of a step of time: added to what is there. */
typedef struct WorldSums {
    ContactSums contact;
    SelfContactFigures self;
    double pairs;     /* that act between parts of the body                                          */
    double crossings; /* edges that pass through faces                                       */
    Pierced pierced;  /* faces, or a rod's elements, that obstacles went through in the step */
    double water;     /* J, what the water has taken in the step                             */
} WorldSums;

void world_measure(const World *world, const Point *at, WorldSums *sums);

/* The same again and again, as of each step of a motion: what finds what is near is made once. The world outlives it. */
typedef struct WorldGauge WorldGauge;
WorldGauge *world_gauge_create(const World *world);
void world_gauge_destroy(WorldGauge *gauge);
void world_gauge_measure(const WorldGauge *gauge, const Point *at, WorldSums *sums);

/* Its longest edge, m, at places x[vertex][3]; and does an obstacle fit between the places where contact is felt, with such
 * edges? */
double world_longest_edge(const World *world, const double *x);
bool world_slips_between(const World *world, int obstacle, double longest);

/* Where the body passes through itself at x, whole vector: how often, and the first of it (self_contact_crossings). */
int world_crossings(const World *world, const double *x, int (*pairs)[2], int max);

/* Of parts that may meet and are nearer than so many parts of their distance at x, whole vector, the nearest
 * (self_contact_nearest); and the body's size where it is too small to meet itself (self_contact_nothing). */
double world_nearest(const World *world, const double *x, double parts, int vertices[2]);
double world_meets_nothing(const World *world);

/* Are all obstacles somewhere at that time? False and a sentence that names the first that is not. */
bool world_stands(const World *world, double time, Error *err);

/* Moves the body at x, whole vector, as it is and by the shortest way, until a vertex is so deep in what an obstacle keeps
 * free of it (its offset); not if one is already. */
void world_lean(const World *world, double time, const double *p, double depth, double *x);

/* Of where vertices feel obstacles, place e of contacts[0]: the vertex, and how far its outside is from it, m. */
int world_vertex(const World *world, int e);
double world_offset(const World *world, int e, const double *p);

/* Adds its terms to a system that is not prepared yet: of statics, or of steps of time. The world outlives it. */
void world_add_terms(const World *world, System *sys, bool motion);
