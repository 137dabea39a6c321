/* safe_file.h - files that are old or new, never half: written beside, read back, synced, renamed. Private to
 * io/.
 *
 * A checked file ends with a trailer of 20 bytes: "SLENDRCK", the length before it (uint64) and the CRC32 of
 * these bytes (uint32), little-endian. */
#pragma once
#include "base/error.h"
#include <stddef.h>

/* Replaces the file. On false the old one is still there. */
bool safe_file_write(const char *path, const void *bytes, size_t size, bool checked, Error *err);

/* Reads a checked file; bytes without the trailer, the caller frees them. */
bool safe_file_read(const char *path, void **bytes, size_t *size, Error *err);
