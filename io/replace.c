#include "io/replace.h"
#include "base/memory.h"
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_one_place(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

char *replace_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? mem_format("%.*s/", (int)(slash - path), path) : mem_text(".");
}

bool replace_is_same(const char *a, const char *b)
{
    const char *slash_a = strrchr(a, '/'), *slash_b = strrchr(b, '/');
    if (is_one_place(a, b)) return true;
    if (strcmp(slash_a ? slash_a + 1 : a, slash_b ? slash_b + 1 : b)) return false;
    char *folder_a = replace_folder(a), *folder_b = replace_folder(b);
    bool same = is_one_place(folder_a, folder_b);
    mem_free(folder_a);
    mem_free(folder_b);
    return same;
}

/* By its first bytes, whatever it is called. */
static bool is_database(const char *path)
{
    static const char mark[16] = "SQLite format 3";
    char head[sizeof mark];
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    bool is = file >= 0 && read(file, head, sizeof head) == sizeof head && !memcmp(head, mark, sizeof mark);
    if (file >= 0) close(file);
    return is;
}

/* A database, or a file that stands beside one and is a part of it, there or not. */
static bool is_journal(const char *path)
{
    static const char *const endings[] = {"-wal", "-shm", "-journal", "-lock"};
    bool is = is_database(path);
    size_t length = strlen(path);
    for (size_t k = 0; !is && k < sizeof endings / sizeof *endings; k++) {
        size_t cut = strlen(endings[k]);
        if (length <= cut || strcmp(path + length - cut, endings[k])) continue;
        char *whole = mem_format("%.*s", (int)(length - cut), path);
        is = is_database(whole);
        mem_free(whole);
    }
    return is;
}

bool replace_check(const char *path, Error *err)
{
    struct stat info;
    if (!*path) return error_set(err, "a file that is to be written has no name");
    bool there = stat(path, &info) == 0;
    if (there && !S_ISREG(info.st_mode))
        return error_set(err, "'%s' cannot be written: it is %s", path,
                         S_ISDIR(info.st_mode) ? "a folder" : "no file, but a device or pipe");
    return !is_journal(path) ||
           error_set(err, "'%s' is not overwritten: it is a run's journal, or another database", path);
}
