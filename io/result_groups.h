/* result_groups.h - the named groups of a body's mesh in journal and result: slender/groups/names, a line each; dim, what the
 * members are (0 vertices, 1 edges, 2 faces, 3 cells); offsets[groups+1] into members, of edges two numbers each: their
 * vertices. */
#pragma once
#include "io/arrays.h"
#include "io/mesh_file.h"
#include "io/result.h"

/* Into a list of what does not change; nothing where there are no groups. */
void result_groups_add(Arrays *list, const MeshGroup *groups, int count);

/* Into groups and group_count of the file; none where the result has none. Members below count[dim], of edges those of
 * vertices. */
bool result_groups_read(Result *result, const int count[4], MeshFile *file, Error *err);
