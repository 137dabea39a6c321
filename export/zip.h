/* zip.h - a zip archive in the making, its members deflated. Sizes have 32 bits: no ZIP64.
 * Source: PKWARE, APPNOTE.TXT - .ZIP File Format Specification 6.3.10. */
#pragma once
#include "base/error.h"
#include "export/bytes.h"

typedef struct Zip {
    Bytes *file;   /* borrowed; empty at first */
    Bytes entries; /* its table of contents    */
    unsigned count;
} Zip;

/* False where the archive would be larger than it may be. */
bool zip_add(Zip *zip, const char *name, const void *data, size_t size, Error *err);

/* Ends the archive, and clears what the zip owns; in any case. */
void zip_end(Zip *zip);
