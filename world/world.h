/* world.h - all that a body meets, as terms for its systems. */
#pragma once
#include "solve/params.h"
#include "solve/system.h"
#include "world/contact.h"
#include "world/water.h"

/* What a body shows to the world; borrowed. */
typedef struct WorldBody {
    int vertex_count, first; /* positions of vertex v are the dofs first + 3v .. + 2 */
    int edge_count, face_count;
    const int (*edges)[2], (*faces)[3]; /* a rod has no faces                                */
    const double (*rest)[3];            /* m                                                 */
    const int *part;                    /* [vertex] the piece that it belongs to; NULL: one  */
    double thickness;                   /* m; a rod's diameter                               */
    double length;                      /* m, of a rod                                       */
} WorldBody;

enum { SAMPLE_KINDS = 3 }; /* vertices, middles of edges, of faces */

typedef struct World {
    WorldBody body;
    Obstacle *obstacles; /* [obstacle_count] owned */
    int obstacle_count;
    bool rubs;                         /* there is friction                                            */
    bool implicit;                     /* what friction lags is the step's end's (MarchDef.implicit)    */
    double offset, slip_speed;         /* m, m/s                                                       */
    ContactDef contacts[SAMPLE_KINDS]; /* of those that the obstacles need                            */
    int contact_kinds;

    bool wet, outer; /* there is water; it knows only the outer sides of faces      */
    FluxField *flow; /* of the water, beside its uniform velocity; owned; NULL: none */
    Water water;

    /* First entries in p, of the blocks that there are: */
    int stiffness; /* [1] N/m, of contact with obstacles at a sample */
    int friction;  /* [obstacle]                                     */
} World;

/* Takes the obstacles, each with its own `feature`; all else is still to be set. */
World *world_create(const WorldBody *body, Obstacle *obstacles, int obstacle_count);
void world_destroy(World *world);

/* Its blocks of parameters; before the body's vectors are made. */
void world_add_params(World *world, Params *params);

/* What a body feels of all that it meets, at a point of statics or at the end of a step of time: added to what is there. */
typedef struct WorldSums {
    ContactSums contact;
    double water; /* J, what the water has taken in the step */
} WorldSums;

void world_measure(const World *world, const Point *at, WorldSums *sums);

/* Adds its terms to a system that is not prepared yet: of statics, or of steps of time. The world outlives it. */
void world_add_terms(const World *world, System *sys, bool motion);
