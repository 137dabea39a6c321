/* THE list of bodies: a scene has one of them. */
#include "rod/front/scene.h"
#include "shell/front/scene.h"
#include "solid/front/scene.h"
#include "spline/front/scene.h"

const BodyRow *const bodies[] = {&shell_body, &rod_body, &solid_body, &spline_body, NULL};
