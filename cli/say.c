#include "cli/say.h"
#include "base/memory.h"
#include "base/plain.h"
#include <stdarg.h>

void say(FILE *stream, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = mem_vformat(format, args), *plain = plain_text(text, "");
    va_end(args);
    fprintf(stream, "%s\n", plain);
    mem_free(text);
    mem_free(plain);
}

void say_lines(FILE *stream, const char *text)
{
    char *plain = plain_text(text, "\n\t");
    fputs(plain, stream);
    mem_free(plain);
}
