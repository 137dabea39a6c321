/* replace.h - may what is written beside a file be renamed over it? */
#pragma once
#include "base/error.h"

/* False and a sentence where there is something else than a file: a folder, or a device or pipe, which would
 * be gone. */
bool replace_check(const char *path, Error *err);
