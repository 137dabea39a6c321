#include "io/safe_file.h"
#include "base/memory.h"
#include "io/path.h"
#include "io/replace.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { TRAILER = 20 };

static const char MARK[8] = SAFE_FILE_MARK;

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

/* ---- The temporary file ----
 *
 * PATH.slender-XXXXXX with a random end, made anew: a link of that name is not followed. Its writer holds a lock on it
 * until it is renamed, so that one that can be locked belongs to a run that was killed. */

enum { RANDOM = 6 };

static const char MIDDLE[] = ".slender-";

/* An open file, locked; its name, which the caller frees. -1: errno says why. */
static int make_beside(const char *path, char **name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz012345";
    struct stat info;
    for (int attempt = 0; attempt < 100; attempt++) {
        unsigned char random[RANDOM];
        char end[RANDOM + 1] = "";
        if (getrandom(random, sizeof random, 0) != sizeof random) return -1;
        for (int k = 0; k < RANDOM; k++) end[k] = letters[random[k] % 32];
        *name = mem_format("%s%s%s", path, MIDDLE, end);
        int file = open(*name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (file >= 0) flock(file, LOCK_EX); /* some file systems cannot */
        if (file >= 0 && fstat(file, &info) == 0 && info.st_nlink > 0) return file;
        int code = errno;
        if (file >= 0) close(file); /* taken for a leftover before it was locked */
        mem_free(*name);
        *name = NULL;
        if (file < 0 && code != EEXIST) return errno = code, -1;
    }
    return -1;
}

/* A file of ours that nobody holds any more goes; it is held meanwhile. */
static void remove_left_over(int folder, const char *name)
{
    struct stat info;
    int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return;
    bool ours = fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid();
    if (ours && flock(file, LOCK_EX | LOCK_NB) == 0) unlinkat(folder, name, 0);
    close(file);
}

void safe_file_sweep(const char *path)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    char *folder = slash ? mem_format("%.*s", (int)(slash - path + 1), path) : mem_text(".");
    char *begin = mem_format("%s%s", base, MIDDLE);
    size_t length = strlen(begin);
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));)
        if (!strncmp(entry->d_name, begin, length) && strlen(entry->d_name) == length + RANDOM)
            remove_left_over(dirfd(entries), entry->d_name);
    if (entries) closedir(entries);
    mem_free(begin);
    mem_free(folder);
}

/* Writes, reads back and renames; on false errno says why, 0: what was written is not what is there. */
static bool write_and_rename(int file, const char *beside, const char *path, const void *bytes, size_t size)
{
    if (!write_all(file, bytes, size) || fsync(file) != 0) return false;
    if (!same_bytes(beside, bytes, size)) return errno = 0, false;
    return rename(beside, path) == 0 && sync_folder(path);
}

bool safe_file_write(const char *path, const void *bytes, size_t size, bool checked, Error *err)
{
    char *beside = NULL, *whole;
    if (!replace_check(path, err)) return false;
    safe_file_sweep(path);
    int file = make_beside(path, &beside);
    if (file < 0) return error_set(err, "%s: cannot be written: %s", path, strerror(errno));
    whole = mem_alloc(size + TRAILER, 1);
    memcpy(whole, bytes, size);
    if (checked) make_trailer(bytes, size, (unsigned char *)whole + size);
    bool ok = write_and_rename(file, beside, path, whole, size + (checked ? TRAILER : 0));
    int code = errno;
    if (!ok) unlink(beside);
    if (close(file) != 0 && ok) ok = false, code = errno;
    mem_free(whole);
    mem_free(beside);
    if (ok) return true;
    if (code == 0) return error_set(err, "%s: what was written does not read back as it was", path);
    return error_set(err, "%s: cannot be written: %s", path, strerror(code));
}

/* What it is instead, and what to do. */
static bool refuse_other(const char *path, const char *bytes, size_t size, Error *err)
{
    static const char database[] = "SQLite format 3";
    if (path_has_ending(path, ".yaml") || path_has_ending(path, ".yml"))
        return error_set(
            err, "%s is no result of slender, but a scene: slender run makes its result, NAME.vtkhdf", path);
    if (size >= sizeof database && !memcmp(bytes, database, sizeof database))
        return error_set(
            err, "%s is no result of slender, but a run's journal: slender export makes a result of it",
            path);
    return error_set(err,
                     "%s is no result of slender, or it has been cut off, or another program has opened it "
                     "for writing (h5py's 'r+'): open results with 'r'",
                     path);
}

bool safe_file_read(const char *path, void **bytes, size_t *size, Error *err)
{
    struct stat info;
    *bytes = NULL;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe would wait for its writer */
    bool known = file >= 0 && fstat(file, &info) == 0;
    if (!known || (!S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))) {
        error_set(err, "%s: cannot be read: %s", path,
                  known ? "it is no file, but a device or pipe" : strerror(errno));
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
        ok = refuse_other(path, all, total, err);
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
