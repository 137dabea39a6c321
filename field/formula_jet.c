#include "field/formula_jet.h"
#include <string.h>

/* Where a formula is sampled: the point itself, then REACH steps either way along each line. */
enum { LINES = 6, REACH = 4, PLACES = 1 + 2 * REACH * LINES, VARIABLES = 4 + FORMULA_JET_NUMBERS };

static const Vec3 line_direction[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};

static int place_along(int line, int k, bool minus)
{
    return 1 + 2 * (REACH * line + k - 1) + minus;
}

static void put_place(const FormulaOfPlace *of, double *variables, Vec3 x, const double *numbers)
{
    double values[] = {x.x, x.y, x.z, hypot(x.x, x.y)};
    memcpy(variables, values, sizeof values);
    memcpy(variables + 4, numbers, (size_t)of->numbers * sizeof *numbers);
}

/* v[PLACES]; false where one of them is not finite. */
static bool sample_places(const FormulaOfPlace *of, Vec3 x, const double *numbers, Vec3 *v)
{
    double variables[PLACES * VARIABLES], results[PLACES * FORMULA_JET_RESULTS];
    int width = 4 + of->numbers;
    put_place(of, variables, x, numbers);
    for (int line = 0; line < LINES; line++)
        for (int k = 1; k <= REACH; k++)
            for (int minus = 0; minus < 2; minus++) {
                double step = minus ? -k * of->step : k * of->step;
                put_place(of, variables + width * place_along(line, k, minus),
                          vec3_axpy(step, line_direction[line], x), numbers);
            }
    if (!formula_eval_all(of->formula, PLACES, variables, results, NULL)) return false;
    for (int k = 0; k < PLACES; k++) {
        double own[FORMULA_JET_RESULTS] = {0};
        memcpy(own, results + k * of->results, (size_t)of->results * sizeof *own);
        v[k] = vec3_load(own);
    }
    return true;
}

/* First and second derivative along a line. */
static void differences(const Vec3 *v, int line, double h, double first[3], double second[3])
{
    static const double c1[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    static const double c2[] = {8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    Vec3 d1 = vec3(0, 0, 0), d2 = vec3_scale(-205.0 / 72, v[0]);
    for (int k = 1; k <= REACH; k++) {
        Vec3 plus = v[place_along(line, k, false)], minus = v[place_along(line, k, true)];
        d1 = vec3_axpy(c1[k - 1], vec3_sub(plus, minus), d1);
        d2 = vec3_axpy(c2[k - 1], vec3_add(plus, minus), d2);
    }
    vec3_store(first, vec3_scale(1 / h, d1));
    vec3_store(second, vec3_scale(1 / (h * h), d2));
}

bool formula_jet(const FormulaOfPlace *of, Vec3 x, const double *numbers, FormulaJet *jet)
{
    Vec3 v[PLACES];
    if (!sample_places(of, x, numbers, v)) {
        *jet = (FormulaJet){.value = {NAN, NAN, NAN}};
        return false;
    }
    double first[LINES][3], second[LINES][3];
    for (int line = 0; line < LINES; line++) differences(v, line, of->step, first[line], second[line]);
    vec3_store(jet->value, v[0]);
    for (int l = 0; l < 3; l++) /* d2/dl dm = (d2/d(l+m)^2 - d2/dl^2 - d2/dm^2)/2 */
        for (int k = 0, m = (l + 1) % 3; k < 3; k++) {
            jet->gradient[k][l] = first[l][k];
            jet->curvature[k][l][l] = second[l][k];
            double mixed = 0.5 * (second[3 + l][k] - second[l][k] - second[m][k]);
            jet->curvature[k][l][m] = jet->curvature[k][m][l] = mixed;
        }
    return true;
}

bool formula_jet_value(const FormulaOfPlace *of, Vec3 x, const double *numbers, double *value, Error *err)
{
    double variables[VARIABLES];
    put_place(of, variables, x, numbers);
    return formula_eval(of->formula, variables, value, err);
}
