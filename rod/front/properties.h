/* properties.h - what a scene says of a rod's section and Young's modulus, numbers and what varies along it, and what these are
 * somewhere on the rod. */
#pragma once
#include "io/formula.h"
#include "io/table.h"
#include "model/build.h"
#include "rod/front/scene.h"
#include "rod/section.h"

enum { ROD_YOUNG, ROD_RADIUS, ROD_WIDTH, ROD_HEIGHT, ROD_AREA, ROD_I1, ROD_I2, ROD_J, ROD_ALONGS };

/* A number, or what it is along the rod. */
typedef struct RodAlong {
    const AlongScene *from; /* the scene's; NULL: not given                */
    Formula *formula;       /* of s and L; owned; NULL: a number or a table */
    Table table;            /* rows s, number; owned                       */
} RodAlong;

typedef struct RodProperties {
    const RodScene *scene;
    RodAlong along[ROD_ALONGS];
    const char *section_varies,
        *varies; /* the key of a number that does: of the section's, of all; NULL: none */
} RodProperties;

/* Formulas and files; false after a refusal. The scene must outlive it. */
bool rod_properties_read(const RodScene *scene, const Build *b, RodProperties *properties);
void rod_properties_clear(RodProperties *properties);

/* Are the files' rows those of a rod of that length? False after a refusal. */
bool rod_properties_check(const RodProperties *properties, const Build *b, double length);

/* The section, of 1 Pa, and Young's modulus at arclength s of a rod of length L. What the scene does not say (of an
 * identification) is NAN. False after a refusal, where a number is not positive. */
bool rod_properties_at(const RodProperties *properties, const Build *b, double s, double L, RodSection *unit,
                       double *young);

enum { ROD_OUTLINE_SIDE = 6, ROD_OUTLINE = 4 * ROD_OUTLINE_SIDE };

/* The outline of the section at the first end of a rod of length L, a polygon along n1 and n2, outline[ROD_OUTLINE][2] m; of a section that is given
 * by what it amounts to a circle of that reach. */
void rod_properties_outline(const RodProperties *properties, const Build *b, double L, double reach,
                            double (*outline)[2]);
