#include "surface/flux.h"
#include <string.h>

Flux flux_uniform(const double *B)
{
    return (Flux){.B = pack3(pack_set(B[0]), pack_set(B[1]), pack_set(B[2]))};
}

Flux flux_of_field(const FluxField *field, Pack3 x, double time)
{
    double numbers[39][PACK_LANES];
    for (int l = 0; l < PACK_LANES; l++) {
        FluxSample sample;
        flux_field_eval(field, (double[]){x.x[l], x.y[l], x.z[l]}, time, &sample);
        for (int k = 0; k < 3; k++) numbers[k][l] = sample.flux[k];
        for (int k = 0; k < 9; k++) numbers[3 + k][l] = sample.gradient[k / 3][k % 3];
        for (int k = 0; k < 27; k++) numbers[12 + k][l] = sample.curvature[k / 9][k / 3 % 3][k % 3];
    }
    Pack3 rows[13];
    memcpy(rows, numbers, sizeof rows);
    Flux flux = {.B = rows[0], .gradient = {rows[1], rows[2], rows[3]}};
    for (int k = 0; k < 3; k++)
        flux.curvature[k] = (PackMat){rows[4 + 3 * k], rows[5 + 3 * k], rows[6 + 3 * k]};
    return flux;
}

/* a + scale b */
static Flux add(Flux a, double scale, const Flux *b)
{
    Pack s = pack_set(scale);
    a.B = pack3_axpy(s, b->B, a.B);
    a.gradient = pack_mat_add(a.gradient, pack_mat_scale(s, b->gradient));
    for (int k = 0; k < 3; k++)
        a.curvature[k] = pack_mat_add(a.curvature[k], pack_mat_scale(s, b->curvature[k]));
    return a;
}

Flux flux_at(const FluxFields *fields, FluxNumbers numbers, Pack3 x, double time)
{
    Flux flux = flux_uniform(numbers.uniform);
    for (int k = 0; k < fields->count; k++) {
        if (numbers.factor[k] == 0) continue;
        Flux field = flux_of_field(fields->items[k], x, time);
        flux = add(flux, numbers.factor[k], &field);
    }
    return flux;
}
