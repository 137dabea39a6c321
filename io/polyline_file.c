#include "io/polyline_file.h"
#include "base/memory.h"
#include "io/mesh_reader.h"
#include "io/polyline_reader.h"
#include "io/table.h"
#include <string.h>
#include <strings.h>

enum { POINTS_MOST = 20000000 };

/* ---- Growing ---- */

/* Ends the strand that is being read. */
static void end_strand(PolylineReader *reader)
{
    PolylineFile *lines = reader->lines;
    if (lines->strand_count == 0) return;
    int start = lines->first[lines->strand_count - 1];
    if (lines->point_count - start < 2) {
        lines->point_count = start;
        lines->strand_count--;
    }
    lines->first[lines->strand_count] = lines->point_count;
}

void polyline_begin(PolylineReader *reader)
{
    PolylineFile *lines = reader->lines;
    end_strand(reader);
    size_t count = (size_t)lines->strand_count, room = reader->strand_room;
    if (count + 2 > room) {
        reader->strand_room = 2 * count + 64;
        lines->first = mem_resize(lines->first, room, reader->strand_room, sizeof *lines->first);
    }
    lines->first[lines->strand_count++] = lines->point_count;
}

bool polyline_add(PolylineReader *reader, Vec3 x)
{
    PolylineFile *lines = reader->lines;
    size_t count = (size_t)lines->point_count;
    if (count >= POINTS_MOST)
        return error_set(reader->err, "there are more than %d points in it", POINTS_MOST);
    if (count == reader->point_room) {
        reader->point_room = 2 * count + 64;
        lines->points = mem_resize(lines->points, count, reader->point_room, sizeof *lines->points);
    }
    lines->points[lines->point_count++] = x;
    return true;
}

/* ---- CSV ---- */

/* Is s the points' arclength? A smooth curve is longer than its chords, by no more than an arc that turns as
 * they do; and no shorter than the few chords between far points, in which noise does not count. */
static bool check_arclength(const Table *table, const PolylineReader *reader)
{
    const double *row = table->values;
    double far = 0, arcs = 0, s = row[4 * (size_t)(table->rows - 1)] - row[0], slack = 1.02;
    int stride = table->rows / 16 > 1 ? table->rows / 16 : 1;
    Vec3 before = vec3(0, 0, 0);
    for (int i = 1; i < table->rows; i++) {
        Vec3 x = vec3_load(row + 4 * (size_t)i + 1), chord = vec3_sub(x, vec3_load(row + 4 * (size_t)i - 3));
        double length = vec3_length(chord),
               turn = fmin(atan2(vec3_length(vec3_cross(before, chord)), vec3_dot(before, chord)), 2);
        arcs += length * (turn > 0 ? turn / 2 / sin(turn / 2) : 1);
        before = chord;
        if (i % stride == 0) far += vec3_length(vec3_sub(x, vec3_load(row + 4 * (size_t)(i - stride) + 1)));
    }
    return (far <= slack * s && s <= slack * arcs) ||
           error_set(
               reader->err,
               "%s:%d: s grows by %g to here, and the points are %g apart along the curve: s must be their "
               "arclength, in the unit of x, y, z",
               reader->path, table->line[table->rows - 1], s, arcs);
}

static bool read_csv(PolylineReader *reader, const char *text, size_t length)
{
    Table table;
    if (!table_parse(reader->path, text, (long)length, NULL, &table, reader->err)) return false;
    bool ok = table.columns == 3 || table.columns == 4;
    if (!ok)
        error_set(reader->err, "%s:%d: %d number%s in this row; it must be x, y, z or s, x, y, z",
                  reader->path, table.line[0], table.columns, table.columns == 1 ? "" : "s");
    ok = ok &&
         table_check_header(&table, reader->path, "s, x, y, z" + (table.columns == 3 ? 3 : 0), reader->err);
    if (ok && table.columns == 4)
        ok =
            table_check_increasing(&table, reader->path, "s", reader->err) && check_arclength(&table, reader);
    polyline_begin(reader);
    for (int i = 0; ok && i < table.rows; i++)
        ok = polyline_add(reader, vec3_load(table.values + (size_t)(i + 1) * (size_t)table.columns - 3)) ||
             error_prefix(reader->err, "%s", reader->path);
    table_clear(&table);
    return ok;
}

