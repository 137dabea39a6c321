/* What the mesh readers share: a mesh that grows. */
#include "io/mesh_reader.h"
#include "base/memory.h"
#include "io/polygon.h"
#include <string.h>

void *reader_grow(void *block, size_t *room, size_t count, size_t size)
{
    if (count <= *room) return block;
    size_t larger = 2 * count + 64;
    block = mem_resize(block, *room, larger, size);
    *room = larger;
    return block;
}

void reader_add_vertex(MeshReader *reader, const double *x, int line)
{
    MeshFile *mesh = reader->mesh;
    size_t count = (size_t)mesh->vertex_count, room = reader->vertex_room;
    mesh->vertices = reader_grow(mesh->vertices, &reader->vertex_room, count + 1, sizeof *mesh->vertices);
    mesh->vertex_line = reader_grow(mesh->vertex_line, &room, count + 1, sizeof *mesh->vertex_line);
    memcpy(mesh->vertices[count], x, sizeof *mesh->vertices);
    mesh->vertex_line[count] = line;
    mesh->vertex_count++;
}

/* ---- Faces ---- */

static void add_triangle(MeshReader *reader, int a, int b, int c, int line)
{
    MeshFile *mesh = reader->mesh;
    size_t count = (size_t)mesh->face_count, room = reader->face_room;
    mesh->faces = reader_grow(mesh->faces, &reader->face_room, count + 1, sizeof *mesh->faces);
    mesh->face_line = reader_grow(mesh->face_line, &room, count + 1, sizeof *mesh->face_line);
    memcpy(mesh->faces[count], (int[3]){a, b, c}, sizeof *mesh->faces);
    mesh->face_line[count] = line;
    mesh->face_count++;
}

static void add_polygon(MeshReader *reader, const int *corners, int count)
{
    size_t first = reader->corner_count, polygons = (size_t)reader->polygon_count;
    reader->corner_count += (size_t)count;
    reader->corners = reader_grow(reader->corners, &reader->corner_room, reader->corner_count, sizeof(int));
    memcpy(reader->corners + first, corners, (size_t)count * sizeof(int));
    reader->polygons =
        reader_grow(reader->polygons, &reader->polygon_room, polygons + 1, sizeof *reader->polygons);
    reader->polygons[reader->polygon_count++] = (Polygon){reader->mesh->face_count, count, first};
}

bool reader_add_face(MeshReader *reader, const Scan *scan, const int *corners, int count)
{
    if (count < 3)
        return scan_refuse(scan, "a face with %d corner%s; it has three at least", count,
                           count == 1 ? "" : "s");
    if (count > POLYGON_MAX_CORNERS)
        return scan_refuse(scan, "a face with more than %d corners; triangulate it", POLYGON_MAX_CORNERS);
    if (reader->mesh->face_count > READER_MAX_INDEX)
        return scan_refuse(scan, "more than %d faces", READER_MAX_INDEX);
    if (count > 3) add_polygon(reader, corners, count);
    for (int i = 1; i + 1 < count; i++)
        add_triangle(reader, corners[0], corners[i], corners[i + 1], scan->line);
    return true;
}

/* ---- Tetrahedra ---- */

bool reader_add_cell(MeshReader *reader, const Scan *scan, const int *nodes, int count)
{
    MeshFile *mesh = reader->mesh;
    size_t cells = (size_t)mesh->cell_count, room = reader->cell_room, each = (size_t)count;
    if (cells && count != mesh->cell_nodes)
        return scan_refuse(scan, "a tetrahedron of %d nodes after one of %d: all of a mesh have as many",
                           count, mesh->cell_nodes);
    if (cells * each > READER_MAX_INDEX)
        return scan_refuse(scan, "more than %d tetrahedra", (int)(READER_MAX_INDEX / each));
    mesh->cell_nodes = count;
    mesh->cells = reader_grow(mesh->cells, &reader->cell_room, cells + 1, each * sizeof *mesh->cells);
    mesh->cell_line = reader_grow(mesh->cell_line, &room, cells + 1, sizeof *mesh->cell_line);
    memcpy(mesh->cells + cells * each, nodes, each * sizeof *nodes);
    mesh->cell_line[cells] = scan->line;
    mesh->cell_count++;
    return true;
}

/* ---- Groups ---- */

