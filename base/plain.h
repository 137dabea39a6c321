/* plain.h - words of users' files made fit to be shown: on a terminal, in JSON, in pictures and XML.
 *
 * What would do something instead of being seen is written out: control characters (which change titles, clear screens
 * or begin lines), marks that turn the direction of writing, and bytes that are no UTF-8. */
#pragma once
#include <stdbool.h>

/* The same text with "\x1b", "\u202e" or "\xff" for these; characters of `kept` ("\n\t", or "") stay. The caller frees. */
char *plain_text(const char *text, const char *kept);

/* Would it stay as it is? */
bool plain_is(const char *text);

/* The inside of a JSON string: escaped, and U+FFFD for bytes that are no UTF-8. The caller frees. */
char *plain_json(const char *text);
