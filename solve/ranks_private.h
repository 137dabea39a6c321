/* ranks_private.h - what ranks_mpi.c (the processes) and direct_mumps.c (what they work on) share. */
#pragma once
#include "solve/ranks.h"

/* What all processes are to do together: a job of MUMPS's on an instance of that number. */
typedef struct RanksOrder {
    int instance, job;
} RanksOrder;

/* May threads take turns in giving orders? */
bool ranks_take_turns(void);

/* By the first: sends it to the others, who begin with it; what is then collective the first one does, too. One thread at a
 * time. */
void ranks_tell(RanksOrder order);

/* In another process: does its part. */
void mumps_serve(RanksOrder order);
