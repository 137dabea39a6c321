/* water_law.h - how the drag of an element depends on its shape and velocity: a row for faces, one for rods (water.h). */
#pragma once
#include "base/pack_mat.h"
#include "world/water.h"

enum { WATER_DOFS = 9, WATER_NUMBERS = 2 };

typedef struct WaterTerm WaterTerm;

/* Elements as they are at the start of a step. */
typedef struct Stream {
    Pack3 n;      /* unit direction: a face's normal, a rod's tangent; 0 where it has none */
    Pack size;    /* of what it was made a unit: m^2, m                                    */
    Pack inverse; /* 1/size, or 0                                                          */
    Pack3 v;      /* the fluid's velocity relative to their middles                        */
    Pack q, V;    /* n.v, v.v                                                              */
} Stream;

/* A number that depends on size, q and V, and its derivatives. */
typedef struct Slope {
    Pack value, size, q, V;
} Slope;

/* C = lambda I + sigma n n^T */
typedef struct Drag {
    Slope lambda, sigma;
} Drag;

typedef struct WaterLaw {
    int corners;
    int numbers; /* of the fluid that C is linear in: density, viscosity */

    int (*vertex)(const WaterTerm *term, int element, int corner);

    /* The direction's vector, bilinear in x, an element's dofs; its change along dx; and the product of w with that, which is
     * added to dx. */
    Pack3 (*direction)(const Pack *x);
    Pack3 (*direction_rate)(const Pack *x, const Pack *dx);
    void (*direction_back)(const Pack *x, Pack3 w, Pack *dx);

    /* Of the elements in a pack. Linear in number[numbers]. */
    Drag (*drag)(const WaterTerm *term, int pack, const Stream *stream, const double *number);
} WaterLaw;

extern const WaterLaw water_face_law, water_rod_law;

/* Of an element of a rod: its length, m; c_t/mu, c_n/mu; C_d r, m. */
typedef struct RodDrag {
    double length, along, across, cross;
} RodDrag;

struct WaterTerm {
    const WaterLaw *law;
    int count, first;
    int number[WATER_NUMBERS]; /* first entries in p */
    Water water;
    int (*faces)[3]; /* of faces */
    bool outer;
    int each;      /* of rods: elements of a strand */
    RodDrag *rods; /* [elements] owned */
};

/* The element in a lane of a pack; the last one fills up. */
static inline int water_element(const WaterTerm *term, int pack, int lane)
{
    int element = pack * PACK_LANES + lane, last = term->count - 1;
    return element < last ? element : last;
}
