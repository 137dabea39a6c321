/* section.h - what a rod's cross-section and material amount to. Its axes n1 and n2 are those of its frames (frame.h): bend1
 * is the stiffness against bending about n1, that is, within the plane of the tangent and n2. */
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

/* A section of a Young's modulus of 1 Pa, with another one. */
static inline RodSection rod_section_of(RodSection unit, double young)
{
    unit.twist *= young, unit.bend1 *= young, unit.bend2 *= young;
    unit.stretch *= young, unit.shear1 *= young, unit.shear2 *= young;
    return unit;
}

/* Of each number the larger one, in `most`. */
void rod_section_most(RodSection *most, const RodSection *other);

/* A circle of that radius. */
RodSection rod_circle(double radius, double young, double poisson, double density);

/* An ellipse with half-axis a1 along n1 and a2 along n2; twist by Saint-Venant, not by the polar moment. Where Poisson's ratio
 * is below 0 the shear stiffness of flat ones across their flat side may come out below 0: the formula has left the sections
 * that it is for. */
RodSection rod_ellipse(double a1, double a2, double young, double poisson, double density);

/* A rectangle of that width along n1 and height along n2, its reach half of the larger one; twist by Saint-Venant's series. */
RodSection rod_rectangle(double width, double height, double young, double poisson, double density);

/* m^4, of a rectangle: the couple that twists it over G and the twist, to rounding [Timoshenko & Goodier, Theory of
 * Elasticity, section 109]. */
double rod_rectangle_torsion(double width, double height);

/* What else a section may be given by. */
typedef struct RodSectionDef {
    double area;           /* m^2                                                                      */
    double I1, I2;         /* m^4, second moments for bending about n1 and n2: int y2^2, int y1^2 dA  */
    double J;              /* m^4, of torsion: GJ is the stiffness                                     */
    double kappa1, kappa2; /* shear coefficients along n1 and n2; 0: not known                         */
    double reach;          /* m                                                                        */
} RodSectionDef;

RodSection rod_given(const RodSectionDef *def, double young, double poisson, double density);
