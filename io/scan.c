#include "io/scan.h"
#include "base/memory.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const size_t MAX_BYTES = (size_t)2 << 30;

bool scan_file(const char *path, char **text, size_t *length, Error *err)
{
    FILE *file = fopen(path, "rb");
    *text = NULL;
    *length = 0;
    if (!file) return error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    size_t room = 0, got = 1;
    while (got > 0 && *length <= MAX_BYTES) {
        if (room - *length < 65536) {
            size_t larger = 2 * room + 65536;
            *text = mem_resize(*text, room, larger, 1);
            room = larger;
        }
        got = fread(*text + *length, 1, room - *length - 1, file);
        *length += got;
    }
    bool ok = !ferror(file) || error_set(err, "%s: cannot be read: %s", path, strerror(errno));
    if (ok && *length > MAX_BYTES) ok = error_set(err, "%s: the file is larger than 2 GiB", path);
    fclose(file);
    if (ok) return true;
    mem_free(*text);
    *text = NULL;
    return false;
}

static bool begins_with(const char *text, size_t length, const char *bytes, size_t count)
{
    return length >= count && !memcmp(text, bytes, count);
}

/* The marks of Unicode's section 23.8; without one, every other byte of UTF-16 is 0 where a text has Latin
 * letters. */
const char *text_skip_mark(const char **text, size_t *length)
{
    if (begins_with(*text, *length, "\xef\xbb\xbf", 3)) *text += 3, *length -= 3;
    if (begins_with(*text, *length, "\xff\xfe\0\0", 4) || begins_with(*text, *length, "\0\0", 2))
        return "UTF-32";
    bool marked = begins_with(*text, *length, "\xff\xfe", 2) || begins_with(*text, *length, "\xfe\xff", 2);
    return marked || (*length >= 2 && !(*text)[0] != !(*text)[1]) ? "UTF-16" : NULL;
}

bool scan_skip_mark(const char *path, const char **text, size_t *length, Error *err)
{
    const char *encoding = text_skip_mark(text, length);
    return !encoding || error_set(err, "%s: the file is %s text; save it as UTF-8", path, encoding);
}

Scan scan_start(const char *path, const char *text, size_t length, char comment, const char *separators,
                Error *err)
{
    return (Scan){.path = path,
                  .next = text,
                  .end = text + length,
                  .start = text,
                  .word_end = text,
                  .at = text,
                  .comment = comment,
                  .separators = separators,
                  .err = err};
}

bool scan_check_text(const Scan *scan)
{
    Scan at = *scan;
    const char *zero = at.next < at.end ? memchr(at.next, 0, (size_t)(at.end - at.next)) : NULL;
    if (!zero) return true;
    at.line += 1 + at.joined;
    for (at.start = at.next; (at.next = memchr(at.start, '\n', (size_t)(zero - at.start))); at.line++)
        at.start = at.next + 1;
    return scan_refuse_at(&at, zero, "a byte that is zero (NUL): no text has one; the file is damaged");
}

/* The end of the line that begins there: its newline, or the end of the text. */
static const char *line_end(const Scan *scan, const char *start)
{
    const char *newline = memchr(start, '\n', (size_t)(scan->end - start));
    return newline ? newline : scan->end;
}

/* A backslash that joins its line with the next. */
static bool is_join(const Scan *scan, const char *c)
{
    if (!scan->joins || *c != '\\') return false;
    c += 1 + (c + 1 < scan->end && c[1] == '\r');
    return c < scan->end && *c == '\n';
}

bool scan_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/* A newline is within a line that is joined with the next. */
static bool splits(const Scan *scan, const char *c)
{
    return scan_is_blank(*c) || *c == '\n' || (*c && strchr(scan->separators, *c)) || is_join(scan, c);
}

static void skip_blanks(Scan *scan)
{
    while (scan->at < scan->word_end && splits(scan, scan->at)) scan->at++;
}

/* Where the line's comment begins, or stop. Within a word its sign is a part of the word: 1.#QNAN. */
static const char *find_comment(const Scan *scan, const char *start, const char *stop)
{
    const char *c = start;
    while (scan->comment && (c = memchr(c, scan->comment, (size_t)(stop - c))) != NULL) {
        if (c == start || splits(scan, c - 1)) return c;
        c++;
    }
    return stop;
}

