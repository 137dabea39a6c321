/* What this program runs with: part of every result, so that a number can be traced. */
#include "base/memory.h"
#include "io/journal.h"
#include "io/result.h"
#include "job/run.h"
#include "optim/optimiser.h"
#include "solve/kernels.h"
#include "solve/sparse.h"
#include <string.h>

char *run_kernels(Run *run, Error *err)
{
    Array before;
    const char *now = kernels_name();
    if (!journal_find(run->journal, "meta", 0, "kernels", &before, err)) return NULL;
    if (!before.data) return mem_text(now);
    const char *last = strrchr(before.data, ' ');
    last = last ? last + 1 : before.data;
    bool same = !strcmp(last, now);
    if (!same)
        host_warn(
            run->host,
            "this run was begun with OpenBLAS's kernels %s and goes on with %s: its numbers are not, bit for "
            "bit, those of an unbroken run; OPENBLAS_CORETYPE=%s keeps to the old ones",
            last, now, last);
    char *all = same ? mem_text(before.data) : mem_format("%s, %s", (const char *)before.data, now);
    array_clear(&before);
    return all;
}

char *run_versions(void)
{
    const char *note = kernels_note();
    char *text = mem_text("slender " SLENDER_VERSION "\n");
    for (int k = 0; k < DIRECT_KINDS; k++)
        if (direct_version(k)) text = mem_join(text, direct_version(k), "\n");
    char *others = mem_format("%s%s\nkernels %s%s%s\nNLopt %s\nHDF5 %s\nSQLite %s\n", kernels_blas_version(),
                              kernels_blas_is_fast() ? "" : " (slow: OpenBLAS is ten times faster)",
                              kernels_name(), *note ? ", " : "", note, optimiser_nlopt_version(),
                              result_hdf5_version(), journal_sqlite_version());
    text = mem_join(text, others, "");
    mem_free(others);
    return text;
}
