/* program.h - other programs, found in PATH and run without a shell. */
#pragma once
#include "base/error.h"
#include <sys/types.h>

/* A new folder for files of a run, in $TMPDIR or /tmp; owned by the caller, who ends with program_remove_folder. */
bool program_folder(char **folder, Error *err);

/* Removes the files in it, and it, and frees the name; NULL is fine. */
void program_remove_folder(char *folder);

/* Runs arguments[0] with the others (ending with NULL) and waits for it; what it prints goes to a file in the folder. False and
 * a sentence where it is not there (with the advice what to do then), or ended otherwise than with 0: the last line of what
 * it said. */
bool program_run(const char *const *arguments, const char *folder, const char *advice, Error *err);

/* Starts it with nothing to read and both outputs in the file `log`; without waiting. `keep` >= 0: in a process group of
 * its own, which no Ctrl-C reaches, with this file descriptor open: a lock lives as long as whoever has it. The errno of a
 * failure, or 0. */
int program_start(const char *const *arguments, const char *log, int keep, pid_t *process);

/* The last line of a file that is not blank; "" if there is none. */
void program_last_line(const char *path, char *line, int size);
