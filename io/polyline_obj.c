#include "base/memory.h"
#include "io/mesh_reader.h"
#include "io/polyline_reader.h"
#include <stdio.h>

/* An l line. Its two ends have the numbers 2 k and 2 k + 1. */
typedef struct ObjLine {
    int first, count; /* its vertices                                                  */
    int line;         /* in the file                                                   */
    bool done;        /* it is in a strand                                             */
} ObjLine;

typedef struct Obj {
    MeshFile mesh; /* all vertices, because lines may come before them                */
    int *vertices, vertex_count;
    ObjLine *lines;
    int line_count;
    size_t vertex_room, line_room;
    int *degree;   /* [vertex] lines that end there, twice those that pass through     */
    int (*end)[2]; /* [vertex] the last two ends there                                 */
    bool *edge;    /* [vertex] a line of two vertices ends there                       */
} Obj;

/* ---- Reading ---- */

/* All vertices; tells whether there are lines or faces. */
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

static bool read_line(Scan *scan, Obj *obj, int so_far)
{
    size_t count = (size_t)obj->line_count;
    if (count == obj->line_room) {
        obj->line_room = 2 * count + 64;
        obj->lines = mem_resize(obj->lines, count, obj->line_room, sizeof *obj->lines);
    }
    ObjLine *line = &obj->lines[obj->line_count++];
    *line = (ObjLine){.first = obj->vertex_count, .line = scan->line};
    for (Word word; scan_word(scan, &word); line->count++) {
        int index;
        if (!obj_index(scan, word, so_far, &index)) return false;
        if (index >= obj->mesh.vertex_count)
            return scan_refuse(scan, "vertex %d does not exist: there are %d", index + 1,
                               obj->mesh.vertex_count);
        count = (size_t)obj->vertex_count;
        if (count == obj->vertex_room) {
            obj->vertex_room = 2 * count + 64;
            obj->vertices = mem_resize(obj->vertices, count, obj->vertex_room, sizeof *obj->vertices);
        }
        obj->vertices[obj->vertex_count++] = index;
    }
    return line->count > 1 || scan_refuse(scan, "a line needs two vertices at least");
}

static bool read_lines(Scan *scan, Obj *obj)
{
    int so_far = 0;
    while (scan_line(scan)) {
        Word word;
        scan_word(scan, &word);
        so_far += word_is(word, "v");
        if (word_is(word, "l") && !read_line(scan, obj, so_far)) return false;
    }
    return true;
}

/* ---- Joining ---- */

/* Of an end. */
static int vertex_at(const Obj *obj, int end)
{
    const ObjLine *line = &obj->lines[end / 2];
    return obj->vertices[line->first + (end % 2 ? line->count - 1 : 0)];
}

static bool refuse_vertex(const PolylineReader *reader, int line, const char *format, int vertex)
{
    char sentence[200];
    snprintf(sentence, sizeof sentence, format, vertex + 1);
    return error_set(reader->err, "%s:%d: %s", reader->path, line, sentence);
}

/* Which lines end where. Lines of many vertices may meet as they like; an edge goes on where one other line
 * ends. */
static bool find_ends(Obj *obj, const PolylineReader *reader)
{
    size_t vertices = (size_t)obj->mesh.vertex_count;
    obj->degree = mem_alloc(vertices, sizeof *obj->degree);
    obj->end = mem_alloc(vertices, sizeof *obj->end);
    obj->edge = mem_alloc(vertices, sizeof *obj->edge);
    for (int k = 0; k < obj->line_count; k++) {
        const ObjLine *line = &obj->lines[k];
        for (int i = 1; i < line->count - 1; i++) obj->degree[obj->vertices[line->first + i]] += 2;
        for (int end = 2 * k; end < 2 * k + 2; end++) {
            int v = vertex_at(obj, end);
            obj->end[v][obj->degree[v]++ % 2] = end;
            obj->edge[v] |= line->count == 2;
        }
        if (line->count == 2 && vertex_at(obj, 2 * k) == vertex_at(obj, 2 * k + 1))
            return refuse_vertex(reader, line->line, "the line goes from vertex %d to the same",
                                 vertex_at(obj, 2 * k));
    }
    for (int k = 0; k < 2 * obj->line_count; k++) {
        int v = vertex_at(obj, k);
        if (obj->edge[v] && obj->degree[v] > 2)
            return refuse_vertex(reader, obj->lines[k / 2].line,
                                 "more than two lines meet at vertex %d: a rod has no branches", v);
    }
    return true;
}

