/* export_groups.h - meshes with their groups out of results, and what each group's magnetisation is. */
#pragma once
#include "io/result.h"
#include "job/run.h"

/* A frame (-1: the final state) as OBJ, its faces in their groups. */
RunStatus export_frame(Result *result, int frame, const char *path, Error *err);

/* A row for each named group of faces or tetrahedra that is magnetised, and one for what is in none: what stands at the
 * magnetiser. */
RunStatus export_groups(Result *result, const char *path, Error *err);
