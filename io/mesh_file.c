#include "io/mesh_file.h"
#include "base/memory.h"
#include "io/mark.h"
#include "io/mesh_reader.h"
#include "io/safe_file.h"
#include "io/text.h"
#include <string.h>
#include <strings.h>

/* ---- Reading ---- */

static const struct {
    const char *format;
    bool is_text; /* else the reader finds out */
    bool (*read)(Scan *scan, MeshReader *reader);
} formats[] = {{"obj", true, mesh_read_obj},
               {"ply", true, mesh_read_ply},
               {"msh", true, mesh_read_msh},
               {"stl", false, mesh_read_stl}};

bool mesh_file_parse(const char *path, const char *format, const char *text, long length, MeshFile *mesh,
                     Error *err)
{
    *mesh = (MeshFile){0};
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (strcasecmp(format, formats[k].format)) continue;
        MeshReader reader = {.mesh = mesh};
        size_t left = (size_t)length;
        mesh->path = mem_text(path);
        bool ok = !formats[k].is_text || scan_skip_mark(path, &text, &left, err);
        Scan scan = scan_start(path, text, left, 0, "", err);
        ok = ok && formats[k].read(&scan, &reader);
        if (ok && mesh->face_count == 0 && mesh->cell_count == 0)
            ok = error_set(err, "%s: there are no faces in it", path);
        reader_clear(&reader);
        if (!ok) mesh_file_clear(mesh);
        return ok;
    }
    return error_set(
        err,
        "%s: a mesh is read from .obj, .ply, .stl or .msh; convert others (3MF, OFF, VTK, ..) with MeshLab, "
        "or with `meshio convert`",
        path);
}

bool mesh_file_read(const char *path, MeshFile *mesh, Error *err)
{
    const char *dot = strrchr(path, '.');
    char *text;
    size_t length;
    *mesh = (MeshFile){0};
    if (!scan_file(path, &text, &length, err)) return false;
    bool ok = mesh_file_parse(path, dot ? dot + 1 : "", text, (long)length, mesh, err);
    mem_free(text);
    return ok;
}

bool mesh_file_check_triangles(const MeshFile *mesh, Error *err)
{
    if (!mesh->cell_count) return true;
    return error_set(
        err,
        "%s:%d: a tetrahedron in a mesh of triangles: mesh surfaces only (gmsh -2), or save only their "
        "physical groups",
        mesh->path, mesh->cell_line[0]);
}

/* ---- Writing ---- */

/* The groups of each face: those of face f are groups[first[f]] to groups[first[f + 1] - 1], ascending. */
typedef struct FaceGroups {
    int *first, *groups;
} FaceGroups;

static FaceGroups face_groups(const MeshFile *mesh)
{
    FaceGroups of = {.first = mem_alloc((size_t)mesh->face_count + 2, sizeof(int))};
    int *end =
        of.first + 1; /* [face + 1]: the counts, their sums, and at last where each face's groups end */
    for (int g = 0; g < mesh->group_count; g++)
        for (int k = 0; mesh->groups[g].dim == 2 && k < mesh->groups[g].count; k++)
            end[mesh->groups[g].members[k] + 1]++;
    for (int f = 0; f < mesh->face_count; f++) end[f + 1] += end[f];
    of.groups = mem_alloc((size_t)end[mesh->face_count], sizeof(int));
    for (int g = 0; g < mesh->group_count; g++)
        for (int k = 0; mesh->groups[g].dim == 2 && k < mesh->groups[g].count; k++)
            of.groups[end[mesh->groups[g].members[k]]++] = g;
    return of;
}

static bool same_groups(const FaceGroups *of, int f, int other)
{
    int count = of->first[f + 1] - of->first[f];
    return count == of->first[other + 1] - of->first[other] &&
           !memcmp(of->groups + of->first[f], of->groups + of->first[other], (size_t)count * sizeof(int));
}

/* A group's name as one word: another reader takes a blank for its end, and # for a comment. */
static void write_name(Text *text, const char *name)
{
    text_add(text, " ");
    for (const char *c = name; *c; c++) {
        bool unfit = (unsigned char)*c <= ' ' || (*c == '#' && c == name) || (*c == '\\' && !c[1]);
        text_add(text, "%c", unfit ? '_' : *c);
    }
}

/* OBJ has groups of faces and, by `l`, of edges. A face is in one g line with all its groups. */
static void write_faces(Text *text, const MeshFile *mesh)
{
    FaceGroups of = face_groups(mesh);
    for (int f = 0; f < mesh->face_count; f++) {
        if (f == 0 ? of.first[1] > 0 : !same_groups(&of, f, f - 1)) {
            text_add(text, "g");
            for (int k = of.first[f]; k < of.first[f + 1]; k++)
                write_name(text, mesh->groups[of.groups[k]].name);
            text_add(text, "\n");
        }
        text_add(text, "f %d %d %d\n", mesh->faces[f][0] + 1, mesh->faces[f][1] + 1, mesh->faces[f][2] + 1);
    }
    mem_free(of.first);
    mem_free(of.groups);
}

static void write_groups(Text *text, const MeshFile *mesh)
{
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dim >= 2) continue;
        text_add(text, "g");
        write_name(text, group->name);
        text_add(text, "\n");
        for (int k = 0; k < group->count; k++)
            if (group->dim == 1)
                text_add(text, "l %d %d\n", group->members[2 * k] + 1, group->members[2 * k + 1] + 1);
            else
                text_add(text, "p %d\n", group->members[k] + 1);
    }
}

bool mesh_file_write_obj(const char *path, const MeshFile *mesh, Error *err)
{
    Text text = {0};
    text_add(&text, MARK_OBJ(SLENDER_VERSION));
    for (int v = 0; v < mesh->vertex_count; v++)
        text_add(&text, "v %.17g %.17g %.17g\n", mesh->vertices[v][0], mesh->vertices[v][1],
                 mesh->vertices[v][2]);
    write_faces(&text, mesh);
    write_groups(&text, mesh);
    bool ok = safe_file_write(path, text.text, text.length, false, err);
    mem_free(text.text);
    return ok;
}

/* ---- The struct ---- */

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
    mem_free(mesh->cells);
    mem_free(mesh->cell_line);
    *mesh = (MeshFile){0};
}

const MeshGroup *mesh_file_group(const MeshFile *mesh, const char *name, int dim)
{
    for (int g = 0; g < mesh->group_count; g++)
        if (mesh->groups[g].dim == dim && !strcmp(mesh->groups[g].name, name)) return &mesh->groups[g];
    return NULL;
}
