/* In place of direct_mumps.c and ranks_mpi.c, in a program that is built without them. */
#include "solve/direct_row.h"
#include "solve/ranks.h"

static bool ready(Error *err)
{
    return error_set(
        err,
        "mumps is not in this program, which is built without it: cmake -DSLENDER_MUMPS=ON (docs/solver.md)");
}

const DirectRow direct_mumps = {.ready = ready};

bool ranks_are_given(void)
{
    return false;
}
void ranks_start(void) {}
int ranks_count(void)
{
    return 0;
}
bool ranks_serve(void)
{
    return false;
}
void ranks_end(void) {}
void ranks_abort(int code)
{
    (void)code;
}
