/* canvas.h - lines, areas, text and raster images on a page that becomes a PNG, SVG or PDF file.
 *
 * Positions and sizes are points (1/72 inch) from the page's top left corner, y downwards; in a PNG a point
 * is `resolution` pixels. The page starts white. Fonts: the system's "sans-serif" through fontconfig; at
 * least one font must be installed (Debian: fonts-dejavu-core). Text is UTF-8.
 *
 * Drawing never fails: trouble is kept and told by canvas_save. Nothing appears at `path` before that. */
#pragma once
#include "base/error.h"
#include "base/vec3.h"
#include "io/colormap.h"
#include <stddef.h>

enum { CANVAS_MAX_SIDE = 32000 }; /* pixels of a PNG */

typedef struct Canvas Canvas;

typedef struct Box {
    double x, y, width, height;
} Box;

/* Round ends and joins. dash > 0: dashes of that length with gaps as long. */
typedef struct Pen {
    Color color;
    double width, dash;
} Pen;

typedef enum TextAlign { TEXT_LEFT, TEXT_CENTER, TEXT_RIGHT } TextAlign;

typedef struct TextStyle {
    Color color;
    double size; /* of the font, pt */
    TextAlign align;
    bool bold;
    bool upwards; /* turned by 90 degrees, to be read from the right; for vertical axes */
} TextStyle;

/* False and a sentence for another ending than .png, .svg or .pdf, any case. */
bool canvas_check_path(const char *path, Error *err);

/* The format follows path's ending: .png, .svg or .pdf, any case. NULL and a sentence for another ending, or
 * for a page that is not 1..10000 pt (or, as PNG, 32000 pixels) wide and high. */
Canvas *canvas_create(const char *path, double width, double height, double resolution, Error *err);

/* Frees the canvas; without canvas_save nothing is written. NULL is fine. */
void canvas_destroy(Canvas *canvas);

/* Pixels per point with which a raster image should be made to be sharp on this canvas. */
double canvas_resolution(const Canvas *canvas);

/* Writes to path.tmp, checks, and renames it to path: a file that was there stays whole until the new one is.
 */
bool canvas_save(Canvas *canvas, Error *err);

/* What has been drawn on a .png canvas: [height][stride] bytes B, G, R, A; borrowed, until more is drawn. */
const unsigned char *canvas_pixels(Canvas *canvas, int *width, int *height, int *stride);

void canvas_line(Canvas *canvas, Vec2 from, Vec2 to, Pen pen);
void canvas_polyline(Canvas *canvas, const Vec2 *points, int count, Pen pen);
void canvas_polygon(Canvas *canvas, const Vec2 *points, int count, Color fill);
/* Fills what is inside an odd number of closed rings: ring k has the points first[k] to first[k + 1] - 1. */
void canvas_rings(Canvas *canvas, const Vec2 *points, const int *first, int count, Color fill);

void canvas_circle(Canvas *canvas, Vec2 center, double radius, Color fill);
void canvas_fill(Canvas *canvas, Box box, Color fill);
void canvas_frame(Canvas *canvas, Box box, Pen pen);

/* An arrow from tail to tip with a filled head; one shorter than its head is scaled down. */
void canvas_arrow(Canvas *canvas, Vec2 tail, Vec2 tip, Pen pen);

/* `at` is on the baseline: its left end, middle or right end as align says. */
void canvas_text(Canvas *canvas, Vec2 at, const char *text, TextStyle style);

/* How far the text's pen advances, pt. */
double canvas_text_width(Canvas *canvas, const char *text, TextStyle style);

/* Nothing is drawn outside the box until canvas_unclip. Clips nest. */
void canvas_clip(Canvas *canvas, Box box);
void canvas_unclip(Canvas *canvas);

/* What is drawn between the two is one coat of transparent ink: its colours are multiplied with those below. */
void canvas_begin_ink(Canvas *canvas);
void canvas_end_ink(Canvas *canvas);

/* Draws [height][width][4] bytes R, G, B, A (not premultiplied), row 0 on top, stretched over the box. */
void canvas_image(Canvas *canvas, const unsigned char *rgba, int width, int height, Box box);

/* Gets the rows of a PNG, from the top, as bytes R, G, B. */
typedef void CanvasRow(void *self, int row, const unsigned char *rgb);

/* Reads a PNG of any kind over white, at most CANVAS_MAX_SIDE pixels a side. 16 bits are reduced to 8. One
 * that lacks its last chunk, IEND, is read, too; a broken one gets a sentence, in which path names it. */
bool canvas_read_png(const char *path, const unsigned char *png, size_t length, CanvasRow *row, void *self,
                     Error *err);
