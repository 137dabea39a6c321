#include "sweep/lock.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

int lock_take(const char *path, bool *held, Error *err)
{
    struct flock all = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    *held = false;
    if (file >= 0 && fcntl(file, F_OFD_SETLK, &all) == 0) return file;
    int code = errno;
    *held = file >= 0 && (code == EAGAIN || code == EACCES);
    if (file >= 0) close(file);
    if (!*held) error_set(err, "%s: cannot be locked: %s", path, strerror(code));
    return -1;
}

bool lock_is_held(const char *path)
{
    struct flock all = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    int file = open(path, O_RDWR | O_CLOEXEC);
    bool held = file >= 0 && fcntl(file, F_OFD_GETLK, &all) == 0 && all.l_type != F_UNLCK;
    if (file >= 0) close(file);
    return held;
}
