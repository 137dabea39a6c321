/* rod_reference.h - the rods of the reference results, for tests: curves, sizes, materials. */
#pragma once
#include "rod/inverse.h"

/* self: dz/du, or NULL for the helix that hangs */
static inline bool reference_helix(void *self, double u, Vec3 *x)
{
    *x = vec3(0.015 * cos(u), 0.015 * sin(u), (self ? *(const double *)self : -0.00318) * u);
    return true;
}

static inline bool reference_conical(void *self, double u, Vec3 *x)
{
    (void)self;
    double r = 0.8e-3 * exp(u / 2);
    *x = vec3(r * cos(2 * u), r * sin(2 * u), -0.016 * u);
    return true;
}

/* self: omega */
static inline bool reference_wave(void *self, double u, Vec3 *x)
{
    *x = vec3(0.05 * sin(*(const double *)self * u), 0, -u);
    return true;
}

static const double reference_omega = 62.83185307179586;

typedef struct ReferenceRod {
    const char *name;
    RodCurvePoint *point;
    const double *omega;
    double range, young;
} ReferenceRod;

enum { REFERENCE_HELIX, REFERENCE_CONICAL, REFERENCE_WAVE, REFERENCE_COUNT };

static const ReferenceRod reference_rods[REFERENCE_COUNT] = {
    {"helix", reference_helix, NULL, 19.565163762857, 5e6},
    {"conical", reference_conical, NULL, 7.88691715750555, 3.5e6},
    {"wave", reference_wave, &reference_omega, .302598403658, 23e6},
};

static const double reference_radius = 1.5e-3, reference_density = 1200, reference_gravity = 9.8;

static inline RodSection reference_section(double young)
{
    return rod_circle(reference_radius, young, 0.5, reference_density);
}

static inline RodLoads reference_weight(RodSection section)
{
    return (RodLoads){.line = vec3(0, 0, -reference_gravity * section.mass)};
}
