#include "cli/export_files.h"
#include "base/memory.h"
#include "cli/say.h"
#include "export/mesh.h"
#include "io/path.h"
#include "io/safe_file.h"

bool further_files_allow(FurtherFiles files, const char *path, int count, Error *err)
{
    bool ok = true;
    for (int k = 1; ok && k <= count; k++) {
        char *name = path_numbered(path, k);
        ok = files.allows(files.self, name, err);
        mem_free(name);
    }
    return ok;
}

/* Writes what was made, if it was, and clears it. */
static RunStatus write_made(bool made, Bytes *bytes, const char *path, Error *err)
{
    RunStatus status = !made                                                         ? RUN_REFUSED
                       : safe_file_write(path, bytes->data, bytes->size, false, err) ? RUN_DONE
                                                                                     : RUN_CANNOT_WRITE;
    bytes_clear(bytes);
    return status;
}

RunStatus export_file_glb(Result *result, const ExportDef *def, const char *path, Error *err)
{
    Bytes bytes = {0};
    return write_made(export_glb(result, def, &bytes, err), &bytes, path, err);
}

RunStatus export_file_ply(Result *result, int frame, const char *path, Error *err)
{
    Bytes bytes = {0};
    return write_made(export_ply(result, frame, &bytes, err), &bytes, path, err);
}

RunStatus export_file_groups(Result *result, const char *path, Error *err)
{
    Bytes bytes = {0};
    return write_made(export_groups(result, &bytes, err), &bytes, path, err);
}

RunStatus export_file_obj(Result *result, int frame, const char *path, Error *err)
{
    MeshFile file;
    RunStatus status = RUN_REFUSED;
    if (export_mesh_read(result, frame, &file, err))
        status = mesh_file_write_obj(path, &file, err) ? RUN_DONE : RUN_CANNOT_WRITE;
    mesh_file_clear(&file);
    return status;
}

RunStatus export_file_npz(Result *result, const char *path, Error *err)
{
    Bytes bytes = {0};
    return write_made(export_npz(result, &bytes, err), &bytes, path, err);
}

/* ---- Parts ---- */

/* "a_2.stl: top: 12.3 mm^3, 340 triangles" */
static void say_part(const char *path, const Part *part)
{
    say(stdout, "%s: %s: %.4g mm^3, %d triangles", path, part->name, 1e9 * part->volume, part->face_count);
}

static RunStatus write_3mf(const Parts *parts, const char *path, Error *err)
{
    Bytes bytes = {0};
    RunStatus status = write_made(parts_write_3mf(parts, &bytes, err), &bytes, path, err);
    for (int k = 0; status == RUN_DONE && k < parts->count; k++) say_part(path, &parts->list[k]);
    return status;
}

static RunStatus write_stl(const Part *part, const char *path, Error *err)
{
    Bytes bytes = {0};
    parts_write_stl(part, &bytes);
    RunStatus status = write_made(true, &bytes, path, err);
    if (status == RUN_DONE) say_part(path, part);
    return status;
}

static RunStatus write_stls(const Parts *parts, const char *path, FurtherFiles further, Error *err)
{
    if (parts->count > FURTHER_FILES_MOST) {
        error_set(err, "it would be %d files, and %d are the most: a .3mf has all parts in one", parts->count,
                  FURTHER_FILES_MOST);
        return RUN_CANNOT_WRITE;
    }
    RunStatus status = further_files_allow(further, path, parts->count, err) ? RUN_DONE : RUN_CANNOT_WRITE;
    for (int k = 0; status == RUN_DONE && k < parts->count; k++) {
        char *name = path_numbered(path, k + 1);
        status = write_stl(&parts->list[k], name, err);
        mem_free(name);
    }
    return status;
}

RunStatus export_file_parts(Result *result, const PartsDef *def, const char *path, FurtherFiles further,
                            Error *err)
{
    Parts parts;
    RunStatus status = parts_make(result, def, &parts, err) ? RUN_DONE : RUN_REFUSED;
    if (status == RUN_DONE && path_has_ending(path, ".3mf"))
        status = write_3mf(&parts, path, err);
    else if (status == RUN_DONE && (def->levels || def->groups))
        status = write_stls(&parts, path, further, err);
    else if (status == RUN_DONE)
        status = write_stl(&parts.list[0], path, err);
    parts_clear(&parts);
    return status;
}
