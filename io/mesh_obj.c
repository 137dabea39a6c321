/* Wavefront OBJ: v, f, g, o, l and p; all else (normals, textures, materials) is passed over. */
#include "base/memory.h"
#include "io/mesh_reader.h"
#include <string.h>

enum { NAMES_MAX = 32 };

/* The names that hold at the moment: of the last g line, and of the last o line. */
typedef struct Names {
    Word group[NAMES_MAX], object;
    int count;
} Names;

/* Indices of f, l and p lines: from 1, or from the end when negative; what follows a slash is passed over.
 * Vertices may come later in the file, so the upper end is checked at the end. */
bool obj_index(const Scan *scan, Word word, int vertex_count, int *index)
{
    const char *slash = memchr(word.text, '/', (size_t)word.length);
    Word number = {word.text, slash ? (int)(slash - word.text) : word.length};
    long value;
    if (!word_integer(number, &value) || value == 0 || value > READER_MAX_INDEX || value < -READER_MAX_INDEX)
        return scan_refuse(scan, "'%.*s' is no vertex: they count from 1, or from -1 backwards",
                           word.length > 40 ? 40 : word.length, word.text);
    if (value < 0 && vertex_count + value < 0)
        return scan_refuse(scan, "vertex %ld is before the first one: there are %d so far", value,
                           vertex_count);
    *index = (int)(value > 0 ? value - 1 : vertex_count + value);
    return true;
}

bool obj_vertex(Scan *scan, MeshReader *reader)
{
    double x[3];
    for (int i = 0; i < 3; i++)
        if (!scan_number(scan, "a coordinate", &x[i])) return false;
    reader_add_vertex(reader, x, scan->line);
    return true;
}

/* Adds to all names that hold. */
static void add_to_groups(MeshReader *reader, const Names *names, int dim, const int *members)
{
    for (int k = 0; k < names->count; k++)
        reader_group_add(reader, reader_group(reader, names->group[k].text, names->group[k].length, dim),
                         members);
    if (names->object.text)
        reader_group_add(reader, reader_group(reader, names->object.text, names->object.length, dim),
                         members);
}

static bool read_face(Scan *scan, MeshReader *reader, const Names *names)
{
    int v[3], count = 0, face = reader->mesh->face_count;
    for (Word word; scan_word(scan, &word); count++)
        if (count < 3 && !obj_index(scan, word, reader->mesh->vertex_count, &v[count])) return false;
    if (count != 3)
        return scan_refuse(scan, "a face with %d corner%s: slender takes triangles only", count,
                           count == 1 ? "" : "s");
    reader_add_face(reader, v, scan->line);
    add_to_groups(reader, names, 2, &face);
    return true;
}

/* l: edges of a polyline; p: vertices. */
static bool read_members(Scan *scan, MeshReader *reader, const Names *names, int dim)
{
    int pair[2] = {0}, count = 0;
    for (Word word; scan_word(scan, &word); count++) {
        pair[0] = pair[1];
        if (!obj_index(scan, word, reader->mesh->vertex_count, &pair[1])) return false;
        if (dim == 0) add_to_groups(reader, names, 0, &pair[1]);
        if (dim == 1 && count > 0) add_to_groups(reader, names, 1, pair);
    }
    return true;
}

/* No word twice, so that a face is in a group once. */
static void read_names(Scan *scan, Names *names)
{
    names->count = 0;
    for (Word word; scan_word(scan, &word) && names->count < NAMES_MAX;) {
        bool known = false;
        for (int k = 0; k < names->count; k++)
            known |= names->group[k].length == word.length &&
                     !strncmp(names->group[k].text, word.text, (size_t)word.length);
        if (!known) names->group[names->count++] = word;
    }
}

static void read_object(Scan *scan, Names *names)
{
    Word word;
    names->object = scan_word(scan, &word) ? word : (Word){0};
}

static bool check_indices(Scan *scan, const MeshFile *mesh)
{
    for (int f = 0; f < mesh->face_count; f++)
        for (int i = 0; i < 3; i++) {
            if (mesh->faces[f][i] < mesh->vertex_count) continue;
            scan->line = mesh->face_line[f];
            return scan_refuse(scan, "vertex %d does not exist: there are %d", mesh->faces[f][i] + 1,
                               mesh->vertex_count);
        }
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        int count = group->dim == 2 ? 0 : group->count * (group->dim + 1);
        for (int k = 0; k < count; k++)
            if (group->members[k] >= mesh->vertex_count)
                return error_set(scan->err, "%s: vertex %d of the group '%.60s' does not exist: there are %d",
                                 scan->path, group->members[k] + 1, group->name, mesh->vertex_count);
    }
    return true;
}

bool mesh_read_obj(Scan *scan, MeshReader *reader)
{
    Names names = {0};
    bool ok = true;
    while (ok && scan_line(scan)) {
        Word word;
        scan_word(scan, &word);
        if (word_is(word, "v"))
            ok = obj_vertex(scan, reader);
        else if (word_is(word, "f"))
            ok = read_face(scan, reader, &names);
        else if (word_is(word, "l"))
            ok = read_members(scan, reader, &names, 1);
        else if (word_is(word, "p"))
            ok = read_members(scan, reader, &names, 0);
        else if (word_is(word, "g"))
            read_names(scan, &names);
        else if (word_is(word, "o"))
            read_object(scan, &names);
    }
    return ok && check_indices(scan, reader->mesh);
}
