/* holds.h - where curves are held: a square each, and of those whose frame is held its axes n1 and n2 and the section's outline;
 * of those that have moved the way from where they began, an open square. They show directions and form: their size is the
 * page's. Plain data that borrows everything. */
#pragma once
#include "io/canvas.h"
#include "view/raster.h"

typedef struct Hold {
    double at[3];        /* m                                              */
    double n1[3], n2[3]; /* unit vectors; NAN: it turns freely             */
    int way_count;
    const double (*way)[3]; /* m, from where it began to `at`; NULL: it has not moved */
} Hold;

typedef struct Holds {
    int count;
    const Hold *items;
    int outline_count;
    const double (*outline)[2]; /* a polygon, along n1 and n2; of any size */
} Holds;

/* Is a frame held? Has one moved? */
bool holds_have_frames(const Holds *holds);
bool holds_have_ways(const Holds *holds);

/* What the camera, of one pixel a point, sees of them from `origin` on the page. */
void holds_draw(Canvas *canvas, const Holds *holds, const Camera *camera, Vec2 origin);

/* A square around `at`; and an axis (1, 2) and a way in a legend, from the left end `at` on. */
void holds_draw_square(Canvas *canvas, Vec2 at, double side);
void holds_draw_axis(Canvas *canvas, int axis, Vec2 at, double length);
void holds_draw_way(Canvas *canvas, Vec2 at, double length);
