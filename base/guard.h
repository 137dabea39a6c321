/* guard.h - work that ends with a sentence where memory is not there.
 *
 * For the entries of the library and for threads: all between guard_call and the allocation that failed is left by longjmp.
 * What it had allocated is lost, and the objects that it was changing are of no use any more, not even to be destroyed;
 * everything else stays as it was. Nobody below may hold a lock, or be called by a library that does, where it
 * allocates. */
#pragma once
#include "base/error.h"

/* Does work(self), with a hook of its own (base/memory.h) in this thread. False with a sentence where memory was not
 * there. Guards may be nested: the innermost one is left. */
bool guard_call(void (*work)(void *self), void *self, Error *err);
