/* Another machine, preloaded: an OpenBLAS that does not know its processor and says "Prescott" until OPENBLAS_CORETYPE
 * tells it better, with KERNELS_DEAF even then; and as many processors as PROCESSORS says. */
#include <dlfcn.h>
#include <stdlib.h>
#include <unistd.h>

char *openblas_get_corename(void);
char *openblas_get_corename(void)
{
    static char prescott[] = "Prescott";
    char *told = getenv("OPENBLAS_CORETYPE");
    return told && !getenv("KERNELS_DEAF") ? told : prescott;
}

long sysconf(int name)
{
    const char *processors = getenv("PROCESSORS");
    if (processors && name == _SC_NPROCESSORS_ONLN) return atol(processors);
    return ((__typeof__(&sysconf))dlsym(RTLD_NEXT, "sysconf"))(name);
}
