/* say.h - lines with words of users' files in them, as plain text (base/plain.h): the way of the program to print. */
#pragma once
#include <stdio.h>

/* One line, its end added. */
void say(FILE *stream, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Lines as they are, with tabs: a report. */
void say_lines(FILE *stream, const char *text);
