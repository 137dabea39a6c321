/* Units wait in memory until their commit succeeds, so that a disk that was full for a while costs nothing.
 * The only file that includes sqlite3.h. */
#include "io/journal.h"
#include "base/clock.h"
#include "base/memory.h"
#include "io/journal_files.h"
#include "io/waiting.h"
#include <sqlite3.h>
#include <string.h>
#include <unistd.h>

enum { APPLICATION_ID = 0x534c4e44 /* "SLND" */, FORMAT_VERSION = 1, BUSY_MS = 5000 };

static const double COMMIT_INTERVAL = 0.5; /* s */

struct Journal {
    char *path; /* in sentences, too */
    sqlite3 *db;
    int lock; /* file descriptor, -1 for readers */
    bool in_memory, reader;
    double committed; /* when */
    Waiting waiting;
    bool finished; /* as it should be, and as it is in the file */
    bool finished_dirty;
};

/* ---- SQLite ---- */

static bool sql_error(const Journal *journal, const char *what, Error *err)
{
    int code = sqlite3_extended_errcode(journal->db) & 0xff;
    if (code == SQLITE_NOMEM) mem_exhausted("SQLite");
    if (code == SQLITE_NOTADB)
        return error_set(err, "%s is not a journal of slender; it has not been touched", journal->path);
    if (code == SQLITE_CORRUPT)
        return error_set(err, "%s is damaged: %s", journal->path, sqlite3_errmsg(journal->db));
    long long limit = code == SQLITE_IOERR ? journal_files_limit() : -1;
    if (limit >= 0)
        return error_set(err, "%s: cannot be %s: files may have at most %lld bytes here (ulimit -f)",
                         journal->path, what, limit);
    return error_set(err, "%s: cannot be %s: %s", journal->path, what, sqlite3_errmsg(journal->db));
}

static bool execute(Journal *journal, const char *sql, const char *what, Error *err)
{
    return sqlite3_exec(journal->db, sql, NULL, NULL, NULL) == SQLITE_OK || sql_error(journal, what, err);
}

static sqlite3_stmt *prepare(Journal *journal, const char *sql, Error *err)
{
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(journal->db, sql, -1, &statement, NULL) == SQLITE_OK) return statement;
    sql_error(journal, "read", err);
    return NULL;
}

/* A single number; `absent` where there is no row. False where it cannot be read. */
static bool query_number(Journal *journal, const char *sql, const char *text, long absent, long *value,
                         Error *err)
{
    sqlite3_stmt *statement = prepare(journal, sql, err);
    if (!statement) return false;
    if (text) sqlite3_bind_text(statement, 1, text, -1, SQLITE_STATIC);
    int code = sqlite3_step(statement);
    bool row = code == SQLITE_ROW && sqlite3_column_type(statement, 0) != SQLITE_NULL;
    *value = row ? (long)sqlite3_column_int64(statement, 0) : absent;
    bool ok = code == SQLITE_ROW || code == SQLITE_DONE || sql_error(journal, "read", err);
    sqlite3_finalize(statement);
    return ok;
}

/* ---- Opening ---- */

static bool open_database(Journal *journal, const char *name, int flags, const char *vfs, Error *err)
{
    if (sqlite3_open_v2(name, &journal->db, flags, vfs) != SQLITE_OK)
        return sql_error(journal, "opened", err);
    sqlite3_busy_timeout(journal->db, BUSY_MS);
    return true;
}

static bool open_to_write(Journal *journal, int flags, Error *err)
{
    const char *name = journal->in_memory ? ":memory:" : journal->path;
    return open_database(journal, name, SQLITE_OPEN_READWRITE | flags, NULL, err);
}

/* SQLite would make an index for a log that has none; with exclusive access and no locks it makes it in
 * memory, and closing must not bring the log into the database. */
static bool open_log(Journal *journal, Error *err)
{
    return open_database(journal, journal->path, SQLITE_OPEN_READONLY, "unix-none", err) &&
           sqlite3_db_config(journal->db, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, NULL) == SQLITE_OK &&
           execute(journal, "PRAGMA locking_mode=EXCLUSIVE", "read", err);
}

