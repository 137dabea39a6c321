/* runs_file.h - the CSV that lists a sweep's runs: its first line the keys, each further one a run's values, split by
 * commas, or by semicolons where the first line has one. What has commas stands in double quotes. Blank lines, and lines
 * that begin with #, are passed over. */
#pragma once
#include "base/error.h"
#include <stddef.h>

typedef struct RunsFile {
    int rows, columns; /* runs, keys */
    char **cells;      /* [1 + rows][columns], the keys first */
    int *line;         /* [1 + rows] from 1 */
    size_t cell_count; /* of a line that was refused, too */
} RunsFile;

/* False and a sentence; clear it in any case. */
bool runs_file_read(const char *path, RunsFile *list, Error *err);
void runs_file_clear(RunsFile *list);
