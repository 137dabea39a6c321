/* Groups of a mesh: renumbered, and found by name. */
#include "base/memory.h"
#include "surface/mesh_private.h"
#include <stdlib.h>
#include <string.h>

/* The group in the mesh's numbering, without members that removing or welding took away; *lost: how many were
 * removed. */
static MeshGroup renumber_group(const MeshGroup *old, const int *vertex_of_file, int *lost)
{
    int size = old->dim == 1 ? 2 : 1;
    MeshGroup group = {.name = mem_text(old->name), .dim = old->dim};
    group.members = mem_alloc((size_t)old->count * (size_t)size, sizeof *group.members);
    *lost = 0;
    for (int i = 0; i < old->count; i++) {
        int member[2] = {0, 1}; /* as different as two ends must be */
        for (int k = 0; k < size; k++) {
            int m = old->members[i * size + k];
            member[k] = old->dim >= 2 ? m : vertex_of_file[m];
        }
        bool removed = member[0] < 0 || member[1] < 0, shrunk = size == 2 && member[0] == member[1];
        *lost += removed;
        if (!removed && !shrunk)
            memcpy(group.members + size * group.count++, member, (size_t)size * sizeof(int));
    }
    return group;
}

/* Lines that are no edges hold vertices, but no folds. */
static void warn_lines(const Mesh *mesh, const MeshGroup *group, const char *path, MeshReport *report)
{
    int count = 0, first = 0;
    for (int k = group->dim == 1 ? group->count : 0; k-- > 0;)
        if (mesh_edge(mesh, group->members[2 * k], group->members[2 * k + 1]) < 0) first = k, count++;
    if (count)
        mesh_warn(report, "%s: %d line%s of the group '%.60s' %s; the first is from vertex %d to %d", path,
                  count, count == 1 ? "" : "s", group->name,
                  count == 1 ? "is no edge of the mesh" : "are no edges of the mesh",
                  mesh->file_vertex[group->members[2 * first]],
                  mesh->file_vertex[group->members[2 * first + 1]]);
}

static int compare_names(const void *a, const void *b, void *groups)
{
    const MeshGroup *s = (MeshGroup *)groups + *(const int *)a, *t = (MeshGroup *)groups + *(const int *)b;
    int order = strcmp(s->name, t->name);
    return order ? order : s->dim - t->dim;
}

void mesh_build_groups(Mesh *mesh, const MeshFile *file, MeshReport *report)
{
    int count = mesh->group_count = file->group_count;
    mesh->groups = mem_alloc((size_t)count, sizeof *mesh->groups);
    mesh->group_order = mem_alloc((size_t)count, sizeof *mesh->group_order);
    for (int g = 0; g < count; g++) {
        const MeshGroup *old = &file->groups[g];
        int lost;
        mesh->groups[g] = renumber_group(old, mesh->vertex_of_file, &lost);
        mesh->group_order[g] = g;
        if (lost)
            mesh_warn(report, "%s: the group '%.60s' has lost %d of its %d %s, being in no face", file->path,
                      old->name, lost, old->count, old->dim == 1 ? "lines" : "vertices");
        warn_lines(mesh, &mesh->groups[g], file->path, report);
    }
    qsort_r(mesh->group_order, (size_t)count, sizeof *mesh->group_order, compare_names, mesh->groups);
}

const MeshGroup *mesh_group(const Mesh *mesh, const char *name, int dim)
{
    int low = 0, high = mesh->group_count;
    while (low < high) {
        int middle = low + (high - low) / 2;
        const MeshGroup *group = &mesh->groups[mesh->group_order[middle]];
        int order = strcmp(group->name, name);
        if (order == 0 && group->dim == dim) return group;
        if (order < 0 || (order == 0 && group->dim < dim))
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

/* Of any dimension a name counts once. */
static bool is_repeated(const Mesh *mesh, int group, int dim)
{
    for (int g = 0; g < group && dim < 0; g++)
        if (!strcmp(mesh->groups[g].name, mesh->groups[group].name)) return true;
    return false;
}

char *mesh_group_names(const Mesh *mesh, int dim)
{
    enum { ROOM = 700 };
    char *names = NULL;
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        if ((dim >= 0 && group->dim != dim) || is_repeated(mesh, g, dim)) continue;
        if (names && strlen(names) + strlen(group->name) > ROOM) return mem_join(names, ", ..", "");
        names = names ? mem_join(names, ", ", group->name) : mem_format("%.*s", ROOM, group->name);
    }
    return names ? names : mem_text("none");
}
