/* record.h - a run from its journal's beginning to its result, for whoever runs jobs. */
#pragma once
#include "job/run.h"

typedef struct RecordDef {
    const Scene *scene;
    Model *model;
    const Host *host;
    const char *path; /* of the scene's file, which no output may replace; NULL: it has none */
    const char *name; /* of NAME.vtkhdf, NAME.run and the further files that the scene names */
    JournalMode
        journal;    /* JOURNAL_RESUME: only the keys that the job leaves free may have changed, and no file */
    bool in_memory; /* the journal, which then is lost with an interruption                */
    bool picture;   /* one is to be drawn of the result: can it be written?                */
    int threads;    /* 1 to 64 */
} RecordDef;

/* Begins the journal, or goes on with the run that it holds; runs the job, writes the result and the further files. On
 * RUN_REFUSED and RUN_CANNOT_WRITE err says why. *drawable: the result has something that a picture could show. */
RunStatus record_run(const RecordDef *def, bool *drawable, Error *err);

/* What there is under a name. */
typedef enum RecordState {
    RECORD_ABSENT,     /* nothing that one could go on with */
    RECORD_UNFINISHED, /* a journal of this scene           */
    RECORD_SHORT,      /* either one, of this scene but for its length, which is now more: --resume goes on */
    RECORD_FINISHED,   /* a result of this scene            */
    RECORD_OTHER,      /* what a run of this scene would not replace: err says why */
    RECORD_DAMAGED,    /* a result that cannot be read: it would not either         */
} RecordState;

/* Is it kept from a run of this scene? */
static inline bool record_is_kept(RecordState state)
{
    return state == RECORD_OTHER || state == RECORD_DAMAGED;
}

/* Files are not changed; the run may live. */
RecordState record_state(const Scene *scene, const char *name, Error *err);
