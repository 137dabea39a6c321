/* file_sum.h - a file told by its contents. */
#pragma once
#include "base/error.h"
#include <stdint.h>

typedef struct FileSum {
    uint32_t crc;    /* CRC32, as of zlib and gzip                                                      */
    long long bytes; /* -1: no regular file (a pipe, a terminal), which cannot be read a second time    */
} FileSum;

/* False and a sentence where it cannot be read. */
bool file_sum(const char *path, FileSum *sum, Error *err);