static bool open_to_read(Journal *journal, Error *err)
{
    JournalAccess access = journal_files_access(journal->path);
    if (access == ACCESS_LOG) return open_log(journal, err);
    bool still = access != ACCESS_SHARED;
    char *name = still ? journal_files_still_uri(journal->path) : mem_text(journal->path);
    bool ok = open_database(journal, name, SQLITE_OPEN_READONLY | (still ? SQLITE_OPEN_URI : 0), NULL, err);
    mem_free(name);
    return ok;
}

static void close_database(Journal *journal)
{
    sqlite3_close(journal->db);
    journal->db = NULL;
}

/* Is it ours, and of this version? One that nothing was ever committed to, on a full disk, is an empty database. */
static bool check_identity(Journal *journal, Error *err)
{
    long id, version, objects;
    if (!query_number(journal, "PRAGMA application_id", NULL, 0, &id, err) ||
        !query_number(journal, "SELECT count(*) FROM sqlite_master", NULL, 0, &objects, err))
        return false;
    if (id == 0 && objects == 0)
        return error_set(err, "%s is incomplete: its run ended before anything was saved; begin it anew",
                         journal->path);
    if (id != APPLICATION_ID)
        return error_set(err, "%s is not a journal of slender; it has not been touched", journal->path);
    if (!query_number(journal, "PRAGMA user_version", NULL, 0, &version, err)) return false;
    return version == FORMAT_VERSION ||
           error_set(err, "%s is of version %ld of the journal, and this program reads version %d",
                     journal->path, version, FORMAT_VERSION);
}

static bool read_finished(Journal *journal, Error *err)
{
    long finished;
    if (!query_number(journal, "SELECT finished FROM run", NULL, 0, &finished, err)) return false;
    journal->finished = finished != 0;
    return true;
}

/* The tables, in one transaction: until its commit the file is empty. */
static bool create_tables(Journal *journal, Error *err)
{
    const char *all =
        "BEGIN; PRAGMA application_id=%d; PRAGMA user_version=%d; CREATE TABLE run(finished INTEGER "
        "NOT NULL); INSERT INTO run VALUES(0); CREATE TABLE arrays(kind TEXT NOT NULL, idx INTEGER NOT NULL, "
        "name TEXT NOT NULL, unit TEXT NOT NULL, type INTEGER NOT NULL, rank INTEGER NOT NULL, d0 INTEGER, "
        "d1 INTEGER, d2 INTEGER, crc INTEGER NOT NULL, bytes BLOB NOT NULL, PRIMARY KEY(kind, idx, name)); "
        "COMMIT;";
    char sql[1024];
    sqlite3_snprintf(sizeof sql, sql, all, APPLICATION_ID, FORMAT_VERSION);
    return execute(journal, sql, "written", err);
}

/* What is in the file may go: it is ours, and finished or empty or no longer wanted. */
static bool may_discard(Journal *journal, JournalMode mode, Error *err)
{
    long arrays = 0, objects = 0;
    bool ok = open_to_write(journal, 0, err);
    ok = ok && query_number(journal, "SELECT count(*) FROM sqlite_master", NULL, 0, &objects, err);
    if (ok && objects > 0) {
        ok = check_identity(journal, err) && read_finished(journal, err) &&
             query_number(journal, "SELECT count(*) FROM arrays", NULL, 0, &arrays, err);
        if (ok && mode == JOURNAL_NEW && !journal->finished && arrays > 0)
            ok = error_set(
                err, "%s holds an unfinished run: go on with it with --resume, or discard it with --force",
                journal->path);
    }
    close_database(journal);
    journal->finished = false;
    return ok;
}

static bool open_new(Journal *journal, JournalMode mode, Error *err)
{
    if (!journal->in_memory && journal_files_exist(journal->path) &&
        (!may_discard(journal, mode, err) || !journal_files_remove(journal->path, err)))
        return false;
    return open_to_write(journal, SQLITE_OPEN_CREATE, err) &&
           execute(journal, "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;", "written", err) &&
           create_tables(journal, err);
}

static bool open_old(Journal *journal, Error *err)
{
    if (journal->in_memory || access(journal->path, F_OK) != 0)
        return error_set(err, "%s: there is no such run", journal->path);
    if (!(journal->reader ? open_to_read(journal, err) : open_to_write(journal, 0, err)) ||
        !check_identity(journal, err) || !read_finished(journal, err))
        return false;
    return journal->reader ||
           (execute(journal, "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;", "written", err) &&
            journal_check(journal, err));
}

