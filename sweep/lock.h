/* lock.h - one process at a time. A lock is a file that stays; it is held by whoever has it open, children that it was
 * given to, too, and is free again when the last of them is gone, however it went. Locks are those of the POSIX kind (of
 * open files), which file systems of clusters know. */
#pragma once
#include "base/error.h"

/* The file descriptor, to be closed; -1 with *held (another one has it), or with a sentence. */
int lock_take(const char *path, bool *held, Error *err);

/* Does somebody have it? Takes nothing. */
bool lock_is_held(const char *path);