typedef struct GroupKey {
    const MeshFile *mesh;
    const char *name;
    int length, dim;
} GroupKey;

static bool same_group(const void *self, int index)
{
    const GroupKey *key = self;
    const MeshGroup *group = &key->mesh->groups[index];
    return group->dim == key->dim && strlen(group->name) == (size_t)key->length &&
           !memcmp(group->name, key->name, (size_t)key->length);
}

int reader_group(MeshReader *reader, const char *name, int length, int dim)
{
    MeshFile *mesh = reader->mesh;
    GroupKey key = {mesh, name, length, dim};
    uint64_t hash = lookup_hash((uint64_t)dim + 1, name, (size_t)length);
    int known = lookup_find(&reader->group_lookup, hash, same_group, &key);
    if (known >= 0) return known;
    size_t count = (size_t)mesh->group_count, room = reader->group_room;
    mesh->groups = reader_grow(mesh->groups, &reader->group_room, count + 1, sizeof *mesh->groups);
    reader->member_room = reader_grow(reader->member_room, &room, count + 1, sizeof *reader->member_room);
    mesh->groups[count] = (MeshGroup){.name = mem_format("%.*s", length, name), .dim = dim};
    lookup_add(&reader->group_lookup, hash, mesh->group_count);
    return mesh->group_count++;
}

void reader_group_add(MeshReader *reader, int index, const int *members)
{
    MeshGroup *group = &reader->mesh->groups[index];
    size_t width = group->dim == 1 ? 2 : 1, used = (size_t)group->count * width;
    group->members = reader_grow(group->members, &reader->member_room[index], used + width, sizeof(int));
    memcpy(group->members + used, members, width * sizeof *members);
    group->count++;
}

void reader_group_add_faces(MeshReader *reader, int group, int first)
{
    for (int f = first; f < reader->mesh->face_count; f++) reader_group_add(reader, group, &f);
}

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

/* ---- The end ---- */

static bool check_corners(const MeshFile *mesh, Scan *scan, int base)
{
    for (int f = 0; f < mesh->face_count; f++)
        for (int i = 0; i < 3; i++) {
            if (mesh->faces[f][i] < mesh->vertex_count) continue;
            if (mesh->face_line) scan->line = mesh->face_line[f];
            return scan_refuse(scan, "vertex %d does not exist: there are %d, counted from %d",
                               mesh->faces[f][i] + base, mesh->vertex_count, base);
        }
    return true;
}

static bool check_groups(const MeshFile *mesh, const Scan *scan, int base)
{
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        int count = group->dim >= 2 ? 0 : group->count * (group->dim + 1);
        for (int k = 0; k < count; k++)
            if (group->members[k] >= mesh->vertex_count)
                return error_set(scan->err, "%s: vertex %d of the group '%.60s' does not exist: there are %d",
                                 scan->path, group->members[k] + base, group->name, mesh->vertex_count);
    }
    return true;
}

static bool split_polygons(const MeshReader *reader, Scan *scan)
{
    const MeshFile *mesh = reader->mesh;
    for (int p = 0; p < reader->polygon_count; p++) {
        const Polygon *polygon = &reader->polygons[p];
        if (polygon_split((const double(*)[3])mesh->vertices, reader->corners + polygon->first_corner,
                          polygon->count, mesh->faces + polygon->first_face))
            continue;
        scan->line = mesh->face_line[polygon->first_face];
        return scan_refuse(
            scan,
            "the face with %d corners crosses itself or has no area: triangulate it (in MeshLab or "
            "Blender), or draw it anew",
            polygon->count);
    }
    return true;
}

bool reader_finish(MeshReader *reader, Scan *scan, int base)
{
    bool ok = check_corners(reader->mesh, scan, base) && check_groups(reader->mesh, scan, base) &&
              split_polygons(reader, scan);
    if (ok) drop_empty_groups(reader->mesh);
    return ok;
}

void reader_drop_lines(MeshReader *reader)
{
    mem_free(reader->mesh->vertex_line);
    mem_free(reader->mesh->face_line);
    reader->mesh->vertex_line = reader->mesh->face_line = NULL;
}

void reader_clear(MeshReader *reader)
{
    lookup_clear(&reader->group_lookup);
    mem_free(reader->polygons);
    mem_free(reader->corners);
    mem_free(reader->member_room);
}
