#include "io/safe_file.h"
#include "base/memory.h"
#include "io/replace.h"
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { TRAILER = 20 };

static const char MARK[8] = "SLENDRCK";

static void make_trailer(const void *bytes, size_t size, unsigned char trailer[TRAILER])
{
    uint32_t crc = (uint32_t)crc32_z(0, bytes, size);
    memcpy(trailer, MARK, 8);
    for (int i = 0; i < 8; i++) trailer[8 + i] = (unsigned char)((uint64_t)size >> (8 * i));
    for (int i = 0; i < 4; i++) trailer[16 + i] = (unsigned char)(crc >> (8 * i));
}

static bool write_all(int file, const void *bytes, size_t size)
{
    const char *c = bytes;
    while (size > 0) {
        ssize_t done = write(file, c, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        c += done;
        size -= (size_t)done;
    }
    return true;
}

static bool read_all(int file, void *bytes, size_t size)
{
    char *c = bytes;
    while (size > 0) {
        ssize_t done = read(file, c, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        c += done;
        size -= (size_t)done;
    }
    return true;
}

/* What was written is what is there. */
static bool same_bytes(const char *path, const void *bytes, size_t size)
{
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    char *back = mem_alloc(size, 1), more;
    bool same = read_all(file, back, size) && !memcmp(back, bytes, size) && read(file, &more, 1) == 0;
    mem_free(back);
    close(file);
    return same;
}

/* The rename is on the disk only when the folder is. */
static bool sync_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? mem_format("%.*s", (int)(slash - path + 1), path) : mem_text(".");
    int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    mem_free(folder);
    if (file < 0) return false;
    bool ok = fsync(file) == 0 || errno == EINVAL; /* some file systems cannot */
    close(file);
    return ok;
}

static bool write_beside(const char *path, const void *bytes, size_t size)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) return false;
    bool ok = write_all(file, bytes, size) && fsync(file) == 0;
    int code = errno;
    if (close(file) != 0 && ok) return false;
    errno = code;
    return ok;
}

bool safe_file_write(const char *path, const void *bytes, size_t size, bool checked, Error *err)
{
    if (!replace_check(path, err)) return false;
    char *beside = mem_format("%s.%d.tmp", path, (int)getpid());
    char *whole = mem_alloc(size + TRAILER, 1);
    size_t total = size + (checked ? TRAILER : 0);
    memcpy(whole, bytes, size);
    if (checked) make_trailer(bytes, size, (unsigned char *)whole + size);
    bool ok = write_beside(beside, whole, total);
    if (!ok) {
        error_set(err, "%s: cannot be written: %s", path, strerror(errno));
    } else if (!same_bytes(beside, whole, total)) {
        ok = error_set(err, "%s: what was written does not read back as it was", path);
    } else if (rename(beside, path) != 0 || !sync_folder(path)) {
        ok = error_set(err, "%s: cannot be written: %s", path, strerror(errno));
    }
    if (!ok) unlink(beside);
    mem_free(whole);
    mem_free(beside);
    return ok;
}

bool safe_file_read(const char *path, void **bytes, size_t *size, Error *err)
{
    struct stat info;
    *bytes = NULL;
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0 || fstat(file, &info) != 0) {
        error_set(err, "%s: cannot be read: %s", path, strerror(errno));
        if (file >= 0) close(file);
        return false;
    }
    size_t total = (size_t)info.st_size;
    unsigned char trailer[TRAILER];
    char *all = mem_alloc(total, 1);
    bool ok = read_all(file, all, total);
    close(file);
    if (!ok) error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    if (ok && (total < TRAILER || memcmp(all + total - TRAILER, MARK, sizeof MARK)))
        ok = error_set(err, "%s is no result of slender, or it has been cut off", path);
    if (ok) {
        make_trailer(all, total - TRAILER, trailer);
        ok = !memcmp(trailer, all + total - TRAILER, TRAILER) ||
             error_set(err, "%s is damaged: its check sum is wrong", path);
    }
    if (!ok) {
        mem_free(all);
        return false;
    }
    *bytes = all;
    *size = total - TRAILER;
    return true;
}
