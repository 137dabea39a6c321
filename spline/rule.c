#include "spline/rule.h"
#include <assert.h>

/* The points right of the middle, as offsets from it in half lengths, with their weights; `middle` is the
 * weight of the middle itself, where it is a point. */
typedef struct Half {
    int count;
    double offset[4], weight[4], middle;
} Half;

static const Half gauss[] = {
    {3, {0.77459666924148338}, {5.0 / 9}, 8.0 / 9},
    {4, {0.33998104358485626, 0.86113631159405258}, {0.65214515486254614, 0.34785484513745386}, 0},
    {5, {0.53846931010568309, 0.90617984593866399}, {0.47862867049936647, 0.23692688505618909}, 128.0 / 225},
    {8,
     {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623},
     {0.36268378337836198, 0.31370664587788729, 0.22238103445337447, 0.10122853629037626},
     0},
};

enum { GAUSS_COUNT = sizeof gauss / sizeof *gauss };

static void add_point(SplineRule *rule, double s, double weight)
{
    int k = rule->count++;
    double u = 1 - s;
    rule->s[k] = s;
    rule->weight[k] = weight;
    double value[4] = {u * u * (u + 3 * s), 3 * u * u * s, s * s * (s + 3 * u), -3 * u * s * s};
    double first[4] = {-6 * u * s, 3 * u * (u - 2 * s), 6 * u * s, 3 * s * (s - 2 * u)};
    double second[4] = {6 * (s - u), 6 * (s - 2 * u), 6 * (u - s), 6 * (2 * s - u)};
    for (int i = 0; i < 4; i++)
        rule->value[k][i] = value[i], rule->first[k][i] = first[i], rule->second[k][i] = second[i];
}

static SplineRule build(const Half *half)
{
    SplineRule rule = {0};
    int pairs = half->count / 2;
    for (int k = pairs - 1; k >= 0; k--) add_point(&rule, (1 - half->offset[k]) / 2, half->weight[k] / 2);
    if (half->count % 2) add_point(&rule, 0.5, half->middle / 2);
    for (int k = 0; k < pairs; k++) add_point(&rule, (1 + half->offset[k]) / 2, half->weight[k] / 2);
    return rule;
}

static const Half *find(int count)
{
    for (int k = 0; k < GAUSS_COUNT; k++)
        if (gauss[k].count == count) return &gauss[k];
    return 0;
}

bool spline_rule_exists(int count)
{
    return find(count) != 0;
}

SplineRule spline_rule_gauss(int count)
{
    const Half *half = find(count);
    assert(half);
    return build(half);
}

SplineRule spline_rule_even(int count)
{
    SplineRule rule = {0};
    for (int k = 0; k < count; k++)
        add_point(&rule, k / (count - 1.0), (k > 0 && k < count - 1 ? 1 : 0.5) / (count - 1));
    return rule;
}

SplineRule spline_rule_hull(void)
{
    static const double control[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, -1}, {0, 0, 1, 0}};
    SplineRule rule = {0};
    for (int k = 0; k < 4; k++) {
        add_point(&rule, k / 3.0, 0.25);
        for (int i = 0; i < 4; i++) rule.value[k][i] = control[k][i];
    }
    return rule;
}
