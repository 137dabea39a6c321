#include "rod/section.h"
#include <stddef.h>

void rod_section_most(RodSection *most, const RodSection *other)
{
    const double *from = (const double *)other;
    double *to = (double *)most;
    for (size_t k = 0; k < sizeof *most / sizeof *to; k++) to[k] = fmax(to[k], from[k]);
}

/* kappa G A of an ellipse of that area, for shear along its half-axis `along`. */
static double ellipse_shear(double along, double other, double young, double poisson, double area)
{
    double a = along * along, b = other * other;
    return 6 * young * area * a * (3 * a + b) /
           ((40 + 37 * poisson) * a * a + (16 + 10 * poisson) * a * b + poisson * b * b);
}

RodSection rod_circle(double radius, double young, double poisson, double density)
{
    double bend = young * M_PI * pow(radius, 4) / 4, area = M_PI * radius * radius,
           shear = ellipse_shear(radius, radius, young, poisson, area); /* kappa = 6 (1 + nu)/(7 + 6 nu) */
    return (RodSection){.twist = bend / (1 + poisson),
                        .bend1 = bend,
                        .bend2 = bend,
                        .mass = density * M_PI * radius * radius,
                        .area = M_PI * (radius * radius),
                        .reach = radius,
                        .stretch = young * area,
                        .shear1 = shear,
                        .shear2 = shear};
}

RodSection rod_ellipse(double a1, double a2, double young, double poisson, double density)
{
    double shear = young / (2 * (1 + poisson)), a = M_PI * a1 * a2;
    return (RodSection){.twist = shear * M_PI * pow(a1 * a2, 3) / (a1 * a1 + a2 * a2),
                        .bend1 = young * a * a2 * a2 / 4,
                        .bend2 = young * a * a1 * a1 / 4,
                        .mass = density * a,
                        .area = M_PI * (a1 * a2),
                        .reach = fmax(a1, a2),
                        .stretch = young * a,
                        .shear1 = ellipse_shear(a1, a2, young, poisson, a),
                        .shear2 = ellipse_shear(a2, a1, young, poisson, a)};
}

/* a^3 b (1/3 - 64/pi^5 a/b sum of tanh(n pi b/2 a)/n^5 over odd n), a <= b, with tanh x = 1 - 2/(e^2x + 1), whose ones add up
 * to 31/32 zeta(5): what is left falls with e^(-pi n). */
double rod_rectangle_torsion(double width, double height)
{
    const double ones = 31.0 / 32 * 1.03692775514336992633;
    double a = fmin(width, height), b = fmax(width, height), sum = ones;
    for (int n = 1; n <= 11; n += 2) sum -= 2 / (pow(n, 5) * (exp(n * M_PI * b / a) + 1));
    return a * a * a * b * (1.0 / 3 - 64 / pow(M_PI, 5) * a / b * sum);
}

/* Cowper's kappa of a rectangle is one and the same along both sides. */
RodSection rod_rectangle(double width, double height, double young, double poisson, double density)
{
    double area = width * height, kappa = 10 * (1 + poisson) / (12 + 11 * poisson);
    RodSectionDef def = {.area = area,
                         .I1 = area * height * height / 12,
                         .I2 = area * width * width / 12,
                         .J = rod_rectangle_torsion(width, height),
                         .kappa1 = kappa,
                         .kappa2 = kappa,
                         .reach = fmax(width, height) / 2};
    return rod_given(&def, young, poisson, density);
}

RodSection rod_given(const RodSectionDef *def, double young, double poisson, double density)
{
    double shear = young / (2 * (1 + poisson));
    return (RodSection){.twist = shear * def->J,
                        .bend1 = young * def->I1,
                        .bend2 = young * def->I2,
                        .mass = density * def->area,
                        .area = def->area,
                        .reach = def->reach,
                        .stretch = young * def->area,
                        .shear1 = def->kappa1 * shear * def->area,
                        .shear2 = def->kappa2 * shear * def->area};
}
