#include "io/file_sum.h"
#include "base/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

static bool read_sum(int file, FileSum *sum)
{
    enum { CHUNK = 1 << 16 };
    unsigned char *bytes = mem_alloc(CHUNK, 1);
    ssize_t done;
    while ((done = read(file, bytes, CHUNK)) > 0 || (done < 0 && errno == EINTR)) {
        if (done < 0) continue;
        sum->crc = (uint32_t)crc32_z(sum->crc, bytes, (size_t)done);
        sum->bytes += done;
    }
    mem_free(bytes);
    return done == 0;
}

bool file_sum(const char *path, FileSum *sum, Error *err)
{
    struct stat info;
    *sum = (FileSum){0};
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) {
        sum->bytes = -1;
        return true;
    }
    int file = open(path, O_RDONLY | O_CLOEXEC);
    bool ok =
        (file >= 0 && read_sum(file, sum)) || error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    if (file >= 0) close(file);
    return ok;
}
