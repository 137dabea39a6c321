/* export_files.h - what export/ makes of a result, as files. */
#pragma once
#include "export/export.h"
#include "export/parts.h"
#include "job/run.h"

/* The mesh at a frame (-1: the final state) as OBJ, its faces in their groups. */
RunStatus export_file_obj(Result *result, int frame, const char *path, Error *err);

/* As export.h says. */
RunStatus export_file_glb(Result *result, const ExportDef *def, const char *path, Error *err);
RunStatus export_file_ply(Result *result, int frame, const char *path, Error *err);
RunStatus export_file_groups(Result *result, const char *path, Error *err);
RunStatus export_file_npz(Result *result, const char *path, Error *err);

/* STL or 3MF, as the path's ending says. Each part is said. Of an STL with levels or groups each is a file of its own, NAME_1.stl,
 * ..; `check` says no, with a sentence, to one that may not be written. */
RunStatus export_file_parts(Result *result, const PartsDef *def, const char *path,
                            bool (*check)(void *self, const char *path, Error *err), void *self, Error *err);
