/* Models of drawings. */
#include "cli/drawn.h"
#include "cli/model.h"

static void add_static(const Model *model, Arrays *list)
{
    drawn_add_static(model->drawing, list);
}

static const BodyOps drawing_ops = {.add_static = add_static};

bool model_drawing(Model *model, const Scene *scene, YamlFile *file)
{
    model->body = &drawing_ops;
    model->drawing = drawing_create(scene->spline, file);
    return model->drawing != NULL;
}
