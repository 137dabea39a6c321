/* arrays_file.h - arrays as an HDF5 file, a dataset each at its name. */
#pragma once
#include "base/error.h"
#include "io/array.h"

/* Replaces the file as safe_file_write does. */
bool arrays_file_write(const char *path, const Array *arrays, int count, Error *err);
