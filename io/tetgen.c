#include "io/tetgen.h"
#include "base/memory.h"
#include "io/mesh_reader.h"
#include "io/safe_file.h"
#include "io/text.h"

bool tetgen_write(const char *path, const double (*vertices)[3], int vertex_count, double scale,
                  const int (*faces)[3], int face_count, Error *err)
{
    Text text = {0};
    text_add(&text, "%d 3 0 0\n", vertex_count); /* coordinates, attributes, markers */
    for (int v = 0; v < vertex_count; v++)
        text_add(&text, "%d %.17g %.17g %.17g\n", v, scale * vertices[v][0], scale * vertices[v][1],
                 scale * vertices[v][2]);
    text_add(&text, "%d 0\n", face_count);
    for (int f = 0; f < face_count; f++)
        text_add(&text, "3 %d %d %d\n", faces[f][0], faces[f][1], faces[f][2]);
    text_add(&text, "0\n0\n"); /* holes, regions */
    bool ok = safe_file_write(path, text.text, text.length, false, err);
    mem_free(text.text);
    return ok;
}

/* A row's number, which must be the next one. */
static bool row_begins(Scan *scan, long row)
{
    long number;
    return (scan_line(scan) || scan_refuse(scan, "the file ends before its last row")) &&
           scan_integer(scan, "a row's number", row, row, &number);
}

static bool read_node(Scan *scan, MeshReader *reader)
{
    double x[3];
    if (!row_begins(scan, reader->mesh->vertex_count)) return false;
    for (int i = 0; i < 3; i++)
        if (!scan_number(scan, "a coordinate", &x[i])) return false;
    reader_add_vertex(reader, x, scan->line);
    return true;
}

static bool read_tetrahedron(Scan *scan, MeshReader *reader)
{
    int nodes[4];
    if (!row_begins(scan, reader->mesh->cell_count)) return false;
    for (int i = 0; i < 4; i++) {
        long node;
        if (!scan_integer(scan, "a node", 0, reader->mesh->vertex_count - 1L, &node)) return false;
        nodes[i] = (int)node;
    }
    return reader_add_cell(reader, scan, nodes, 4);
}

/* Rows that are counted on the first line; attributes and markers at their ends are passed over. */
static bool read_rows(const char *stem, const char *ending, bool (*read)(Scan *, MeshReader *),
                      MeshReader *reader, Error *err)
{
    char *path = mem_format("%s.%s", stem, ending), *text;
    size_t length;
    long count;
    bool ok = scan_file(path, &text, &length, err);
    if (ok) {
        Scan scan = scan_start(path, text, length, '#', "", err);
        ok = scan_check_text(&scan) && (scan_line(&scan) || scan_refuse(&scan, "the file is empty")) &&
             scan_integer(&scan, "the number of rows", 1, READER_MAX_INDEX, &count);
        for (long k = 0; ok && k < count; k++) ok = read(&scan, reader);
        mem_free(text);
    }
    mem_free(path);
    return ok;
}

bool tetgen_read(const char *stem, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){.path = mem_text(stem)};
    MeshReader reader = {.mesh = mesh};
    bool ok = read_rows(stem, "node", read_node, &reader, err) &&
              read_rows(stem, "ele", read_tetrahedron, &reader, err);
    reader_drop_lines(&reader);
    mem_free(mesh->cell_line);
    mesh->cell_line = NULL;
    reader_clear(&reader);
    if (!ok) mesh_file_clear(mesh);
    return ok;
}
