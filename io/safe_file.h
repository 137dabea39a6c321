/* safe_file.h - files that are old or new, never half: written beside, read back, synced, renamed. All that is written
 * but the journal is written so.
 *
 * A checked file ends with a trailer of 20 bytes: "SLENDRCK", the length before it (uint64) and the CRC32 of
 * these bytes (uint32), little-endian. */
#pragma once
#include "base/error.h"
#include <stddef.h>

#define SAFE_FILE_MARK "SLENDRCK"

/* Replaces the file, if replace_check allows it. On false the old one is still there. */
bool safe_file_write(const char *path, const void *bytes, size_t size, bool checked, Error *err);

/* Removes the temporary files that runs which were killed have left beside this file, none of a run that lives. Every
 * write begins with it. */
void safe_file_sweep(const char *path);

/* Reads a checked file; bytes without the trailer, the caller frees them. */
bool safe_file_read(const char *path, void **bytes, size_t *size, Error *err);
