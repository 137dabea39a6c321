/* slender.h - slender as a library: simulates and designs slender things. For C and C++.
 *
 * Link libslender (pkg-config slender; CMake: find_package(slender), slender::slender). Calls may come from several threads at
 * once. No call prints, ends the process, catches a signal or sets anything for the process as a whole; so what OpenBLAS does
 * is the program's to say, before it starts: with OPENBLAS_NUM_THREADS=1 numbers are the same bits every time. */
#ifndef SLENDER_H
#define SLENDER_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SLENDER_API __attribute__((visibility("default")))
#else
#define SLENDER_API
#endif

/* "0.1.0". */
SLENDER_API const char *slender_version(void);

/* The versions of slender and of the libraries that it works with, a line each, to be freed by slender_free; NULL where
 * memory is not there. */
SLENDER_API char *slender_versions(void);

/* Frees a text that a call returned; NULL is fine. */
SLENDER_API void slender_free(char *text);

#ifdef __cplusplus
}
#endif
#endif
