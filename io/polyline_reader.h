/* polyline_reader.h - a PolylineFile that grows while it is read. Private to its readers. */
#pragma once
#include "io/polyline_file.h"
#include <stddef.h>

typedef struct PolylineReader {
    PolylineFile *lines;
    size_t point_room, strand_room;
    const char *path;
    Error *err;
} PolylineReader;

/* Begins a strand, at that line of the file; one that has got a single point or none by the next is dropped.
 */
void polyline_begin(PolylineReader *reader, int line);

/* Refused beyond twenty million points, with a sentence that does not name the file. */
bool polyline_add(PolylineReader *reader, Vec3 x);

/* The formats of their own files. */
bool polyline_read_obj(PolylineReader *reader, const char *text, size_t length);
bool polyline_read_svg(PolylineReader *reader, const char *text, size_t length);