static void destroy(Journal *journal)
{
    close_database(journal);
    if (journal->lock >= 0) close(journal->lock);
    waiting_clear(&journal->waiting);
    mem_free(journal->path);
    mem_free(journal);
}

Journal *journal_open(const char *path, JournalMode mode, Error *err)
{
    Journal *journal = mem_alloc(1, sizeof *journal);
    *journal = (Journal){.path = mem_text(path ? path : "the journal in memory"),
                         .in_memory = path == NULL,
                         .lock = -1,
                         .reader = mode == JOURNAL_READ,
                         .committed = clock_seconds()};
    bool old = mode == JOURNAL_READ || mode == JOURNAL_RESUME;
    bool ok = (journal->reader || journal->in_memory || journal_files_lock(path, &journal->lock, err)) &&
              (old ? open_old(journal, err) : open_new(journal, mode, err));
    if (ok) return journal;
    destroy(journal);
    return NULL;
}

bool journal_close(Journal *journal, Error *err)
{
    if (!journal) return true;
    bool ok = journal->reader || journal_flush(journal, err);
    destroy(journal);
    return ok;
}

/* ---- Writing ---- */

static bool insert(Journal *journal, sqlite3_stmt *statement, const Pending *pending, Error *err)
{
    const Array *array = &pending->array;
    sqlite3_reset(statement);
    sqlite3_bind_text(statement, 1, pending->kind, -1, SQLITE_STATIC);
    sqlite3_bind_int(statement, 2, pending->index);
    sqlite3_bind_text(statement, 3, array->name, -1, SQLITE_STATIC);
    sqlite3_bind_text(statement, 4, array->unit, -1, SQLITE_STATIC);
    sqlite3_bind_int(statement, 5, (int)array->type);
    sqlite3_bind_int(statement, 6, array->rank);
    for (int r = 0; r < ARRAY_MAX_RANK; r++)
        sqlite3_bind_int(statement, 7 + r, r < array->rank ? array->dims[r] : 0);
    sqlite3_bind_int64(statement, 10, array_crc(array, pending->kind, pending->index));
    sqlite3_bind_blob64(statement, 11, array->data, array_bytes(array), SQLITE_STATIC);
    return sqlite3_step(statement) == SQLITE_DONE || sql_error(journal, "written", err);
}

static bool delete_kind(Journal *journal, const char *kind, Error *err)
{
    sqlite3_stmt *row = prepare(journal, "DELETE FROM arrays WHERE kind=?", err);
    if (!row) return false;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
    bool ok = sqlite3_step(row) == SQLITE_DONE || sql_error(journal, "written", err);
    sqlite3_finalize(row);
    return ok;
}

static bool insert_all(Journal *journal, Error *err)
{
    sqlite3_stmt *statement =
        prepare(journal, "INSERT OR REPLACE INTO arrays VALUES(?,?,?,?,?,?,?,?,?,?,?)", err);
    bool ok = statement != NULL;
    for (size_t k = 0; ok && k < journal->waiting.count; k++) {
        const Pending *pending = &journal->waiting.items[k];
        ok = pending->array.name ? insert(journal, statement, pending, err)
                                 : delete_kind(journal, pending->kind, err);
    }
    sqlite3_finalize(statement);
    if (!ok || !journal->finished_dirty) return ok;
    return execute(journal, journal->finished ? "UPDATE run SET finished=1" : "UPDATE run SET finished=0",
                   "written", err);
}

bool journal_flush(Journal *journal, Error *err)
{
    if (!journal->waiting.count && !journal->finished_dirty) return true;
    bool ok = execute(journal, "BEGIN IMMEDIATE", "written", err) && insert_all(journal, err) &&
              execute(journal, "COMMIT", "written", err);
    if (!ok) {
        if (!sqlite3_get_autocommit(journal->db)) sqlite3_exec(journal->db, "ROLLBACK", NULL, NULL, NULL);
        return false;
    }
    waiting_clear(&journal->waiting);
    journal->finished_dirty = false;
    journal->committed = clock_seconds();
    return true;
}

bool journal_replace(Journal *journal, const char *kind, int index, const Array *arrays, int count,
                     Error *err)
{
    waiting_push_end(&journal->waiting, kind);
    return journal_put(journal, kind, index, arrays, count, err);
}

