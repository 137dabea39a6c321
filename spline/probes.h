/* probes.h - where the tone of a drawing is compared with the picture's: at the leaves of a quad tree.
 *
 * A probe at x_c sees the ink within its own radius R_c, weighted by W(d) = 4/(pi R_c^2) (1 - d^2/R_c^2)^3,
 * whose integral is 1; it asks for the density D_c, the picture's seen through the same W. R_c is 1.6 line
 * distances pen/D, so that a few lines are within it, fine where the picture is dark and wide where it is
 * light; leaves are smaller than 0.4 R_c. As the radius belongs to the probe and not to the ink, gradients
 * stay simple while the scale follows the tone.
 *
 * From place to place R_c grows no more than the distance (as sizes do in a graded mesh [Borouchaki, Hecht and
 * Frey 1998]): no probe's disc has that of a finer one wholly inside. Beside a hard edge, wide probes on blank
 * paper would take ink on it for that of the dark beyond the edge.
 *
 * Each level of the tree is kept as a whole grid of cells, most of them no probes (inverse 0): a window of it
 * is a few short rows in memory, and the sums over it need neither lists nor gathers. */
#pragma once
#include "base/workers.h"
#include "spline/grid_spline.h"
#include <stdint.h>

typedef struct ProbesDef {
    double radius; /* R_c in line distances; default 1.6                                                    */
    double radius_min; /* in pens; default 1.5 */
    double radius_max; /* in units of the page; default 0.15 */
    double cell;  /* largest leaf in R_c; default 0.4                                                      */
    double faint; /* errors count by 1/max(D_c, faint), so that light lines are as stiff as dark ones; 0.03 */
    Workers *workers; /* borrowed; NULL: one thread */
} ProbesDef;

ProbesDef probes_default(void);

enum { PROBES_MAX_LEVELS = 16 };

typedef struct ProbeLevel {
    int columns, rows, stride; /* stride: of rows in memory, with room for a pack beyond the last column */
    double dx, dy;             /* size of a cell; probes are at the centres                              */
    double reach;              /* the largest radius                                                     */
    long first;                /* of its cells in the arrays below                                       */
} ProbeLevel;

typedef struct Probes {
    int level_count, count; /* probes in all */
    ProbeLevel levels[PROBES_MAX_LEVELS];
    long size;       /* of the arrays                                            */
    double *inverse; /* [size] 1/R_c^2; 0: no probe                              */
    double *target;  /* [size] D_c                                               */
    double *gain;    /* [size] area of the leaf/max(D_c, faint)                  */
    /* The levels that have a probe within its radius of a tile of the page, as bits. */
    int tile_columns, tile_rows;
    double tile_dx, tile_dy;
    uint16_t *tiles; /* [tile_rows][tile_columns] */
} Probes;

/* density: the picture's; what is beyond 0 and 1 counts as the bound. */
Probes *probes_create(const SplinePage *page, const SplineGrid *density, const ProbesDef *def);
void probes_destroy(Probes *probes);
