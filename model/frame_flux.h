/* frame_flux.h - the flux density anywhere around the body of a result, at each of its frames: of the sources in the scene that
 * the result keeps, with the numbers that they had in the frame (frames/flux_uniform, flux_sources). */
#pragma once
#include "field/flux.h"
#include "io/result.h"

typedef struct FrameFlux {
    FluxFields fields; /* none: of a result without sources whose field varies in space */
    Params params;
    FluxBlocks blocks;
    double *p, time; /* of the frame that was taken */
} FrameFlux;

/* Of a result that does not say what its sources were in its frames there are no fields. False and a sentence where they cannot
 * be made again (a map that is gone, or another one). Clear it in any case. */
bool frame_flux_open(FrameFlux *flux, Result *result, Error *err);
void frame_flux_clear(FrameFlux *flux);

/* Goes to a frame, which is at a time (s); NAN: of a state of rest, whose time the result knows. */
bool frame_flux_take(FrameFlux *flux, Result *result, int frame, double time, Error *err);

/* B[3] in T at x (m) in that frame. NaN where it is not known: within magnets, at windings, beyond maps. */
void frame_flux_at(const FrameFlux *flux, const double x[3], double B[3]);

/* The middle of a source in that frame, m; false where it does not act then, or has no shape. */
bool frame_flux_middle(const FrameFlux *flux, int source, double middle[3]);

/* The numbers of a source in frames/flux_sources: its factor, how far it is moved and turned beyond its scene. */
enum { FRAME_FLUX_WIDTH = 7 };
void frame_flux_numbers(const FluxBlocks *blocks, const double *p, int source, double row[FRAME_FLUX_WIDTH]);
