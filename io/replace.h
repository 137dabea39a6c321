/* replace.h - may a file be written, and what would it replace? */
#pragma once
#include "base/error.h"

/* False and a sentence where there is something else than a file: a folder, or a device or pipe, which would
 * be gone; and where there is a journal, or a part of one. */
bool replace_check(const char *path, Error *err);

/* One file (through links, ./ and hard links), or one name in one folder where there is none yet. */
bool replace_is_same(const char *a, const char *b);

/* "a/b/" of "a/b/c", "." where there is none; the caller frees. */
char *replace_folder(const char *path);
