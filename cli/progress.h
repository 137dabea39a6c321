/* progress.h - the program as the host of a job (job/host.h): what a run says while it runs, and whether it has been
 * interrupted.
 *
 * On a terminal one line that changes; otherwise a line now and then; with JSON one object per line. Each says of how many
 * steps, and how long the others will take if they go on so. */
#pragma once
#include "job/host.h"
#include <stdbool.h>

typedef enum ProgressMode { PROGRESS_NORMAL, PROGRESS_QUIET, PROGRESS_JSON } ProgressMode;

typedef struct Progress {
    ProgressMode mode;
    bool terminal;
    double started, shown; /* s */
    int step;              /* the last one, 0: none yet        */
    double stepped, pace;  /* s: when it was; of the last ones */
} Progress;

/* Catches Ctrl-C and SIGTERM: the first one asks the run to save and stop, one that comes a second later or more ends the program.
 */
Progress progress_start(ProgressMode mode);

/* Steps are shown at most twice a second, the last one always. Borrows it. */
Host progress_host(Progress *progress);

/* With JSON an object {"error": ".."} or {"warning": ".."} beside the sentence that goes to the error stream. */
void progress_tell(ProgressMode mode, const char *kind, const char *sentence);
