/* text.h - a text that grows, for writers of files. */
#pragma once
#include <stddef.h>

typedef struct Text {
    char *text; /* owned; "" at least after the first add */
    size_t length, room;
} Text;

void text_add(Text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_indent(Text *text, int depth);

/* In XML, between tags or within quotes; as plain text (base/plain.h), since XML cannot say control characters. */
void text_add_xml(Text *text, const char *string);

/* In double quotes, with the escapes that YAML and JSON share. */
void text_add_quoted(Text *text, const char *string);
