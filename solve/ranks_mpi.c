#include "solve/ranks_private.h"
#include <mpi.h>
#include <stdlib.h>
#include <time.h>

enum { END = -1000 }; /* no job of MUMPS's */

static struct {
    int rank, count; /* count 0: not started */
    bool turns;
} ranks;

/* Open MPI's, PMIx's (srun) and PMI's (MPICH, Intel) ways of telling. */
bool ranks_are_given(void)
{
    return getenv("OMPI_COMM_WORLD_RANK") || getenv("PMIX_RANK") || getenv("PMI_RANK");
}

void ranks_start(void)
{
    int provided;
    if (ranks.count) return;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks.count);
    ranks.turns = provided >= MPI_THREAD_SERIALIZED;
}

int ranks_count(void)
{
    return ranks.count;
}

bool ranks_take_turns(void)
{
    return ranks.turns;
}

void ranks_tell(RanksOrder order)
{
    for (int to = 1; to < ranks.count; to++) MPI_Send(&order, 2, MPI_INT, to, 0, MPI_COMM_WORLD);
}

/* MPI waits at full speed, on a processor that the first process's threads could use. */
static RanksOrder wait_for_order(void)
{
    const struct timespec nap = {.tv_nsec = 50000};
    RanksOrder order;
    MPI_Request request;
    int arrived = 0;
    MPI_Irecv(&order, 2, MPI_INT, 0, 0, MPI_COMM_WORLD, &request);
    while (MPI_Test(&request, &arrived, MPI_STATUS_IGNORE), !arrived) nanosleep(&nap, NULL);
    return order;
}

bool ranks_serve(void)
{
    if (ranks.rank == 0) return false;
    for (RanksOrder order; (order = wait_for_order()).job != END;) mumps_serve(order);
    MPI_Finalize();
    return true;
}

void ranks_end(void)
{
    if (!ranks.count) return;
    ranks_tell((RanksOrder){.job = END});
    MPI_Finalize();
    ranks.count = 0;
}

void ranks_abort(int code)
{
    if (ranks.count > 1) MPI_Abort(MPI_COMM_WORLD, code);
}
