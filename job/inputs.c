#include "job/inputs.h"
#include "base/memory.h"
#include "io/file_sum.h"
#include <string.h>

static const char NO_FILE[] = "- -"; /* in the place of the sum of a pipe */

typedef struct Lines {
    char *text;
    Error *err;
    bool failed;
} Lines;

static void add_line(void *self, const char *key, const char *path)
{
    Lines *lines = self;
    FileSum sum;
    if (lines->failed) return;
    lines->failed = !file_sum(path, &sum, lines->err);
    char *line = sum.bytes < 0 ? mem_format("%s %s\n", NO_FILE, key)
                               : mem_format("%08x %lld %s\n", sum.crc, sum.bytes, key);
    lines->text = mem_join(lines->text, line, "");
    mem_free(line);
}

char *inputs_text(const Scene *scene, Error *err)
{
    Lines lines = {.text = mem_text(""), .err = err};
    yaml_files(scene_table(), scene, add_line, &lines);
    if (!lines.failed) return lines.text;
    mem_free(lines.text);
    return NULL;
}

/* ---- Comparison ---- */

typedef struct Check {
    const char *before, *now;
    Error *err;
    bool failed;
} Check;

/* The line of a key, without its end; "" where there is none. */
static char *line_of(const char *text, const char *key)
{
    size_t tail = strlen(key);
    for (size_t length; *text; text += length + 1) {
        length = strcspn(text, "\n");
        bool found =
            length > tail && text[length - tail - 1] == ' ' && !strncmp(text + length - tail, key, tail);
        if (found) return mem_format("%.*s", (int)length, text);
    }
    return mem_text("");
}

static void check_line(void *self, const char *key, const char *path)
{
    Check *check = self;
    char *before = line_of(check->before, key), *now = line_of(check->now, key);
    bool same = !strcmp(before, now), told = strncmp(now, NO_FILE, strlen(NO_FILE)) != 0;
    mem_free(before);
    mem_free(now);
    if (check->failed || (same && told)) return;
    check->failed = true;
    error_set(
        check->err,
        told ? "%s: %s is not the file that the run began with; put that back, or start anew with --force"
             : "%s: %s is no regular file: whether it still gives what the run began with cannot be told; "
               "start anew with --force",
        key, path);
}

bool inputs_check(const Scene *scene, const char *before, const char *now, Error *err)
{
    Check check = {.before = before, .now = now, .err = err};
    yaml_files(scene_table(), scene, check_line, &check);
    return !check.failed;
}

/* ---- Keys ---- */

typedef struct Keys {
    size_t count, length;
    char **list, *text; /* where they go; NULL: they are counted */
} Keys;

static void add_key(void *self, const char *key, const char *path)
{
    (void)path;
    Keys *keys = self;
    size_t length = strlen(key) + 1;
    if (keys->list) keys->list[keys->count] = memcpy(keys->text + keys->length, key, length);
    keys->count++;
    keys->length += length;
}

char **inputs_keys(const Scene *scene)
{
    Keys keys = {0};
    yaml_files(scene_table(), scene, add_key, &keys);
    char **list = mem_alloc((keys.count + 1) * sizeof *list + keys.length, 1);
    Keys all = {.list = list, .text = (char *)(list + keys.count + 1)};
    yaml_files(scene_table(), scene, add_key, &all);
    return list;
}
