#include "io/path.h"
#include "base/memory.h"
#include <stdbool.h>
#include <string.h>

char *path_base_name(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return mem_format("%.*s", (int)(dot && dot > name ? dot - name : (long)strlen(name)), name);
}

char *path_without_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), cut = strlen(ending);
    bool has = length > cut && !strcmp(path + length - cut, ending);
    return mem_format("%.*s", (int)(has ? length - cut : length), path);
}
