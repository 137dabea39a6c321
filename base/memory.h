/* memory.h - zeroed allocation that never returns NULL.
 *
 * Where memory is not there, the thread's hook is called with a sentence, and does not return: that of the program ends it
 * with an exit code of its own (cli/main.c), that of the library leaves the call (base/guard.h), and a worker's leaves
 * the task, for the thread that waits for it to call its own (base/workers.h). The number of live blocks is counted, so
 * that a test can show that everything was freed. */
#pragma once
#include <stdarg.h>
#include <stddef.h>

/* What a thread does about memory that is not there: "out of memory in HDF5". Must not return. The sentence lies on the
 * stack that it leaves. */
typedef struct MemHook {
    void (*call)(void *self, const char *sentence);
    void *self;
} MemHook;

/* Sets the hook of the calling thread and returns the one before. A thread begins without: to run out of memory is a bug
 * then, an assert. */
MemHook mem_set_hook(MemHook hook);

/* Calls the hook as an allocation here would; for libraries that say so: "the sparse factorisation". */
_Noreturn void mem_exhausted(const char *where);

/* The same with a sentence that another thread's hook was called with. */
_Noreturn void mem_exhausted_again(const char *sentence);

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
