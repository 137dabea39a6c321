/* rod.h - rods in elements of constant strain, and their states: inextensible, unshearable ones (Kirchhoff), or ones that
 * stretch and shear, too (Cosserat). One rod, or several strands of as many elements each, one after the other: they know
 * nothing of each other but by their world.
 *
 * Its shape is a rotation at each node; between two nodes strain is constant, so an element is a piece of a
 * helix and its chord is known in closed form: positions follow from rotations exactly, and never stretch
 * [Bertails et al. 2006, with rotations in place of curvatures as unknowns]. A node's frame is R = R(q):
 * tangent R e_x, section's axes R e_y, R e_z. A Cosserat rod's elements have a strain of stretch and shear each, by which
 * their chords are longer and off the frames' tangents (chord.h): where these are stiff it is Kirchhoff's, with no more
 * Newton iterations.
 *
 * A state x[dofs] holds, in this order (RodLayout),
 *     positions    [nodes][3], m, of the forms that have them;
 *     turns        [nodes][3], increments from the reference in the body's frame, q = reference (1, turn/2)
 *                  made a unit: terms differentiate at turn 0, and accepted turns go into the references;
 *     strains      [elements][3], of a Cosserat rod: along the tangent, n1, n2 (stretch and shear);
 *     multipliers  [elements][3], N, what an element does to its first node, where there are positions;
 *     references   [nodes][4], unit quaternions (w, v), which are no unknowns;
 * so that x is the whole state. Two forms serve: `hanging`, of rotations only, for statics of a rod that is
 * clamped at its first end and free at the other (3 unknowns per node, a positive definite matrix); and with
 * positions and multipliers for motion, designs, held ends and fields of position. Both have the same
 * equilibria. */
#pragma once
#include "base/quat.h"
#include "rod/frame.h"
#include "rod/inverse.h"
#include "rod/potential.h"
#include "rod/section.h"
#include "solve/masses.h"
#include "solve/params.h"
#include "solve/system.h"
#include "field/flux.h"
#include "world/world.h"

typedef enum RodSupport { ROD_FREE, ROD_PINNED, ROD_CLAMPED } RodSupport;

typedef struct RodStrand {
    double length; /* m               */
    Vec3 position; /* of its first node, m */
    Quat frame;
} RodStrand;

/* What acts on a rod beside weight and dead forces, and counts before its blocks are made. Taken by it. */
typedef struct RodActs {
    FluxFields fields;
    RodPotentials potentials;
    bool couples; /* are there any? */
} RodActs;

typedef struct Rod {
    int strands, elements; /* of all strands                               */
    RodStrand *strand;     /* [strands] owned                              */
    RodSection *unit;      /* [elements] of a Young's modulus of 1 Pa; owned (rod_set_sections)  */
    double *heavier; /* [elements] kg/m: what the elements beyond it have more than as many like it; owned */
    bool cosserat;   /* stretches and shears                         */
    RodSupport start, end; /* of each; start: clamped or pinned            */
    Vec3 *bow;         /* [elements] m, in the first node's frame: how far an element's chord is off that of a
                * helix, because strain varies within it; usually 0; owned */
    FluxFields fields; /* parts of the flux density that vary in space; owned. Not for the hanging form */
    RodPotentials potentials; /* energies of its places; owned. Not for the hanging form       */
    World *world;          /* what it meets; owned; NULL: nothing. Not for the hanging form                 */
    int (*edges)[2];       /* [elements] the nodes of each, and                                             */
    double (*straight)[3]; /* [nodes] m, places along x,                                          */
    int *part;             /* [nodes] and strands,                                         */
    double *lengths;       /* [strands] m, and                                               */
    double *radii;         /* [elements] m: what its world knows of it; all owned            */

    Params params;       /* blocks and their first entries in p:                           */
    int young;           /* [element] Pa                                                   */
    int natural_strain;  /* [element][3] twist, k1, k2, 1/m                                */
    int magnetization;   /* [element][3] A/m, in the material frame                        */
    FluxBlocks flux;     /* flux_density [3] T, the uniform part, and those of fields      */
    int gravity;         /* [3] m/s^2                                                      */
    int load;            /* [node][3] N, dead                                              */
    int pull;            /* [element][3] N, the loads beyond the element (rod_sum_loads)   */
    int damping;         /* [1] N s/m^2, drag on each metre, in steps of time              */
    int couple;          /* [node][3] N m, dead: rows are there where there are couples    */
    int potential_scale; /* [potential] factors on the potentials                         */
    bool couples;
} Rod;

/* Clamped at the origin along x, free at the other end, of one section; material, strains and loads are up to p. Takes what
 * acts on it (NULL: nothing). */
Rod *rod_create(int elements, double length, RodSection unit, const RodActs *acts);

/* Many, of length[strands] and so many elements each. */
Rod *rod_create_strands(int strands, int elements, const double *length, RodSection unit,
                        const RodActs *acts);
void rod_destroy(Rod *rod);

/* A section for each element, unit[elements]; before there are systems of it. */
void rod_set_sections(Rod *rod, const RodSection *unit);

/* Of each number the largest one along the rod. */
RodSection rod_largest_section(const Rod *rod);

static inline int rod_node_count(const Rod *rod)
{
    return rod->elements + rod->strands;
}

