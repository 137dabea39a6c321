#include "view/show_drawing.h"
#include "spline/drawn.h"
#include "spline/preview.h"

static bool check_options(const ShowDef *def, Error *err)
{
    if (def->frame >= 0 || def->stills || def->seconds > 0)
        return error_set(err, "a drawing has no frames to show; output.every writes SVG files on the way");
    if (def->only) return error_set(err, "--case %s: a drawing has no load cases", def->only);
    if (def->field) return error_set(err, "--field %s: a drawing has no faces to colour", def->field);
    return def->target == PICTURE_TARGET_AUTO || def->target == PICTURE_TARGET_BESIDE ||
           error_set(err, "--target: the target of a drawing is always beside it");
}

bool show_drawing(ShowData *data, const char *picture, Error *err)
{
    Drawn drawn = {0};
    if (!check_options(data->def, err)) return false;
    bool ok = drawn_read(data->result, &drawn, err);
    data->drawn = ok;
    if (ok) {
        SplineGrid target = spline_grid(&drawn.picture);
        ok = spline_preview(picture, &drawn.plot, &drawn.page, &target, data->def->width, err);
    }
    drawn_clear(&drawn);
    return ok;
}
