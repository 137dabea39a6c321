/* raster.h - a small z-buffer: shaded triangle meshes as an image.
 *
 * Each pixel has 3x3 samples, averaged at the end, so that edges are smooth and no seams show between faces.
 * Light: a headlight and a soft key light from the viewer's upper left; both sides of a face are lit. Every
 * drawing call tests and writes depth, so that the order of calls does not matter except for translucent
 * colours, which want to come last. */
#pragma once
#include "base/vec3.h"
#include "io/colormap.h"
#include <stdbool.h>

/* An axonometric view, or a perspective one from `distance`. Pixels: x to the right, y down. */
typedef struct Camera {
    Vec3 right, up, toward; /* orthonormal; toward points from the scene to the eye          */
    Vec3 center;            /* the point seen at (x, y)                                      */
    double x, y;            /* pixels                                                        */
    double scale;           /* pixels per length unit, at the centre                         */
    double distance;        /* of the eye from the centre; 0: infinite, parallel projection  */
} Camera;

/* Where the camera looks from by default: three quarters, from the front, the right and above; z is up. */
extern const Vec3 CAMERA_THREE_QUARTER;

/* Looks at the origin from `from` (any length), with `up` upwards as far as possible; an `up` that is zero or
 * parallel to `from` is replaced by z or y. Parallel projection, one pixel a unit, (0, 0) the origin: fit it.
 */
Camera camera_view(Vec3 from, Vec3 up);

/* Moves and scales the camera so that the points (rows of NaN are left out) fill the middle of width x height
 * pixels but for a margin. perspective > 0: from that many radii of their bounding sphere away (4 is mild).
 * One point or none gives a usable camera. */
void camera_fit(Camera *camera, const double (*points)[3], int count, double width, double height,
                double margin, double perspective);

/* The pixel position of a point, and in z its height above the centre towards the eye, in length units; in a
 * perspective view D h/(D - h), which is linear across the image of a face. NaN for what is beside or behind
 * the eye. */
Vec3 camera_project(const Camera *camera, Vec3 point);

/* The range of the points' pixel positions: low and high corner, z as in camera_project. Points that cannot
 * be seen are left out; false where none is left. */
bool camera_bounds(const Camera *camera, const double (*points)[3], int count, Vec3 *low, Vec3 *high);

typedef struct RasterMesh {
    int vertex_count, face_count;
    const double (*vertices)[3]; /* a face with a NaN vertex is left out                        */
    const int (*faces)[3];
    const Color *face_colors; /* [face]; NULL: color                                         */
    Color color;              /* transparent: wires only                                     */
    Color edge_color;
    double edge_width; /* of the faces' edges, pixels; 0: none                        */
    double hidden;     /* what lies behind other things shows with this much of its opacity */
    double raise;      /* lifts towards the eye by this length in the depth test only */
    bool
        one_sided; /* only faces whose normals point to the eye are seen; those seen edge-on as lines, edge_width wide */
} RasterMesh;

/* What a body meets, at one moment; borrowed. */
typedef struct Surroundings {
    const RasterMesh *obstacles; /* NULL: nothing                                                    */
    int near_count;              /* points of those that a picture has room for, beside the body's own */
    const double (*near)[3];
} Surroundings;

typedef struct Raster Raster;

/* Transparent, width x height pixels, both 1..8000. */
Raster *raster_create(int width, int height);
void raster_destroy(Raster *raster);

void raster_mesh(Raster *raster, const Camera *camera, const RasterMesh *mesh);

/* A round arrow with its middle at `middle`; thickness is the shaft's diameter, the head is 2.6 times as
 * thick. It is raised by its own depth: lying on a surface that faces the eye, it shows whole. */
void raster_arrow(Raster *raster, const Camera *camera, Vec3 middle, Vec3 vector, double thickness,
                  Color color);

/* A ball; where it is behind other things it shines through them. */
void raster_ball(Raster *raster, const Camera *camera, Vec3 center, double radius, Color color);

/* Darkens what lies up to `reach` (length units) below its surroundings: creases, and the places where one
 * part passes over another. strength 0..1. Call it when everything is drawn. */
void raster_occlude(Raster *raster, const Camera *camera, double reach, double strength);

/* What of another raster of the same size lies behind what is drawn here shines through with that opacity. */
void raster_show_through(Raster *raster, const Raster *behind, double opacity);

/* Averages the samples into rgba[height][width][4] bytes, not premultiplied. */
void raster_resolve(const Raster *raster, unsigned char *rgba);
