/* slender schema and slender mesh: what can be had from scenes without running them. */
#include "base/memory.h"
#include "cli/verb.h"
#include "io/mark.h"
#include "io/path.h"
#include "job/outputs.h"
#include "sweep/sweep.h"
#include <stdio.h>

int verb_schema(int argc, char **argv)
{
    static const char usage[] =
        "schema [--manual | --keys] [--sweep]\n  JSON Schema of scene files for editors; with --manual the "
        "manual of all keys (docs/scene.md),\n"
        "  with --keys a line for each, as --set has it; with --sweep those of sweeps";
    bool manual = false, keys = false, sweep = false;
    int code;
    const Option options[] = {
        {"manual", .value = &manual}, {"keys", .value = &keys}, {"sweep", .value = &sweep}};
    if (!options_parse(argc, argv, usage, options, 3, NULL, &code)) return code;
    if (manual && keys) return verb_fail(RUN_USAGE, "--manual and --keys exclude each other");
    const YamlTable *table = sweep ? &sweep_table : scene_table();
    char *text = manual ? yaml_manual(table, sweep ? "Sweeps" : "Scene files")
                 : keys ? yaml_keys(table)
                        : yaml_schema(table, sweep ? "slender sweep" : "slender scene");
    fputs(text, stdout);
    mem_free(text);
    return RUN_DONE;
}

/* A mesh as a file again, in its own numbering. */
static bool write_mesh(const Mesh *mesh, const char *path, Error *err)
{
    MeshFile file = {.vertex_count = mesh->vertex_count,
                     .face_count = mesh->face_count,
                     .vertices = mesh->rest,
                     .faces = mesh->faces,
                     .group_count = mesh->group_count,
                     .groups = mesh->groups};
    return mesh_file_write_obj(path, &file, err);
}

int verb_mesh(int argc, char **argv)
{
    static const char usage[] = "mesh SCENE [-o FILE.obj] [--force]\n"
                                "  --force    replaces a file of that name that slender has not made\n"
                                "  Writes the scene's mesh, generated or read, as OBJ with its groups.";
    const char *output = NULL, *scene_path;
    bool force = false;
    int code;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &output, .words = OPTION_WORDS(".obj")},
        {"force", .value = &force}};
    if (!options_parse(argc, argv, usage, options, 2, &scene_path, &code)) return code;
    YamlFile *file;
    Scene scene;
    Error err;
    char *name = path_base_name(scene_path), *path = output ? mem_text(output) : mem_format("%s.obj", name);
    Model *model = verb_load_scene(scene_path, NULL, &file, &scene) ? verb_build_model(&scene, file) : NULL;
    code = RUN_REFUSED;
    if (model && !model->mesh)
        code = verb_fail(RUN_REFUSED, "the scene has no mesh");
    else if (model) {
        bool ok = outputs_check_source(&scene, scene_path, path, &err) && mark_check(path, force, &err) &&
                  write_mesh(model->mesh, path, &err);
        code = ok ? RUN_DONE : verb_fail(RUN_CANNOT_WRITE, err.text);
    }
    model_destroy(model);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    mem_free(name);
    mem_free(path);
    return code;
}
