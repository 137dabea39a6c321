/* kernels_start.h - what the program sets of OpenBLAS (solve/kernels.h) for the whole process: its kernels and its threads. */
#pragma once

/* First thing in main: one BLAS thread, for the same bits every time (threads are ours to use elsewhere). Starts the
 * program again by /proc/self/exe, with the same arguments, where the kernels are older than the processor and
 * OPENBLAS_CORETYPE is not set; and where address space is limited and OpenBLAS has threads of its own. Returns where
 * nothing is to be done, or where it cannot. */
void kernels_start(char **argv);

/* BLAS calls from one thread. Of a program that does not begin with kernels_start. */
void kernels_one_thread(void);
