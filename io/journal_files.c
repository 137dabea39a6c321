#include "io/journal_files.h"
#include "base/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* The file's size; -1 where there is none. */
static long long size_of(const char *path, const char *ending)
{
    struct stat info;
    char *file = mem_format("%s%s", path, ending);
    long long size = stat(file, &info) == 0 ? (long long)info.st_size : -1;
    mem_free(file);
    return size;
}

bool journal_files_exist(const char *path)
{
    return size_of(path, "") > 0;
}

bool journal_files_lock(const char *path, int *lock, Error *err)
{
    char *file = mem_format("%s-lock", path);
    *lock = open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    int code = errno;
    mem_free(file);
    if (*lock < 0) return error_set(err, "%s-lock: cannot be written: %s", path, strerror(code));
    if (flock(*lock, LOCK_EX | LOCK_NB) == 0) return true;
    return error_set(
        err, "another run is writing %s at this moment; wait for it, or choose another name with -o", path);
}

static bool remove_file(const char *path, const char *ending, Error *err)
{
    char *file = mem_format("%s%s", path, ending);
    bool ok = unlink(file) == 0 || errno == ENOENT ||
              error_set(err, "%s: cannot be replaced: %s", file, strerror(errno));
    mem_free(file);
    return ok;
}

/* The database first: without it, what is left in the log means nothing. */
bool journal_files_remove(const char *path, Error *err)
{
    return remove_file(path, "", err) && remove_file(path, "-wal", err) && remove_file(path, "-shm", err);
}

/* Bytes 18 and 19 of a database are 2 where it has a log [sqlite.org/fileformat2.html, 1.3.3]. */
static bool says_log(const char *path)
{
    enum { VERSIONS = 18, LOG = 2 };
    unsigned char version[2] = {0};
    int file = open(path, O_RDONLY | O_CLOEXEC);
    bool log = file >= 0 && pread(file, version, 2, VERSIONS) == 2 && version[0] == LOG;
    if (file >= 0) close(file);
    return log;
}

JournalAccess journal_files_access(const char *path)
{
    long long log = size_of(path, "-wal");
    bool index = size_of(path, "-shm") >= 0;
    if (log < 0 || (log == 0 && !index)) return says_log(path) ? ACCESS_STILL : ACCESS_SHARED;
    return index ? ACCESS_SHARED : ACCESS_LOG;
}

char *journal_files_still_uri(const char *path)
{
    static const char before[] = "file:", after[] = "?immutable=1";
    char *uri = mem_alloc(sizeof before + 3 * strlen(path) + sizeof after, 1), *at = uri;
    at += sprintf(at, "%s", before);
    for (const char *c = path; *c; c++)
        at += sprintf(at, strchr("?#%", *c) ? "%%%02X" : "%c", (unsigned char)*c);
    sprintf(at, "%s", after);
    return uri;
}

long long journal_files_limit(void)
{
    struct rlimit size;
    if (getrlimit(RLIMIT_FSIZE, &size) != 0 || size.rlim_cur == RLIM_INFINITY) return -1;
    return (long long)size.rlim_cur;
}