/* The end of another line at which one goes on from an end: an edge in any direction, lines of more vertices
 * head to tail. -1: none. */
static int joined_to(const Obj *obj, int end)
{
    int v = vertex_at(obj, end), other = obj->end[v][0] == end ? obj->end[v][1] : obj->end[v][0];
    bool joins = obj->degree[v] == 2 && other / 2 != end / 2 && (obj->edge[v] || other % 2 != end % 2);
    return joins ? other : -1;
}

/* The lines of a strand from the end of its first one. *forward: vertices passed in the lines' directions
 * less those passed against them. Returns the end at which the last one ends. */
static int follow(Obj *obj, int begin, int *forward)
{
    int end = begin;
    *forward = 0;
    for (int next = begin; next >= 0;) {
        end = next ^ 1;
        *forward += (obj->lines[next / 2].count - 1) * (next % 2 ? -1 : 1);
        obj->lines[next / 2].done = true;
        next = joined_to(obj, end);
        if (next == begin) break; /* a ring */
    }
    return end;
}

static bool add_points(const Obj *obj, int begin, PolylineReader *reader)
{
    int end = begin;
    bool ok = polyline_add(reader, vec3_load(obj->mesh.vertices[vertex_at(obj, begin)]));
    for (int next = begin; ok && next >= 0;) {
        const ObjLine *line = &obj->lines[next / 2];
        end = next ^ 1;
        for (int i = 1; ok && i < line->count; i++) {
            int place = line->first + (next % 2 ? line->count - 1 - i : i);
            ok = polyline_add(reader, vec3_load(obj->mesh.vertices[obj->vertices[place]]));
        }
        next = joined_to(obj, end);
        if (next == begin) break;
    }
    return ok || error_prefix(reader->err, "%s", reader->path);
}

/* The strand of a line: from the end from which most of it goes forward, else from that of the lower vertex.
 */
static bool add_strand(Obj *obj, int k, PolylineReader *reader)
{
    int forward, begin = follow(obj, 2 * k + 1, &forward);
    bool ring = joined_to(obj, begin) >= 0;
    if (ring) begin = 2 * k;
    int other = follow(obj, begin, &forward);
    if (ring && obj->edge[vertex_at(obj, begin)] && obj->edge[vertex_at(obj, begin ^ 1)] &&
        joined_to(obj, begin ^ 1) == (other ^ 1) &&
        obj->lines[begin / 2].count == obj->lines[other / 2].count)
        return refuse_vertex(reader, obj->lines[k].line, "the edge from vertex %d is there twice",
                             vertex_at(obj, begin));
    if (forward < 0 || (forward == 0 && !ring && vertex_at(obj, other) < vertex_at(obj, begin)))
        begin = other;
    polyline_begin(reader, obj->lines[k].line);
    return add_points(obj, begin, reader);
}

static void clear(Obj *obj)
{
    mesh_file_clear(&obj->mesh);
    mem_free(obj->vertices);
    mem_free(obj->lines);
    mem_free(obj->degree);
    mem_free(obj->end);
    mem_free(obj->edge);
}

bool polyline_read_obj(PolylineReader *reader, const char *text, size_t length)
{
    Obj obj = {.mesh = {0}};
    MeshReader vertices = {.mesh = &obj.mesh};
    bool lines = false, faces = false;
    bool ok = scan_skip_mark(reader->path, &text, &length, reader->err);
    Scan scan = scan_start(reader->path, text, length, 0, "", reader->err);
    obj_begin(&scan);
    Scan again = scan;
    ok = ok && scan_check_text(&scan) && read_vertices(&scan, &vertices, &lines, &faces);
    if (ok && faces && !lines)
        ok = error_set(reader->err, "%s: there are faces in it and no lines", reader->path);
    ok = ok && read_lines(&again, &obj) && find_ends(&obj, reader);
    for (int k = 0; ok && k < obj.line_count; k++)
        if (!obj.lines[k].done) ok = add_strand(&obj, k, reader);
    if (ok && !lines) polyline_begin(reader, 1);
    for (int v = 0; ok && !lines && v < obj.mesh.vertex_count; v++)
        ok = polyline_add(reader, vec3_load(obj.mesh.vertices[v])) ||
             error_prefix(reader->err, "%s", reader->path);
    reader_clear(&vertices);
    clear(&obj);
    return ok;
}
