/* polyline_file.h - strands of points from files: CSV, OBJ lines and SVG paths.
 *
 * .csv: one strand; rows x, y, z, or s, x, y, z, of which s must be the arclength (table.h).
 *
 * .obj: `l` lines are strands. Where two of them end at a vertex and no other is there, they are joined:
 * edges (of two vertices) in any order and direction, lines of more vertices head to tail. A strand begins
 * where most of it goes forward. Edges with branches are refused. A file of vertices only is one strand, in
 * their order.
 *
 * .svg: each subpath of a path, polyline, polygon, line, rect, circle or ellipse is a strand: its corners
 * where all of it is straight, else points evenly on its curves, about 512 or eight per piece of curve. In
 * metres by the drawing's size (a unit is 1/96 inch where it says none), x to the right, y up, z = 0, from
 * the upper left corner of the page. What is not displayed, invisible or only defined is passed over, as
 * attributes and styles (svg_tree.h) say; clones (use, symbol) and an svg within the svg are drawn where they
 * are. Texts, images and foreign objects are refused.
 *
 * CSV and OBJ are in metres unless a CSV's header says another unit, or the caller scales them. A closed path ends with its first point. */
#pragma once
#include "base/error.h"
#include "base/vec3.h"

typedef struct PolylineFile {
    int point_count, strand_count;
    Vec3 *points; /* [point_count] m; owned                                                           */
    int *first;   /* [strand_count + 1] strand k has the points first[k] to first[k + 1] - 1; owned   */
    int *line;    /* [strand_count] where in the file it begins; owned                                */
    bool scaled;  /* its header says another unit than m, which is honoured                           */
} PolylineFile;

/* Format by the ending (.csv, .obj, .svg), any case. Each strand has two points at least, and there is one at
 * least. False, an empty *lines and a sentence with file and, where there is one, line, where the file cannot
 * be read or is none of these, and for more than twenty million points. */
bool polyline_file_read(const char *path, PolylineFile *lines, Error *err);

/* The same from memory (tests and fuzzing); format is "csv", "obj" or "svg". */
bool polyline_file_parse(const char *path, const char *format, const char *text, long length,
                         PolylineFile *lines, Error *err);

void polyline_file_clear(PolylineFile *lines);
