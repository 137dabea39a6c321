#include "cli/kernels_start.h"
#include "solve/kernels.h"
#include <cblas.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/resource.h>
#include <unistd.h>

#define THREADS_KEY "OPENBLAS_NUM_THREADS"

static bool memory_is_limited(void)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/* Not where the loader was called as a program: /proc/self/exe is the loader then. */
static void start_again(char **argv)
{
    if (getauxval(AT_BASE)) execv("/proc/self/exe", argv);
}

void kernels_start(char **argv)
{
    const char *core = getenv(KERNELS_CORE_KEY) ? NULL : kernels_better(), *threads = getenv(THREADS_KEY);
    bool one = openblas_get_num_threads() == 1 || (threads && !strcmp(threads, "1"));
    if (core || (!one && memory_is_limited())) {
        char *before = threads ? strdup(threads) : NULL;
        if (core) setenv(KERNELS_CORE_KEY, core, 0);
        setenv(THREADS_KEY, "1", 1);
        start_again(argv);
        if (core) unsetenv(KERNELS_CORE_KEY);
        if (before) setenv(THREADS_KEY, before, 1);
        free(before);
    }
    kernels_one_thread();
}

void kernels_one_thread(void)
{
    openblas_set_num_threads(1);
}
