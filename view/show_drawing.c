#include "view/show_drawing.h"
#include "spline/drawn.h"
#include "spline/preview.h"
#include "view/show_film.h"

static bool check_options(const ShowDef *def, Error *err)
{
    if (def->stills)
        return error_set(err,
                         "--stills: a drawing has no moments side by side; --frame shows one of its film");
    if (def->only) return error_set(err, "--case %s: a drawing has no load cases", def->only);
    if (def->field) return error_set(err, "--field %s: a drawing has no faces to colour", def->field);
    return def->target == PICTURE_TARGET_AUTO || def->target == PICTURE_TARGET_BESIDE ||
           error_set(err, "--target: the target of a drawing is always beside it");
}

bool show_drawing(ShowData *data, const char *result, const char *picture, Error *err)
{
    Drawn drawn = {0};
    if (!check_options(data->def, err)) return false;
    bool film = data->def->frame >= 0 || data->def->seconds > 0, ok = drawn_read(data->result, &drawn, err);
    if (ok && film) ok = show_film(data, &drawn, result, picture, err);
    data->drawn = ok || data->drawn;
    if (ok && !film) {
        SplineGrid target = spline_grid(&drawn.picture);
        ok = spline_preview(picture, &drawn.plot, &drawn.page, &target, data->def->width, err);
    }
    drawn_clear(&drawn);
    return ok;
}
