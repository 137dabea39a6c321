/* section.h - what a rod's cross-section and material amount to. */
#pragma once
#include <math.h>

typedef struct RodSection {
    double twist, bend1, bend2; /* GJ and E I about n1 and n2, N m^2 */
    double mass;                /* kg/m                              */
    double reach;               /* its largest half-width, m         */
} RodSection;

/* A circle of that radius. */
static inline RodSection rod_circle(double radius, double young, double poisson, double density)
{
    double bend = young * M_PI * pow(radius, 4) / 4;
    return (RodSection){bend / (1 + poisson), bend, bend, density * M_PI * radius * radius, radius};
}

/* A section of a Young's modulus of 1 Pa, with another one. */
static inline RodSection rod_section_of(RodSection unit, double young)
{
    unit.twist *= young, unit.bend1 *= young, unit.bend2 *= young;
    return unit;
}

/* An ellipse with half-axis a1 along n1 and a2 along n2; twist by Saint-Venant, not by the polar moment. */
static inline RodSection rod_ellipse(double a1, double a2, double young, double poisson, double density)
{
    double shear = young / (2 * (1 + poisson)), a = M_PI * a1 * a2;
    return (RodSection){shear * M_PI * pow(a1 * a2, 3) / (a1 * a1 + a2 * a2), young * a * a2 * a2 / 4,
                        young * a * a1 * a1 / 4, density * a, fmax(a1, a2)};
}
