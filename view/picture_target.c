#include "view/picture_target.h"
#include "base/memory.h"
#include <math.h>

static const double DOT = 2.2; /* its radius, points */

static bool is_there(const double x[3])
{
    return isfinite(x[0] + x[1] + x[2]);
}

static bool is_whole(const PictureScene *scene, const double (*target)[3], int face)
{
    const int *v = scene->faces[face];
    return is_there(target[v[0]]) && is_there(target[v[1]]) && is_there(target[v[2]]);
}

bool picture_target_has_face(const PictureScene *scene, const PicturePanel *panel)
{
    for (int f = 0; f < scene->face_count; f++)
        if (is_whole(scene, panel->target, f)) return true;
    return false;
}

PictureTarget picture_target_place(const PictureScene *scene, const PicturePanel *panel)
{
    return picture_target_has_face(scene, panel) ? scene->target : PICTURE_TARGET_OVER;
}

static bool any_but(const PictureScene *scene, PictureTarget place)
{
    for (int i = 0; i < scene->panel_count; i++) {
        const PicturePanel *panel = &scene->panels[i];
        if (panel->target && picture_target_place(scene, panel) != place) return true;
    }
    return false;
}

bool picture_target_any_beside(const PictureScene *scene)
{
    return any_but(scene, PICTURE_TARGET_OVER);
}

bool picture_target_any_over(const PictureScene *scene)
{
    return any_but(scene, PICTURE_TARGET_BESIDE);
}

void picture_target_dots(Raster *raster, const PanelStyle *style, const Camera *camera,
                         const double (*target)[3])
{
    const PictureScene *scene = style->scene;
    double radius = DOT * style->resolution / style->scale;
    bool *drawn = mem_alloc((size_t)scene->vertex_count, sizeof *drawn);
    for (int f = 0; f < scene->face_count; f++)
        for (int i = 0; i < 3 && is_whole(scene, target, f); i++) drawn[scene->faces[f][i]] = true;
    for (int v = 0; v < scene->vertex_count; v++)
        if (!drawn[v] && is_there(target[v]))
            raster_ball(raster, camera, vec3_load(target[v]), radius, panel_target_ink);
    mem_free(drawn);
}
