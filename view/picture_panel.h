/* picture_panel.h - private to picture: one panel, a shaded mesh with what belongs to it. */
#pragma once
#include "view/picture.h"
#include "view/raster.h"

/* What the panels of a page share. Each case has its own centre; scale and direction are the same for all. */
typedef struct PanelStyle {
    const PictureScene *scene;
    double resolution;     /* pixels per point                                               */
    double scale;          /* of the cameras, pixels per metre                               */
    Camera *cameras;       /* [panel] in pixels from the middle of the panel; owned          */
    double *heights;       /* [panel] of what is seen, result and target, points; owned      */
    ColorScale colors;     /* of the field                                                   */
    int arrow_count;       /* 0: no arrows                                                   */
    int *arrow_faces;      /* [arrow_count] faces that carry one; owned                      */
    double arrow_length;   /* m, of the greatest vector                                      */
    double arrow_greatest; /* its size in its unit                                           */
    Color arrow_color;
    double flux_greatest; /* T, over all panels */
} PanelStyle;

/* Fits all panels into width x height points. */
PanelStyle panel_style_create(const PictureScene *scene, double resolution, double width, double height);
void panel_style_clear(PanelStyle *style);

/* Does any panel have a field, vectors? */
bool panel_any_field(const PictureScene *scene);
bool panel_any_vectors(const PictureScene *scene);

/* Draws panel number `index`, or its target alone, into the box. */
void panel_draw_result(Canvas *canvas, const PanelStyle *style, int index, Box box);
void panel_draw_target(Canvas *canvas, const PanelStyle *style, int index, Box box);

/* Axes, the panel's gravity, its flux density and a length, along the box's lower edge. */
void panel_draw_measures(Canvas *canvas, const PanelStyle *style, int index, Box box);

/* The colour of a target that is drawn as wires or dots. */
extern const Color panel_target_ink;
