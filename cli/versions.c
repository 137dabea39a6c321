/* What this program runs with: part of every result, so that a number can be traced. */
#include "base/memory.h"
#include "cli/run.h"
#include "io/journal.h"
#include "io/result.h"
#include "optim/optimiser.h"
#include "solve/sparse.h"

char *run_versions(void)
{
    return mem_format("slender %s\nCHOLMOD %s\n%s%s\nNLopt %s\nHDF5 %s\nSQLite %s\n", SLENDER_VERSION,
                      sparse_version(), sparse_blas_version(),
                      sparse_blas_is_fast() ? "" : " (slow: OpenBLAS is ten times faster)",
                      optimiser_nlopt_version(), result_hdf5_version(), journal_sqlite_version());
}