bool journal_put(Journal *journal, const char *kind, int index, const Array *arrays, int count, Error *err)
{
    for (int k = 0; k < count; k++) waiting_push(&journal->waiting, kind, index, &arrays[k]);
    return clock_seconds() - journal->committed < COMMIT_INTERVAL || journal_flush(journal, err);
}

bool journal_set_finished(Journal *journal, bool finished, Error *err)
{
    journal->finished = finished;
    journal->finished_dirty = true;
    return journal_flush(journal, err);
}

bool journal_is_finished(Journal *journal)
{
    return journal->finished;
}

/* ---- Reading ---- */

/* Readers see what is committed; the writer commits first. */
static bool settle(Journal *journal, Error *err)
{
    return journal->reader || journal_flush(journal, err);
}

/* The array in the columns name, unit, type, rank, d0, d1, d2, crc, bytes of a row. */
static bool take_row(sqlite3_stmt *row, const char *kind, int index, Array *array)
{
    const char *name = (const char *)sqlite3_column_text(row, 0),
               *unit = (const char *)sqlite3_column_text(row, 1);
    *array = (Array){.name = name ? name : "",
                     .unit = unit ? unit : "",
                     .type = (ArrayType)sqlite3_column_int(row, 2),
                     .rank = sqlite3_column_int(row, 3)};
    for (int r = 0; r < ARRAY_MAX_RANK; r++) array->dims[r] = sqlite3_column_int(row, 4 + r);
    size_t bytes = (size_t)sqlite3_column_bytes(row, 8);
    array->data = sqlite3_column_blob(row, 8);
    return array_own(array, bytes, kind, index, (uint32_t)sqlite3_column_int64(row, 7));
}

static bool damaged(const Journal *journal, const char *kind, int index, const char *name, Error *err)
{
    return error_set(err, "%s is damaged: %s %d, %s is not as it was written", journal->path, kind, index,
                     name);
}

/* Rows of a kind, or of it and an index, or the one of that name too, as the text has room for them; the
 * caller finalizes. NULL where the journal cannot be read. */
static sqlite3_stmt *select_rows(Journal *journal, const char *sql, const char *kind, int index,
                                 const char *name, Error *err)
{
    sqlite3_stmt *row = settle(journal, err) ? prepare(journal, sql, err) : NULL;
    if (!row) return NULL;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
    sqlite3_bind_int(row, 2, index);
    sqlite3_bind_text(row, 3, name, -1, SQLITE_STATIC);
    return row;
}

bool journal_find(Journal *journal, const char *kind, int index, const char *name, Array *array, Error *err)
{
    *array = (Array){0};
    sqlite3_stmt *row = select_rows(
        journal,
        "SELECT name, unit, type, rank, d0, d1, d2, crc, bytes FROM arrays WHERE kind=? AND idx=? AND name=?",
        kind, index, name, err);
    if (!row) return false;
    int code = sqlite3_step(row);
    bool ok = code == SQLITE_DONE;
    if (code == SQLITE_ROW) {
        ok = take_row(row, kind, index, array);
        if (!ok) *array = (Array){0}, damaged(journal, kind, index, name, err);
    } else if (!ok) {
        sql_error(journal, "read", err);
    }
    sqlite3_finalize(row);
    return ok;
}

bool journal_get(Journal *journal, const char *kind, int index, const char *name, Array *array, Error *err)
{
    return journal_find(journal, kind, index, name, array, err) &&
           (array->data || error_set(err, "%s has no %s %d, %s", journal->path, kind, index, name));
}

bool journal_has(Journal *journal, const char *kind, int index, const char *name, bool *has, Error *err)
{
    sqlite3_stmt *row = select_rows(journal, "SELECT 1 FROM arrays WHERE kind=? AND idx=? AND name=?", kind,
                                    index, name, err);
    if (!row) return false;
    int code = sqlite3_step(row);
    *has = code == SQLITE_ROW;
    bool ok = *has || code == SQLITE_DONE || sql_error(journal, "read", err);
    sqlite3_finalize(row);
    return ok;
}