/* ---- OBJ ---- */

/* All vertices, because lines may come before them; tells whether there are lines or faces. */
static bool read_vertices(Scan *scan, MeshReader *vertices, bool *lines, bool *faces)
{
    while (scan_line(scan)) {
        Word word;
        scan_word(scan, &word);
        if (word_is(word, "v") && !obj_vertex(scan, vertices)) return false;
        *lines |= word_is(word, "l");
        *faces |= word_is(word, "f");
    }
    return true;
}

/* An l line; before: the vertex at which the last one ended. */
static bool read_line(Scan *scan, PolylineReader *reader, const MeshFile *mesh, int so_far, int *before)
{
    int count = 0;
    for (Word word; scan_word(scan, &word); count++) {
        int index;
        if (!obj_index(scan, word, so_far, &index)) return false;
        if (index >= mesh->vertex_count)
            return scan_refuse(scan, "vertex %d does not exist: there are %d", index + 1, mesh->vertex_count);
        bool goes_on = count == 0 && index == *before;
        if (count == 0 && !goes_on) polyline_begin(reader);
        if (!goes_on && !polyline_add(reader, vec3_load(mesh->vertices[index])))
            return error_prefix(reader->err, "%s", reader->path);
        *before = index;
    }
    return count > 1 || scan_refuse(scan, "a line needs two vertices at least");
}

static bool read_lines(Scan *scan, PolylineReader *reader, const MeshFile *mesh)
{
    int so_far = 0, before = -1;
    while (scan_line(scan)) {
        Word word;
        scan_word(scan, &word);
        so_far += word_is(word, "v");
        if (word_is(word, "l") && !read_line(scan, reader, mesh, so_far, &before)) return false;
    }
    return true;
}

static bool read_obj(PolylineReader *reader, const char *text, size_t length)
{
    MeshFile mesh = {0};
    MeshReader vertices = {.mesh = &mesh};
    bool lines = false, faces = false;
    bool ok = scan_skip_mark(reader->path, &text, &length, reader->err);
    Scan scan = scan_start(reader->path, text, length, '#', "", reader->err);
    ok = ok && read_vertices(&scan, &vertices, &lines, &faces);
    if (ok && faces && !lines)
        ok = error_set(reader->err, "%s: there are faces in it and no lines", reader->path);
    if (ok && lines) {
        scan = scan_start(reader->path, text, length, '#', "", reader->err);
        ok = read_lines(&scan, reader, &mesh);
    } else {
        polyline_begin(reader);
        for (int v = 0; ok && v < mesh.vertex_count; v++)
            ok = polyline_add(reader, vec3_load(mesh.vertices[v])) ||
                 error_prefix(reader->err, "%s", reader->path);
    }
    mesh_file_clear(&mesh);
    return ok;
}

/* ---- Reading ---- */

static const struct {
    const char *format;
    bool (*read)(PolylineReader *reader, const char *text, size_t length);
} formats[] = {{"csv", read_csv}, {"obj", read_obj}, {"svg", polyline_read_svg}};

bool polyline_file_parse(const char *path, const char *format, const char *text, long length,
                         PolylineFile *lines, Error *err)
{
    *lines = (PolylineFile){0};
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (strcasecmp(format, formats[k].format)) continue;
        PolylineReader reader = {.lines = lines, .path = path, .err = err};
        bool ok = formats[k].read(&reader, text, (size_t)length);
        end_strand(&reader);
        if (ok && lines->strand_count == 0) ok = error_set(err, "%s: there are no lines in it", path);
        if (!ok) polyline_file_clear(lines);
        return ok;
    }
    return error_set(err, "%s: a curve's points are read from .csv, .obj or .svg", path);
}

bool polyline_file_read(const char *path, PolylineFile *lines, Error *err)
{
    const char *dot = strrchr(path, '.');
    char *text;
    size_t length;
    *lines = (PolylineFile){0};
    if (!scan_file(path, &text, &length, err)) return false;
    bool ok = polyline_file_parse(path, dot ? dot + 1 : "", text, (long)length, lines, err);
    mem_free(text);
    return ok;
}

void polyline_file_clear(PolylineFile *lines)
{
    mem_free(lines->points);
    mem_free(lines->first);
    *lines = (PolylineFile){0};
}
