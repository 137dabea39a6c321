/* smooth.h - rasters of one number per pixel: another resolution, and the Gaussian blur. */
#pragma once
#include "spline/grid.h"

/* What lies beyond the edge: the picture mirrored (.. b a | a b ..), or the last pixels for ever (a a | a b).
 */
typedef enum SmoothEdge { SMOOTH_MIRROR, SMOOTH_EXTEND } SmoothEdge;

/* to[rows][columns]: the mean over each new pixel of the grid's first numbers, bilinear between pixel centres
 * and constant beyond the outermost ones. */
void smooth_resample(const SplineGrid *grid, int columns, int rows, double *to);

/* Blurs in place, sigma in pixels along x and y, cut off at 4 sigma; below 0.1 pixels nothing is done. */
void smooth_blur(double *values, int columns, int rows, const double sigma[2], SmoothEdge edge);
