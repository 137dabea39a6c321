#include "io/mesh_file.h"
#include "base/memory.h"
#include "io/mesh_reader.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* ---- Growing ---- */

static size_t larger(size_t count)
{
    return 2 * count + 64;
}

void reader_add_vertex(MeshReader *reader, const double *x, int line)
{
    MeshFile *mesh = reader->mesh;
    size_t count = (size_t)mesh->vertex_count;
    if (count == reader->vertex_room) {
        mesh->vertices = mem_resize(mesh->vertices, count, larger(count), sizeof *mesh->vertices);
        mesh->vertex_line = mem_resize(mesh->vertex_line, count, larger(count), sizeof *mesh->vertex_line);
        reader->vertex_room = larger(count);
    }
    memcpy(mesh->vertices[count], x, sizeof *mesh->vertices);
    mesh->vertex_line[count] = line;
    mesh->vertex_count++;
}

void reader_add_face(MeshReader *reader, const int *vertices, int line)
{
    MeshFile *mesh = reader->mesh;
    size_t count = (size_t)mesh->face_count;
    if (count == reader->face_room) {
        mesh->faces = mem_resize(mesh->faces, count, larger(count), sizeof *mesh->faces);
        mesh->face_line = mem_resize(mesh->face_line, count, larger(count), sizeof *mesh->face_line);
        reader->face_room = larger(count);
    }
    memcpy(mesh->faces[count], vertices, sizeof *mesh->faces);
    mesh->face_line[count] = line;
    mesh->face_count++;
}

int reader_group(MeshReader *reader, const char *name, int length, int dim)
{
    MeshFile *mesh = reader->mesh;
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dim == dim && strlen(group->name) == (size_t)length &&
            !strncmp(group->name, name, (size_t)length))
            return g;
    }
    size_t count = (size_t)mesh->group_count;
    mesh->groups = mem_resize(mesh->groups, count, count + 1, sizeof *mesh->groups);
    reader->group_room = mem_resize(reader->group_room, count, count + 1, sizeof *reader->group_room);
    mesh->groups[count] = (MeshGroup){.name = mem_format("%.*s", length, name), .dim = dim};
    return mesh->group_count++;
}

void reader_group_add(MeshReader *reader, int index, const int *members)
{
    MeshGroup *group = &reader->mesh->groups[index];
    size_t width = group->dim == 1 ? 2 : 1, used = (size_t)group->count * width;
    if (used + width > reader->group_room[index]) {
        group->members = mem_resize(group->members, reader->group_room[index], larger(used), sizeof(int));
        reader->group_room[index] = larger(used);
    }
    memcpy(group->members + used, members, width * sizeof *members);
    group->count++;
}

/* ---- Reading ---- */

static const struct {
    const char *format;
    char comment;
    bool (*read)(Scan *scan, MeshReader *reader);
} formats[] = {{"obj", '#', mesh_read_obj}, {"ply", 0, mesh_read_ply}, {"msh", 0, mesh_read_msh}};

/* Groups without members say nothing. */
static void drop_empty_groups(MeshFile *mesh)
{
    int kept = 0;
    for (int g = 0; g < mesh->group_count; g++) {
        if (mesh->groups[g].count > 0)
            mesh->groups[kept++] = mesh->groups[g];
        else
            mem_free(mesh->groups[g].name);
    }
    mesh->group_count = kept;
}

bool mesh_file_parse(const char *path, const char *format, const char *text, long length, MeshFile *mesh,
                     Error *err)
{
    *mesh = (MeshFile){0};
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (strcasecmp(format, formats[k].format)) continue;
        MeshReader reader = {.mesh = mesh};
        size_t left = (size_t)length;
        mesh->path = mem_text(path);
        bool ok = scan_skip_mark(path, &text, &left, err);
        Scan scan = scan_start(path, text, left, formats[k].comment, "", err);
        ok = ok && formats[k].read(&scan, &reader);
        if (ok && mesh->face_count == 0) ok = error_set(err, "%s: there are no triangles in it", path);
        mem_free(reader.group_room);
        if (ok)
            drop_empty_groups(mesh);
        else
            mesh_file_clear(mesh);
        return ok;
    }
    return error_set(err, "%s: a mesh is read from .obj, .ply or .msh", path);
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

/* ---- Writing ---- */

/* OBJ has groups of faces and, by `l`, of edges. A face is in one g line with all its groups. */
static void write_faces(FILE *file, const MeshFile *mesh)
{
    char *member = mem_alloc((size_t)mesh->face_count * (size_t)mesh->group_count + 1, 1);
    size_t stride = (size_t)mesh->group_count;
    for (int g = 0; g < mesh->group_count; g++)
        for (int k = 0; mesh->groups[g].dim == 2 && k < mesh->groups[g].count; k++)
            member[(size_t)mesh->groups[g].members[k] * stride + (size_t)g] = 1;
    for (int f = 0; f < mesh->face_count; f++) {
        const char *now = member + (size_t)f * stride, *before = f > 0 ? now - stride : NULL;
        if (stride && (!before || memcmp(now, before, stride))) {
            fprintf(file, "g");
            for (size_t g = 0; g < stride; g++)
                if (now[g]) fprintf(file, " %s", mesh->groups[g].name);
            fprintf(file, "\n");
        }
        fprintf(file, "f %d %d %d\n", mesh->faces[f][0] + 1, mesh->faces[f][1] + 1, mesh->faces[f][2] + 1);
    }
    mem_free(member);
}

static void write_groups(FILE *file, const MeshFile *mesh)
{
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dim == 2) continue;
        fprintf(file, "g %s\n", group->name);
        for (int k = 0; k < group->count; k++)
            if (group->dim == 1)
                fprintf(file, "l %d %d\n", group->members[2 * k] + 1, group->members[2 * k + 1] + 1);
            else
                fprintf(file, "p %d\n", group->members[k] + 1);
    }
}

bool mesh_file_write_obj(const char *path, const MeshFile *mesh, Error *err)
{
    FILE *file = fopen(path, "w");
    if (!file) return error_set(err, "%s: cannot be written: %s", path, strerror(errno));
    for (int v = 0; v < mesh->vertex_count; v++)
        fprintf(file, "v %.17g %.17g %.17g\n", mesh->vertices[v][0], mesh->vertices[v][1],
                mesh->vertices[v][2]);
    write_faces(file, mesh);
    write_groups(file, mesh);
    bool failed = ferror(file) != 0;
    failed |= fclose(file) != 0;
    return !failed || error_set(err, "%s: cannot be written: %s", path, strerror(errno));
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
    *mesh = (MeshFile){0};
}

const MeshGroup *mesh_file_group(const MeshFile *mesh, const char *name)
{
    for (int g = 0; g < mesh->group_count; g++)
        if (!strcmp(mesh->groups[g].name, name)) return &mesh->groups[g];
    return NULL;
}
