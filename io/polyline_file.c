#include "io/polyline_file.h"
#include "base/memory.h"
#include "io/polyline_reader.h"
#include "io/scan.h"
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

void polyline_begin(PolylineReader *reader, int line)
{
    PolylineFile *lines = reader->lines;
    end_strand(reader);
    size_t count = (size_t)lines->strand_count, room = reader->strand_room;
    if (count + 2 > room) {
        reader->strand_room = 2 * count + 64;
        lines->first = mem_resize(lines->first, room, reader->strand_room, sizeof *lines->first);
        lines->line = mem_resize(lines->line, room, reader->strand_room, sizeof *lines->line);
    }
    lines->line[lines->strand_count] = line;
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

static Vec3 place_of(const Table *table, int row)
{
    return vec3_load(table->values + 4 * (size_t)row + 1);
}

/* By how much the chords on either side of a row turn; at the ends none. */
static double turn_at(const Table *table, int row)
{
    if (row < 1 || row > table->rows - 2) return 0;
    Vec3 x = place_of(table, row), before = vec3_sub(x, place_of(table, row - 1)),
         after = vec3_sub(place_of(table, row + 1), x);
    return atan2(vec3_length(vec3_cross(before, after)), vec3_dot(before, after));
}

/* Is s the points' arclength? A smooth curve is longer than its chords, by no more than arcs that turn as
 * they do; and no shorter than the few chords between far points, in which noise does not count. */
static bool check_arclength(const Table *table, const PolylineReader *reader)
{
    const double slack = 1.02, most = 2; /* rad */
    double far = 0, arcs = 0, s = table->values[4 * (size_t)(table->rows - 1)] - table->values[0];
    int stride = table->rows / 16 > 1 ? table->rows / 16 : 1;
    for (int i = 1; i < table->rows; i++) {
        double chord = vec3_length(vec3_sub(place_of(table, i), place_of(table, i - 1))),
               turn = fmin(fmax(turn_at(table, i - 1), turn_at(table, i)), most);
        arcs += chord * (turn > 0 ? turn / 2 / sin(turn / 2) : 1);
        if (i % stride == 0) far += vec3_length(vec3_sub(place_of(table, i), place_of(table, i - stride)));
    }
    return (far <= slack * s && s <= slack * arcs) ||
           error_set(reader->err,
                     "%s:%d: s grows by %g to here, and the points are %g apart along the curve: s must be "
                     "their arclength, in the unit of x, y, z",
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
    const char *names = table.columns == 3 ? "x [m], y [m], z [m]" : "s [m], x [m], y [m], z [m]";
    ok = ok && table_take_header(&table, reader->path, names, reader->err);
    if (ok && table.columns == 4)
        ok =
            table_check_increasing(&table, reader->path, "s", reader->err) && check_arclength(&table, reader);
    reader->lines->scaled = table.scaled;
    polyline_begin(reader, ok ? table.line[0] : 0);
    for (int i = 0; ok && i < table.rows; i++)
        ok = polyline_add(reader, vec3_load(table.values + (size_t)(i + 1) * (size_t)table.columns - 3)) ||
             error_prefix(reader->err, "%s", reader->path);
    table_clear(&table);
    return ok;
}

/* ---- Reading ---- */

static const struct {
    const char *format;
    bool (*read)(PolylineReader *reader, const char *text, size_t length);
} formats[] = {{"csv", read_csv}, {"obj", polyline_read_obj}, {"svg", polyline_read_svg}};

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
    mem_free(lines->line);
    *lines = (PolylineFile){0};
}
