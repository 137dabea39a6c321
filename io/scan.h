/* scan.h - lines and words of a text file, with sentences that name the line. Private to the readers of io/.
 */
#pragma once
#include "base/error.h"
#include <stddef.h>

typedef struct Scan {
    const char *path;
    const char *next, *end; /* what is still to be read                                */
    const char *start;      /* of the current line                                     */
    const char *word_end;   /* end of the current line's content                       */
    const char *at;         /* where the next word of the line begins                  */
    int line, joined; /* number of the current line, from 1; 0 before the first; and how many joined it */
    char comment;     /* a word that begins with it, and what follows; 0: none   */
    const char *separators; /* beside blanks, what splits words; "" for none           */
    bool joins;             /* a backslash at a line's end joins it with the next      */
    Error *err;
} Scan;

typedef struct Word {
    const char *text;
    int length;
} Word;

/* A whole file in memory; *text is the caller's (mem_free). Refused: what cannot be read, more than 2 GiB. */
bool scan_file(const char *path, char **text, size_t *length, Error *err);

/* Past the byte order mark that a text may begin with: text and length are then what follows it. Returns
 * NULL, or the name of an encoding that is not read ("UTF-16"). */
const char *text_skip_mark(const char **text, size_t *length);

/* The same for a reader; false with a sentence where the text is not UTF-8. Every reader of text begins with
 * it. */
bool scan_skip_mark(const char *path, const char **text, size_t *length, Error *err);

Scan scan_start(const char *path, const char *text, size_t length, char comment, const char *separators,
                Error *err);

/* Refuses a NUL byte in what is still to be read: as the end of a C text it would cut a word in silence. */
bool scan_check_text(const Scan *scan);

/* The next line that has words on it; false at the end. */
bool scan_line(Scan *scan);

/* The next word of the line; false at its end. */
bool scan_word(Scan *scan, Word *word);

static inline bool scan_more(const Scan *scan)
{
    return scan->at < scan->word_end;
}

bool scan_is_blank(char c);

bool word_is(Word word, const char *text);
bool word_begins(Word word, const char *text); /* any case */

/* A word that is a whole number or a finite number, and nothing else. */
bool word_integer(Word word, long *value);
bool word_number(Word word, double *value);

/* "path:line: sentence"; returns false. */
bool scan_refuse(const Scan *scan, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same with the column of a place within the current line. */
bool scan_refuse_at(const Scan *scan, const char *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* What is left of the line as one word, blanks within it too; of no length at the line's end. */
Word scan_rest(Scan *scan);

/* Refuses what is left on the line after all that belongs there. */
bool scan_line_ends(Scan *scan);

/* The next word as a number; refused with what it should be ("a coordinate"). */
bool scan_number(Scan *scan, const char *what, double *value);
bool scan_integer(Scan *scan, const char *what, long low, long high, long *value);
