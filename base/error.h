/* error.h - one sentence about bad input or a file that cannot be used.
 *
 * A function that can be refused its input takes an Error and returns false after filling it with ONE
 * sentence "file:line:column: what is wrong, what is allowed". Non-convergence is no error but a
 * result; a bug is an assert; memory that is not there is the thread's hook's to deal with (memory.h). */
#pragma once
#include <stdbool.h>

typedef struct Error {
    char text[1024];
} Error;

/* Writes the sentence and returns false, so that refusing is one line: return error_set(err, ...);
 * err may be NULL. */
bool error_set(Error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Puts "prefix: " before the sentence already there; returns false. */
bool error_prefix(Error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));
