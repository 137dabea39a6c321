#include "cli/export_groups.h"
#include "base/memory.h"
#include "base/plain.h"
#include "base/vec3.h"
#include "export/mesh.h"
#include "field/flux_field.h"
#include "io/mesh_file.h"
#include "io/safe_file.h"
#include <math.h>
#include <string.h>

/* ---- Meshes with groups ---- */

RunStatus export_frame(Result *result, int frame, const char *path, Error *err)
{
    MeshFile file;
    RunStatus status = RUN_REFUSED;
    if (export_mesh_read(result, frame, &file, err))
        status = mesh_file_write_obj(path, &file, err) ? RUN_DONE : RUN_CANNOT_WRITE;
    mesh_file_clear(&file);
    return status;
}

/* ---- A row for each group ---- */

/* Elements of one dimension, with their magnetisation and, as its weight, area (of a shell by thickness) or volume at rest. */
typedef struct Magnets {
    int count;
    const double (*M)[3];
    double *size;
    bool *named; /* in a group */
} Magnets;

static Vec3 edge(const MeshFile *file, const int *v, int k)
{
    return vec3_sub(vec3_load(file->vertices[v[k]]), vec3_load(file->vertices[v[0]]));
}

/* Thickness of each face; NULL: all have the same. */
static Magnets magnets_of(const MeshFile *file, int dim, const double (*M)[3], const double *thickness)
{
    Magnets all = {.count = dim == 3 ? file->cell_count : file->face_count, .M = M};
    all.size = mem_alloc((size_t)all.count, sizeof *all.size);
    all.named = mem_alloc((size_t)all.count, sizeof *all.named);
    for (int e = 0; e < all.count; e++) {
        const int *v = dim == 3 ? file->cells + e * file->cell_nodes : file->faces[e];
        Vec3 normal = vec3_cross(edge(file, v, 1), edge(file, v, 2));
        all.size[e] = dim == 3 ? fabs(vec3_dot(normal, edge(file, v, 3))) / 6 : vec3_length(normal) / 2;
        if (thickness) all.size[e] *= thickness[e];
    }
    return all;
}

static bool is_magnet(const Magnets *all, int e)
{
    const double *M = all->M[e];
    return M[0] * M[0] + M[1] * M[1] + M[2] * M[2] > 0; /* false of NaN: none there */
}

/* The mean over the group, weighed by size, and the largest angle of a member's to it. */
static void write_row(const Magnets *all, const char *name, const int *members, int count, char **text)
{
    Vec3 sum = vec3(0, 0, 0);
    double size = 0, spread = 0;
    int there = 0, magnets = 0;
    for (int k = 0; k < count; k++) {
        if (isnan(all->M[members[k]][0])) continue; /* a face without the layer */
        there++;
        size += all->size[members[k]];
        sum = vec3_axpy(all->size[members[k]], vec3_load(all->M[members[k]]), sum);
        magnets += is_magnet(all, members[k]);
    }
    if (!magnets) return;
    Vec3 M = vec3_scale(1 / size, sum);
    double length = vec3_length(M), degree = 180 / M_PI;
    for (int k = 0; k < count; k++) {
        if (!is_magnet(all, members[k])) continue;
        Vec3 own = vec3_load(all->M[members[k]]);
        spread = fmax(spread, atan2(vec3_length(vec3_cross(own, M)), vec3_dot(own, M)));
    }
    char *word = plain_text(name, ""), *row;
    for (char *c = word; *c; c++)
        if (*c == ',' || *c == '"') *c = '_';
    row = mem_format("%s%s,%d,%.6g,%.6g,%.4f,%.4f,%.4f", *text, word, there, length, 1e3 * FLUX_MU_0 * length,
                     degree * atan2(M.y, M.x), degree * atan2(M.z, hypot(M.x, M.y)), degree * spread);
    mem_free(word);
    mem_free(*text);
    *text = mem_join(row, "", "\n");
}

static void write_rows(const MeshFile *file, int dim, const double (*M)[3], const double *thickness,
                       char **text)
{
    Magnets all = magnets_of(file, dim, M, thickness);
    for (int g = 0; g < file->group_count; g++) {
        const MeshGroup *group = &file->groups[g];
        if (group->dim != dim) continue;
        for (int k = 0; k < group->count; k++) all.named[group->members[k]] = true;
        write_row(&all, group->name, group->members, group->count, text);
    }
    int *rest = mem_alloc((size_t)all.count, sizeof *rest), count = 0;
    for (int e = 0; e < all.count; e++)
        if (!all.named[e] && is_magnet(&all, e)) rest[count++] = e;
    write_row(&all, dim == 3 ? "(other tetrahedra)" : "(other faces)", rest, count, text);
    mem_free(rest);
    mem_free(all.size);
    mem_free(all.named);
}

/* Of the last frame: tetrahedra first, then faces. */
static RunStatus write_groups(Result *result, const MeshFile *file, const double *thickness, const char *path,
                              Error *err)
{
    Array M;
    if (!export_magnetization_read(result, file, &M, err)) return RUN_REFUSED;
    RunStatus status = RUN_REFUSED;
    static const char HEADER[] =
        "name,count,magnetization [A/m],remanence [mT],azimuth [deg],elevation [deg],spread [deg]\n";
    char *text = mem_text(HEADER);
    const double(*rows)[3] = (const double(*)[3])M.data;
    if (file->cell_count) write_rows(file, 3, rows, NULL, &text);
    write_rows(file, 2, rows + file->cell_count, thickness, &text);
    if (!strcmp(text, HEADER))
        error_set(err, "nothing is magnetised");
    else
        status = safe_file_write(path, text, strlen(text), false, err) ? RUN_DONE : RUN_CANNOT_WRITE;
    mem_free(text);
    array_clear(&M);
    return status;
}

RunStatus export_groups(Result *result, const char *path, Error *err)
{
    Array thickness = {0};
    MeshFile file;
    if (!result_has(result, "slender/groups/names")) {
        error_set(err, "the body's mesh has no groups");
        return RUN_REFUSED;
    }
    bool ok = export_mesh_read(result, MESH_REST, &file, err);
    ok = ok && export_thickness_read(result, &file, &thickness, err);
    RunStatus status = ok ? write_groups(result, &file, thickness.data, path, err) : RUN_REFUSED;
    array_clear(&thickness);
    mesh_file_clear(&file);
    return status;
}
