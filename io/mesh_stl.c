/* STL, ASCII and binary (3D Systems, StereoLithography Interface Specification, 1989): facets that name their
 * corners by coordinates. Corners at exactly the same place are one vertex. The solids of ASCII files are
 * groups of faces; normals, attributes and the names in binary files are passed over. */
#include "base/memory.h"
#include "base/weld.h"
#include "io/mesh_reader.h"
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

/* ---- Binary: 80 bytes, the number of facets, and for each its normal, three corners and two bytes ---- */

enum { HEADER = 84, FACET = 50, NORMAL = 12 };

static uint32_t load_u32(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double load_float(const char *bytes)
{
    uint32_t bits = load_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static bool read_facet(Scan *scan, MeshReader *reader, const char *facet)
{
    int first = reader->mesh->vertex_count;
    for (int i = 0; i < 3; i++) {
        double x[3];
        for (int k = 0; k < 3; k++) {
            x[k] = load_float(facet + NORMAL + 4 * (3 * i + k));
            if (!isfinite(x[k]))
                return error_set(scan->err, "%s: a coordinate of facet %d must be a finite number, not %g",
                                 scan->path, reader->mesh->face_count, x[k]);
        }
        reader_add_vertex(reader, x, 0);
    }
    return reader_add_face(reader, scan, (int[3]){first, first + 1, first + 2}, 3);
}

static bool read_binary(Scan *scan, MeshReader *reader)
{
    size_t length = (size_t)(scan->end - scan->next), there = length < HEADER ? 0 : (length - HEADER) / FACET;
    if (length < HEADER)
        return error_set(scan->err, "%s: neither an ASCII nor a binary STL file", scan->path);
    uint32_t count = load_u32(scan->next + HEADER - 4);
    if (count > there)
        return error_set(
            scan->err,
            "%s: neither an ASCII STL file, which begins with solid, nor a whole binary one: there are "
            "%zu of its %u facets",
            scan->path, there, count);
    size_t behind = length - HEADER - FACET * (size_t)count;
    if (behind > 0)
        return error_set(scan->err,
                         "%s: neither an ASCII STL file, which begins with solid, nor a whole binary one: "
                         "%zu bytes follow the %u facets that it counts",
                         scan->path, behind, count);
    bool ok = count < READER_MAX_INDEX / 3 || error_set(scan->err, "%s: more facets than fit", scan->path);
    for (uint32_t f = 0; ok && f < count; f++)
        ok = read_facet(scan, reader, scan->next + HEADER + FACET * (size_t)f);
    reader_drop_lines(reader);
    return ok;
}

/* ---- ASCII ---- */

static bool is_keyword(Word word, const char *text)
{
    return (size_t)word.length == strlen(text) && word_begins(word, text);
}

static bool read_vertex(Scan *scan, MeshReader *reader)
{
    double x[3];
    for (int i = 0; i < 3; i++)
        if (!scan_number(scan, "a coordinate", &x[i])) return false;
    reader_add_vertex(reader, x, scan->line);
    return scan_line_ends(scan);
}

/* At the end of a loop: its corners are the vertices that are in no face yet. */
static bool end_loop(Scan *scan, MeshReader *reader, Word solid)
{
    int face = reader->mesh->face_count, first = 3 * face, corners = reader->mesh->vertex_count - first;
    if (corners != 3) return scan_refuse(scan, "a facet with %d corners; it has three", corners);
    if (!reader_add_face(reader, scan, (int[3]){first, first + 1, first + 2}, 3)) return false;
    if (solid.length) reader_group_add(reader, reader_group(reader, solid.text, solid.length, 2), &face);
    return true;
}

/* The words of a line; *open: within a solid. */
static bool read_words(Scan *scan, MeshReader *reader, Word *solid, bool *open)
{
    Word word;
    scan_word(scan, &word);
    if (is_keyword(word, "vertex")) return read_vertex(scan, reader);
    if (is_keyword(word, "endloop")) return end_loop(scan, reader, *solid);
    if (is_keyword(word, "solid")) {
        *open = true;
        *solid = scan_rest(scan);
    } else if (is_keyword(word, "endsolid")) {
        *open = false;
    } else if (!is_keyword(word, "facet") && !is_keyword(word, "outer") && !is_keyword(word, "endfacet")) {
        return scan_refuse_at(scan, word.text, "'%.*s' is no word of an STL file",
                              word.length > 40 ? 40 : word.length, word.text);
    }
    return true;
}

static bool read_ascii(Scan *scan, MeshReader *reader)
{
    Word solid = {0};
    bool ok = scan_check_text(scan), open = false;
    while (ok && scan_line(scan)) ok = read_words(scan, reader, &solid, &open);
    return ok && (!open || error_set(scan->err, "%s: the file ends before endsolid", scan->path));
}

/* ---- Both ---- */

/* One vertex for all corners at the same place. */
static void weld(MeshFile *mesh)
{
    int count = mesh->vertex_count, *first = mem_alloc((size_t)count, sizeof *first);
    weld_map((const double(*)[3])mesh->vertices, count, 0, first);
    mesh->vertex_count = 0;
    for (int v = 0; v < count; v++) { /* those before v have their new numbers already */
        int u = first[v];
        first[v] = u < v ? first[u] : mesh->vertex_count;
        if (u < v) continue;
        memcpy(mesh->vertices[mesh->vertex_count], mesh->vertices[v], sizeof *mesh->vertices);
        if (mesh->vertex_line) mesh->vertex_line[mesh->vertex_count] = mesh->vertex_line[v];
        mesh->vertex_count++;
    }
    for (int k = 0; k < 3 * mesh->face_count; k++)
        mesh->faces[k / 3][k % 3] = first[mesh->faces[k / 3][k % 3]];
    mem_free(first);
}

/* Binary files may begin with "solid" too: their length tells, or a zero among their first bytes. */
static bool is_binary(const char *text, size_t length)
{
    if (length >= HEADER && length == HEADER + FACET * (size_t)load_u32(text + HEADER - 4)) return true;
    text_skip_mark(&text, &length);
    return length < 5 || strncasecmp(text, "solid", 5) != 0 || memchr(text, 0, length < 512 ? length : 512);
}

bool mesh_read_stl(Scan *scan, MeshReader *reader)
{
    size_t length = (size_t)(scan->end - scan->next);
    bool binary = is_binary(scan->next, length);
    if (!binary) text_skip_mark(&scan->next, &length);
    if (!(binary ? read_binary : read_ascii)(scan, reader)) return false;
    weld(reader->mesh);
    return reader_finish(reader, scan, 0);
}
