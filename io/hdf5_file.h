/* hdf5_file.h - HDF5 files as images in memory: built whole, and read only after their bytes have been
 * checked. Private to io/. A failing disk or a damaged file never meets the HDF5 library. */
#pragma once
#include "base/error.h"
#include "io/array.h"

typedef struct Hdf5 Hdf5;

/* An empty file in memory; the same content gives the same bytes. */
Hdf5 *hdf5_create(void);

/* A file from bytes, which are copied. NULL and a sentence where they are no HDF5. */
Hdf5 *hdf5_open(const void *bytes, size_t size, Error *err);
void hdf5_close(Hdf5 *file);

/* How a dataset is stored. Zeros: whole, as doubles, not compressed. */
typedef struct Hdf5Layout {
    int chunk_rows; /* rows of the first dimension in a chunk, which are compressed (gzip 1, shuffle) */
    bool single;    /* float32                                                                        */
    bool wide;      /* int32 stored as int64, as VTKHDF wants it                                      */
    bool bytes;     /* int32 stored as uint8                                                          */
} Hdf5Layout;

/* Writes an array at a path; groups on the way are made. With a unit it gets the attribute `unit`. */
bool hdf5_write(Hdf5 *file, const char *path, const Array *array, Hdf5Layout layout, Error *err);

/* A dataset that is filled chunk by chunk, each chunk_rows rows of `width` numbers (0: numbers): [all rows,width], or
 * stacked, [chunks,chunk_rows,width]. */
typedef struct Hdf5Rows Hdf5Rows;
Hdf5Rows *hdf5_rows_create(Hdf5 *file, const char *path, const char *unit, int chunk_rows, int width,
                           bool stacked, bool single, Error *err);
bool hdf5_rows_append(Hdf5Rows *rows, const double *values, Error *err); /* chunk_rows of them */
bool hdf5_rows_close(Hdf5Rows *rows, Error *err);

bool hdf5_attribute_text(Hdf5 *file, const char *group, const char *name, const char *text, Error *err);
bool hdf5_attribute_ints(Hdf5 *file, const char *group, const char *name, const int *values, int count,
                         Error *err);

/* The whole file; the caller frees the bytes. */
bool hdf5_image(Hdf5 *file, void **bytes, size_t *size, Error *err);

/* ---- Reading ---- */

bool hdf5_has(Hdf5 *file, const char *path);

/* Rows first .. first+count-1 of the first dimension; count < 0: all. Floating point as float64, integers as
 * int32. */
bool hdf5_read(Hdf5 *file, const char *path, int first, int count, Array *array, Error *err);
bool hdf5_read_attribute_text(Hdf5 *file, const char *group, const char *name, char **text, Error *err);

/* Paths of all datasets, sorted by group: "slender/state/x". One block for mem_free. */
bool hdf5_list(Hdf5 *file, char ***paths, int *count, Error *err);

const char *hdf5_version(void);
