/* mesh.h - the tetrahedra that a scene describes. */
#pragma once
#include "solid/front/scene.h"
#include "solid/tets.h"

/* At that key ("solid.mesh"), of that order; NULL after a refusal: a key that its source does not take, too. report as for
 * tets_create. */
Tets *solid_read_mesh(const SolidMeshScene *scene, YamlFile *yaml, const char *at, int order,
                      MeshReport *report);