bool journal_indices(Journal *journal, const char *kind, int **indices, int *count, Error *err)
{
    *indices = NULL;
    *count = 0;
    sqlite3_stmt *row =
        select_rows(journal, "SELECT DISTINCT idx FROM arrays WHERE kind=? ORDER BY idx", kind, 0, NULL, err);
    if (!row) return false;
    size_t room = 0;
    int code;
    while ((code = sqlite3_step(row)) == SQLITE_ROW) {
        if ((size_t)*count == room) {
            *indices = mem_resize(*indices, room, 2 * room + 16, sizeof **indices);
            room = 2 * room + 16;
        }
        (*indices)[(*count)++] = sqlite3_column_int(row, 0);
    }
    bool ok = code == SQLITE_DONE || sql_error(journal, "read", err);
    sqlite3_finalize(row);
    if (!ok) mem_free(*indices), *indices = NULL;
    return ok;
}

bool journal_names(Journal *journal, const char *kind, int index, char ***names, int *count, Error *err)
{
    *names = NULL;
    *count = 0;
    sqlite3_stmt *row = select_rows(journal, "SELECT name FROM arrays WHERE kind=? AND idx=? ORDER BY name",
                                    kind, index, NULL, err);
    if (!row) return false;
    /* One pass, so that a writer cannot come between: all names in a row first, then the table of them. */
    char *all = NULL;
    size_t used = 0, room = 0;
    int code;
    while ((code = sqlite3_step(row)) == SQLITE_ROW) {
        size_t length = (size_t)sqlite3_column_bytes(row, 0) + 1;
        if (used + length > room) {
            size_t larger = 2 * room + length;
            all = mem_resize(all, room, larger, 1);
            room = larger;
        }
        memcpy(all + used, sqlite3_column_text(row, 0), length);
        used += length;
        (*count)++;
    }
    bool ok = code == SQLITE_DONE || sql_error(journal, "read", err);
    sqlite3_finalize(row);
    char **table = mem_alloc((size_t)*count * sizeof *table + used, 1), *text = (char *)(table + *count);
    if (used) memcpy(text, all, used);
    for (int k = 0; k < *count; k++, text += strlen(text) + 1) table[k] = text;
    mem_free(all);
    if (!ok) mem_free(table);
    *names = ok ? table : NULL;
    return ok;
}

bool journal_count(Journal *journal, const char *kind, int *count, Error *err)
{
    long found = 0;
    bool ok =
        settle(journal, err) &&
        query_number(journal, "SELECT count(DISTINCT idx) FROM arrays WHERE kind=?", kind, 0, &found, err);
    *count = (int)found;
    return ok;
}

bool journal_forget(Journal *journal, const char *kind, Error *err)
{
    return settle(journal, err) && delete_kind(journal, kind, err) &&
           execute(journal, "VACUUM", "written", err);
}

bool journal_check(Journal *journal, Error *err)
{
    if (!settle(journal, err)) return false;
    sqlite3_stmt *row = prepare(journal, "PRAGMA integrity_check(1)", err);
    if (!row) return false;
    bool ok = sqlite3_step(row) == SQLITE_ROW || sql_error(journal, "read", err);
    const char *said = ok ? (const char *)sqlite3_column_text(row, 0) : NULL;
    if (ok && (!said || strcmp(said, "ok")))
        ok = error_set(err, "%s is damaged: %.200s", journal->path, said ? said : "it cannot be read");
    sqlite3_finalize(row);
    if (!ok) return false;
    row = prepare(journal,
                  "SELECT name, unit, type, rank, d0, d1, d2, crc, bytes, kind, idx FROM arrays ORDER BY "
                  "kind, idx, name",
                  err);
    if (!row) return false;
    int code;
    while (ok && (code = sqlite3_step(row)) == SQLITE_ROW) {
        Array array;
        const char *kind = (const char *)sqlite3_column_text(row, 9),
                   *name = (const char *)sqlite3_column_text(row, 0);
        ok = take_row(row, kind ? kind : "", sqlite3_column_int(row, 10), &array);
        if (ok)
            array_clear(&array);
        else
            damaged(journal, kind ? kind : "?", sqlite3_column_int(row, 10), name ? name : "?", err);
    }
    if (ok && code != SQLITE_DONE) ok = sql_error(journal, "read", err);
    sqlite3_finalize(row);
    return ok;
}

const char *journal_sqlite_version(void)
{
    return sqlite3_libversion();
}
