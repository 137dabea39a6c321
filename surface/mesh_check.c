/* What can be judged of a mesh's file before anything is built. */
#include "surface/mesh_private.h"
#include <math.h>
#include <stdio.h>

MeshPlace mesh_place(const MeshFile *file, const int *lines, int element)
{
    MeshPlace at;
    if (lines)
        snprintf(at.text, sizeof at.text, "%.480s:%d", file->path, lines[element]);
    else
        snprintf(at.text, sizeof at.text, "%.480s", file->path);
    return at;
}

static bool check_coordinates(const MeshFile *file, Error *err)
{
    for (int v = 0; v < file->vertex_count; v++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(file->vertices[v][k]) <= MESH_FARTHEST))
                return error_set(err, "%s: vertex %d has %c = %g; coordinates are finite and within %g m",
                                 mesh_place(file, file->vertex_line, v).text, v, "xyz"[k],
                                 file -> vertices[v][k], MESH_FARTHEST);
    return true;
}

/* Some of the file's elements: of so many vertices each. */
typedef struct Elements {
    const char *name;
    const int *vertices, *lines;
    int count, each;
} Elements;

static bool check_indices(const MeshFile *file, Elements of, Error *err)
{
    for (int i = 0; i < of.count * of.each; i++)
        if (of.vertices[i] < 0 || of.vertices[i] >= file->vertex_count)
            return error_set(err, "%s: %s %d names vertex %d; the vertices are 0 to %d",
                             mesh_place(file, of.lines, i / of.each).text, of.name, i / of.each,
                             of.vertices[i], file->vertex_count - 1);
    return true;
}

static bool check_groups(const MeshFile *file, Error *err)
{
    const int ends[] = {file->vertex_count, file->vertex_count, file->face_count, file->cell_count};
    static const char *const names[] = {"vertex", "vertex", "face", "tetrahedron"};
    for (int g = 0; g < file->group_count; g++) {
        const MeshGroup *group = &file->groups[g];
        int member_count = group->dim == 1 ? 2 * group->count : group->count;
        for (int i = 0; i < member_count; i++)
            if (group->members[i] < 0 || group->members[i] >= ends[group->dim])
                return error_set(err, "%s: group '%s' names %s %d; the last one is %d", file->path,
                                 group->name, names[group->dim], group->members[i], ends[group->dim] - 1);
    }
    return true;
}

bool mesh_check_file(const MeshFile *file, Error *err)
{
    Elements faces = {"face", (const int *)file->faces, file->face_line, file->face_count, 3};
    Elements cells = {"tetrahedron", file->cells, file->cell_line, file->cell_count, file->cell_nodes};
    return check_coordinates(file, err) && check_indices(file, faces, err) &&
           check_indices(file, cells, err) && check_groups(file, err);
}
