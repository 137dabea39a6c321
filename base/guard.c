#include "base/guard.h"
#include "base/memory.h"
#include <setjmp.h>

typedef struct Guard {
    jmp_buf entry;
    Error *err;
} Guard;

static void leave(void *self, const char *sentence)
{
    Guard *guard = self;
    error_set(guard->err, "%s", sentence);
    longjmp(guard->entry, 1);
}

bool guard_call(void (*work)(void *self), void *self, Error *err)
{
    Guard guard = {.err = err};
    const MemHook outer = mem_set_hook((MemHook){leave, &guard});
    if (setjmp(guard.entry) != 0) {
        mem_set_hook(outer);
        return false;
    }
    work(self);
    mem_set_hook(outer);
    return true;
}
