/* inputs.h - the files that a scene is made of, told by their contents: whichever keys its table has for
 * files.
 *
 * A run keeps their sums; one that is resumed must find the same contents, wherever they now lie. */
#pragma once
#include "base/error.h"
#include "model/scene.h"

/* A line for each file: its CRC32, its length in bytes, its key. NULL and a sentence where one cannot be
 * read; the caller frees. */
char *inputs_text(const Scene *scene, Error *err);

/* False and a sentence that names the first file that is not what it was when `before` was made. */
bool inputs_check(const Scene *scene, const char *before, const char *now, Error *err);

/* The keys, NULL-terminated, in one block with their texts; the caller frees. */
char **inputs_keys(const Scene *scene);
