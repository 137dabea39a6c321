/* The library's calls, each within a guard: where memory is not there the call returns and says so. */
#include "slender.h"
#include "base/guard.h"
#include "base/memory.h"
#include "job/run.h"

const char *slender_version(void)
{
    return SLENDER_VERSION;
}

static void take_versions(void *self)
{
    *(char **)self = run_versions();
}

char *slender_versions(void)
{
    char *text = NULL;
    return guard_call(take_versions, &text, NULL) ? text : NULL;
}

void slender_free(char *text)
{
    mem_free(text);
}
