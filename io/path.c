#include "io/path.h"
#include "base/memory.h"
#include <stdbool.h>
#include <string.h>

char *path_base_name(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return mem_format("%.*s", (int)(dot && dot > name ? dot - name : (long)strlen(name)), name);
}

bool path_has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), size = strlen(ending);
    return length > size && !strcmp(path + length - size, ending);
}

char *path_without_ending(const char *path, const char *ending)
{
    size_t cut = path_has_ending(path, ending) ? strlen(ending) : 0;
    return mem_format("%.*s", (int)(strlen(path) - cut), path);
}

char *path_numbered(const char *path, int number)
{
    const char *dot = strrchr(path, '.');
    return mem_format("%.*s_%d%s", (int)(dot - path), path, number, dot);
}
