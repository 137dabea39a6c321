/* libFuzzer: curves from files, the format by the first byte; what is read goes through the fit of a rod's
 * curve. */
#include "base/memory.h"
#include "io/polyline_file.h"
#include "rod/samples.h"
#include <stdint.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void fit(const PolylineFile *file)
{
    enum { ELEMENTS = 4, SAMPLES_MOST = 600 };
    RodSamplesDef def = rod_samples_default();
    for (int k = 0; k < file->strand_count && k < 2; k++) {
        int count = file->first[k + 1] - file->first[k];
        RodCurve curve;
        Error err;
        if (count < 2) abort();
        if (count > SAMPLES_MOST) count = SAMPLES_MOST;
        if (rod_samples_curve(file->points + file->first[k], count, &def, ELEMENTS, &curve, NULL, &err))
            rod_curve_clear(&curve);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const char *const formats[] = {"svg", "obj", "csv"};
    PolylineFile file;
    Error err;
    if (size == 0) return 0;
    if (polyline_file_parse("fuzz", formats[bytes[0] % 3], (const char *)bytes + 1, (long)size - 1, &file,
                            &err)) {
        if (bytes[0] & 64) fit(&file);
        polyline_file_clear(&file);
    }
    if (mem_live_count()) abort();
    return 0;
}
