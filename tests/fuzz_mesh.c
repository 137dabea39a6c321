/* libFuzzer: mesh files, the format by the first byte; what is read goes through the mesh's own checks, or those of
 * tetrahedra. */
#include "base/memory.h"
#include "solid/tets.h"
#include <stdint.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const char *const formats[] = {"obj", "ply", "msh", "stl"};
    MeshFile file;
    Error err;
    if (size == 0) return 0;
    if (mesh_file_parse("fuzz", formats[bytes[0] % 4], (const char *)bytes + 1, (long)size - 1, &file,
                        &err)) {
        MeshReport report;
        if (file.cell_count)
            tets_destroy(tets_create(&file, bytes[0] & 8 ? TET_LINEAR : TET_QUADRATIC, &report, &err));
        else
            mesh_destroy(mesh_create(&file, bytes[0] & 8 ? 1e-3 : 0, &report, &err));
        mesh_report_clear(&report);
        mesh_file_clear(&file);
    }
    if (mem_live_count()) abort();
    return 0;
}
