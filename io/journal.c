/* Units wait in memory until their commit succeeds, so that a disk that was full for a while costs nothing.
 * The only file that includes sqlite3.h. */
#include "io/journal.h"
#include "base/clock.h"
#include "base/memory.h"
#include "io/waiting.h"
#include <errno.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { APPLICATION_ID = 0x534c4e44 /* "SLND" */, FORMAT_VERSION = 1, BUSY_MS = 5000 };

static const double COMMIT_INTERVAL = 0.5; /* s */

struct Journal {
    char *path;
    sqlite3 *db;
    int lock; /* file descriptor, -1 for readers */
    bool reader;
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

static bool take_lock(Journal *journal, Error *err)
{
    char *path = mem_format("%s-lock", journal->path);
    journal->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    int code = errno;
    mem_free(path);
    if (journal->lock < 0)
        return error_set(err, "%s-lock: cannot be written: %s", journal->path, strerror(code));
    if (flock(journal->lock, LOCK_EX | LOCK_NB) == 0) return true;
    return error_set(err,
                     "another run is writing %s at this moment; wait for it, or choose another name with -o",
                     journal->path);
}

static bool exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && info.st_size > 0;
}

static bool open_database(Journal *journal, int flags, Error *err)
{
    if (sqlite3_open_v2(journal->path, &journal->db, flags, NULL) != SQLITE_OK)
        return sql_error(journal, "opened", err);
    sqlite3_busy_timeout(journal->db, BUSY_MS);
    return true;
}

static void close_database(Journal *journal)
{
    sqlite3_close(journal->db);
    journal->db = NULL;
}

/* Is it ours, and of this version? */
static bool check_identity(Journal *journal, Error *err)
{
    long id, version;
    if (!query_number(journal, "PRAGMA application_id", NULL, 0, &id, err)) return false;
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
    char sql[1024];
    sqlite3_snprintf(sizeof sql, sql,
                     "BEGIN; PRAGMA application_id=%d; PRAGMA user_version=%d;"
                     "CREATE TABLE run(finished INTEGER NOT NULL); INSERT INTO run VALUES(0);"
                     "CREATE TABLE arrays(kind TEXT NOT NULL, idx INTEGER NOT NULL, name TEXT NOT NULL, unit "
                     "TEXT NOT NULL,"
                     " type INTEGER NOT NULL, rank INTEGER NOT NULL, d0 INTEGER, d1 INTEGER, d2 INTEGER, crc "
                     "INTEGER NOT NULL,"
                     " bytes BLOB NOT NULL, PRIMARY KEY(kind, idx, name)); COMMIT;",
                     APPLICATION_ID, FORMAT_VERSION);
    return execute(journal, sql, "written", err);
}

static bool remove_file(const char *path, Error *err)
{
    return unlink(path) == 0 || errno == ENOENT ||
           error_set(err, "%s: cannot be replaced: %s", path, strerror(errno));
}

/* The database first: without it, what is left in the log means nothing. */
static bool discard(const Journal *journal, Error *err)
{
    char *wal = mem_format("%s-wal", journal->path), *shm = mem_format("%s-shm", journal->path);
    bool ok = remove_file(journal->path, err) && remove_file(wal, err) && remove_file(shm, err);
    mem_free(wal);
    mem_free(shm);
    return ok;
}

/* What is in the file may go: it is ours, and finished or empty or no longer wanted. */
static bool may_discard(Journal *journal, JournalMode mode, Error *err)
{
    long arrays = 0;
    bool ok = open_database(journal, SQLITE_OPEN_READWRITE, err);
    long objects = 0;
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
    if (exists(journal->path) && (!may_discard(journal, mode, err) || !discard(journal, err))) return false;
    return open_database(journal, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, err) &&
           execute(journal, "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;", "written", err) &&
           create_tables(journal, err);
}

static bool open_old(Journal *journal, JournalMode mode, Error *err)
{
    if (!exists(journal->path)) return error_set(err, "%s: there is no such run", journal->path);
    int flags = mode == JOURNAL_READ ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
    if (!open_database(journal, flags, err) || !check_identity(journal, err) || !read_finished(journal, err))
        return false;
    if (mode == JOURNAL_READ) return true;
    return execute(journal, "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;", "written", err) &&
           journal_check(journal, err);
}

static void destroy(Journal *journal)
{
    close_database(journal);
    if (journal->lock >= 0)
        close(journal->lock); /* the lock file stays: to remove it would race with the next writer */
    waiting_clear(&journal->waiting);
    mem_free(journal->path);
    mem_free(journal);
}

