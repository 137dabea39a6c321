/* grid_file.h - fields on a regular grid in space, from an HDF5 file.
 *
 * Datasets of its root: x [nx], y [ny], z [nz], places along the axes, ascending in equal steps to 1e-3 of one (m), and each
 * field by its name, [nx,ny,nz]. An attribute `unit` (or `units`) of any of them is honoured. */
#pragma once
#include "base/error.h"

typedef struct GridFile {
    int nodes[3];
    double low[3], step[3]; /* m; of an axis with one place the step is 1 */
    double *values;         /* [field][nx][ny][nz] SI; owned */
} GridFile;

/* So many fields, which have this unit. False and a sentence where the file is none, lacks one, or has another shape. */
bool grid_file_read(const char *path, const char *const *fields, int count, const char *unit, GridFile *grid,
                    Error *err);
void grid_file_clear(GridFile *grid);
