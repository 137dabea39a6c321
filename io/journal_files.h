/* journal_files.h - the files of a journal: the database NAME.run, SQLite's log NAME.run-wal with its index
 * NAME.run-shm, and the writer's lock NAME.run-lock. Private to journal.c. */
#pragma once
#include "base/error.h"

/* Is there a database that is not empty? */
bool journal_files_exist(const char *path);

/* Takes the writer's lock, a file descriptor to be closed; the file stays, for to remove it would race with
 * the next writer. False with a sentence while another run has it. */
bool journal_files_lock(const char *path, int *lock, Error *err);

/* Removes the database and its log. */
bool journal_files_remove(const char *path, Error *err);

/* How a reader sees all that is committed without making a file beside the journal, which may be in a folder
 * that it can only read. */
typedef enum JournalAccess {
    ACCESS_SHARED, /* as SQLite does it by itself: no log, or a log with its index, perhaps of a living run */
    ACCESS_STILL,  /* the database says that it has a log, but there is none: it is all there is  */
    ACCESS_LOG, /* a log without its index: nobody writes; the index has to be made in memory             */
} JournalAccess;

JournalAccess journal_files_access(const char *path);

/* The path as a URI that says that nobody writes; the caller frees. */
char *journal_files_still_uri(const char *path);

/* The limit that a process has for the sizes of its files, bytes; -1: none. SQLite keeps to itself what the system
 * said of a write that failed. */
long long journal_files_limit(void);
