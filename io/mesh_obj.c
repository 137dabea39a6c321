/* Wavefront OBJ: v, f, g, o, l and p; all else (normals, textures, materials) is passed over. A backslash at
 * a line's end joins it with the next. */
#include "io/mesh_reader.h"
#include "io/polygon.h"
#include <string.h>

enum { NAMES_MAX = 32, OTHERS_MAX = 5 };

/* The names that hold at the moment: of the last g line, and of the last o line. */
typedef struct Names {
    Word group[NAMES_MAX], object;
    int count;
} Names;

void obj_begin(Scan *scan)
{
    scan->comment = '#';
    scan->joins = true;
}

/* Indices of f, l and p lines: from 1, or from the end when negative; what follows a slash is passed over.
 * Vertices may come later in the file, so the upper end is checked at the end. */
bool obj_index(const Scan *scan, Word word, int vertex_count, int *index)
{
    const char *slash = memchr(word.text, '/', (size_t)word.length);
    Word number = {word.text, slash ? (int)(slash - word.text) : word.length};
    long value;
    if (!word_integer(number, &value) || value == 0 || value > READER_MAX_INDEX || value < -READER_MAX_INDEX)
        return scan_refuse_at(scan, word.text, "'%.*s' is no vertex: they count from 1, or from -1 backwards",
                              word.length > 40 ? 40 : word.length, word.text);
    if (value < 0 && vertex_count + value < 0)
        return scan_refuse_at(scan, word.text, "vertex %ld is before the first one: there are %d so far",
                              value, vertex_count);
    *index = (int)(value > 0 ? value - 1 : vertex_count + value);
    return true;
}

/* A weight or a colour may follow the coordinates. */
bool obj_vertex(Scan *scan, MeshReader *reader)
{
    double x[3], other;
    for (int i = 0; i < 3; i++)
        if (!scan_number(scan, "a coordinate", &x[i])) return false;
    for (int i = 0; i < OTHERS_MAX && scan_more(scan); i++)
        if (!scan_number(scan, "what follows a vertex", &other)) return false;
    reader_add_vertex(reader, x, scan->line);
    return scan_line_ends(scan);
}

static bool is_listed(const Names *names, Word word)
{
    for (int k = 0; k < names->count; k++)
        if (names->group[k].length == word.length &&
            !strncmp(names->group[k].text, word.text, (size_t)word.length))
            return true;
    return false;
}

/* The groups of all names that hold: at most NAMES_MAX + 1. */
static int groups_now(MeshReader *reader, const Names *names, int dim, int *groups)
{
    int count = 0;
    for (int k = 0; k < names->count; k++)
        groups[count++] = reader_group(reader, names->group[k].text, names->group[k].length, dim);
    if (names->object.length && !is_listed(names, names->object))
        groups[count++] = reader_group(reader, names->object.text, names->object.length, dim);
    return count;
}

static void add_to_groups(MeshReader *reader, const Names *names, int dim, const int *members)
{
    int groups[NAMES_MAX + 1], count = groups_now(reader, names, dim, groups);
    for (int k = 0; k < count; k++) reader_group_add(reader, groups[k], members);
}

static bool read_face(Scan *scan, MeshReader *reader, const Names *names)
{
    int corners[POLYGON_MAX_CORNERS], count = 0, first = reader->mesh->face_count;
    for (Word word; scan_word(scan, &word); count++)
        if (count < POLYGON_MAX_CORNERS &&
            !obj_index(scan, word, reader->mesh->vertex_count, &corners[count]))
            return false;
    if (!reader_add_face(reader, scan, corners, count)) return false;
    int groups[NAMES_MAX + 1], group_count = groups_now(reader, names, 2, groups);
    for (int k = 0; k < group_count; k++) reader_group_add_faces(reader, groups[k], first);
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
static bool read_names(Scan *scan, Names *names)
{
    names->count = 0;
    for (Word word; scan_word(scan, &word);) {
        if (is_listed(names, word)) continue;
        if (names->count == NAMES_MAX)
            return scan_refuse_at(scan, word.text, "more than %d groups in one line", NAMES_MAX);
        names->group[names->count++] = word;
    }
    return true;
}

bool mesh_read_obj(Scan *scan, MeshReader *reader)
{
    Names names = {0};
    bool ok = scan_check_text(scan);
    obj_begin(scan);
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
            ok = read_names(scan, &names);
        else if (word_is(word, "o"))
            names.object = scan_rest(scan);
    }
    return ok && reader_finish(reader, scan, 1);
}
