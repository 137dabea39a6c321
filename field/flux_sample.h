/* flux_sample.h - a flux density at a point, with its derivatives. */
#pragma once

/* B at a point x (m) and time (s): flux[3] in T, gradient[k][l] = dB_k/dx_l in T/m, curvature[k][l][m] in T/m^2. */
typedef struct FluxSample {
    double flux[3], gradient[3][3], curvature[3][3][3];
} FluxSample;

/* From own axes to those of space: the rows are the own axes. */
void flux_vector_turn(const double (*axes)[3], double v[3]);
void flux_sample_turn(const double (*axes)[3], FluxSample *sample);
