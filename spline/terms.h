/* terms.h - the energies of a drawing. These two lists are the only places that name them all.
 *
 * E sums over all segments; r(s), n = |r'|, dl = n ds, k the curvature, L0 the rest length of a segment. To
 * add one: write spline/<name>.c that defines spline_<name>_term() and ends in one private TermOps (or
 * _bulk(), BulkOps), add a row here and a member at the same place of SplineWeights. Behind the name: a
 * number, and the powers of pen width and of line distance in its factor. */
#pragma once
#include "solve/bulk.h"
#include "spline/model.h"

#define SPLINE_TERMS(X)                                                                                      \
    X(strain, 0.1, 0, 0)  /* S int (n - L0)^2/(2 L0) ds: length, and even speed                       */     \
    X(bend, 0.5, 0, 2)    /* B int |r''|^2/L0^3 ds = B int k^2 dl where n = L0                        */     \
    X(align, 0.2, 0, 0)   /* P int r'.M(r) r'/n ds: across a direction field costs                    */     \
    X(wall, 0.2, 0, 0)    /* R int b dl, b a logarithmic barrier two pens wide: never beyond the edge */     \
    X(outline, 0.2, 0, 0) /* R int b dl, b the same of the distance to the region's outline           */     \
    X(stretch, 1, 0, 0)   /* S (L - L0)^2 L/L0^2 of each segment  [Linewise, strain]                  */     \
    X(curvature, 1, 0, 2) /* B int k^2 dl                         [Linewise, bending]                 */     \
    X(potential, 1, 0, 0) /* Q int Phi(r) dl                      [Linewise]                          */     \
    X(flow, 1, 0, 0)      /* P int v(r).r' ds                     [Linewise, field]                   */     \
    X(boundary, 1, 0, 2)  /* R int dl/d^2, d to the nearest edge  [Linewise]                          */

#define SPLINE_BULKS(X)                                                                                      \
    X(tone, 1, -1, 0) /* K/2 sum over probes of their ink less what the picture asks for, squared */         \
    X(pair, 1, 0, -1) /* C/2 int int g(|r1 - r2|) dl1 dl2, g smooth with a cut-off  [Linewise, corrected] */ \
    X(length, 1, 0, 0) /* S (L - L0)^2 L/L0^2 of each stroke        [Linewise, strain as printed]           */

/* Which second derivatives a term gives. */
typedef enum SplineHessian {
    SPLINE_EXACT,    /* of the energy                                                             */
    SPLINE_POSITIVE, /* semidefinite: what bends energies down is left out (Gauss-Newton)         */
    SPLINE_OWN,      /* the same, and of Bulks the part within segments: coupled along strokes only */
} SplineHessian;

/* The terms borrow the model. */
typedef Term SplineTermCreate(const SplineModel *model, SplineHessian hessian);
typedef Bulk SplineBulkCreate(const SplineModel *model, SplineHessian hessian);

#define X(name, scale, pen, spacing) SplineTermCreate spline_##name##_term;
SPLINE_TERMS(X)
#undef X
#define X(name, scale, pen, spacing) SplineBulkCreate spline_##name##_bulk;
SPLINE_BULKS(X)
#undef X

typedef struct SplineTermRow {
    const char *name;
    SplineTermCreate *term; /* one of the two */
    SplineBulkCreate *bulk;
    double scale;
    int pen, spacing;
} SplineTermRow;

/* [SPLINE_WEIGHT_COUNT] as the members of SplineWeights. */
extern const SplineTermRow spline_term_rows[];
