/* section.h - what a rod's cross-section and material amount to. */
#pragma once
#include "base/vec3.h"
#include <math.h>
#include <stdbool.h>

/* Nothing but doubles. */
typedef struct RodSection {
    double twist, bend1, bend2; /* GJ and E I about n1 and n2, N m^2 */
    double mass;                /* kg/m                              */
    double area;                /* m^2                               */
    double reach;               /* its largest half-width, m         */
    double stretch; /* EA, N; and kappa G A along n1 and n2, N, of Cosserat rods: the shear coefficients
                                 * kappa are those of Cowper (1966) for solid sections */
    double shear1, shear2;
} RodSection;

/* Sections along a rod: one for all of its places, or one for each. */
typedef struct RodSections {
    const RodSection *at; /* borrowed */
    bool vary;
} RodSections;

static inline RodSections rod_alike(const RodSection *section)
{
    return (RodSections){section, false};
}

static inline const RodSection *rod_section_at(RodSections sections, int place)
{
    return sections.at + (sections.vary ? place : 0);
}

/* (GJ, EI1, EI2) of a section of 1 Pa with that modulus, N m^2. */
static inline Vec3 rod_stiffness(const RodSection *unit, double young)
{
    return vec3(unit->twist * young, unit->bend1 * young, unit->bend2 * young);
}

/* The strain (twist, k1, k2) that a moment bends it by, both in its frame. */
static inline Vec3 rod_bent(const RodSection *section, Vec3 moment)
{
    return vec3(moment.x / section->twist, moment.y / section->bend1, moment.z / section->bend2);
}

/* Of an ellipse of that area, for shear along its half-axis `along`. Below 0 (where Poisson's ratio is) the formula has
 * left the sections that it is for: flat ones across their flat side. */
static inline double rod_shear(double along, double other, double young, double poisson, double area)
{
    double a = along * along, b = other * other;
    return 6 * young * area * a * (3 * a + b) /
           ((40 + 37 * poisson) * a * a + (16 + 10 * poisson) * a * b + poisson * b * b);
}

/* A circle of that radius. */
static inline RodSection rod_circle(double radius, double young, double poisson, double density)
{
    double bend = young * M_PI * pow(radius, 4) / 4, area = M_PI * radius * radius,
           shear = rod_shear(radius, radius, young, poisson, area); /* kappa = 6 (1 + nu)/(7 + 6 nu) */
    return (RodSection){
        bend / (1 + poisson), bend,  bend, density * M_PI * radius * radius, M_PI * (radius * radius), radius,
        young * area,         shear, shear};
}

/* A section of a Young's modulus of 1 Pa, with another one. */
static inline RodSection rod_section_of(RodSection unit, double young)
{
    unit.twist *= young, unit.bend1 *= young, unit.bend2 *= young;
    unit.stretch *= young, unit.shear1 *= young, unit.shear2 *= young;
    return unit;
}

/* An ellipse with half-axis a1 along n1 and a2 along n2; twist by Saint-Venant, not by the polar moment. */
static inline RodSection rod_ellipse(double a1, double a2, double young, double poisson, double density)
{
    double shear = young / (2 * (1 + poisson)), a = M_PI * a1 * a2;
    return (RodSection){shear * M_PI * pow(a1 * a2, 3) / (a1 * a1 + a2 * a2),
                        young * a * a2 * a2 / 4,
                        young * a * a1 * a1 / 4,
                        density * a,
                        M_PI * (a1 * a2),
                        fmax(a1, a2),
                        young * a,
                        rod_shear(a1, a2, young, poisson, a),
                        rod_shear(a2, a1, young, poisson, a)};
}
