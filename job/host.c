#include "job/host.h"
#include "base/memory.h"
#include <stdarg.h>

void host_step(const Host *host, int step, int total, const char *format, ...)
{
    if (!host->step) return;
    va_list args;
    va_start(args, format);
    char *detail = mem_vformat(format, args);
    va_end(args);
    host->step(host->self, step, total, detail);
    mem_free(detail);
}

static void tell(const Host *host, void (*to)(void *self, const char *sentence), const char *format,
                 va_list args)
{
    if (!to) return;
    char *sentence = mem_vformat(format, args);
    to(host->self, sentence);
    mem_free(sentence);
}

void host_say(const Host *host, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    tell(host, host->say, format, args);
    va_end(args);
}

void host_warn(const Host *host, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    tell(host, host->warn, format, args);
    va_end(args);
}

bool host_stops(const Host *host)
{
    return host->stop && host->stop(host->self);
}
