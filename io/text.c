#include "io/text.h"
#include "base/memory.h"
#include "base/plain.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void reserve(Text *text, size_t more)
{
    if (text->length + more + 1 <= text->room) return;
    size_t room = 2 * (text->length + more + 1);
    text->text = mem_resize(text->text, text->room, room, 1);
    text->room = room;
}

void text_add(Text *text, const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int size = vsnprintf(NULL, 0, format, args);
    reserve(text, (size_t)size);
    vsnprintf(text->text + text->length, (size_t)size + 1, format, again);
    text->length += (size_t)size;
    va_end(args);
    va_end(again);
}

void text_indent(Text *text, int depth)
{
    text_add(text, "%*s", 2 * depth, "");
}

void text_add_xml(Text *text, const char *string)
{
    char *plain = plain_text(string, "");
    for (const char *c = plain; *c; c++)
        if (strchr("<&\"", *c))
            text_add(text, "&#%d;", *c);
        else
            text_add(text, "%c", *c);
    mem_free(plain);
}

void text_add_quoted(Text *text, const char *string)
{
    text_add(text, "\"");
    for (const char *c = string; *c; c++) {
        if (*c == '"' || *c == '\\')
            text_add(text, "\\%c", *c);
        else if (*c == '\n')
            text_add(text, "\\n");
        else if (*c == '\t')
            text_add(text, "\\t");
        else if ((unsigned char)*c < 0x20 || *c == 0x7f)
            text_add(text, "\\u%04x", (unsigned)*c);
        else
            text_add(text, "%c", *c);
    }
    text_add(text, "\"");
}
