/* Sources: ISO/IEC 15948 (PNG), 11.3.4.3: tEXt, with the keyword Software. */
#include "io/mark.h"
#include "base/memory.h"
#include "io/replace.h"
#include "io/safe_file.h"
#include <ctype.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>
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
    static const char said[] = MARK_PNG(SLENDER_VERSION);
    size_t length = sizeof said - 1;
    unsigned char *chunk = mem_alloc(length + 8, 1);
    put_big_endian(chunk, (uint32_t)(length - 4));
    memcpy(chunk + 4, said, length);
    put_big_endian(chunk + 4 + length, (uint32_t)crc32_z(0, (const unsigned char *)said, length));
    *size = length + 8;
    return chunk;
}

/* ---- Whose a file is ---- */

/* A kind of file, and its mark with * for the version. */
typedef struct Kind {
    const char *ending, *mark;
    size_t length;
} Kind;

#define KIND(ending, mark)                                                                                   \
    {                                                                                                        \
        ending, mark, sizeof(mark) - 1                                                                       \
    }

static const Kind kinds[] = {
    KIND(".png", MARK_PNG("*")),    KIND(".svg", MARK_SVG("*")),   KIND(".pdf", MARK_PDF("*")),
    KIND(".webp", MARK_WEBP("*")),  KIND(".html", MARK_HTML("*")), KIND(".htm", MARK_HTML("*")),
    KIND(".glb", MARK_GLB("*")),    KIND(".ply", MARK_PLY("*")),   KIND(".obj", MARK_OBJ("*")),
    KIND(".stl", MARK_STL("*")),    KIND(".3mf", MARK_ZIP("*")),   KIND(".npz", MARK_ZIP("*")),
    KIND(".vtkhdf", SAFE_FILE_MARK)};

/* NULL: of a kind that bears no mark. */
static const Kind *kind_of(const char *path)
{
    const char *ending = strrchr(path, '.');
    for (size_t k = 0; ending && k < sizeof kinds / sizeof *kinds; k++)
        if (!strcasecmp(ending, kinds[k].ending)) return &kinds[k];
    return NULL;
}

/* How long the X.Y.Z is that begins there; 0: there is none. */
static size_t version_length(const char *at, const char *end)
{
    const char *from = at;
    for (int part = 0; part < 3; part++) {
        if (part > 0 && (at == end || *at++ != '.')) return 0;
        const char *digits = at;
        while (at < end && isdigit((unsigned char)*at)) at++;
        if (at == digits) return 0;
    }
    return (size_t)(at - from);
}

/* Does the mark begin there, of whichever version? */
static bool is_mark(const Kind *kind, const char *at, const char *end)
{
    for (size_t k = 0; k < kind->length; k++) {
        size_t step = kind->mark[k] == '*' ? version_length(at, end) : at < end && *at == kind->mark[k];
        if (step == 0) return false;
        at += step;
    }
    return true;
}

static bool has_mark(const Kind *kind, const char *bytes, ssize_t count)
{
    for (ssize_t k = 0; k < count; k++)
        if (is_mark(kind, bytes + k, bytes + count)) return true;
    return false;
}

/* Is it, or is there nothing yet? */
static bool is_own(const Kind *kind, const char *path)
{
    struct stat info;
    char bytes[SEARCHED];
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return access(path, F_OK) != 0;
    bool own = fstat(file, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0 ||
               has_mark(kind, bytes, read(file, bytes, sizeof bytes)) ||
               (lseek(file, info.st_size > SEARCHED ? -SEARCHED : 0, SEEK_END) >= 0 &&
                has_mark(kind, bytes, read(file, bytes, sizeof bytes)));
    close(file);
    return own;
}

bool mark_is_foreign(const char *path)
{
    const Kind *kind = kind_of(path);
    return kind && !is_own(kind, path);
}

bool mark_check(const char *path, bool force, Error *err)
{
    if (!replace_check(path, err)) return false;
    return force || !mark_is_foreign(path) ||
           error_set(err,
                     "'%s' is there, and slender has not made it: give another name, or replace it with "
                     "--force",
                     path);
}
