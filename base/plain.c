#include "base/plain.h"
#include "base/memory.h"
#include <stdio.h>
#include <string.h>

enum { LONGEST = 8 }; /* bytes that one character becomes */

/* Bytes of the character that begins here and its number; 0: it is no UTF-8 (overlong and surrogates included). */
static int decode(const unsigned char *c, unsigned *code)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    int length = c[0] < 0x80 ? 1 : c[0] >> 5 == 6 ? 2 : c[0] >> 4 == 14 ? 3 : c[0] >> 3 == 30 ? 4 : 0;
    *code = length > 1 ? c[0] & (0xffu >> (length + 1)) : c[0];
    for (int k = 1; k < length; k++) {
        if (c[k] >> 6 != 2) return 0;
        *code = *code << 6 | (c[k] & 0x3fu);
    }
    bool sound = length && *code >= least[length] && *code <= 0x10ffff && *code >> 11 != 0x1b;
    return sound ? length : 0;
}

/* Controls of ASCII and Latin 1, separators of lines, and the marks that order or hide writing. */
static bool acts(unsigned code)
{
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || (code >= 0x200b && code <= 0x200f) ||
           (code >= 0x2028 && code <= 0x202e) || (code >= 0x2060 && code <= 0x2069) || code == 0xfeff ||
           code == 0xfffe || code == 0xffff;
}

/* One character at a time; `show` writes at most LONGEST bytes of it and says how many. length 0: a byte that is none. */
static char *convert(const char *text,
                     int (*show)(char *out, const char *c, int length, unsigned code, const char *kept),
                     const char *kept)
{
    char *shown = mem_alloc(LONGEST * strlen(text) + 1, 1), *out = shown;
    for (const char *c = text; *c;) {
        unsigned code;
        int length = decode((const unsigned char *)c, &code);
        out += show(out, c, length, code, kept);
        c += length ? length : 1;
    }
    return shown;
}

static int show_plain(char *out, const char *c, int length, unsigned code, const char *kept)
{
    if (!length || (code < 0x80 && acts(code) && !strchr(kept, *c)))
        return sprintf(out, "\\x%02x", (unsigned char)*c);
    if (code >= 0x80 && acts(code)) return sprintf(out, "\\u%04x", code);
    memcpy(out, c, (size_t)length);
    return length;
}

static int show_json(char *out, const char *c, int length, unsigned code, const char *kept)
{
    (void)kept;
    if (!length) return sprintf(out, "\\ufffd");
    if (code == '"' || code == '\\') return sprintf(out, "\\%c", *c);
    if (acts(code)) return sprintf(out, "\\u%04x", code);
    memcpy(out, c, (size_t)length);
    return length;
}

char *plain_text(const char *text, const char *kept)
{
    return convert(text, show_plain, kept);
}

char *plain_json(const char *text)
{
    return convert(text, show_json, "");
}

bool plain_is(const char *text)
{
    unsigned code;
    for (const char *c = text; *c;) {
        int length = decode((const unsigned char *)c, &code);
        if (!length || acts(code)) return false;
        c += length;
    }
    return true;
}
