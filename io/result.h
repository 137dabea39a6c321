/* result.h - NAME.vtkhdf: what a run leaves for people and programs, made from its journal.
 *
 * An HDF5 file in two groups; every dataset of numbers has a text attribute `unit`.
 *
 * /VTKHDF, if the journal has frames and static/faces or static/lines: an UnstructuredGrid over time
 * (VTKHDF 2.0) for ParaView 5.12 and later, of triangles or, as rows of static/lines say (first point and
 * number of points), of polylines. Cells are stored once; one chunk per step, gzip 1 and shuffle:
 *
 *     Points           [T*n_v,3]            float32, unless double_frames or where that does not resolve the body
 *     CellData/NAME    [T*n_f], [T*n_f,3]   from the frames' arrays cell/NAME
 *     PointData/NAME   likewise             from point/NAME, 0 at the points of static/still
 *
 * An array that a frame does not have is the one of the frame before it (Steps/CellDataOffsets says which),
 * so that what never changes need only be in the first frame.
 *
 * /slender: every array of meta, static, obstacles and final at its own name (scene, versions, rest, faces, edges,
 * state/x, design/BLOCK, cases/NAME/.., ..) with its type and shape, and
 *
 *     history/NAME           [evaluations]   one for each scalar that the evaluations hold
 *     frames/flux_density    [T,3]           where the frames have it
 *     frames/obstacle_pose   [T,n_o,12]      float64, where the frames have it
 *     frames/x               [T,n_v,3]       float64, if those are
 *     frames/NAME            [T,n]           float64: the frames' arrays state/NAME
 *     probes/NAME            [T], [T,3]      float64: the frames' arrays probes/NAME, or those of the evaluations
 *     stages/NAME            [T], [T,n,3]    float64, of texts lines: the frames' arrays stages/NAME
 *     state/x                [n_v,3]         the last frame's x, until final has it
 *     attribute status       text            final/status; "unfinished" if there is none yet
 *     attribute kernels      text            meta/kernels
 *
 * The file ends with a trailer of 20 bytes that HDF5 does not look at: "SLENDRCK", the length before it
 * (uint64) and the CRC32 of these bytes (uint32), little-endian. A file whose trailer does not fit is never
 * handed to HDF5.
 *
 * NAME.xdmf beside it shows the same steps to ParaView 5.11, whose VTKHDF reader cannot do time. Polylines of
 * different lengths are listed for it in /slender/xdmf_topology (2, the number of points, the points; and so on). */
#pragma once
#include "base/error.h"
#include "io/array.h"
#include "io/journal.h"

typedef struct ResultDef {
    bool double_frames; /* scene key output.precision: double */
} ResultDef;

/* Writes the result and its sidecar; *sum, where it is not NULL, becomes the CRC32 of the trailer. The file is
 * built in memory (so it needs its own size in memory, twice for a moment), written to a temporary file beside
 * path, read back, synced to the disk and renamed: at every moment path is the old file or the new one, whole.
 * On false the old one is still there. */
bool result_write(Journal *journal, const char *path, ResultDef def, uint32_t *sum, Error *err);

/* The name of the result's sidecar, which the caller frees. False where there is none, since XDMF cannot name the
 * result: a name with : or |, control characters or bytes that are no UTF-8, or blanks at its ends. */
char *result_sidecar(const char *path);
bool result_has_sidecar(const char *path);

typedef struct Result Result;

/* Opens a result for reading, after checking every byte against the trailer. NULL and a sentence on refusal.
 */
Result *result_open(const char *path, Error *err);
void result_close(Result *result);

/* The CRC32 of the trailer: no other result has it. */
uint32_t result_sum(const Result *result);

/* Is that what frames say of what is around the body, in rows: obstacle_pose, source_pose, flux_density, ..? */
bool result_is_around(const char *field);

/* The paths of all datasets, e.g. "slender/state/x", sorted by group. One block, to be freed by mem_free. */
bool result_list(Result *result, char ***paths, int *count, Error *err);

bool result_has(Result *result, const char *path);

/* Reads a dataset: floating point as float64, integers as int32 (a number that does not fit is refused),
 * texts as text. "slender/status" and "slender/kernels" read the attributes. To be freed by array_clear. */
bool result_read(Result *result, const char *path, Array *array, Error *err);

/* The same, refused where it has another type or rank, or rows of another width (0: any). */
bool result_read_as(Result *result, const char *path, ArrayType type, int rank, int width, Array *array,
                    Error *err);

/* Reads only rows first .. first + count - 1 of the first dimension. */
bool result_read_rows(Result *result, const char *path, int first, int count, Array *array, Error *err);

/* Stored steps, 0 if there is no /VTKHDF. */
int result_step_count(Result *result);

/* False and a sentence where a body is nowhere yet: there is no step, and no final state (unsolved, or hardly begun). */
bool result_check_state(Result *result, Error *err);

/* One step of /VTKHDF: name is "Points", "CellData/<name>" or "PointData/<name>"; the array of doubles has one row per
 * vertex or cell, those of Points three numbers. */
bool result_read_step(Result *result, const char *name, int step, Array *array, Error *err);

/* The linked library's version, e.g. "1.10.8". */
const char *result_hdf5_version(void);
