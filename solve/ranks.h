/* ranks.h - the processes of one run, by MPI, that share in its factors (direct_mumps.c). The first one runs the program; the
 * others serve it, and do nothing else. For the program alone: MPI is a process's own.
 *
 * A program that is built without it (-DSLENDER_MUMPS=ON, docs/solver.md) is one process: nothing is ever given or started. */
#pragma once
#include <stdbool.h>

/* Has a launcher (mpirun, srun, ..) started this process as one of several? */
bool ranks_are_given(void);

/* Starts MPI; by itself a process is the only one. Once. */
void ranks_start(void);

/* 0 before ranks_start. */
int ranks_count(void);

/* In all but the first: serves until the first one ends, and is true. In the first false, at once. */
bool ranks_serve(void);

/* By the first: the others end, too. Nothing may use factors of theirs any more. Does nothing where nothing was started. */
void ranks_end(void);

/* Where there is no way back: ends all processes with that code, if there are others; else returns. */
void ranks_abort(int code);
