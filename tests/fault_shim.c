/* A disk that fails: preloaded, it lets the FAULT_AT-th write, sync, truncation or rename of a regular file
 * fail, and all later ones too where FAULT_STAYS is set (a full disk). FAULT_LOG gets a line when it strikes.
 * The monotonic clock runs fast, a second with every look at it, so that the journal commits every unit. */
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

static atomic_long calls;

static bool strikes(const char *what)
{
    const char *at = getenv("FAULT_AT"), *log = getenv("FAULT_LOG");
    long number = atomic_fetch_add(&calls, 1) + 1, wanted = at ? atol(at) : 0;
    bool strike = wanted > 0 && (number == wanted || (number > wanted && getenv("FAULT_STAYS")));
    if (strike && log) {
        FILE *file = fopen(log, "a");
        if (file) fprintf(file, "%s\n", what), fclose(file);
    }
    return strike;
}

static bool is_file(int fd)
{
    struct stat info;
    return fd > 2 && fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void *bytes, size_t size)
{
    if (is_file(fd) && strikes("write")) return errno = ENOSPC, -1;
    return REAL(write)(fd, bytes, size);
}

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t at)
{
    if (is_file(fd) && strikes("pwrite")) return errno = ENOSPC, -1;
    return REAL(pwrite)(fd, bytes, size, at);
}

ssize_t pwrite64(int fd, const void *bytes, size_t size, off64_t at)
{
    if (is_file(fd) && strikes("pwrite64")) return errno = ENOSPC, -1;
    return REAL(pwrite64)(fd, bytes, size, at);
}

int fsync(int fd)
{
    if (strikes("fsync")) return errno = EIO, -1;
    return REAL(fsync)(fd);
}

int fdatasync(int fd)
{
    if (strikes("fdatasync")) return errno = EIO, -1;
    return REAL(fdatasync)(fd);
}

int ftruncate(int fd, off_t size)
{
    if (strikes("ftruncate")) return errno = ENOSPC, -1;
    return REAL(ftruncate)(fd, size);
}

int ftruncate64(int fd, off64_t size)
{
    if (strikes("ftruncate64")) return errno = ENOSPC, -1;
    return REAL(ftruncate64)(fd, size);
}

int rename(const char *from, const char *to)
{
    if (strikes("rename")) return errno = ENOSPC, -1;
    return REAL(rename)(from, to);
}

int clock_gettime(clockid_t id, struct timespec *now)
{
    static atomic_long looks;
    int result = REAL(clock_gettime)(id, now);
    if (id == CLOCK_MONOTONIC) now->tv_sec += atomic_fetch_add(&looks, 1);
    return result;
}
