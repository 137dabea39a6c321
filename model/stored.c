#include "model/stored.h"
#include <string.h>

bool stored_scene(const Array *text, YamlFile **file, Scene *scene)
{
    const char *stored = text->type == ARRAY_TEXT ? text->data : "";
    *scene = (Scene){0};
    *file = yaml_parse("scene", stored, strlen(stored));
    return yaml_load(*file, scene_table(), scene);
}

bool stored_result_scene(Result *result, YamlFile **file, Scene *scene)
{
    Array text;
    *scene = (Scene){0};
    *file = NULL;
    if (!result_read(result, "slender/scene", &text, NULL)) return false;
    bool known = stored_scene(&text, file, scene);
    array_clear(&text);
    return known;
}
