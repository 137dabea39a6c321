#include "io/mesh_file.h"
#include "base/memory.h"
#include <string.h>

void mesh_file_clear(MeshFile *mesh)
{
    for (int g = 0; g < mesh->group_count; g++) {
        mem_free(mesh->groups[g].name);
        mem_free(mesh->groups[g].members);
    }
    mem_free(mesh->groups);
    mem_free(mesh->path);
    mem_free(mesh->vertices);
    mem_free(mesh->vertex_line);
    mem_free(mesh->faces);
    mem_free(mesh->face_line);
    *mesh = (MeshFile){0};
}

const MeshGroup *mesh_file_group(const MeshFile *mesh, const char *name)
{
    for (int g = 0; g < mesh->group_count; g++)
        if (!strcmp(mesh->groups[g].name, name)) return &mesh->groups[g];
    return NULL;
}
