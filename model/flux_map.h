/* flux_map.h - a flux density measured or computed on a regular grid.
 *
 * A CSV file with rows x, y, z, Bx, By, Bz (m, T), one for each node, in any order. Steps along an axis are equal, to 1e-3 of
 * one; where an axis has one place only, B does not depend on it. Or an HDF5 file, by its ending .h5 or .hdf5, with the
 * datasets x [nx], y [ny], z [nz] and Bx, By, Bz [nx,ny,nz] (io/grid_file.h). */
#pragma once
#include "field/flux_field.h"

/* Its numbers times a factor. NULL and a sentence, of a CSV file with file:line. */
FluxField *flux_map_read(const char *path, double factor, Error *err);
