/* memory.h - zeroed allocation that never returns NULL.
 *
 * Running out of memory prints one message and ends the program, with an exit code of its own. The number of live blocks is
 * counted, so that a test can show that everything was freed. */
#pragma once
#include <stdarg.h>
#include <stddef.h>

enum { MEM_EXIT_CODE = 5 };

/* Ends the program as an allocation here would; for libraries that say so: "the sparse factorisation". */
_Noreturn void mem_exhausted(const char *where);

/* count*size zeroed bytes, aligned to 64 (a cache line, and any vector). count may be 0. Thread-safe. */
void *mem_alloc(size_t count, size_t size);

/* Grows block from old_count to new_count elements; new ones are zero. block may be NULL. */
void *mem_resize(void *block, size_t old_count, size_t new_count, size_t size);

/* A copy of count*size bytes. */
void *mem_copy(const void *from, size_t count, size_t size);

/* A copy of the text, NULL for NULL. */
char *mem_text(const char *text);

/* Formats into a new text. */
char *mem_format(const char *format, ...) __attribute__((format(printf, 1, 2)));
char *mem_vformat(const char *format, va_list args) __attribute__((format(printf, 1, 0)));

/* One text of three; takes the first one over. */
char *mem_join(char *text, const char *second, const char *third);

/* Frees the block; NULL is fine. */
void mem_free(void *block);

/* Blocks allocated and not yet freed. */
long mem_live_count(void);

/* Blocks allocated so far: what is done in a loop should not need any. */
long mem_total_count(void);