Journal *journal_open(const char *path, JournalMode mode, Error *err)
{
    Journal *journal = mem_alloc(1, sizeof *journal);
    journal->path = mem_text(path);
    journal->lock = -1;
    journal->reader = mode == JOURNAL_READ;
    journal->committed = clock_seconds();
    bool old = mode == JOURNAL_READ || mode == JOURNAL_RESUME;
    bool ok = (journal->reader || take_lock(journal, err)) &&
              (old ? open_old(journal, mode, err) : open_new(journal, mode, err));
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

static bool insert_all(Journal *journal, Error *err)
{
    sqlite3_stmt *statement =
        prepare(journal, "INSERT OR REPLACE INTO arrays VALUES(?,?,?,?,?,?,?,?,?,?,?)", err);
    bool ok = statement != NULL;
    for (size_t k = 0; ok && k < journal->waiting.count; k++)
        ok = insert(journal, statement, &journal->waiting.items[k], err);
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
    if (array->type > ARRAY_TEXT || array->rank < 0 || array->rank > ARRAY_MAX_RANK) return false;
    for (int r = 0; r < array->rank; r++) {
        array->dims[r] = sqlite3_column_int(row, 4 + r);
        if (array->dims[r] < 0) return false;
    }
    size_t bytes = (size_t)sqlite3_column_bytes(row, 8);
    array->data = sqlite3_column_blob(row, 8);
    if (bytes != array_bytes(array) ||
        array_crc(array, kind, index) != (uint32_t)sqlite3_column_int64(row, 7))
        return false;
    char *data = mem_alloc(bytes + 1, 1); /* a text ends with 0 */
    if (bytes) memcpy(data, array->data, bytes);
    array->name = mem_text(array->name);
    array->unit = mem_text(array->unit);
    array->data = data;
    return true;
}

static bool damaged(const Journal *journal, const char *kind, int index, const char *name, Error *err)
{
    return error_set(err, "%s is damaged: %s %d, %s is not as it was written", journal->path, kind, index,
                     name);
}

bool journal_get(Journal *journal, const char *kind, int index, const char *name, Array *array, Error *err)
{
    *array = (Array){0};
    if (!settle(journal, err)) return false;
    sqlite3_stmt *row = prepare(
        journal,
        "SELECT name, unit, type, rank, d0, d1, d2, crc, bytes FROM arrays WHERE kind=? AND idx=? AND name=?",
        err);
    if (!row) return false;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
    sqlite3_bind_int(row, 2, index);
    sqlite3_bind_text(row, 3, name, -1, SQLITE_STATIC);
    int code = sqlite3_step(row);
    bool ok = false;
    if (code == SQLITE_ROW) {
        ok = take_row(row, kind, index, array);
        if (!ok) *array = (Array){0}, damaged(journal, kind, index, name, err);
    } else if (code == SQLITE_DONE) {
        error_set(err, "%s has no %s %d, %s", journal->path, kind, index, name);
    } else {
        sql_error(journal, "read", err);
    }
    sqlite3_finalize(row);
    return ok;
}

bool journal_has(Journal *journal, const char *kind, int index, const char *name)
{
    sqlite3_stmt *row = settle(journal, NULL)
                            ? prepare(journal, "SELECT 1 FROM arrays WHERE kind=? AND idx=? AND name=?", NULL)
                            : NULL;
    if (!row) return false;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
    sqlite3_bind_int(row, 2, index);
    sqlite3_bind_text(row, 3, name, -1, SQLITE_STATIC);
    bool found = sqlite3_step(row) == SQLITE_ROW;
    sqlite3_finalize(row);
    return found;
}

bool journal_indices(Journal *journal, const char *kind, int **indices, int *count, Error *err)
{
    *indices = NULL;
    *count = 0;
    sqlite3_stmt *row =
        settle(journal, err)
            ? prepare(journal, "SELECT DISTINCT idx FROM arrays WHERE kind=? ORDER BY idx", err)
            : NULL;
    if (!row) return false;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
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
    if (ok) return true;
    mem_free(*indices);
    *indices = NULL;
    return false;
}

bool journal_names(Journal *journal, const char *kind, int index, char ***names, int *count, Error *err)
{
    *names = NULL;
    *count = 0;
    sqlite3_stmt *row =
        settle(journal, err)
            ? prepare(journal, "SELECT name FROM arrays WHERE kind=? AND idx=? ORDER BY name", err)
            : NULL;
    if (!row) return false;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
    sqlite3_bind_int(row, 2, index);
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
    *names = table;
    if (!ok) mem_free(table), *names = NULL;
    return ok;
}

int journal_count(Journal *journal, const char *kind)
{
    long count;
    bool ok =
        settle(journal, NULL) &&
        query_number(journal, "SELECT count(DISTINCT idx) FROM arrays WHERE kind=?", kind, 0, &count, NULL);
    return ok ? (int)count : -2;
}

bool journal_forget(Journal *journal, const char *kind, Error *err)
{
    sqlite3_stmt *row = settle(journal, err) ? prepare(journal, "DELETE FROM arrays WHERE kind=?", err) : NULL;
    if (!row) return false;
    sqlite3_bind_text(row, 1, kind, -1, SQLITE_STATIC);
    bool ok = sqlite3_step(row) == SQLITE_DONE || sql_error(journal, "written", err);
    sqlite3_finalize(row);
    return ok && execute(journal, "VACUUM", "written", err);
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
