/* flux_map.h - a flux density measured or computed on a regular grid.
 *
 * A CSV file with rows x, y, z, Bx, By, Bz (m, T), one for each node, in any order. Steps along an axis are equal, to 1e-3 of
 * one; where an axis has one place only, B does not depend on it. */
#pragma once
#include "field/flux_field.h"

/* Its numbers times a factor. NULL and a sentence with file:line. */
FluxField *flux_map_read(const char *path, double factor, Error *err);
