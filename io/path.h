/* path.h - names of files. */
#pragma once

/* "dir/name.ext" without its folder and ending; "dir/name.ext" without that ending, if it has it. The caller frees. */
char *path_base_name(const char *path);
char *path_without_ending(const char *path, const char *ending);
