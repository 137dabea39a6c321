/* svg_path.h - the data of an SVG path as cubics [SVG 1.1, 8.3 and F.6]. Private to polyline_svg.c. */
#pragma once
#include "base/error.h"
#include "base/vec3.h"
#include <stddef.h>

typedef struct SvgCubic {
    Vec2 at[4];    /* control points                   */
    bool starts;   /* a subpath begins with this one   */
    bool straight; /* a line: the controls on it       */
} SvgCubic;

typedef struct SvgPath {
    SvgCubic *cubics; /* owned */
    int count;
    size_t room;
} SvgPath;

/* Commands and numbers of a `d` attribute; arcs as cubics, to 1e-7 of their radii. False and a sentence,
 * without a file, where the data is wrong. */
bool svg_path_parse(const char *data, SvgPath *path, Error *err);

/* Pairs of coordinates as lines: a polyline, or a polygon if it is closed. */
bool svg_path_parse_points(const char *points, bool closed, SvgPath *path, Error *err);

/* Numbers in a row, split by blanks and at most one comma each; reads up to `most` of them until one does not
 * follow, moves *at behind them, and returns how many. */
int svg_numbers(const char **at, double *values, int most);

void svg_path_clear(SvgPath *path);
