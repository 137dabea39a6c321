/* kernels.h - the BLAS: which of OpenBLAS's kernels do the work, and for how many threads there is room.
 *
 * OpenBLAS chooses its kernels when it is loaded, by the processor's model. One that is newer than the library gets
 * the oldest ones, without a word: OpenBLAS 0.3.21 of Debian 12 multiplies on a Xeon with AVX-512 by its "Prescott", at
 * a quarter of the speed. It also starts its threads then, each with 128 MB of address space, which it asks for again
 * and again where there is none. Both can be told to it in its environment only, before it is loaded: the program sees to
 * that (cli/kernels_start.h). Nothing here changes what the process has set.
 *
 * Numbers are the same bits as long as the kernels are the same, and OpenBLAS works in one thread. */
#pragma once
#include <stdbool.h>

/* What OpenBLAS reads when it is loaded: the name of its kernels. */
#define KERNELS_CORE_KEY "OPENBLAS_CORETYPE"

typedef struct KernelFeatures {
    bool avx2;   /* with FMA                                                   */
    bool avx512; /* F, CD, BW, DQ and VL: what the kernels of SkylakeX consist of */
} KernelFeatures;

/* What this processor has and the operating system lets it use. */
KernelFeatures kernels_features(void);

/* The value of OPENBLAS_CORETYPE where `core` (openblas_get_corename) uses less than the processor has; NULL where it
 * is right. */
const char *kernels_wanted(const char *core, KernelFeatures features);

/* The same for the OpenBLAS that is loaded; NULL too where it was built for one processor alone. */
const char *kernels_better(void);

/* Takes OpenBLAS's memory for that many threads that call it at the same time; returns for how many there was room, 0:
 * for none, when a call would never return. */
int kernels_reserve(int threads);

/* "SkylakeX". */
const char *kernels_name(void);

/* Of kernels that use less than this processor has, what it could use and how; else "". */
const char *kernels_note(void);

/* Flops per second of dgemm on this thread, now: takes some milliseconds. */
double kernels_flops(void);

/* What BLAS is loaded ("OpenBLAS 0.3.21 ..."), a static text; is it the one that is called? False when another BLAS
 * stands before it, the reference one being ten times slower. */
const char *kernels_blas_version(void);
bool kernels_blas_is_fast(void);
