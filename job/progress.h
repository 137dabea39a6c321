/* progress.h - what a run says while it runs, and whether it has been interrupted.
 *
 * On a terminal one line that changes; otherwise a line now and then; with JSON one object per line. */
#pragma once
#include <stdbool.h>

typedef enum ProgressMode { PROGRESS_NORMAL, PROGRESS_QUIET, PROGRESS_JSON } ProgressMode;

typedef struct Progress {
    ProgressMode mode;
    bool terminal;
    double started, shown; /* s */
} Progress;

/* Catches Ctrl-C and SIGTERM: the first one asks the run to save and stop, the second one ends the program.
 */
Progress progress_start(ProgressMode mode);

/* Has the user asked to stop? */
bool progress_interrupted(void);

/* A step of `total` is done; `detail` says what it brought ("F 0.02 F0"). Shown at most twice a second, the
 * last one always. */
void progress_step(Progress *progress, int step, int total, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* With JSON an object {"error": ".."} or {"warning": ".."} beside the sentence that goes to the error stream. */
void progress_tell(ProgressMode mode, const char *kind, const char *sentence);

/* A line that stays. */
void progress_say(Progress *progress, const char *format, ...) __attribute__((format(printf, 2, 3)));
