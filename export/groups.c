/* The table of groups: what stands at the magnetiser. */
#include "base/memory.h"
#include "base/plain.h"
#include "base/vec3.h"
#include "export/export.h"
#include "export/mesh.h"
#include "field/flux_field.h"
#include "io/text.h"
#include <math.h>
#include <string.h>

enum { FURTHER = 2 };

static const struct {
    const char *name, *unit;
    bool by_area; /* the mean; else by volume */
} further[FURTHER] = {{"thickness", "m", true}, {"young", "Pa", false}};

/* A number of each face or tetrahedron, shown where a design has looked for it or it is not the same everywhere. */
typedef struct Further {
    Array values;
    bool shown;
} Further;

/* Elements of one dimension, with their magnetisation and, as its weight, area (of a shell by thickness) or volume at rest. */
typedef struct Magnets {
    int count;
    const double (*M)[3];
    double *size;
    bool *named; /* in a group */
    const Further *further;
} Magnets;

static Vec3 edge(const MeshFile *file, const int *v, int k)
{
    return vec3_sub(vec3_load(file->vertices[v[k]]), vec3_load(file->vertices[v[0]]));
}

static const double *values_of(const Magnets *all, int k)
{
    const Array *values = &all->further[k].values;
    return values->data && values->dims[0] == all->count ? values->data : NULL;
}

static Magnets magnets_of(const MeshFile *file, int dim, const double (*M)[3], const Further *more)
{
    Magnets all = {.count = dim == 3 ? file->cell_count : file->face_count, .M = M, .further = more};
    const double *thickness = dim == 3 ? NULL : values_of(&all, 0);
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

static bool shows_more(const Further *more)
{
    bool shows = false;
    for (int k = 0; k < FURTHER; k++) shows |= more[k].shown;
    return shows;
}

/* The name as a cell: what has commas or quotes stands in quotes [RFC 4180]. */
static void add_name(Text *text, const char *name)
{
    char *word = plain_text(name, "");
    bool quoted = strpbrk(word, ",\"") != NULL;
    if (quoted) text_add(text, "\"");
    for (const char *c = word; *c; c++) text_add(text, *c == '"' ? "\"\"" : "%c", *c);
    if (quoted) text_add(text, "\"");
    mem_free(word);
}

/* What else a design may have made of the group, the means. Of what has none: an empty cell. */
static void add_means(const Magnets *all, const int *members, int count, Text *text)
{
    for (int k = 0; k < FURTHER; k++) {
        const double *values = values_of(all, k);
        double sum = 0, size = 0;
        if (!all->further[k].shown) continue;
        for (int m = 0; values && m < count; m++) {
            double value = values[members[m]],
                   weight = all->size[members[m]] / (further[k].by_area ? value : 1);
            sum += weight * value;
            size += weight;
        }
        text_add(text, ",");
        if (size > 0) text_add(text, "%.6g", sum / size);
    }
}

/* The mean over the group, weighed by size, and the largest angle of a member's to it. */
static void write_row(const Magnets *all, const char *name, const int *members, int count, Text *text)
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
    if (!count || (!magnets && !shows_more(all->further))) return;
    Vec3 M = vec3_scale(magnets ? 1 / size : 0, sum);
    double length = vec3_length(M), degree = 180 / M_PI;
    for (int k = 0; k < count; k++) {
        if (!is_magnet(all, members[k])) continue;
        Vec3 own = vec3_load(all->M[members[k]]);
        spread = fmax(spread, atan2(vec3_length(vec3_cross(own, M)), vec3_dot(own, M)));
    }
    add_name(text, name);
    text_add(text, ",%d,%.6g,%.6g,%.4f,%.4f,%.4f", there, length, 1e3 * FLUX_MU_0 * length,
             degree * atan2(M.y, M.x), degree * atan2(M.z, hypot(M.x, M.y)), degree * spread);
    add_means(all, members, count, text);
    text_add(text, "\n");
}

static void write_rows(const MeshFile *file, int dim, const double (*M)[3], const Further *more, Text *text)
{
    Magnets all = magnets_of(file, dim, M, more);
    for (int g = 0; g < file->group_count; g++) {
        const MeshGroup *group = &file->groups[g];
        if (group->dim != dim) continue;
        for (int k = 0; k < group->count; k++) all.named[group->members[k]] = true;
        write_row(&all, group->name, group->members, group->count, text);
    }
    int *rest = mem_alloc((size_t)all.count, sizeof *rest), count = 0;
    for (int e = 0; e < all.count; e++)
        if (!all.named[e] && (is_magnet(&all, e) || (values_of(&all, 1) && shows_more(more))))
            rest[count++] = e;
    write_row(&all, dim == 3 ? "(other tetrahedra)" : "(other faces)", rest, count, text);
    mem_free(rest);
    mem_free(all.size);
    mem_free(all.named);
}

static bool is_varied(const Array *values)
{
    const double *value = values->data;
    for (int e = 1; e < values->dims[0]; e++)
        if (value[e] != value[0]) return true;
    return false;
}

/* Of a shell, of each face; of a solid, of each tetrahedron; of what has none nothing. */
static bool read_further(Result *result, const MeshFile *file, int k, Further *more, Error *err)
{
    int count = file->cell_count ? file->cell_count : file->face_count;
    char *path = mem_format("slender/design/%s", further[k].name),
         *gradient = mem_format("slender/design/gradient/%s", further[k].name);
    bool ok = true;
    if (result_has(result, path)) {
        ok = result_read_as(result, path, ARRAY_FLOAT64, 1, 0, &more->values, err) &&
             (more->values.dims[0] == count || error_set(err, "%s is not as slender writes it", path));
        more->shown = ok && (result_has(result, gradient) || is_varied(&more->values));
    }
    mem_free(path);
    mem_free(gradient);
    return ok;
}

static void add_header(const Further *more, Text *text)
{
    text_add(text,
             "name,count,magnetization [A/m],remanence [mT],azimuth [deg],elevation [deg],spread [deg]");
    for (int k = 0; k < FURTHER; k++)
        if (more[k].shown) text_add(text, ",%s [%s]", further[k].name, further[k].unit);
    text_add(text, "\n");
}

/* Of the last frame: tetrahedra first, then faces. */
static bool write_groups(Result *result, const MeshFile *mesh, const Further *more, Bytes *file, Error *err)
{
    Array M;
    if (!export_magnetization_read(result, MESH_FINAL, mesh, &M, err)) return false;
    Text text = {0};
    add_header(more, &text);
    size_t header = text.length;
    const double(*rows)[3] = (const double(*)[3])M.data;
    if (mesh->cell_count) write_rows(mesh, 3, rows, more, &text);
    write_rows(mesh, 2, rows + mesh->cell_count, more, &text);
    bool any = text.length > header;
    if (any) bytes_add(file, text.text, text.length);
    mem_free(text.text);
    array_clear(&M);
    return any || error_set(err, "nothing is magnetised");
}

bool export_groups(Result *result, Bytes *file, Error *err)
{
    Further more[FURTHER] = {0};
    MeshFile mesh;
    if (!result_has(result, "slender/groups/names")) return error_set(err, "the body's mesh has no groups");
    bool ok = export_mesh_read(result, MESH_REST, &mesh, err);
    for (int k = 0; k < FURTHER; k++) ok = ok && read_further(result, &mesh, k, &more[k], err);
    ok = ok && write_groups(result, &mesh, more, file, err);
    for (int k = 0; k < FURTHER; k++) array_clear(&more[k].values);
    mesh_file_clear(&mesh);
    return ok;
}
