/* Part of every test: OpenBLAS works in one thread, as it does in the program, where nothing below cli/ sets it. */
#include "cli/kernels_start.h"

static __attribute__((constructor)) void begin(void)
{
    kernels_one_thread();
}
