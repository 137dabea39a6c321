/* The tetrahedra of a scene. */
#include "model/build.h"
#include "solid/front/front.h"
#include "solid/shapes.h"

static bool make_file(const SolidMeshScene *scene, MeshFile *file, Error *err)
{
    if (scene->file) return build_read_mesh(scene->file, scene->scale, file, err);
    return solid_shape_box(scene->size, scene->cells, file, err);
}

Tets *solid_read_tets(const SolidScene *scene, YamlFile *yaml, MeshReport *report)
{
    const SolidMeshScene *mesh = &scene->mesh;
    const char *at = mesh->file ? "solid.mesh.file" : "solid.mesh";
    MeshFile file = {0};
    Error err;
    Tets *tets = NULL;
    if (!mesh->file && (mesh->size_count != 3 || mesh->cells_count != 3))
        yaml_refuse(yaml, at, "a box needs `size`, three lengths, and `cells`, three numbers");
    else if (!make_file(mesh, &file, &err) || !(tets = tets_create(&file, scene->order, report, &err)))
        yaml_refuse(yaml, at, "%s", err.text);
    mesh_file_clear(&file);
    return tets;
}
