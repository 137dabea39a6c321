/* hdf5_private.h - what io/hdf5_file.c and io/hdf5_read.c share; no other file includes hdf5.h. */
#pragma once
#include "io/hdf5_file.h"
#include <hdf5.h>

struct Hdf5 {
    hid_t file, links; /* links: makes the groups on the way        */
    size_t size;       /* bytes of one that is read: nothing in it is larger */
};

/* False, and the sentence "HDF5 cannot WHAT PATH". */
bool hdf5_failed(const char *what, const char *path, Error *err);
