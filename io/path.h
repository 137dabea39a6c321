/* path.h - names of files. */
#pragma once
#include <stdbool.h>

/* "dir/name.ext" without its folder and ending; "dir/name.ext" without that ending, if it has it. The caller frees. */
char *path_base_name(const char *path);
char *path_without_ending(const char *path, const char *ending);

/* "dir/name_3.ext" of "dir/name.ext", which has an ending. The caller frees. */
char *path_numbered(const char *path, int number);

/* Does it have that ending, and something before it? */
bool path_has_ending(const char *path, const char *ending);
