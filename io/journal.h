/* journal.h - NAME.run: everything that a running job has acknowledged, safe from a kill, a full disk or a power cut.
 *
 * A journal is a store of arrays, each under a kind, an index and a name. A unit (what one journal_put
 * brings) is acknowledged as soon as it is committed: after a kill at any moment the journal holds every
 * committed unit whole, and of the others nothing. Each array carries a CRC32 over its key, type, shape, unit
 * and bytes, checked whenever it is read, so that damage gives a sentence and never a wrong number.
 *
 * Kinds used by slender (index 0 where there is only one):
 *   meta        scene (text), versions (text), inputs (text: CRC32, length and key of each file of the scene)
 *   static      rest [n_v,3], faces [n_f,3], edges [n_e,2]; of curves lines [L,2]: first point, number of points
 *   frame       index n: x [n_v,3], time, turns, cell/<name> [n_f] or [n_f,3], point/<name>
 *   evaluation  index k: unknowns, gradient, and the scalars objective, gradient_norm, newton_iterations, seconds
 *   state       what the run needs to go on
 *   film        of a drawing (spline/film.h)
 *   final       arrays of the result, named by their path below /slender
 *   result      crc32: which result the frames of a finished simulation have gone to
 *
 * The file is an SQLite database (WAL, synchronous=FULL) on a local disk; while a run lives there are
 * NAME.run-wal and NAME.run-shm (SQLite's) and NAME.run-lock (the writer's lock) beside it. At its end the log
 * goes into the database. Readers make no files (journal_files.h). Numbers are kept bit for bit, as raw
 * little-endian bytes. One thread at a time may use a Journal.
 *
 * Damage to NAME.run-wal after a kill (bits flipped by the disk, or cut off) cannot always be told from a
 * commit that never happened: it takes away the last units, and never changes one. */
#pragma once
#include "base/error.h"
#include "io/array.h"

typedef struct Journal Journal;

typedef enum JournalMode {
    JOURNAL_NEW,    /* start a run; an unfinished run in the file is refused, a finished one is discarded  */
    JOURNAL_FORCE,  /* start a run; an unfinished one is discarded too (never one that is being written)  */
    JOURNAL_RESUME, /* go on with the run in the file, checked as a whole; refused if anything is damaged  */
    JOURNAL_READ,   /* see the run as it is now, even while its writer lives; no file is changed or made   */
} JournalMode;

/* Opens the journal; NULL and a sentence on refusal. A second writer is refused while the first one lives,
 * and a file that is no journal of slender is never touched. Without a path it is a new one in memory, for a run that
 * nobody will go on with: it makes no file, and is gone when it is closed. */
Journal *journal_open(const char *path, JournalMode mode, Error *err);

/* Commits what is left, gives the lock back and frees the journal in every case. False with a sentence if the
 * last units could not be committed; they are lost then. NULL is fine. */
bool journal_close(Journal *journal, Error *err);

/* Puts several arrays as one unit; an array already there under the same kind, index and name is replaced,
 * the others of that kind and index stay. The arrays are copied. A unit is committed at once if the last
 * commit is half a second ago or more; units that come faster are gathered. On false the unit is kept in
 * memory and goes with the next commit that succeeds; what was committed before stays. */
bool journal_put(Journal *journal, const char *kind, int index, const Array *arrays, int count, Error *err);

/* Puts them in the place of all that is under this kind, in one transaction: of an older state nothing stays. */
bool journal_replace(Journal *journal, const char *kind, int index, const Array *arrays, int count,
                     Error *err);

/* Commits what has been gathered: before a long computation, and where a unit must not be lost. After a
 * failure it may be tried again. */
bool journal_flush(Journal *journal, Error *err);

/* Reads one array, to be freed by array_clear. False and a sentence if it is not there or damaged. */
bool journal_get(Journal *journal, const char *kind, int index, const char *name, Array *array, Error *err);

/* The same where it may be missing, which is no error: the array's data is NULL then. */
bool journal_find(Journal *journal, const char *kind, int index, const char *name, Array *array, Error *err);

/* Is there such an array? False and a sentence where that cannot be told. */
bool journal_has(Journal *journal, const char *kind, int index, const char *name, bool *has, Error *err);

/* The indices of a kind, ascending, and the names under a kind and index, sorted. One block each, to be freed
 * by mem_free (the names lie in the same block). */
bool journal_indices(Journal *journal, const char *kind, int **indices, int *count, Error *err);
bool journal_names(Journal *journal, const char *kind, int index, char ***names, int *count, Error *err);

/* How many indices a kind has. */
bool journal_count(Journal *journal, const char *kind, int *count, Error *err);

/* Lets all of a kind go and gives its space back. */
bool journal_forget(Journal *journal, const char *kind, Error *err);

/* A finished run may be replaced by JOURNAL_NEW. A resumed run that goes on sets it back to false. */
bool journal_set_finished(Journal *journal, bool finished, Error *err);
bool journal_is_finished(Journal *journal);

/* Reads the whole file. False with a sentence that names the first damaged record, or says what else is
 * wrong; intact records can still be read. */
bool journal_check(Journal *journal, Error *err);

/* The linked library's version, e.g. "3.40.1". */
const char *journal_sqlite_version(void);
