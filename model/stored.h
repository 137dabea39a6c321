/* stored.h - the scene that a journal or a result was made from, which both keep as a text. */
#pragma once
#include "io/result.h"
#include "model/scene.h"

/* False where it cannot be read; clear and destroy in any case. */
bool stored_scene(const Array *text, YamlFile **file, Scene *scene);

/* The same of a result; an empty scene where it keeps none that can be read. */
bool stored_result_scene(Result *result, YamlFile **file, Scene *scene);
