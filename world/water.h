/* water.h - what a fluid does to a body that moves in it: drag and thrust on triangles, drag on slender rods.
 *
 * An element feels the force f = C v, v the fluid's velocity relative to its middle, in equal parts at its vertices, with
 *
 *     C = lambda I + sigma n n^T,
 *
 * n a face's unit normal or a rod's tangent. C is taken where the step begins, v where it ends, so that
 *
 *     E = dt/2 v^T C v,   v = u - (x - x_prev)/dt,
 *
 * is what a step minimises: C is symmetric and positive semidefinite, any step is stable, and drag that is quadratic in
 * the velocity is integrated exactly. In statics it is nothing.
 *
 * Faces [Min et al. 2019; Chen 2022, eqs. 42-44, C_d = C_t = 2 sin^2]: with q = n.v, eps = 1e-5 m/s
 *
 *     lambda = rho A q^2/sqrt(|v|^2 + eps^2),   sigma = rho A q^2/sqrt(q^2 + eps^2).
 *
 * It pushes a face along the stream whichever way its vertices go round. The equations themselves, `outer`, know the
 * outward normal of a closed surface: faces from which the stream flows away (q > 0) feel nothing. There is no friction along a
 * face, no added mass and no buoyancy.
 *
 * Rods: Stokes's drag of a long slender spheroid [Chwang & Wu 1975], of length L and radius r, per length along
 * c_t = 2 pi mu/(ln(L/r) - 1/2) and across c_n = 4 pi mu/(ln(L/r) + 1/2), and across it that of the cross flow, for which a
 * smooth cylinder has C_d = 1.1 [Taylor 1952]: with y the speed across and l an element's length
 *
 *     lambda = l (c_n + rho C_d r y^2/sqrt(y^2 + eps^2)),   sigma = l c_t - lambda. */
#pragma once
#include "solve/term.h"
#include "field/flux_field.h"

/* A fluid: first entries in p, and how it flows beside the uniform part: a velocity in m/s of place and time, taken where
 * an element was at the start of the step, at the time of its end. */
typedef struct Water {
    int density;           /* [1] kg/m^3                    */
    int viscosity;         /* [1] Pa s; of rods only        */
    int velocity;          /* [3] m/s, of all of it         */
    const FluxField *flow; /* borrowed; NULL: that is all   */
} Water;

/* Triangles; the positions of vertex v are the dofs first + 3v .. */
typedef struct WaterDef {
    int face_count, first;
    int (*faces)[3]; /* [face] vertices; borrowed                         */
    bool outer;      /* they go round the normals out of closed surfaces  */
    Water water;
} WaterDef;

Term water_term(const WaterDef *def);

/* Rods, one after the other, each of as many elements of equal length from node to node; the positions of node i are the
 * dofs first + 3i .. */
typedef struct RodWaterDef {
    int element_count, strands, first; /* elements: of all */
    const double *length;              /* [strands] m; > ROD_WATER_SLENDER radius */
    const double *radius;              /* [elements] m; borrowed while the term is made */
    Water water;
} RodWaterDef;

enum { ROD_WATER_SLENDER = 5 };

Term rod_water_term(const RodWaterDef *def);

/* The power that the fluid takes from a body in that state, W, of either of these terms. */
double water_power(const Term *term, const State *state, const double *p);
