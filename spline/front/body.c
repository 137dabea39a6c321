/* Models of drawings. */
#include "spline/front/drawn.h"
#include "model/model.h"

static void add_static(const Model *model, Arrays *list)
{
    drawn_add_static(model->drawing, list);
}

static const BodyOps drawing_ops = {.add_static = add_static};

/* What says how a pen is lifted needs the file that says so. */
static bool check_plotter(const Scene *scene, YamlFile *file)
{
    if (scene->spline->plotter.z && !scene->output.gcode)
        return yaml_refuse(file, "spline.plotter.z",
                           "this is for the file `output.gcode`, which has no name");
    return !scene->spline->plotter.servo || scene->output.gcode_servo ||
           yaml_refuse(file, "spline.plotter.servo",
                       "this is for the file `output.gcode_servo`, which has no name");
}

bool model_drawing(Model *model, const Scene *scene, YamlFile *file)
{
    if (!check_plotter(scene, file)) return false;
    model->body = &drawing_ops;
    model->drawing = drawing_create(scene->spline, file);
    return model->drawing != NULL;
}