/* Takes the line at `next`, with those that it is joined with; a comment is not joined. */
static void take_line(Scan *scan)
{
    bool goes_on = true;
    const char *start = scan->next;
    scan->line += 1 + scan->joined;
    scan->start = scan->at = start;
    for (scan->joined = 0; goes_on; scan->joined += goes_on) {
        const char *stop = line_end(scan, start);
        scan->word_end = find_comment(scan, start, stop);
        const char *last = stop - (stop > start && stop[-1] == '\r') - 1;
        goes_on = scan->word_end == stop && last >= start && is_join(scan, last);
        scan->next = start = stop < scan->end ? stop + 1 : stop;
    }
    skip_blanks(scan);
}

bool scan_line(Scan *scan)
{
    while (scan->next < scan->end) {
        take_line(scan);
        if (scan_more(scan)) return true;
    }
    scan->start = scan->at = scan->word_end = scan->end;
    return false;
}

bool scan_word(Scan *scan, Word *word)
{
    if (!scan_more(scan)) return false;
    word->text = scan->at;
    while (scan->at < scan->word_end && !splits(scan, scan->at)) scan->at++;
    word->length = (int)(scan->at - word->text);
    skip_blanks(scan);
    return true;
}

Word scan_rest(Scan *scan)
{
    Word rest = {scan->at, 0}, word;
    while (scan_word(scan, &word)) rest.length = (int)(word.text + word.length - rest.text);
    return rest;
}

bool word_is(Word word, const char *text)
{
    return strlen(text) == (size_t)word.length && !strncmp(word.text, text, (size_t)word.length);
}

bool word_begins(Word word, const char *text)
{
    size_t length = strlen(text);
    return (size_t)word.length >= length && !strncasecmp(word.text, text, length);
}

enum { NUMBER_LENGTH = 63 };

/* The word as a C text; words longer than any number are none. */
static bool copy_word(Word word, char text[NUMBER_LENGTH + 1])
{
    if (word.length > NUMBER_LENGTH || word.length == 0) return false;
    memcpy(text, word.text, (size_t)word.length);
    text[word.length] = 0;
    return true;
}

bool word_integer(Word word, long *value)
{
    char text[NUMBER_LENGTH + 1], *end;
    if (!copy_word(word, text)) return false;
    errno = 0;
    *value = strtol(text, &end, 10);
    return end == text + word.length && errno == 0;
}

bool word_number(Word word, double *value)
{
    char text[NUMBER_LENGTH + 1], *end;
    if (!copy_word(word, text) || strpbrk(text, "xXnN")) return false;
    *value = strtod(text, &end);
    return end == text + word.length && isfinite(*value);
}

bool scan_refuse(const Scan *scan, const char *format, ...)
{
    char sentence[512];
    va_list args;
    va_start(args, format);
    vsnprintf(sentence, sizeof sentence, format, args);
    va_end(args);
    return error_set(scan->err, "%s:%d: %s", scan->path, scan->line, sentence);
}

bool scan_refuse_at(const Scan *scan, const char *at, const char *format, ...)
{
    char sentence[512];
    va_list args;
    va_start(args, format);
    vsnprintf(sentence, sizeof sentence, format, args);
    va_end(args);
    int line = scan->line, column = 1;
    for (const char *c = scan->start; c < at; c++) {
        column += ((unsigned char)*c & 0xc0) != 0x80; /* characters, not bytes */
        if (*c == '\n') line++, column = 1;
    }
    return error_set(scan->err, "%s:%d:%d: %s", scan->path, line, column, sentence);
}

static int shown(Word word)
{
    return word.length > 40 ? 40 : word.length;
}

bool scan_line_ends(Scan *scan)
{
    Word word;
    return !scan_word(scan, &word) ||
           scan_refuse_at(scan, word.text, "'%.*s' is more than belongs here", shown(word), word.text);
}

bool scan_number(Scan *scan, const char *what, double *value)
{
    Word word;
    if (!scan_word(scan, &word)) return scan_refuse(scan, "%s is missing", what);
    return word_number(word, value) ||
           scan_refuse_at(scan, word.text, "%s must be a finite number, not '%.*s'", what, shown(word),
                          word.text);
}

bool scan_integer(Scan *scan, const char *what, long low, long high, long *value)
{
    Word word;
    if (!scan_word(scan, &word)) return scan_refuse(scan, "%s is missing", what);
    if (!word_integer(word, value))
        return scan_refuse_at(scan, word.text, "%s must be a whole number, not '%.*s'", what, shown(word),
                              word.text);
    return (*value >= low && *value <= high) ||
           scan_refuse_at(scan, word.text, "%s is %ld; it must be from %ld to %ld", what, *value, low, high);
}
