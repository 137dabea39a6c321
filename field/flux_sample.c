#include "field/flux_sample.h"

void flux_vector_turn(const double (*axes)[3], double v[3])
{
    double own[3] = {v[0], v[1], v[2]};
    for (int i = 0; i < 3; i++) v[i] = axes[0][i] * own[0] + axes[1][i] * own[1] + axes[2][i] * own[2];
}

/* v^T a v for the axes a: of the columns, then of the rows. */
static void turn_matrix(const double (*axes)[3], double v[3][3])
{
    for (int i = 0; i < 3; i++) flux_vector_turn(axes, v[i]);
    for (int j = 0; j < 3; j++) {
        double column[3] = {v[0][j], v[1][j], v[2][j]};
        flux_vector_turn(axes, column);
        for (int i = 0; i < 3; i++) v[i][j] = column[i];
    }
}

void flux_sample_turn(const double (*axes)[3], FluxSample *sample)
{
    flux_vector_turn(axes, sample->flux);
    turn_matrix(axes, sample->gradient);
    for (int k = 0; k < 3; k++) turn_matrix(axes, sample->curvature[k]);
    for (int l = 0; l < 3; l++)
        for (int m = 0; m < 3; m++) {
            double along[3] = {sample->curvature[0][l][m], sample->curvature[1][l][m],
                               sample->curvature[2][l][m]};
            flux_vector_turn(axes, along);
            for (int k = 0; k < 3; k++) sample->curvature[k][l][m] = along[k];
        }
}
