/* cubic_grid.h - the C2 function through numbers on a regular grid of one, two or three dimensions.
 *
 * It is the tensor product of cubic B-splines that takes the numbers at the nodes, with ends that are no knots [de Boor
 * 1978, IV]: of fourth order up to the edges; through three or two nodes a parabola or a line. Beyond the grid its last
 * cell goes on for a while: along each axis the place where it is evaluated comes to rest one cell beyond the edge, within
 * two, by a C2 map. From there on the function is constant or, `linear`, goes on with the slope that it has. */
#pragma once
#include <stdbool.h>

/* A function of space at a point, and its derivatives there. */
typedef struct SpaceSample {
    double value, gradient[3], hessian[3][3];
} SpaceSample;

typedef struct CubicGrid {
    int nodes[3]; /* along each axis; 1: it does not depend on that coordinate */
    double low[3], step[3];
    bool linear;
    double *coefficients; /* two more along each axis of several nodes; owned */
} CubicGrid;

/* values[nodes[0]][nodes[1]][nodes[2]]. Clear it. */
CubicGrid cubic_grid_create(const int nodes[3], const double low[3], const double step[3],
                            const double *values, bool linear);
void cubic_grid_clear(CubicGrid *grid);

/* How far a coordinate is from where the function is evaluated, 0 on the grid, and the derivatives of that: m, 1, 1/m. */
void cubic_grid_beyond(const CubicGrid *grid, int axis, double x, double beyond[3]);

/* Value, gradient and Hessian at a point. Re-entrant. */
void cubic_grid_at(const CubicGrid *grid, const double x[3], SpaceSample *sample);
