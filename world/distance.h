/* distance.h - the distance between a point and a triangle, and between two edges, with its derivatives.
 *
 * Either is the least |c|, c = sum w_i x_i over four vertices: a point 0 and a triangle 1, 2, 3, or edges 0, 1 and 2, 3.
 * The weights depend on unknowns l_k where the nearest points may slide: none where both are vertices, one on an edge, two
 * within a triangle or of two edges. With t_k = dc/dl_k and W_ik = dw_i/dl_k the envelope theorem gives
 *
 *     d|c|^2/dx_i = 2 w_i c,   dl_k/dx_i = -(t.t)^-1_kl q_il,   q_il = W_il c + w_i t_l,
 *     d2|c|^2/dx_i dx_j = 2 w_i w_j I - 2 q_ik (t.t)^-1_kl q_jl^T,
 *
 * the same for all these classes. |c| is C1 where it is not 0, but for edges that are parallel: there the nearest points
 * jump, and parallel_weight takes such pairs out [Li et al. 2020, "Incremental Potential Contact", 5.3].
 *
 * Triangles may have no area, and edges no length. Coordinates that are not finite give what is not. */
#pragma once

enum {
    DISTANCE_DOFS = 12,
    DISTANCE_LOWER = 78
}; /* of four vertices; the lower triangle of a matrix of them */

typedef struct Distance {
    double square;        /* |c|^2, m^2                      */
    double c[3];          /* from the other to the first, m  */
    double w[4], W[2][4]; /* W: of the unknowns that slide   */
    int slides;           /* so many: 0, 1 or 2              */
} Distance;

typedef Distance DistanceOf(const double x[DISTANCE_DOFS]);

/* Of vertex 0 and the edge 1, 2: of a rod. */
Distance distance_point_edge(const double x[DISTANCE_DOFS]);
Distance distance_point_triangle(const double x[DISTANCE_DOFS]);
Distance distance_edges(const double x[DISTANCE_DOFS]);

/* q, and the inverse of t.t: [0][0], [0][1], [1][1]. */
typedef struct Slide {
    double q[2][DISTANCE_DOFS], t[2][3], inverse[3];
} Slide;

Slide distance_slide(const Distance *distance, const double x[DISTANCE_DOFS]);

/* Adds a grad grad^T + b Hess of |c|^2 to the lower triangle H, by rows. */
void distance_add_hessian(const Distance *distance, const double x[DISTANCE_DOFS], double a, double b,
                          double H[DISTANCE_LOWER]);

/* m = (2 - r) r, r = |a x b|^2/least for edges a and b with r < 1; else 1. Writes dm/dx to g; where H is not NULL, adds
 * b d2m/dx2 to it, by rows. */
double parallel_weight(const double x[DISTANCE_DOFS], double least, double g[DISTANCE_DOFS], double b,
                       double *H);
