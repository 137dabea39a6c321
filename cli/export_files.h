/* export_files.h - what export/ makes of a result, as files. */
#pragma once
#include "export/export.h"
#include "export/parts.h"
#include "job/run.h"

/* Which files may be written beside the one that was asked for: of others `allows` says no, with a sentence. */
typedef struct FurtherFiles {
    bool (*allows)(const void *self, const char *path, Error *err);
    const void *self;
} FurtherFiles;

enum { FURTHER_FILES_MOST = 100 };

/* Are they all allowed, NAME_1.stl, .., as many as that, of NAME.stl? */
bool further_files_allow(FurtherFiles files, const char *path, int count, Error *err);

/* The mesh at a frame (-1: the final state) as OBJ, its faces in their groups. */
RunStatus export_file_obj(Result *result, int frame, const char *path, Error *err);

/* As export.h says. */
RunStatus export_file_glb(Result *result, const ExportDef *def, const char *path, Error *err);
RunStatus export_file_ply(Result *result, int frame, const char *path, Error *err);
RunStatus export_file_groups(Result *result, const char *path, Error *err);
RunStatus export_file_npz(Result *result, const char *path, Error *err);

/* STL or 3MF, as the path's ending says. Each part is said. Of an STL with levels or groups each is a file of its own,
 * NAME_1.stl, ..: all of them, or none. */
RunStatus export_file_parts(Result *result, const PartsDef *def, const char *path, FurtherFiles further,
                            Error *err);
