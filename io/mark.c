/* Sources: ISO/IEC 15948 (PNG), 11.3.4.3: tEXt, with the keyword Software. */
#include "io/mark.h"
#include "base/memory.h"
#include "io/path.h"
#include "io/replace.h"
#include <ctype.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { SEARCHED = 2048 }; /* bytes at either end */

static void put_big_endian(unsigned char *at, uint32_t number)
{
    for (int k = 0; k < 4; k++) at[k] = (unsigned char)(number >> (24 - 8 * k));
}

unsigned char *mark_png_chunk(size_t *size)
{
    static const char said[] = "tEXtSoftware\0" MARK_TEXT;
    size_t length = sizeof said - 1;
    unsigned char *chunk = mem_alloc(length + 8, 1);
    put_big_endian(chunk, (uint32_t)(length - 4));
    memcpy(chunk + 4, said, length);
    put_big_endian(chunk + 4 + length, (uint32_t)crc32_z(0, (const unsigned char *)said, length));
    *size = length + 8;
    return chunk;
}

/* The word and a number, whichever version it is; or the mark of a result. */
static bool has_mark(const char *bytes, ssize_t count)
{
    static const char word[] = "slender ", result[] = "SLENDRCK";
    const ssize_t length = sizeof word - 1;
    for (ssize_t k = 0; k + length < count; k++)
        if ((!memcmp(bytes + k, word, sizeof word - 1) && isdigit((unsigned char)bytes[k + length])) ||
            !memcmp(bytes + k, result, sizeof result - 1))
            return true;
    return false;
}

/* Is it, or can nothing be said against it? */
static bool is_own(const char *path)
{
    struct stat info;
    char bytes[SEARCHED];
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return true; /* writing says more */
    bool own = fstat(file, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0 ||
               has_mark(bytes, read(file, bytes, sizeof bytes)) ||
               (lseek(file, info.st_size > SEARCHED ? -SEARCHED : 0, SEEK_END) >= 0 &&
                has_mark(bytes, read(file, bytes, sizeof bytes)));
    close(file);
    return own;
}

bool mark_check(const char *path, bool force, Error *err)
{
    static const char *const bearing[] = {".png", ".svg", ".pdf", ".webp", ".html", ".htm",   ".glb",
                                          ".ply", ".obj", ".stl", ".3mf",  ".npz",  ".vtkhdf"};
    bool bears = false;
    for (size_t k = 0; k < sizeof bearing / sizeof *bearing; k++) bears |= path_has_ending(path, bearing[k]);
    if (!replace_check(path, err)) return false;
    return force || !bears || is_own(path) ||
           error_set(err,
                     "'%s' is there, and slender has not made it: give another name, or replace it with "
                     "--force",
                     path);
}
