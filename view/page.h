/* page.h - what pages have in common: size, title and small print, axes and lengths. Private to the pictures
 * of io/.
 *
 * All sizes are points; a page is PAGE_WIDTH wide and as high as it needs. */
#pragma once
#include "io/canvas.h"
#include "view/raster.h"

extern const double PAGE_WIDTH, PAGE_MARGIN, PAGE_GAP;

/* Of text and of lines beside it. */
extern const Color page_ink, page_soft;

/* Of small print and of axes, pt. */
extern const double PAGE_SMALL, PAGE_LABEL;

/* Above everything else: a bold title (NULL: none), and lines in small print. */
typedef struct PageHead {
    const char *title;
    const char *const *lines;
    int line_count;
} PageHead;

/* Where the head ends. */
double page_head_end(PageHead head);
void page_draw_head(Canvas *canvas, PageHead head);

/* Text in a smaller font where it would be wider than the given width; returns where it ends. */
double page_draw_fitted(Canvas *canvas, Vec2 at, const char *text, TextStyle style, double width);

/* The directions of x, y and z as the camera sees them. */
void page_draw_axes(Canvas *canvas, const Camera *camera, Vec2 origin);

/* A round length of at most 60 pt that ends at a place, with its size above; points: of a metre on the page.
 */
void page_draw_length(Canvas *canvas, double points, Vec2 end);

/* The direction of gravity, which is not zero: an arrow of 13 pt with a letter, or where it points at the eye or away a
 * circle with a dot or a cross. */
void page_draw_gravity(Canvas *canvas, const Camera *camera, const double *gravity, Vec2 middle);

/* A pixel width that pictures are made in: false and a sentence outside 400..4000. */
bool page_check_width(const char *path, int width, Error *err);
