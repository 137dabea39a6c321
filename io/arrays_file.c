#include "io/arrays_file.h"
#include "base/memory.h"
#include "io/hdf5_file.h"
#include "io/safe_file.h"

bool arrays_file_write(const char *path, const Array *arrays, int count, Error *err)
{
    Hdf5 *file = hdf5_create();
    void *bytes = NULL;
    size_t size;
    bool ok = true;
    for (int k = 0; k < count && ok; k++)
        ok = hdf5_write(file, arrays[k].name, &arrays[k], (Hdf5Layout){0}, err);
    ok = ok && hdf5_image(file, &bytes, &size, err);
    hdf5_close(file);
    ok = ok && safe_file_write(path, bytes, size, false, err);
    mem_free(bytes);
    return ok;
}