/* Elements of a strand, and its nodes. */
static inline int rod_each(const Rod *rod)
{
    return rod->elements / rod->strands;
}

/* Of an element. */
static inline double rod_element_length(const Rod *rod, int e)
{
    int each = rod_each(rod);
    return rod->strand[e / each].length / each;
}

/* m, of the longest strand. */
double rod_length(const Rod *rod);

/* What it shows to the world: elements as capsules around their chords, at rest straight, so that what is near along the
 * rod is its own neighbour. Borrowed from the rod. */
WorldBody rod_world_body(Rod *rod);

/* Mass of each node, kg: half of the elements beside it; the caller's. */
Masses rod_masses(const Rod *rod);

/* Of a strand, kg. */
double rod_strand_mass(const Rod *rod, int strand);

/* Young's modulus everywhere, scales and strengths of fields 1, all else 0. p[params.size] */
void rod_default_params(const Rod *rod, double young, double *p);

/* Is one of the fields that vary in space at work in p? */
bool rod_field_varies(const Rod *rod, const double *p);

/* Does it have couples in p? */
bool rod_has_couples(const Rod *rod, const double *p);

/* Puts the sums of p's loads into its pull. */
void rod_sum_loads(const Rod *rod, double *p);

/* Puts loads of a strand into p as forces and couples at its nodes: of a line load (N/m) by the nodes' lengths, of one that
 * varies along them by Simpson's rule; what acts at a point is shared by the nodes beside it. */
void rod_share_loads(const Rod *rod, int strand, RodLoads loads, double *p);

/* ---- States ---- */

typedef struct RodLayout {
    int nodes, elements, each;                         /* each: elements of a strand */
    int position, turn, strain, multiplier, reference; /* first dof of each; -1: none */
    int dofs;
} RodLayout;

RodLayout rod_layout(const Rod *rod, bool positions);

/* The first node of element e; the other one is the next. */
static inline int rod_element_node(const RodLayout *layout, int e)
{
    return e + e / layout->each;
}

static inline Quat rod_reference(const RodLayout *layout, const double *x, int node)
{
    const double *q = x + layout->reference + 4 * node;
    return (Quat){q[0], {q[1], q[2], q[3]}};
}

/* The state with these rotations: q[nodes], turns, strains and multipliers 0, positions from the first node on. */
void rod_set_state(const Rod *rod, const RodLayout *layout, const Quat *q, double *x);

/* Of a rod that stretches: the least length of an element along its section's normal, in parts of that at rest; and which
 * (NULL: not asked for). */
double rod_least_stretch(const RodLayout *layout, const double *x, int *element);

/* Is a rod with that none any more: is an element pressed to a thousandth of its length and less, or does it go backwards? */
bool rod_is_tangled(double least_stretch);

/* The natural shape, from the clamp on. */
void rod_natural_state(const Rod *rod, const RodLayout *layout, const double *p, double *x);

/* The same state in another form; strains as far as both have them. */
void rod_copy_state(const Rod *rod, const RodLayout *from, const double *x, const RodLayout *to, double *y);

/* Places of the first `count` nodes, place[count][3], from the strands' first ones (of x, or the rod's) and the
 * rotations, turns included, and strains. place may be x's own positions. */
void rod_places(const Rod *rod, const RodLayout *layout, const double *x, int count, double *place);

/* The hanging state x that follows curves[strands] of as many elements as each strand: rotations from their
 * frames[strand][stations] at the nodes; and bow so that the strands have the curves' places, to rounding. Takes position,
 * frame and length of each from its curve. */
void rod_follow_curves(Rod *rod, const RodCurve *curves, RodFrame *const *frames, double *x);

/* ---- Systems ---- */

/* All terms, prepared. hanging: rotations only; the rod is clamped and free. Else with positions: statics, or
 * with inertia and damping; young is about the rod's modulus (it decides nothing). The rod must outlive the
 * system. */
System *rod_hanging_system(const Rod *rod);
System *rod_system(const Rod *rod, double young, bool dynamic);

/* Strains (twist, k1, k2) of the elements, strain[elements], 1/m. */
void rod_element_strains(const Rod *rod, const RodLayout *layout, const double *x, Vec3 *strain);

/* Puts the multipliers into the state x of a system at that point (at->x is x) with which forces are in balance, and, where
 * the last end is held, moments (and the forces that a Cosserat rod's strains are of) as well as its support's force can
 * make them. */
void rod_carry(const Rod *rod, System *sys, const RodLayout *layout, const Point *at, double *x);

/* Puts the natural strains into p with which the rotations of the state x of a system are in equilibrium at that time if its
 * last end is free, to rounding: moments from node to node, from the free end on. Sets the multipliers of x, if it has any; and
 * of a Cosserat rod the strains that its loads, dead ones, give it, with the positions that follow. */
void rod_balance(const Rod *rod, System *sys, const RodLayout *layout, double time, double *x, double *p);

/* The same with a couple (N m, in the world) on the last end of each strand, beside the force on it that p's load has. With
 * both in its support instead the state is in equilibrium, too. */
void rod_balance_end(const Rod *rod, System *sys, const RodLayout *layout, double time, Vec3 couple,
                     double *x, double *p);
