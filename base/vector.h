/* vector.h - plain vectors of n doubles. */
#pragma once

static inline double vector_dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}
