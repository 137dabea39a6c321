#include "field/flux_formula.h"
#include <string.h>

/* Where a formula is sampled: the point itself, then REACH steps either way along each line. */
enum { LINES = 6, REACH = 4, PLACES = 1 + 2 * REACH * LINES };

static const Vec3 line_direction[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};

static int place_along(int line, int k, bool minus)
{
    return 1 + 2 * (REACH * line + k - 1) + minus;
}

static void put_place(double *variables, Vec3 x, double time)
{
    double values[] = {x.x, x.y, x.z, hypot(x.x, x.y), time};
    memcpy(variables, values, sizeof values);
}

/* B[PLACES]; false where one of them is not finite. */
static bool sample_places(Formula *formula, double step, Vec3 x, double time, Vec3 *B)
{
    double variables[PLACES][5], results[PLACES][3];
    put_place(variables[0], x, time);
    for (int line = 0; line < LINES; line++)
        for (int k = 1; k <= REACH; k++)
            for (int minus = 0; minus < 2; minus++) {
                double way = minus ? -k * step : k * step;
                put_place(variables[place_along(line, k, minus)], vec3_axpy(way, line_direction[line], x),
                          time);
            }
    if (!formula_eval_all(formula, PLACES, variables[0], results[0], NULL)) return false;
    for (int k = 0; k < PLACES; k++) B[k] = vec3_load(results[k]);
    return true;
}

/* First and second derivative along a line, central differences of eighth order: for a field that varies on the
 * body's scale L, a step of L/64 leaves truncation and round-off both near 1e-12 (docs/theory.md). */
static void differences(const Vec3 *B, int line, double h, double first[3], double second[3])
{
    static const double c1[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    static const double c2[] = {8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    Vec3 d1 = vec3(0, 0, 0), d2 = vec3_scale(-205.0 / 72, B[0]);
    for (int k = 1; k <= REACH; k++) {
        Vec3 plus = B[place_along(line, k, false)], minus = B[place_along(line, k, true)];
        d1 = vec3_axpy(c1[k - 1], vec3_sub(plus, minus), d1);
        d2 = vec3_axpy(c2[k - 1], vec3_add(plus, minus), d2);
    }
    vec3_store(first, vec3_scale(1 / h, d1));
    vec3_store(second, vec3_scale(1 / (h * h), d2));
}

void flux_of_formula(Formula *formula, double step, const double x[3], double time, FluxSample *sample)
{
    Vec3 B[PLACES];
    if (!sample_places(formula, step, vec3_load(x), time, B)) {
        *sample = (FluxSample){.flux = {NAN, NAN, NAN}};
        return;
    }
    double first[LINES][3], second[LINES][3];
    for (int line = 0; line < LINES; line++) differences(B, line, step, first[line], second[line]);
    vec3_store(sample->flux, B[0]);
    for (int l = 0; l < 3; l++) /* d2/dl dm = (d2/d(l+m)^2 - d2/dl^2 - d2/dm^2)/2 */
        for (int k = 0, m = (l + 1) % 3; k < 3; k++) {
            sample->gradient[k][l] = first[l][k];
            sample->curvature[k][l][l] = second[l][k];
            double mixed = 0.5 * (second[3 + l][k] - second[l][k] - second[m][k]);
            sample->curvature[k][l][m] = sample->curvature[k][m][l] = mixed;
        }
}

bool flux_formula_value(Formula *formula, const double x[3], double time, double flux[3], Error *err)
{
    double variables[5];
    put_place(variables, vec3_load(x), time);
    return formula_eval(formula, variables, flux, err);
}
