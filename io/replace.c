#include "io/replace.h"
#include <sys/stat.h>

bool replace_check(const char *path, Error *err)
{
    struct stat info;
    if (!*path) return error_set(err, "a file that is to be written has no name");
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode)) return true;
    return error_set(err, "'%s' cannot be written: it is %s", path,
                     S_ISDIR(info.st_mode) ? "a folder" : "no file, but a device or pipe");
}
