/* picture_target.h - private to picture: where a panel's target is shown, and how.
 *
 * Faces whose corners all have a target are drawn as a mesh, or as wires over the result; vertices in no such face as dots.
 * A target of dots alone says nothing without the body: it is always over it. */
#pragma once
#include "view/picture_panel.h"

/* Where the panel's target is shown; it must have one. */
PictureTarget picture_target_place(const PictureScene *scene, const PicturePanel *panel);

/* Has any panel its target beside it, over it? */
bool picture_target_any_beside(const PictureScene *scene);
bool picture_target_any_over(const PictureScene *scene);

/* Is any of it a face? */
bool picture_target_has_face(const PictureScene *scene, const PicturePanel *panel);

/* The vertices in no whole face. */
void picture_target_dots(Raster *raster, const PanelStyle *style, const Camera *camera,
                         const double (*target)[3]);
