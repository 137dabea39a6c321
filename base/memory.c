#include "base/memory.h"
#include <assert.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Large blocks are made of huge pages where the system has them: what is read at random, or once from end to end, is
 * read half as fast again (a factor of 250 MB: 16.6 GB/s, not 10.2). */
enum { ALIGNMENT = 64, LARGE = 4 << 20 };

static atomic_long live, total;

static _Thread_local MemHook hook;

MemHook mem_set_hook(MemHook next)
{
    MemHook before = hook;
    hook = next;
    return before;
}

_Noreturn void mem_exhausted_again(const char *sentence)
{
    assert(hook.call && "out of memory in a thread without a hook");
    hook.call(hook.self, sentence);
    __builtin_trap(); /* a hook does not return */
}

_Noreturn void mem_exhausted(const char *where)
{
    char sentence[200];
    snprintf(sentence, sizeof sentence, "out of memory in %s", where);
    mem_exhausted_again(sentence);
}

static _Noreturn void out_of_memory(size_t count, size_t size)
{
    char sentence[200];
    snprintf(sentence, sizeof sentence, "out of memory: %zu blocks of %zu bytes were asked for", count, size);
    mem_exhausted_again(sentence);
}

/* The whole pages of a block. */
static void use_huge_pages(char *block, size_t bytes)
{
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), first = ((uintptr_t)block + page - 1) / page * page;
    madvise((void *)first, ((uintptr_t)block + bytes - first) / page * page, MADV_HUGEPAGE);
}

/* The system's pages are zero already, and calloc knows: a large block costs nothing until it is used. Where the block
 * of calloc begins stands before ours, for which there is room: its blocks are aligned to 16 at least. */
void *mem_alloc(size_t count, size_t size)
{
    if (size && count > SIZE_MAX / 2 / size) out_of_memory(count, size);
    size_t bytes = count * size + ALIGNMENT;
    char *raw = calloc(1, bytes);
    if (!raw) out_of_memory(count, size);
    if (bytes >= LARGE) use_huge_pages(raw, bytes);
    atomic_fetch_add(&live, 1);
    atomic_fetch_add(&total, 1);
    char *block = raw + ALIGNMENT - (uintptr_t)raw % ALIGNMENT;
    ((void **)block)[-1] = raw;
    return block;
}

void *mem_resize(void *block, size_t old_count, size_t new_count, size_t size)
{
    void *grown = mem_alloc(new_count, size);
    if (block) memcpy(grown, block, (old_count < new_count ? old_count : new_count) * size);
    mem_free(block);
    return grown;
}

void *mem_copy(const void *from, size_t count, size_t size)
{
    void *copy = mem_alloc(count, size);
    if (count && size) memcpy(copy, from, count * size);
    return copy;
}

char *mem_text(const char *text)
{
    return text ? mem_copy(text, strlen(text) + 1, 1) : NULL;
}

char *mem_vformat(const char *format, va_list args)
{
    va_list again;
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = mem_alloc((size_t)length + 1, 1);
    vsnprintf(text, (size_t)length + 1, format, args);
    return text;
}

char *mem_format(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = mem_vformat(format, args);
    va_end(args);
    return text;
}

char *mem_join(char *text, const char *second, const char *third)
{
    char *longer = mem_format("%s%s%s", text, second, third);
    mem_free(text);
    return longer;
}

void mem_free(void *block)
{
    if (!block) return;
    atomic_fetch_sub(&live, 1);
    free(((void **)block)[-1]);
}

long mem_live_count(void)
{
    return atomic_load(&live);
}

long mem_total_count(void)
{
    return atomic_load(&total);
}
